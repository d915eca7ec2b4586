#pragma once
// The driver's cache of compiled shaders, where the disk below it has no room. Mesa writes to its index as to memory: on a full disk that ends the process by
// SIGBUS, in whatever frame needs a new page of it.
#include <string>

namespace pitviper {

/// Takes the room for the index of Mesa's cache, before the first context is made. Where there is none the driver is told to do without its cache (by its
/// environment variables), and what there is to say of that is returned; empty: nothing.
std::string takeRoomForDriverCache();

/// Whether what one context has had compiled another one of this process finds again, as far as the driver's environment says.
bool driverKeepsPrograms();

/// Gets such a line, once a process; nobody without.
using TellOfDriver = void (*)(const char* line);
void tellOfDriverBy(TellOfDriver tell);

/// What GlContext calls.
void prepareDriverCache();

}  // namespace pitviper

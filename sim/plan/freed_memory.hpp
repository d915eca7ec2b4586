#pragma once
// Memory that planning has used and nobody needs any more.

namespace pitviper {

/// Back to the system with what has been freed: the C library keeps it, for each thread that has planned its own. Some milliseconds.
void giveBackFreedMemory();

}  // namespace pitviper

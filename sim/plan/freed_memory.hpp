#pragma once
// Memory that planning has used and nobody needs any more.

namespace pitviper {

/// Gives memory that has been freed back to the system: the C library keeps it for each thread that has planned. Takes some milliseconds.
void giveBackFreedMemory();

}  // namespace pitviper

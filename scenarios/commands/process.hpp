#pragma once
// What the program is to the system that runs it: its signals, its streams, its last words.
#include <functional>

namespace pitviper {

/// Called once, first of all, while there is one thread. From then on: SIGINT, SIGTERM and SIGHUP remove what is half written, say so and end the program
/// with 128 + the signal's number (those that are ignored stay so); a file beyond its size limit is an error of the write; memory that is not there ends
/// the program with a message and 2, in whatever thread; streams that were closed read and write nothing, and writing is then an error.
void prepareProcess();

/// While it lives the first SIGINT, SIGTERM or SIGHUP calls `end` (on another thread) instead of ending the program, which then ends by itself; the second is
/// as ever.
class EndsItself {
 public:
  explicit EndsItself(std::function<void()> end);
  ~EndsItself();
  EndsItself(const EndsItself&) = delete;
  EndsItself& operator=(const EndsItself&) = delete;
};

/// One line on stderr, whatever the text holds: readable() of it.
void tell(const char* message);

/// Flushes stdout. `code` unless what was printed could not be written: then a message and 1, or `code` where that is an error already.
int finishOutput(int code);

/// What std::bad_alloc comes to: a message without taking memory. Returns the exit code, 2.
int tellOutOfMemory();

}  // namespace pitviper

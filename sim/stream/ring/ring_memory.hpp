#pragma once
// A shared memory object with one writer. It gets its name when it is whole, and is locked for as long as its writer lives: what ends a writer, at whatever
// moment, leaves no memory without a name, and a name that the next writer may take.
#include <cstddef>
#include <functional>
#include <string>

namespace pitviper {

/// For a program that is about to end by a signal: no ring of its own stays.
void removeOpenRings();

class RingMemory {
 public:
  /// Of so many bytes, all of them there, first written by `fill`. Errors: std::runtime_error (another process has the name, no memory), one line.
  RingMemory(std::string name, std::size_t bytes, const std::function<void(char*)>& fill);
  /// Takes the name away, unless it is another's by now.
  void unlink();
  ~RingMemory();
  RingMemory(const RingMemory&) = delete;
  RingMemory& operator=(const RingMemory&) = delete;
  char* at() const { return static_cast<char*>(at_); }
  /// Lets `write` write to it. Who may write to the object may also cut it short, and a touch beyond its end would end the process: false then, the rest of
  /// what is written, now and later, is in memory that nobody else sees.
  bool write(const std::function<void()>& write);

 private:
  void place();
  std::string name_;
  std::size_t bytes_ = 0;
  int file_ = -1;
  void* at_ = nullptr;
  bool isCut_ = false;
};

}  // namespace pitviper

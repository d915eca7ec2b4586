#pragma once
// The writer's side of frames in shared memory. Layout and rules: pitviper_stream.h beside this.
#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"
#include "sim/stream/ring/pitviper_stream.h"
#include "sim/stream/ring/ring_memory.hpp"

namespace pitviper {

struct RingLayer {
  std::string name, unit;
  bool isCounts = false;    ///< whole numbers up to `maximum`, else floats as they are
  bool isRadiance = false;  ///< of counts: frames say what they are in radiance
  std::uint16_t maximum = 65535;
};

struct RingDesign {
  std::string name;  ///< of the object: "/pitviper.tracker"
  std::string scenario, camera;
  int width = 0, height = 0, slots = 8;
  double rate_hz = 0.0;           ///< of simulation time
  std::vector<RingLayer> layers;  ///< at most PITVIPER_STREAM_LAYERS
};

/// Why a name is none; empty: it is one.
std::string wrongRingName(const std::string& name);

class RingWriter {
 public:
  /// Takes the place of one whose writer is no more. Errors: std::runtime_error (another process writes it, no memory), one line.
  explicit RingWriter(const RingDesign& design);
  /// Readers are told that the stream has ended; the object goes when the last of them has left it.
  ~RingWriter();
  RingWriter(const RingWriter&) = delete;
  RingWriter& operator=(const RingWriter&) = delete;
  /// Never waits. The frame has the design's layers and size, or they stay dark. Errors: std::runtime_error where the object was cut short.
  void publish(const Frame& frame);
  std::uint64_t published() const { return published_; }

 private:
  pitviper_stream_header& header() const { return *reinterpret_cast<pitviper_stream_header*>(memory_->at()); }
  void fill(pitviper_stream_header& h, std::size_t bytes) const;
  void write(const Frame& frame);
  void wakeReaders(std::uint32_t wake);
  RingDesign design_;
  std::unique_ptr<RingMemory> memory_;
  std::size_t headerBytes_ = 0, slotBytes_ = 0;
  std::vector<std::size_t> offsets_;  ///< of layers in a slot
  std::atomic<std::uint64_t> published_{0};
};

}  // namespace pitviper

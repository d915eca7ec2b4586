#pragma once
// A camera on the network for clients of machine vision: compatible with GVCP and GVSP, tested with Aravis. No claim of GigE Vision certification.
#include <memory>

#include "sim/stream/gige/gige_types.hpp"

namespace pitviper {

class GigeDevice {
 public:
  /// Answers clients as soon as it is there. Errors: std::runtime_error with one line of what is wrong with the settings or the network.
  GigeDevice(const GigeSettings& settings, GigeCallbacks callbacks);
  GigeDevice(const GigeDevice&) = delete;
  GigeDevice& operator=(const GigeDevice&) = delete;
  /// Ends its threads within some milliseconds; a client notices by its heartbeat.
  ~GigeDevice();

  // All of these may be called from any thread, callbacks included, and return at once.

  /// Sends the picture if a client streams, and has triggered it where it wants triggers. Only the latest few wait for the sender; older ones are skipped and
  /// counted. Errors: std::invalid_argument where the picture has not the size of the camera.
  void publish(std::shared_ptr<const GigePicture> picture);
  /// A pulse on Line1.
  void trigger();
  bool isControlled() const;
  bool isStreaming() const;
  GigeCounts counts() const;

 private:
  class Running;
  std::unique_ptr<Running> running_;
};

}  // namespace pitviper

#pragma once
// A projector: a window on a thread of its own.
#include <memory>

#include "sim/stream/on_demand/own_thread.hpp"
#include "sim/stream/projector/frame_mailbox.hpp"
#include "sim/stream/projector/projector_module.hpp"

namespace pitviper {

class WindowProjector final : public Projector {
 public:
  /// Throws ProjectorFailure.
  explicit WindowProjector(const ProjectorOptions& options);
  ~WindowProjector() override;

  void show(std::span<const std::uint16_t> codes, std::uint64_t sequence) override;
  bool waitSwap(ProjectorSwap& swap, std::int64_t timeout_ns) override;
  bool closed() const override;
  std::string error() const override;
  ProjectorCounts counts() const override;
  double rate_hz() const override;
  bool isPaced() const override;

 private:
  struct Shared;
  static void run(Shared& shared, const ProjectorOptions& options);

  std::vector<ShownCode> table_;
  size_t pixels_;
  ShownFrame next_;
  std::shared_ptr<Shared> shared_;
  OwnThread thread_;
};

}  // namespace pitviper

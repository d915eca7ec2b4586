#include "sim/stream/ring/ring_writer.hpp"

#include <algorithm>
#include <cctype>
#include <climits>
#include <cstring>
#include <stdexcept>

#include "sim/frame/frame_number.hpp"
#include "sim/frame/mark_header.hpp"
#include "sim/frame/version.hpp"
#include "sim/image/grey_codes.hpp"
#include "sim/stream/clock/wall_clock.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kPage = 4096;

std::size_t whole(std::size_t bytes, std::size_t of) { return (bytes + of - 1) / of * of; }

template <std::size_t N>
void copyText(char (&to)[N], const std::string& text) {
  const std::size_t count = std::min(text.size(), N - 1);
  std::memcpy(to, text.data(), count);
  to[count] = 0;
}

}  // namespace

std::string wrongRingName(const std::string& name) {
  if (name.size() < 2 || name[0] != '/' || name.size() > NAME_MAX) return "a slash and up to 254 letters";
  for (std::size_t k = 1; k < name.size(); ++k)
    if (!std::isalnum(static_cast<unsigned char>(name[k])) && name[k] != '.' && name[k] != '_' && name[k] != '-')
      return "letters, digits, '.', '_' and '-' after one slash";
  return name == "/." || name == "/.." ? "a name" : "";
}

RingWriter::RingWriter(const RingDesign& design) : design_(design) {
  if (design_.layers.size() > PITVIPER_STREAM_LAYERS) design_.layers.resize(PITVIPER_STREAM_LAYERS);
  const std::size_t pixels = static_cast<std::size_t>(design_.width) * static_cast<std::size_t>(design_.height);
  slotBytes_ = whole(sizeof(pitviper_stream_frame), 64);
  for (const RingLayer& l : design_.layers) {
    offsets_.push_back(slotBytes_);
    slotBytes_ += whole(pixels * (l.isCounts ? sizeof(std::uint16_t) : sizeof(float)), 64);
  }
  slotBytes_ = whole(slotBytes_, kPage);
  headerBytes_ = whole(sizeof(pitviper_stream_header), kPage);
  const std::size_t bytes = headerBytes_ + static_cast<std::size_t>(design_.slots) * slotBytes_;
  memory_ = std::make_unique<RingMemory>(design_.name, bytes, [&](char* at) { fill(*reinterpret_cast<pitviper_stream_header*>(at), bytes); });
}

void RingWriter::fill(pitviper_stream_header& h, std::size_t bytes) const {
  std::memcpy(h.magic, PITVIPER_STREAM_MAGIC, sizeof h.magic);
  h.version = PITVIPER_STREAM_VERSION;
  h.header_bytes = static_cast<std::uint32_t>(headerBytes_);
  h.slot_bytes = slotBytes_;
  h.total_bytes = bytes;
  h.slots = static_cast<std::uint32_t>(design_.slots);
  h.layers = static_cast<std::uint32_t>(design_.layers.size());
  h.width = static_cast<std::uint32_t>(design_.width);
  h.height = static_cast<std::uint32_t>(design_.height);
  h.writer_pid = getpid();
  h.rate_hz = design_.rate_hz;
  copyText(h.program, std::string("pitviper ") + kVersion);
  copyText(h.scenario, design_.scenario);
  copyText(h.camera, design_.camera);
  for (std::size_t k = 0; k < design_.layers.size(); ++k) {
    const RingLayer& l = design_.layers[k];
    copyText(h.layer[k].name, l.name);
    copyText(h.layer[k].unit, l.unit);
    copyText(h.layer[k].radiance_unit, l.isCounts && l.isRadiance ? "W/(m2 sr)" : "");
    h.layer[k].type = l.isCounts ? PITVIPER_UINT16 : PITVIPER_FLOAT32;
    h.layer[k].maximum = l.maximum;
    h.layer[k].offset = offsets_[k];
  }
}

RingWriter::~RingWriter() {
  memory_->unlink();
  memory_->write([&] {
    __atomic_store_n(&header().ended, 1u, __ATOMIC_RELEASE);
    wakeReaders(static_cast<std::uint32_t>(published_ + 1));
  });
}

void RingWriter::wakeReaders(std::uint32_t wake) {
  __atomic_store_n(&header().wake, wake, __ATOMIC_RELEASE);
  syscall(SYS_futex, &header().wake, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

void RingWriter::publish(const Frame& frame) {
  if (memory_->write([&] { write(frame); })) return;
  throw std::runtime_error("shared memory " + design_.name +
                           " was cut short by another process while frames went there; expected that readers map it for reading only; fix: end what writes to "
                           "it, and stream again");
}

void RingWriter::write(const Frame& frame) {
  // Nothing is read from the header: others may have written to it.
  const std::uint64_t k = published_;
  auto* slot = memory_->at() + headerBytes_ + k % static_cast<std::uint64_t>(design_.slots) * slotBytes_;
  auto& f = *reinterpret_cast<pitviper_stream_frame*>(slot);
  __atomic_store_n(&f.lock, 2 * k + 1, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  const FrameStamp s = frame.stamp.value_or(FrameStamp{});
  f.sequence = frame.stamp ? s.sequence : static_cast<std::uint64_t>(frame.number);
  f.host_frame = s.hostFrame;
  f.flags = 0;
  if (s.isLate) f.flags |= PITVIPER_LATE;
  if (s.isRepeated) f.flags |= PITVIPER_REPEATED;
  if (s.isOutsideLimits) f.flags |= PITVIPER_OUTSIDE_LIMITS;
  f.time_ns = s.time_ns, f.exposure_start_ns = s.exposureStart_ns, f.exposure_end_ns = s.exposureEnd_ns;
  f.render_start_tai_ns = s.renderStart_tai_ns, f.render_end_tai_ns = s.renderEnd_tai_ns, f.due_tai_ns = s.due_tai_ns;
  f.pose_age_ns = s.poseAge_ns;
  f.dropped = s.dropped, f.late = s.late, f.repeated = s.repeated;
  f.accuracy = s.accuracy, f.predicted_error = s.predictedError;
  for (int i = 0; i < 3; ++i) f.position_ecef_m[i] = s.position_ecef_m[i], f.sight_ecef[i] = s.sight_ecef[i];
  f.latitude_deg = s.latitude_deg, f.longitude_deg = s.longitude_deg, f.height_m = s.height_m;
  const glm::dquat& q = s.orientation_ecef;
  const double wxyz[4] = {q.w, q.x, q.y, q.z};
  std::copy(std::begin(wxyz), std::end(wxyz), f.orientation_ecef_wxyz);
  f.truth_column_px = s.column_px, f.truth_row_px = s.row_px;
  f.exposure_s = numberOf(frame, "pitviper.exposure_s", 0.0);
  for (const auto& [channel, tally] : markTallies(frame))
    if (tally.full > 0) f.flags |= PITVIPER_SATURATED;
  const std::size_t pixels = static_cast<std::size_t>(design_.width) * static_cast<std::size_t>(design_.height);
  for (std::size_t l = 0; l < design_.layers.size(); ++l) {
    const RingLayer& design = design_.layers[l];
    f.gain[l] = 1.0, f.offset[l] = 0.0;
    if (design.isCounts) {
      const std::string calibration = "calibration." + design.name + ".";
      f.gain[l] = numberOf(frame, calibration + "radiance_per_count", 0.0);
      f.offset[l] = numberOf(frame, calibration + "radiance_at_0", 0.0);
    }
    char* to = slot + offsets_[l];
    const auto layer = std::find_if(frame.layers.begin(), frame.layers.end(), [&](const FrameLayer& o) { return o.name == design.name; });
    if (layer == frame.layers.end() || layer->pixels.size() != pixels) {
      std::memset(to, 0, pixels * (design.isCounts ? sizeof(std::uint16_t) : sizeof(float)));
    } else if (design.isCounts) {
      if (toGreyCodes(layer->pixels, 0.0, 1.0, design.maximum, {reinterpret_cast<std::uint16_t*>(to), pixels}) > 0) f.flags |= PITVIPER_SATURATED;
    } else {
      std::memcpy(to, layer->pixels.data(), pixels * sizeof(float));
    }
  }
  f.sent_tai_ns = taiOf_ns(monotonic_ns());
  __atomic_store_n(&f.lock, 2 * k + 2, __ATOMIC_RELEASE);
  published_ = k + 1;
  __atomic_store_n(&header().published, k + 1, __ATOMIC_RELEASE);
  wakeReaders(static_cast<std::uint32_t>(k + 1));
}

}  // namespace pitviper

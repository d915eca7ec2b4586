#include "sim/stream/ring/ring_writer.hpp"

#include <signal.h>

#include <algorithm>
#include <cctype>
#include <climits>
#include <cstring>
#include <mutex>
#include <set>
#include <stdexcept>

#include "sim/frame/frame_number.hpp"
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

/// An object of the name that a living process writes stays.
void removeAbandoned(const std::string& name) {
  const int file = shm_open(name.c_str(), O_RDONLY, 0);
  if (file < 0) return;
  pitviper_stream_header h{};
  const bool is = pread(file, &h, sizeof h, 0) == static_cast<ssize_t>(sizeof h) && std::memcmp(h.magic, PITVIPER_STREAM_MAGIC, sizeof h.magic) == 0;
  close(file);
  if (!is) throw std::runtime_error("shared memory " + name + " is there already and is no stream's; expected a free name; fix: choose another");
  const bool lives = !h.ended && h.writer_pid > 0 && h.writer_pid <= INT_MAX && (kill(static_cast<pid_t>(h.writer_pid), 0) == 0 || errno == EPERM);
  if (lives)
    throw std::runtime_error("shared memory " + name + " is written by process " + std::to_string(h.writer_pid) +
                             "; expected a free name; fix: end that stream, or choose another name");
  shm_unlink(name.c_str());
}

std::mutex gOpen;
std::set<std::string> gOpenRings;

}  // namespace

void removeOpenRings() {
  const std::lock_guard lock(gOpen);
  for (const std::string& name : gOpenRings) shm_unlink(name.c_str());
}

std::string wrongRingName(const std::string& name) {
  if (name.size() < 2 || name[0] != '/' || name.size() > NAME_MAX) return "a slash and up to 254 letters";
  for (std::size_t k = 1; k < name.size(); ++k)
    if (!std::isalnum(static_cast<unsigned char>(name[k])) && name[k] != '.' && name[k] != '_' && name[k] != '-')
      return "letters, digits, '.', '_' and '-' after one slash";
  return name == "/." || name == "/.." ? "a name" : "";
}

RingWriter::RingWriter(const RingDesign& design) : design_(design) {
  if (design_.layers.size() > PITVIPER_STREAM_LAYERS) design_.layers.resize(PITVIPER_STREAM_LAYERS);
  removeAbandoned(design_.name);
  const std::size_t pixels = static_cast<std::size_t>(design_.width) * static_cast<std::size_t>(design_.height);
  std::size_t slotBytes = whole(sizeof(pitviper_stream_frame), 64);
  std::vector<std::size_t> offsets;
  for (const RingLayer& l : design_.layers) {
    offsets.push_back(slotBytes);
    slotBytes += whole(pixels * (l.isCounts ? sizeof(std::uint16_t) : sizeof(float)), 64);
  }
  slotBytes = whole(slotBytes, kPage);
  const std::size_t headerBytes = whole(sizeof(pitviper_stream_header), kPage);
  bytes_ = headerBytes + static_cast<std::size_t>(design_.slots) * slotBytes;
  const auto fail = [&](const char* what, int reason) {
    throw std::runtime_error("shared memory " + design_.name + ": " + what + " (" + std::strerror(reason) + "); expected " + std::to_string(bytes_ >> 20) +
                             " MB in /dev/shm; fix: free it there, or ask for fewer slots");
  };
  const int file = shm_open(design_.name.c_str(), O_RDWR | O_CREAT | O_EXCL, 0600);
  if (file < 0) fail("cannot be made", errno);
  // All of it now: a full disk of memory ends a process at its first touch.
  const int room = ftruncate(file, static_cast<off_t>(bytes_)) != 0 ? errno : posix_fallocate(file, 0, static_cast<off_t>(bytes_));
  at_ = room != 0 ? MAP_FAILED : mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  const int reason = room != 0 ? room : errno;
  close(file);
  if (at_ == MAP_FAILED) {
    shm_unlink(design_.name.c_str());
    fail("there is no room", reason);
  }
  pitviper_stream_header& h = header();
  h.version = PITVIPER_STREAM_VERSION;
  h.header_bytes = static_cast<std::uint32_t>(headerBytes);
  h.slot_bytes = slotBytes;
  h.total_bytes = bytes_;
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
    h.layer[k].offset = offsets[k];
  }
  __atomic_thread_fence(__ATOMIC_RELEASE);
  std::memcpy(h.magic, PITVIPER_STREAM_MAGIC, sizeof h.magic);  // last: who sees it sees the rest
  const std::lock_guard lock(gOpen);
  gOpenRings.insert(design_.name);
}

RingWriter::~RingWriter() {
  shm_unlink(design_.name.c_str());
  {
    const std::lock_guard lock(gOpen);
    gOpenRings.erase(design_.name);
  }
  pitviper_stream_header& h = header();
  __atomic_store_n(&h.ended, 1u, __ATOMIC_RELEASE);
  __atomic_fetch_add(&h.wake, 1u, __ATOMIC_RELEASE);
  syscall(SYS_futex, &h.wake, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
  munmap(at_, bytes_);
}

std::uint64_t RingWriter::published() const { return __atomic_load_n(&header().published, __ATOMIC_ACQUIRE); }

void RingWriter::publish(const Frame& frame) {
  pitviper_stream_header& h = header();
  const std::uint64_t k = h.published;
  auto* slot = static_cast<char*>(at_) + h.header_bytes + k % h.slots * h.slot_bytes;
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
  const std::size_t pixels = static_cast<std::size_t>(design_.width) * static_cast<std::size_t>(design_.height);
  for (std::size_t l = 0; l < design_.layers.size(); ++l) {
    const RingLayer& design = design_.layers[l];
    f.gain[l] = 1.0, f.offset[l] = 0.0;
    if (design.isCounts) {
      const std::string calibration = "calibration." + design.name + ".";
      f.gain[l] = numberOf(frame, calibration + "radiance_per_count", 0.0);
      f.offset[l] = numberOf(frame, calibration + "radiance_at_0", 0.0);
    }
    char* to = slot + h.layer[l].offset;
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
  __atomic_store_n(&h.published, k + 1, __ATOMIC_RELEASE);
  __atomic_store_n(&h.wake, static_cast<std::uint32_t>(k + 1), __ATOMIC_RELEASE);
  syscall(SYS_futex, &h.wake, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace pitviper

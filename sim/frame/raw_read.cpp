// Reads frames of bare bytes behind a short header: raw_file.cpp says how they lie.
#include "sim/frame/frame_notes.hpp"
#include "sim/frame/read_frame.hpp"
#include "sim/image/number_bytes.hpp"
#include "sim/image/picture_file.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {

Frame readRawFrame(const std::filesystem::path& file) {
  const Location where{.file = file.string()};
  const std::string bytes = readWholeFile(file, {.what = "a frame of raw bytes"});
  const auto fail = [&](const std::string& what) { throw UserError(where, what, "a whole frame of raw bytes", "copy or write the file again"); };
  constexpr std::size_t kFixed = 32;
  if (bytes.size() < kFixed || !bytes.starts_with("PITVRAW1")) fail("the file has no header of raw bytes");
  const auto number = [&](std::size_t at) { return static_cast<std::size_t>(numberAt<std::uint32_t>(bytes.data() + at, false)); };
  const std::size_t header = number(8), width = number(12), height = number(16), layers = number(20);
  if (header < kFixed || header > bytes.size()) fail("the file ends within its header");
  FrameNotes notes = frameNotes(bytes.substr(kFixed, header - kFixed), where);
  Frame& frame = notes.frame;
  if (width != static_cast<std::size_t>(frame.width) || height != static_cast<std::size_t>(frame.height) || layers != frame.layers.size())
    fail("the header's numbers and its JSON disagree");
  std::size_t at = header;
  for (std::size_t k = 0; k < layers; ++k) {
    const bool isCodes = notes.codes[k].type == "uint16";
    if (!isCodes && notes.codes[k].type != "float32") fail("a layer is neither uint16 nor float32");
    const NumberType type = isCodes ? NumberType::UInt16 : NumberType::Float32;
    const std::size_t count = width * height;
    if (count * bytesOf(type) > bytes.size() - at) fail("the file ends before its pixels do");
    std::vector<float>& pixels = frame.layers[k].pixels;
    pixels.resize(count);
    eachNumber(type, bytes.data() + at, count, false, [&](std::size_t i, auto value) { pixels[i] = static_cast<float>(value); });
    at += count * bytesOf(type);
  }
  return std::move(notes.frame);
}

}  // namespace pitviper

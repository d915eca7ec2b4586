#include "sim/frame/read_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "sim/frame/frame_notes.hpp"
#include "sim/frame/target_rows.hpp"
#include "sim/image/fits.hpp"
#include "sim/image/png.hpp"
#include "sim/image/tiff.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

/// False too where it cannot be told, as of names that are too long.
bool isFile(const std::filesystem::path& path) {
  std::error_code failure;
  return std::filesystem::is_regular_file(path, failure);
}

Frame frameOf(PictureFile file) {
  Frame frame;
  frame.width = file.width, frame.height = file.height;
  for (ReadPicture& p : file.pictures) frame.layers.push_back({std::move(p.name), std::move(p.unit), std::move(p.pixels)});
  frame.attributes = std::move(file.attributes);
  return frame;
}

Frame readExrFrame(const std::filesystem::path& file) {
  ExrImage image = readExr(file);
  Frame frame;
  frame.width = image.width, frame.height = image.height;
  for (FloatLayer& l : image.layers) {
    const Attribute* unit = image.findAttribute("unit." + l.name);
    const std::string* text = unit ? std::get_if<std::string>(&unit->value) : nullptr;
    frame.layers.push_back({l.name, text ? *text : "", std::move(l.pixels)});
  }
  frame.attributes = std::move(image.attributes);
  return frame;
}

/// What the `.json` beside a TIFF says, where it is of that file.
Frame readTiffFrame(const std::filesystem::path& file) {
  Frame frame = frameOf(readTiff(file));
  std::filesystem::path beside = file;
  beside.replace_extension(".json");
  if (!isFile(beside)) return frame;
  try {
    FrameNotes notes = frameNotes(readWholeFile(beside, {.mostBytes = std::uintmax_t{256} << 20}), {.file = beside.string()});
    if (notes.codes.front().file != file.filename().string()) return frame;
    frame.camera = notes.frame.camera, frame.number = notes.frame.number, frame.time_s = notes.frame.time_s;
    frame.attributes = std::move(notes.frame.attributes);
  } catch (const UserError&) {
    return frame;  // another program's: the pixels are whole without it
  }
  return frame;
}

/// Codes of a grey PNG.
Frame readPngFrame(const std::filesystem::path& file) {
  GreyImage image = readPngGrey(file);
  const float full = static_cast<float>((1 << image.bits) - 1);
  for (float& v : image.pixels) v = std::round(v * full);
  Frame frame;
  frame.width = image.width, frame.height = image.height;
  frame.layers.push_back({"grey", "count", std::move(image.pixels)});
  return frame;
}

/// The layers that a `.json` names, in PNG files beside it; of a TIFF's, that.
Frame readJsonFrame(const std::filesystem::path& file) {
  const Location where{.file = file.string()};
  FrameNotes notes = frameNotes(readWholeFile(file, {.what = "a frame's JSON", .mostBytes = std::uintmax_t{256} << 20}), where);
  Frame& frame = notes.frame;
  for (std::size_t k = 0; k < frame.layers.size(); ++k) {
    const LayerCode& code = notes.codes[k];
    const std::filesystem::path name = code.file;
    if (name.empty() || name != name.filename() || name == file.filename())
      throw UserError(where, "layer '" + code.layer + "' is in the file '" + code.file + "'", "the name of a file beside this one", "write the frame again");
    if (name.extension() == ".tif") return readTiffFrame(file.parent_path() / name);
    Frame grey = readPngFrame(file.parent_path() / name);
    if (grey.width != frame.width || grey.height != frame.height)
      throw UserError(where, "the picture " + code.file + " has another size than the frame", "pictures of the frame's size", "write the frame again");
    std::vector<float>& pixels = frame.layers[k].pixels = std::move(grey.layers.front().pixels);
    if (code.low != 0.0 || code.step != 1.0 || code.zeroIsNone)
      for (float& v : pixels) v = code.zeroIsNone && v == 0.0f ? NAN : static_cast<float>(code.low + code.step * static_cast<double>(v));
  }
  return std::move(notes.frame);
}

struct FrameReader {
  const char* start;
  std::size_t bytes;
  Frame (*read)(const std::filesystem::path&);
};

using ReadFunction = Frame (*)(const std::filesystem::path&);

/// What reads a file, by its content and, of ENVI's pixels, by the header beside it. Null: nothing.
ReadFunction readerOf(const std::filesystem::path& file) {
  static const FrameReader readers[] = {{"\x76\x2f\x31\x01", 4, readExrFrame},
                                        {"SIMPLE  =", 9, [](const std::filesystem::path& f) { return frameOf(readFits(f)); }},
                                        {"II*\0", 4, readTiffFrame},
                                        {"MM\0*", 4, readTiffFrame},
                                        {"II+\0", 4, readTiffFrame},
                                        {"MM\0+", 4, readTiffFrame},
                                        {"\x89PNG\r\n\x1a\n", 8, readPngFrame},
                                        {"PITVRAW1", 8, readRawFrame},
                                        {"ENVI", 4, readEnviFrame},
                                        {"{", 1, readJsonFrame}};
  const std::string start = readFileStart(file, 64);
  for (const FrameReader& r : readers)
    if (start.starts_with(std::string_view(r.start, r.bytes))) return r.read;
  std::filesystem::path header = file;
  header.replace_extension(".hdr");
  if (header != file && (isFile(header) || isFile(file.string() + ".hdr"))) return readEnviFrame;
  return nullptr;
}

void nameLayers(Frame& frame) {
  for (std::size_t k = 0; k < frame.layers.size(); ++k)
    if (frame.layers[k].name.empty()) frame.layers[k].name = "layer_" + std::to_string(k + 1);
  std::stable_partition(frame.layers.begin(), frame.layers.end(), [](const FrameLayer& l) { return !l.name.starts_with("truth."); });
}

/// Camera, number and time, as makeFrame() tells them.
void takeAttributes(Frame& frame) {
  for (const Attribute& a : frame.attributes) {
    const auto numbers = numbersOf(a);
    const bool single = numbers && numbers->size() == 1;
    if (const auto* text = std::get_if<std::string>(&a.value); text && (a.name == "pitviper.camera" || (a.name == "INSTRUME" && frame.camera.empty())))
      frame.camera = *text;
    if (single && a.name == "pitviper.frame" && std::abs(numbers->front()) <= std::numeric_limits<int>::max())
      frame.number = static_cast<int>(numbers->front());
    if (single && a.name == "pitviper.time_s") frame.time_s = numbers->front();
  }
}

}  // namespace

Frame readFrame(const std::filesystem::path& file) {
  const auto read = readerOf(file);
  if (!read)
    throw UserError({.file = file.string()}, "the file is no frame that is read here",
                    "an EXR, FITS, TIFF, ENVI, raw or grey PNG file, or the JSON of PNG files", "name another file, or convert it");
  try {
    Frame frame = read(file);
    nameLayers(frame);
    takeAttributes(frame);
    restoreTargets(frame);
    return frame;
  } catch (const std::bad_alloc&) {
    throw UserError({.file = file.string()}, "the frame is too large for this machine's memory", "a smaller frame", "use a machine with more memory");
  }
}

}  // namespace pitviper

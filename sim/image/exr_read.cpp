#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfRationalAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>

#include "sim/image/exr.hpp"
#include "sim/image/exr_check.hpp"
#include "sim/image/exr_names.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

class MemoryReader : public Imf::IStream {
 public:
  explicit MemoryReader(const std::string& bytes) : Imf::IStream("memory"), bytes_(bytes) {}

  bool read(char to[], int count) override {
    const std::uint64_t size = static_cast<std::uint64_t>(count);
    if (count < 0 || at_ > bytes_.size() || size > bytes_.size() - at_) throw std::runtime_error("the file ends early");
    std::memcpy(to, bytes_.data() + at_, static_cast<std::size_t>(size));
    at_ += size;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = position; }

 private:
  const std::string& bytes_;
  std::uint64_t at_ = 0;
};

std::vector<double> numbersIn(const Imath::M44f& m) { return {m.getValue(), m.getValue() + 16}; }

template <class V>
std::vector<double> listOf(const V& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

std::vector<Attribute> readAttributes(const Imf::Header& header) {
  std::vector<Attribute> found;
  for (auto i = header.begin(); i != header.end(); ++i) {
    const std::string name = i.name();
    if (exr::isReserved(name)) continue;
    const Imf::Attribute& stored = i.attribute();
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&stored)) found.push_back({name, text->value()});
    else if (const auto* real = dynamic_cast<const Imf::DoubleAttribute*>(&stored)) found.push_back({name, real->value()});
    else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&stored)) found.push_back({name, static_cast<double>(single->value())});
    else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&stored)) found.push_back({name, whole->value()});
    else if (const auto* v3d = dynamic_cast<const Imf::V3dAttribute*>(&stored)) found.push_back({name, listOf(v3d->value())});
    else if (const auto* v3f = dynamic_cast<const Imf::V3fAttribute*>(&stored)) found.push_back({name, listOf(v3f->value())});
    else if (const auto* curve = dynamic_cast<const Imf::FloatVectorAttribute*>(&stored)) found.push_back({name, curve->value()});
    else if (const auto* ratio = dynamic_cast<const Imf::RationalAttribute*>(&stored)) found.push_back({name, static_cast<double>(ratio->value())});
    else if (const auto* m44 = dynamic_cast<const Imf::M44fAttribute*>(&stored)) found.push_back({name, numbersIn(m44->value())});
  }
  return found;
}

/// Pixels of the data window where they stand in the display window.
void place(ExrImage& image, const Imath::Box2i& window, const Imath::Box2i& display) {
  const Imath::V2i low(std::max(window.min.x, display.min.x), std::max(window.min.y, display.min.y)),
      high(std::min(window.max.x, display.max.x), std::min(window.max.y, display.max.y));
  const int width = display.max.x - display.min.x + 1, height = display.max.y - display.min.y + 1;
  const auto at = [](int x, int y, const Imath::Box2i& box) {
    return static_cast<std::ptrdiff_t>(y - box.min.y) * (box.max.x - box.min.x + 1) + (x - box.min.x);
  };
  for (FloatLayer& layer : image.layers) {
    std::vector<float> whole(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0f);
    for (int y = low.y; y <= high.y; ++y) {
      const auto from = layer.pixels.begin() + at(low.x, y, window);
      std::copy(from, from + (high.x - low.x + 1), whole.begin() + at(low.x, y, display));
    }
    layer.pixels = std::move(whole);
  }
  image.width = width, image.height = height;
  const PixelBox held{low.x - display.min.x, low.y - display.min.y, high.x + 1 - display.min.x, high.y + 1 - display.min.y};
  if (held.right - held.left < width || held.bottom - held.top < height) image.held = held;
}

ExrImage decode(const std::string& bytes) {
  MemoryReader stream(bytes);
  Imf::InputFile file(stream, 0);
  const Imf::Header& header = file.header();
  const Imath::Box2i window = header.dataWindow(), display = header.displayWindow();
  ExrImage image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  image.attributes = readAttributes(header);
  const std::size_t width = static_cast<std::size_t>(image.width);
  const std::size_t count = width * static_cast<std::size_t>(image.height);
  const bool hasPicture = image.findAttribute(kPictureAttribute) != nullptr;
  const auto isOfPicture = [hasPicture](std::string_view name) { return hasPicture && (name == "R" || name == "G" || name == "B"); };
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
    if (!isOfPicture(i.name())) image.layers.push_back({i.name(), std::vector<float>(count)});
  Imf::FrameBuffer frame;
  for (FloatLayer& layer : image.layers)
    frame.insert(layer.name, Imf::Slice::Make(Imf::FLOAT, layer.pixels.data(), window, sizeof(float), sizeof(float) * width));
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  if (window != display) place(image, window, display);
  return image;
}

}  // namespace

const FloatLayer* ExrImage::find(std::string_view name) const {
  const auto i = std::find_if(layers.begin(), layers.end(), [&](const FloatLayer& layer) { return layer.name == name; });
  return i == layers.end() ? nullptr : &*i;
}

const Attribute* ExrImage::findAttribute(std::string_view name) const {
  const auto i = std::find_if(attributes.begin(), attributes.end(), [&](const Attribute& a) { return a.name == name; });
  return i == attributes.end() ? nullptr : &*i;
}

std::optional<std::vector<double>> numbersOf(const Attribute& attribute) {
  if (const auto* list = std::get_if<std::vector<double>>(&attribute.value)) return *list;
  if (const auto* real = std::get_if<double>(&attribute.value)) return std::vector<double>{*real};
  if (const auto* whole = std::get_if<int>(&attribute.value)) return std::vector<double>{static_cast<double>(*whole)};
  if (const auto* curve = std::get_if<std::vector<float>>(&attribute.value)) return std::vector<double>(curve->begin(), curve->end());
  const std::string& text = std::get<std::string>(attribute.value);
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    double number = 0;
    const auto [next, failure] = std::from_chars(at, end, number);
    if (failure != std::errc() || (next != end && *next != ' ')) return std::nullopt;
    numbers.push_back(number);
    at = next == end ? end : next + 1;
  }
  return numbers;
}

ExrImage readExr(const std::filesystem::path& path) {
  const Location where{.file = path.string()};
  std::string bytes = readWholeFile(path);
  exr::checkHeader(bytes, where.file);
  try {
    return decode(bytes);
  } catch (const std::bad_alloc&) {
    throw UserError(where, "the image is too large for this machine's memory", "a smaller image", "use a machine with more memory");
  } catch (const std::exception& failure) {
    throw UserError(where, std::string("cannot read the EXR image: ") + failure.what(), "a whole EXR file", "copy or render the file again");
  }
}

std::optional<std::string> readExrText(const std::filesystem::path& path, std::string_view name) {
  constexpr std::size_t kLongestHeader = 4u << 20;  // 4096 bodies with their places have 1 MB, 1024 layers 0.3 MB
  try {
    return exr::textIn(readFileStart(path, kLongestHeader), name);
  } catch (const UserError&) {
    return std::nullopt;
  }
}

}  // namespace pitviper

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfRational.h>
#include <ImfRationalAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <exception>
#include <set>
#include <stdexcept>

#include "sim/image/atomic_file.hpp"
#include "sim/image/exr.hpp"
#include "sim/image/exr_names.hpp"

namespace pitviper {
namespace {

/// Encoding goes to memory first: a full disk then shows in our own checked write, not inside the library.
class MemoryWriter : public Imf::OStream {
 public:
  MemoryWriter() : Imf::OStream("memory") {}

  void write(const char bytes[], int count) override {
    const std::size_t size = static_cast<std::size_t>(count);
    if (at_ + size > bytes_.size()) bytes_.resize(at_ + size);
    std::memcpy(bytes_.data() + at_, bytes, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

void checkName(const std::string& name, std::set<std::string_view>& seen, const char* kind) {
  if (name.empty() || name.size() > exr::maxNameBytes || name.find('\0') != std::string::npos)
    throw std::invalid_argument(std::string("writeExr: bad ") + kind + " name '" + name + "'");
  if (!seen.insert(name).second) throw std::invalid_argument(std::string("writeExr: two ") + kind + "s named '" + name + "'");
}

void check(const ExrImage& image) {
  if (image.width < 1 || image.height < 1 || image.width > exr::maxSide || image.height > exr::maxSide)
    throw std::invalid_argument("writeExr: a side is not in 1..32768");
  if (image.layers.empty() || image.layers.size() > static_cast<std::size_t>(exr::maxChannels))
    throw std::invalid_argument("writeExr: the number of layers is not in 1..1024");
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (!image.picture.empty() && image.picture.size() != 3 * count) throw std::invalid_argument("writeExr: the picture is not 3 * width * height");
  std::set<std::string_view> layers, attributes;
  if (!image.picture.empty()) layers = {"R", "G", "B"};
  for (const FloatLayer& layer : image.layers) {
    checkName(layer.name, layers, "layer");
    if (layer.pixels.size() != count) throw std::invalid_argument("writeExr: layer '" + layer.name + "' is not width * height");
  }
  for (const Attribute& attribute : image.attributes) {
    checkName(attribute.name, attributes, "attribute");
    if (exr::isReserved(attribute.name)) throw std::invalid_argument("writeExr: '" + attribute.name + "' is EXR's own attribute");
  }
}

std::string joinNumbers(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) {
    std::array<char, 40> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::general, 17).ptr;
    if (!text.empty()) text += ' ';
    text.append(digits.data(), end);
  }
  return text;
}

/// Those that other programs know by name and type.
bool insertStandard(Imf::Header& header, const Attribute& attribute) {
  const char* name = attribute.name.c_str();
  const auto* number = std::get_if<double>(&attribute.value);
  const auto* list = std::get_if<std::vector<double>>(&attribute.value);
  if (attribute.name == "worldToCamera" && list && list->size() == 16) {
    Imath::M44f matrix;
    for (int k = 0; k < 16; ++k) matrix[k / 4][k % 4] = static_cast<float>((*list)[static_cast<std::size_t>(k)]);
    header.insert(name, Imf::M44fAttribute(matrix));
  } else if (attribute.name == "framesPerSecond" && number) {
    header.insert(name, Imf::RationalAttribute(Imf::Rational(*number)));
  } else if ((attribute.name == "expTime" || attribute.name == "aperture") && number) {
    header.insert(name, Imf::FloatAttribute(static_cast<float>(*number)));
  } else {
    return false;
  }
  return true;
}

void insert(Imf::Header& header, const Attribute& attribute) {
  if (insertStandard(header, attribute)) return;
  const char* name = attribute.name.c_str();
  if (const auto* text = std::get_if<std::string>(&attribute.value)) header.insert(name, Imf::StringAttribute(*text));
  else if (const auto* number = std::get_if<double>(&attribute.value)) header.insert(name, Imf::DoubleAttribute(*number));
  else if (const auto* whole = std::get_if<int>(&attribute.value)) header.insert(name, Imf::IntAttribute(*whole));
  else if (const auto* curve = std::get_if<std::vector<float>>(&attribute.value)) header.insert(name, Imf::FloatVectorAttribute(*curve));
  else if (const auto& list = std::get<std::vector<double>>(attribute.value); list.size() == 3)
    header.insert(name, Imf::V3dAttribute(Imath::V3d(list[0], list[1], list[2])));
  else header.insert(name, Imf::StringAttribute(joinNumbers(list)));
}

std::string encode(const ExrImage& image, ExrCompression compression) {
  Imf::Header header(image.width, image.height);
  header.compression() = compression == ExrCompression::Zip ? Imf::ZIP_COMPRESSION : Imf::NO_COMPRESSION;
  header.zipCompressionLevel() = 4;  // OpenEXR's default since 3.1.3, named so that a later default keeps our bytes
  for (const Attribute& attribute : image.attributes) insert(header, attribute);
  Imf::FrameBuffer frame;
  const std::size_t rowBytes = sizeof(float) * static_cast<std::size_t>(image.width);
  for (const FloatLayer& layer : image.layers) {
    header.channels().insert(layer.name, Imf::Channel(Imf::FLOAT));
    // The library takes one pointer type for reading and writing; it only reads from this one.
    char* base = const_cast<char*>(reinterpret_cast<const char*>(layer.pixels.data()));
    frame.insert(layer.name, Imf::Slice(Imf::FLOAT, base, sizeof(float), rowBytes));
  }
  std::vector<half> picture(image.picture.begin(), image.picture.end());
  for (std::size_t k = 0; k < 3 && !picture.empty(); ++k) {
    constexpr std::array<const char*, 3> names = {"R", "G", "B"};
    header.channels().insert(names[k], Imf::Channel(Imf::HALF));
    frame.insert(names[k], Imf::Slice(Imf::HALF, reinterpret_cast<char*>(picture.data() + k), 3 * sizeof(half),
                                      3 * sizeof(half) * static_cast<std::size_t>(image.width)));
  }
  MemoryWriter stream;
  {
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
  }  // the destructor writes the table of offsets, over bytes that are there already, so it cannot run out of memory
  return stream.bytes();
}

}  // namespace

void writeExr(const std::filesystem::path& path, const ExrImage& image, const MayReplace& mayReplace, ExrCompression compression) {
  check(image);
  std::string bytes;
  try {
    bytes = encode(image, compression);
  } catch (const std::exception& failure) {
    throw OutputError(path, std::string("cannot encode the image: ") + failure.what(), 0, "free memory or make a smaller image");
  }
  writeFileAtomically(path, bytes, mayReplace);
}

}  // namespace pitviper

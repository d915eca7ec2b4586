#pragma once
// Float images with metadata as OpenEXR files. The only place that knows OpenEXR.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim/image/atomic_file.hpp"

namespace pitviper {

/// Row-major, row 0 at the top: width * height values. A dot in the name makes a layer in EXR viewers ("mw.radiance").
struct FloatLayer {
  std::string name;  ///< 1 to 255 bytes, unique in the image
  std::vector<float> pixels;
};

/// Stored as EXR string, double, int, floatvector (a curve) and v3d (a list of 3). EXR has no list of doubles of other lengths; such a list is a
/// string of numbers separated by spaces, exact to the last bit, and comes back as that string: see numbersOf. Standard attributes (OpenEXR, "Standard
/// Optional Attributes") have the types that other programs look for: worldToCamera (16 numbers) is an m44f, framesPerSecond a rational, expTime and aperture
/// are floats.
struct Attribute {
  std::string name;  ///< 1 to 255 bytes, unique, none of EXR's own names
  std::variant<std::string, double, int, std::vector<double>, std::vector<float>> value;
};

/// A file with this attribute has channels R, G and B for people, which are no layers of it.
inline constexpr const char* kPictureAttribute = "pitviper.picture";

/// A part of an image: columns [left, right), rows [top, bottom).
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;
};

struct ExrImage {
  int width = 0;
  int height = 0;
  std::vector<FloatLayer> layers;
  std::vector<Attribute> attributes;
  /// What programs show that know nothing of the layers: linear sRGB, three values a pixel; or empty. Written in half precision as R, G and B, never read
  /// back. kPictureAttribute has to say what it is.
  std::vector<float> picture = {};
  /// What of the image the file has, where its data window leaves some of its display window out: elsewhere pixels are 0.
  std::optional<PixelBox> held = {};

  /// The layer of that name, or null.
  const FloatLayer* find(std::string_view name) const;
  /// The attribute of that name, or null.
  const Attribute* findAttribute(std::string_view name) const;
};

/// The numbers in an attribute however it was stored: a list, a single number, or a string of them. Nothing if it is other text.
std::optional<std::vector<double>> numbersOf(const Attribute& attribute);

/// How pixels are packed. ZIP, without loss, takes a fifth to two fifths less room and 13 to 27 times as long (frames of sixteen and first_light: 97 and 33 ms
/// for 3.6 and 2.5); runs of equal bytes, the fast way that EXR has, find none in floats.
enum class ExrCompression { None, Zip };

/// Scan-line file, 32-bit float channels; the same image gives the same bytes. Written atomically.
/// Errors: OutputError if it cannot be stored; std::invalid_argument if the image breaks the shapes and names above, is empty, is
/// over 32768 on a side or has more than 1024 layers (a caller's bug, not a user's).
/// `mayReplace`: as of writeFileAtomically.
void writeExr(const std::filesystem::path& path, const ExrImage& image, const MayReplace& mayReplace = {}, ExrCompression compression = ExrCompression::None);

/// Reads a single-part file in scan lines or tiles (of several levels the finest), of any compression; half and integer channels become float. The display
/// window is the image: what the data window has beyond it is cut off, what it leaves out is 0 and told by `held`.
/// Layers and attributes come sorted by name. Attributes of types string, double, float, int, v3d and v3f are returned, others and
/// EXR's own are left out.
/// Errors: UserError with the file name if it is missing, damaged, truncated, multi-part, deep, subsampled, over the limits above, or if its two windows have
/// no pixel in common.
ExrImage readExr(const std::filesystem::path& path);

/// A text attribute, from the header alone, read at most 4 MB far. Nothing where it isn't there, or the file is no EXR. Never throws but std::bad_alloc.
std::optional<std::string> readExrText(const std::filesystem::path& path, std::string_view name);

}  // namespace pitviper

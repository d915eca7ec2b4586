// Frames as ENVI files: a text header and bands of 32-bit floats (band sequential, little-endian), as GDAL and ENVI read them.
// Source: L3Harris, "ENVI Header Files" (fields), https://www.nv5geospatialsoftware.com/docs/ENVIHeaderFiles.html
#include <cstdio>

#include "sim/frame/file_formats.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// A header's texts end at braces and commas.
std::string plain(std::string text) {
  for (char& c : text)
    if (c == '{' || c == '}' || c == ',' || c == '\n' || c == '=') c = ' ';
  return text;
}

template <class Of>
std::string listOf(const Frame& frame, const Of& of) {
  std::string list = "{";
  for (const FrameLayer& l : frame.layers) list += (list.size() > 1 ? ", " : "") + of(l);
  return list + "}";
}

/// Ends of a layer's band [um], where it has one.
std::optional<std::pair<double, double>> bandOf(const Frame& frame, const FrameLayer& layer) {
  for (const Attribute& a : frame.attributes) {
    double low = 0.0, high = 0.0;
    if (a.name == "band_um." + layer.name && std::sscanf(std::get<std::string>(a.value).c_str(), "%lf to %lf", &low, &high) == 2) return std::pair(low, high);
    if (a.name != "bin_um." + layer.name) continue;
    if (const auto ends = numbersOf(a); ends && ends->size() == 2) return std::pair(ends->front(), ends->back());
  }
  return std::nullopt;
}

}  // namespace

void writeEnviFiles(const std::filesystem::path& file, const Frame& frame, const FileOptions& options) {
  std::string header = "ENVI\ndescription = {pitviper frame of camera " + plain(frame.camera) + "}\n";
  header += "samples = " + std::to_string(frame.width) + "\nlines = " + std::to_string(frame.height) + "\nbands = " + std::to_string(frame.layers.size()) +
            "\nheader offset = 0\nfile type = ENVI Standard\ndata type = 4\ninterleave = bsq\nbyte order = 0\n";
  header += "band names = " + listOf(frame, [](const FrameLayer& l) { return plain(l.name + " [" + l.unit + "]"); }) + "\n";
  bool all = true;
  for (const FrameLayer& l : frame.layers) all = all && bandOf(frame, l);
  if (all) {  // wavelengths are of every band or of none
    const auto band = [&](const FrameLayer& l) { return *bandOf(frame, l); };
    header += "wavelength units = Micrometers\nwavelength = " +
              listOf(frame, [&](const FrameLayer& l) { return print("%.9g", 0.5 * (band(l).first + band(l).second)); }) +
              "\nfwhm = " + listOf(frame, [&](const FrameLayer& l) { return print("%.9g", band(l).second - band(l).first); }) + "\n";
  }
  for (const Attribute& a : frame.attributes) {
    header += plain(a.name) + " = ";
    if (const auto* text = std::get_if<std::string>(&a.value)) header += plain(*text);
    else if (const auto numbers = numbersOf(a)) {
      std::string list;
      for (double n : *numbers) list += (list.empty() ? "" : ", ") + print("%.9g", n);
      header += numbers->size() == 1 ? list : "{" + list + "}";
    }
    header += "\n";
  }
  std::string bytes;
  for (const FrameLayer& l : frame.layers) bytes.append(reinterpret_cast<const char*>(l.pixels.data()), sizeof(float) * l.pixels.size());
  std::filesystem::path pixels = file;
  writeFileAtomically(pixels.replace_extension(".img"), bytes, options.mayReplace);
  writeFileAtomically(file, header, options.mayReplace);
}

}  // namespace pitviper

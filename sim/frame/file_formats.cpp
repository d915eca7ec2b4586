#include "sim/frame/file_formats.hpp"

#include <algorithm>
#include <stdexcept>

namespace pitviper {

const std::vector<FileFormat>& fileFormats() {
  static const std::vector<FileFormat> all = {
      {"exr", ".exr", "", "OpenEXR, 32-bit floats, all layers and metadata; what programs show that know nothing of layers is a grey picture", writeExrFile},
      {"tiff", ".tif", ".json", "TIFF, a page for each layer: counts as 16-bit codes, the rest as 32-bit floats; metadata in a `.json` beside it",
       writeTiffFile},
      {"png", ".json", "",
       "16-bit PNG, a file `<camera>_<frame>_<layer>.png` for each layer: counts as they are, the rest as codes whose value the `.json` gives", writePngFiles},
      {"fits", ".fits", "", "FITS, an image for each layer (the first is the primary one) with BUNIT, EXPTIME and, where `time` has a date, DATE-OBS",
       writeFitsFile},
      {"envi", ".hdr", ".img", "ENVI, header and `.img`, 32-bit floats, a band for each layer, with wavelengths: for spectral images", writeEnviFiles},
      {"raw", ".raw", "", "bytes behind a short header: its layout is in sim/frame/raw_file.cpp", writeRawFile}};
  return all;
}

const FileFormat& fileFormat(const std::string& name) {
  const auto found = std::find_if(fileFormats().begin(), fileFormats().end(), [&](const FileFormat& f) { return f.name == name; });
  if (found == fileFormats().end()) throw std::invalid_argument("fileFormat: no format '" + name + "'");
  return *found;
}

bool isCounts(const FrameLayer& layer) { return layer.unit == "count"; }

}  // namespace pitviper

#pragma once
// Frames read back from files: those of fileFormats(), and plain ones of other programs.
#include <filesystem>
#include <vector>

#include "sim/frame/frame.hpp"

namespace pitviper {

/// An EXR, FITS, TIFF or ENVI file, one of raw bytes (raw_file.cpp), a grey PNG or the `.json` of several; an ENVI header or the pixels beside it. Told by
/// content, ENVI's pixels by their header. Layers have names and units, the frame attributes, number, time and camera where the file says so; metadata of a
/// TIFF are in the `.json` beside it. Layers without a name are "layer_1", ...; channels come before truth. Targets are restored as far as attributes tell
/// them. Not read back: stamp, kind; the curves of
/// a FITS file's tables. Errors: UserError with the file name for other files, those that are damaged or truncated, layers of different sizes, over 32768 on a
/// side or over 1024.
Frame readFrame(const std::filesystem::path& file);

/// The files of a folder that look like frames, in natural order of their stems ("a_2" before "a_10"), then of their extensions; not those that belong to
/// another one of them. Of a file: itself. Errors: UserError if there is neither.
std::vector<std::filesystem::path> framesIn(const std::filesystem::path& fileOrFolder);

struct FrameDifference {
  std::vector<float> pixels;     ///< b - a, row-major; NaN where either is not finite
  std::size_t compared = 0;      ///< pixels where both are finite
  double rms = 0.0;              ///< in the layer's unit; NaN where nothing is compared, as all that follows
  double largest = 0.0;          ///< of |b - a|
  int column = -1, row = -1;     ///< where that is; -1: nowhere
  double largestRelative = 0.0;  ///< of |b - a| / max(|a|, 1e-3 x the 99th percentile of |a|); 0 where both are 0
  double rmsRelative = 0.0;
};

/// Errors: UserError for frames of different sizes, or without that layer.
FrameDifference differenceOf(const Frame& a, const Frame& b, const std::string& layer);

// Of single formats, without what attributes say of the frame.
Frame readEnviFrame(const std::filesystem::path& file);
Frame readRawFrame(const std::filesystem::path& file);

}  // namespace pitviper

#pragma once
// The formats in which a frame can be a file. A row in file_formats.cpp registers one.
#include <filesystem>
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"
#include "sim/image/exr.hpp"

namespace pitviper {

struct FileOptions {
  ExrCompression compression = ExrCompression::None;
  bool picture = true;  ///< of EXR: R, G and B for people
  MayReplace mayReplace = {};
};

struct FileFormat {
  std::string name;       ///< what `format:` says
  std::string extension;  ///< of the file that says whose it is
  std::string beside;     ///< of one beside it; empty: none
  std::string description;
  /// `file` has that extension; others of the format lie beside it. Errors: OutputError.
  void (*write)(const std::filesystem::path& file, const Frame& frame, const FileOptions& options);
};

const std::vector<FileFormat>& fileFormats();
/// Of a name that is there.
const FileFormat& fileFormat(const std::string& name);

void writeExrFile(const std::filesystem::path& file, const Frame& frame, const FileOptions& options);
void writeFitsFile(const std::filesystem::path& file, const Frame& frame, const FileOptions& options);
void writeTiffFile(const std::filesystem::path& file, const Frame& frame, const FileOptions& options);
void writePngFiles(const std::filesystem::path& file, const Frame& frame, const FileOptions& options);
void writeEnviFiles(const std::filesystem::path& file, const Frame& frame, const FileOptions& options);
void writeRawFile(const std::filesystem::path& file, const Frame& frame, const FileOptions& options);

/// Values are whole, 0 to 65535.
bool isCounts(const FrameLayer& layer);

}  // namespace pitviper

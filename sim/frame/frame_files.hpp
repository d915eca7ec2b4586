#pragma once
// Frames as files.
#include <filesystem>
#include <map>

#include "sim/frame/frame.hpp"
#include "sim/image/exr.hpp"

namespace pitviper {

/// One EXR with a layer per channel quantity and truth layer. `mayReplace`: as of writeFileAtomically. Errors: OutputError.
void writeFrame(const std::filesystem::path& folder, const Frame& frame, const MayReplace& mayReplace = {}, ExrCompression compression = ExrCompression::None);
void writeFrameFile(const std::filesystem::path& file, const Frame& frame, const MayReplace& mayReplace = {},
                    ExrCompression compression = ExrCompression::None);
/// Ends of the colour bar by layer name, in the layer's unit; layers without choose their own.
using PreviewRanges = std::map<std::string, std::pair<double, double>>;
/// One PNG per frame: channels side by side, each with colour bar and unit.
void writePreview(const std::filesystem::path& folder, const Frame& frame, const PreviewRanges& ranges = {}, const MayReplace& mayReplace = {});
void writePreviewFile(const std::filesystem::path& file, const Frame& frame, const PreviewRanges& ranges = {}, const MayReplace& mayReplace = {});

}  // namespace pitviper

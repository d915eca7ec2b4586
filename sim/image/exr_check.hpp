#pragma once
// A strict walk over an EXR header before OpenEXR sees it. The library trusts sizes in the file and allocates by them.
#include <optional>
#include <string>
#include <string_view>

namespace pitviper::exr {

/// Checks magic, version, attribute sizes, channel list and data window against the limits, and the size of the pixels against that of
/// the file. Attributes of types we do not return are made opaque in `bytes`, so that the library skips them unparsed.
/// Errors: UserError naming `file`.
void checkHeader(std::string& bytes, const std::string& file);

/// The value of a text attribute in the beginning of a file. Nothing where there is no such attribute or the bytes are no EXR header.
std::optional<std::string> textIn(std::string_view bytes, std::string_view attribute);

}  // namespace pitviper::exr

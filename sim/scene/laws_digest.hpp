#pragma once
// What tables that are kept between runs depend on besides the content that they are made from: the laws, algorithms and data of this program.
#include <string_view>

namespace pitviper {

/// Of the sources of all that makes such tables (radiometry to plan, atmospheres, materials, sensors), 16 hexadecimal digits: a change of any makes what was
/// kept before a stranger.
std::string_view lawsDigest();

}  // namespace pitviper

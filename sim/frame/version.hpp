#pragma once
// The version that frames carry; the same as the project version in CMakeLists.txt.
namespace pitviper {
/// Program version, written into every frame.
inline constexpr const char* kVersion = "0.1.0";
}  // namespace pitviper

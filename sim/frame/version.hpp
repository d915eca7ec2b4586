#pragma once
namespace pitviper {
/// Program version, written into every frame.
inline constexpr const char* kVersion = "0.1.0";
}  // namespace pitviper

#pragma once
// Pictures that the program writes, read back by libpng alone.
#include <png.h>

#include <filesystem>
#include <stdexcept>

#include "sim/image/picture.hpp"

namespace pitviper::test {

inline Rgb8Image readPng(const std::filesystem::path& path) {
  png_image file{};
  file.version = PNG_IMAGE_VERSION;
  Rgb8Image picture;
  if (png_image_begin_read_from_file(&file, path.c_str())) {
    file.format = PNG_FORMAT_RGB;
    picture.width = static_cast<int>(file.width), picture.height = static_cast<int>(file.height);
    picture.rgb.resize(PNG_IMAGE_SIZE(file));
    png_image_finish_read(&file, nullptr, picture.rgb.data(), 0, nullptr);
  }
  if (PNG_IMAGE_FAILED(file)) throw std::runtime_error(path.string() + ": " + file.message);
  return picture;
}

}  // namespace pitviper::test

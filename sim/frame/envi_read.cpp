// Reads ENVI files: a text header and bands of numbers. Source: L3Harris, "ENVI Header Files" (envi_file.cpp).
#include <algorithm>
#include <charconv>
#include <map>

#include "sim/frame/read_frame.hpp"
#include "sim/image/number_bytes.hpp"
#include "sim/image/picture_file.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

std::string bare(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string_view::npos ? "" : std::string(text.substr(first, text.find_last_not_of(" \t\r\n") + 1 - first));
}

/// `name = value` in their order; a value in braces may go over several lines.
using EnviFields = std::vector<std::pair<std::string, std::string>>;

EnviFields enviFields(std::string_view text) {
  EnviFields fields;
  for (std::size_t at = text.find('\n'); at < text.size();) {
    const std::size_t begin = at + 1;
    std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::size_t equals = text.find('=', begin);
    if (equals < end) {
      if (bare(text.substr(equals + 1, end - equals - 1)).starts_with('{')) {
        const std::size_t close = text.find('}', equals);
        end = close == std::string_view::npos ? text.size() : std::min(text.find('\n', close), text.size());
      }
      fields.emplace_back(bare(text.substr(begin, equals - begin)), bare(text.substr(equals + 1, end - equals - 1)));
    }
    at = end;
  }
  return fields;
}

std::vector<std::string> enviList(const std::string& value) {
  std::vector<std::string> items;
  if (value.size() < 2 || value.front() != '{' || value.back() != '}') return items;
  const std::string inside = value.substr(1, value.size() - 2);
  for (std::size_t at = 0; at <= inside.size();) {
    const std::size_t comma = std::min(inside.find(',', at), inside.size());
    items.push_back(bare(std::string_view(inside).substr(at, comma - at)));
    at = comma + 1;
  }
  return items;
}

std::optional<double> enviNumber(const std::string& text) {
  double number = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

Attribute enviAttribute(const std::string& name, const std::string& value) {
  if (const auto number = enviNumber(value)) return {name, *number};
  std::vector<double> numbers;
  const std::vector<std::string> items = enviList(value);
  for (const std::string& item : items)
    if (const auto number = enviNumber(item)) numbers.push_back(*number);
  if (!items.empty() && numbers.size() == items.size()) return {name, numbers};
  return {name, value};
}

/// The header and the pixels of either.
std::pair<std::filesystem::path, std::filesystem::path> enviFiles(const std::filesystem::path& file) {
  std::filesystem::path header = file, pixels = file;
  std::error_code failure;
  if (file.extension() != ".hdr" && file.extension() != ".HDR") {
    header.replace_extension(".hdr");
    if (!std::filesystem::exists(header, failure)) header = file.string() + ".hdr";
    return {header, pixels};
  }
  for (const char* extension : {"", ".img", ".dat", ".raw", ".bsq", ".bil", ".bip", ".bin"})
    if (std::filesystem::is_regular_file(pixels.replace_extension(extension), failure)) return {header, pixels};
  return {header, pixels.replace_extension(".img")};
}

NumberType enviType(double code, const Location& where) {
  const std::map<double, NumberType> types = {{1, NumberType::UInt8},   {2, NumberType::Int16},   {3, NumberType::Int32},  {4, NumberType::Float32},
                                              {5, NumberType::Float64}, {12, NumberType::UInt16}, {13, NumberType::UInt32}};
  const auto found = types.find(code);
  if (found == types.end()) throw UserError(where, print("data type %g is none that is read here", code), "1, 2, 3, 4, 5, 12 or 13", "convert the file");
  return found->second;
}

}  // namespace

Frame readEnviFrame(const std::filesystem::path& file) {
  const auto [header, data] = enviFiles(file);
  const Location where{.file = header.string()};
  const std::string text = readWholeFile(header, {.what = "an ENVI header", .mostBytes = std::uintmax_t{64} << 20});
  if (!text.starts_with("ENVI")) throw UserError(where, "the file does not begin with ENVI", "an ENVI header", "name another file");
  const EnviFields fields = enviFields(text);
  const auto valueOf = [&](std::string_view name) -> const std::string* {
    for (const auto& [key, value] : fields)
      if (key == name) return &value;
    return nullptr;
  };
  const auto number = [&](const std::string& name, std::optional<double> otherwise, double least, double most) {
    const std::string* value = valueOf(name);
    const std::optional<double> read = value ? enviNumber(*value) : otherwise;
    if (!read || !(*read >= least && *read <= most) || *read != static_cast<double>(static_cast<long long>(*read)))
      throw UserError(where, "'" + name + "' is " + (value ? "'" + *value + "'" : "not there"), print("a whole number from %.0f to %.0f", least, most),
                      "correct the header");
    return static_cast<std::size_t>(*read);
  };
  constexpr double kSide = kMostPictureSide;
  const std::size_t width = number("samples", {}, 1, kSide), height = number("lines", {}, 1, kSide), bands = number("bands", {}, 1, kMostPictures),
                    offset = number("header offset", 0.0, 0, 1e12);
  const NumberType type = enviType(static_cast<double>(number("data type", {}, 0, 100)), where);
  const bool bigEndian = number("byte order", 0.0, 0, 1) == 1;
  std::string order = valueOf("interleave") ? *valueOf("interleave") : "bsq";
  for (char& c : order) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (order != "bsq" && order != "bil" && order != "bip") throw UserError(where, "interleave is '" + order + "'", "bsq, bil or bip", "correct the header");
  const std::string bytes = readWholeFile(data, {.what = "the pixels of an ENVI file", .fix = "put it beside its header"});
  // 2^15 x 2^15 x 2^10 x 2^3 bytes are less than 2^64.
  if (offset > bytes.size() || width * height * bands * bytesOf(type) > bytes.size() - offset)
    throw UserError({.file = data.string()}, "the file is too short for the pixels of its header", "whole pixels", "copy or write the file again");

  Frame frame;
  frame.width = static_cast<int>(width), frame.height = static_cast<int>(height);
  const std::vector<std::string> names = valueOf("band names") ? enviList(*valueOf("band names")) : std::vector<std::string>();
  const bool byBand = order == "bsq", byLine = order == "bil";
  const std::size_t size = bytesOf(type);
  for (std::size_t b = 0; b < bands; ++b) {
    const ReadPicture named = b < names.size() ? namedWithUnit(names[b]) : ReadPicture();
    frame.layers.push_back({named.name, named.unit, std::vector<float>(width * height)});
    std::vector<float>& pixels = frame.layers.back().pixels;
    for (std::size_t y = 0; y < height; ++y) {
      float* to = pixels.data() + y * width;
      const std::size_t at = byBand ? (b * height + y) * width : byLine ? (y * bands + b) * width : y * width * bands + b;
      const char* from = bytes.data() + offset + at * size;
      if (byBand || byLine) {
        eachNumber(type, from, width, bigEndian, [&](std::size_t x, auto value) { to[x] = static_cast<float>(value); });
      } else {
        for (std::size_t x = 0; x < width; ++x)
          eachNumber(type, from + x * bands * size, 1, bigEndian, [&](std::size_t, auto value) { to[x] = static_cast<float>(value); });
      }
    }
  }
  for (const auto& [name, value] : fields) {
    const auto isShape = [&](const char* known) { return name == known; };
    static constexpr const char* kShape[] = {"samples", "lines", "bands", "header offset", "file type", "data type", "interleave", "byte order", "band names"};
    if (!std::any_of(std::begin(kShape), std::end(kShape), isShape)) frame.attributes.push_back(enviAttribute(name, value));
  }
  return frame;
}

}  // namespace pitviper

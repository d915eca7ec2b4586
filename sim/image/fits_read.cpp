// Reads FITS files (IAU FITS Standard 4.0): sections 4.1 (cards), 4.2.1.2 (CONTINUE), 4.4 (sizes), 5 (numbers), 7.1 (IMAGE).
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <new>

#include "sim/image/fits.hpp"
#include "sim/image/number_bytes.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kFitsCard = 80, kFitsBlock = 2880;

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? "" : std::string(text.substr(first, text.find_last_not_of(' ') + 1 - first));
}

/// A quoted text: two quotes stand for one, blanks at its end for nothing.
std::string fitsText(std::string_view from) {
  std::string text;
  for (std::size_t i = 1; i < from.size(); ++i) {
    if (from[i] == '\'' && (i + 1 >= from.size() || from[++i] != '\'')) break;
    text += from[i];
  }
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

Attribute fitsValue(const std::string& name, std::string_view value) {
  const std::string text = trimmed(value);
  if (text.starts_with('\'')) return {name, fitsText(text)};
  std::string number = trimmed(std::string_view(text).substr(0, text.find('/')));
  for (char& c : number)
    if (c == 'D' || c == 'd') c = 'E';
  const char *first = number.data() + number.starts_with('+'), *last = number.data() + number.size();
  int whole = 0;
  double real = 0.0;
  if (const auto [end, failure] = std::from_chars(first, last, whole); failure == std::errc() && end == last) return {name, whole};
  if (const auto [end, failure] = std::from_chars(first, last, real); failure == std::errc() && end == last) return {name, real};
  return {name, number};
}

/// The cards of one header, with where its data begin.
struct FitsHeader {
  std::vector<Attribute> cards;
  std::size_t end = 0;

  const Attribute* find(std::string_view name) const {
    for (const Attribute& a : cards)
      if (a.name == name) return &a;
    return nullptr;
  }
  std::string text(std::string_view name) const {
    const Attribute* card = find(name);
    const std::string* value = card ? std::get_if<std::string>(&card->value) : nullptr;
    return value ? *value : "";
  }
  double number(std::string_view name, double otherwise) const {
    const Attribute* card = find(name);
    if (!card) return otherwise;
    if (const int* whole = std::get_if<int>(&card->value)) return *whole;
    const double* real = std::get_if<double>(&card->value);
    return real ? *real : otherwise;
  }
};

/// Of the file itself and its shape, no metadata.
bool isStructural(const std::string& name) {
  for (const char* known : {"SIMPLE", "BITPIX", "EXTEND", "PCOUNT", "GCOUNT", "BZERO", "BSCALE", "BLANK", "XTENSION", "EXTNAME", "BUNIT", "LONGSTRN"})
    if (name == known) return true;
  return name.starts_with("NAXIS");
}

/// `NAME.1`, `NAME.2`, ... as one list.
std::vector<Attribute> withLists(const std::vector<Attribute>& cards) {
  std::vector<Attribute> all;
  for (const Attribute& a : cards) {
    if (isStructural(a.name)) continue;
    const std::size_t dot = a.name.rfind('.');
    const auto numbers = std::holds_alternative<std::string>(a.value) ? std::nullopt : numbersOf(a);
    const std::string base = a.name.substr(0, dot), end = dot == std::string::npos ? "" : a.name.substr(dot + 1);
    if (numbers && end == "1") all.push_back({base, *numbers});
    else if (auto* list = all.empty() || all.back().name != base ? nullptr : std::get_if<std::vector<double>>(&all.back().value);
             numbers && list && end == std::to_string(list->size() + 1))
      list->push_back(numbers->front());
    else all.push_back(a);
  }
  return all;
}

/// One reading of a file.
class FitsReader {
 public:
  FitsReader(const std::string& bytes, const std::string& file) : bytes_(bytes), where_{.file = file} {}

  PictureFile all() {
    if (!bytes_.starts_with("SIMPLE  =")) fail("the file is no FITS file");
    for (std::size_t at = 0; at + kFitsCard <= bytes_.size();) {
      if (at > 0 && !bytes_.substr(at, 8).starts_with("XTENSION")) break;  // section 3.5: special records may follow
      at = part(header(at), at == 0);
    }
    if (file_.pictures.empty()) throw UserError(where_, "the file has no image", "an image, primary or in an IMAGE extension", "name another file");
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw UserError(where_, what, "a whole FITS file", "copy or write the file again"); }

  FitsHeader header(std::size_t at) const {
    FitsHeader header;
    bool goesOn = false;
    for (;; at += kFitsCard) {
      if (at + kFitsCard > bytes_.size()) fail("a header has no end");
      const std::string_view card = std::string_view(bytes_).substr(at, kFitsCard);
      std::string key = trimmed(card.substr(0, 8));
      if (key == "END") break;
      std::string_view value = card.substr(10);
      if (key == "CONTINUE" && goesOn) {
        std::string& text = std::get<std::string>(header.cards.back().value);
        text.pop_back();
        text += fitsText(trimmed(value));
      } else {
        if (key == "HIERARCH") {
          const std::size_t equals = card.find('=');
          if (equals == std::string_view::npos || equals < 9) continue;
          key = trimmed(card.substr(9, equals - 9)), value = card.substr(equals + 1);
          // cfitsio writes capitals; names of this program are in small letters but for some parts of them.
          for (char& c : key) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        } else if (card.substr(8, 2) != "= ") continue;
        header.cards.push_back(fitsValue(key, value));
      }
      const std::string* text = header.cards.empty() ? nullptr : std::get_if<std::string>(&header.cards.back().value);
      goesOn = text && text->ends_with('&');
    }
    header.end = (at / kFitsBlock + 1) * kFitsBlock;
    return header;
  }

  std::size_t wholeKey(const FitsHeader& header, const std::string& name, double otherwise) const {
    const double value = header.number(name, otherwise);
    if (!(value >= 0.0 && value <= 1e12) || value != std::floor(value)) fail(name + " is no count");
    return static_cast<std::size_t>(value);
  }

  /// Reads an image; returns where the next part begins.
  std::size_t part(const FitsHeader& header, bool isPrimary) {
    const std::map<int, NumberType> types = {{8, NumberType::UInt8},  {16, NumberType::Int16},    {32, NumberType::Int32},
                                             {64, NumberType::Int64}, {-32, NumberType::Float32}, {-64, NumberType::Float64}};
    const double bitpix = header.number("BITPIX", 0.0);
    if (!(std::abs(bitpix) <= 64.0) || !types.contains(static_cast<int>(bitpix))) fail("BITPIX is none of 8, 16, 32, 64, -32, -64");
    const NumberType type = types.at(static_cast<int>(bitpix));
    const std::size_t axes = wholeKey(header, "NAXIS", -1.0);
    if (axes > 999) fail("NAXIS is over 999");
    std::vector<std::size_t> sides;
    for (std::size_t k = 1; k <= axes; ++k) sides.push_back(wholeKey(header, "NAXIS" + std::to_string(k), -1.0));
    if (isPrimary) file_.attributes = withLists(header.cards);
    if (header.text("GROUPS") == "T") throw UserError(where_, "the file has random groups", "images", "convert the file");
    // In doubles: a header can claim any size.
    double count = axes > 0 ? 1.0 : 0.0;
    for (const std::size_t side : sides) count *= static_cast<double>(side);
    const double room = static_cast<double>(bytesOf(type)) * static_cast<double>(isPrimary ? 1 : wholeKey(header, "GCOUNT", 1.0)) *
                        (count + static_cast<double>(isPrimary ? 0 : wholeKey(header, "PCOUNT", 0.0)));
    if (header.end > bytes_.size() || !(room <= static_cast<double>(bytes_.size() - header.end))) fail("the file ends before its data do");
    const auto size = static_cast<std::size_t>(room);
    const std::size_t next = header.end + (size + kFitsBlock - 1) / kFitsBlock * kFitsBlock;
    if (header.text("ZIMAGE") == "T")
      throw UserError(where_, "the image is compressed in a table", "an image that is not compressed", "unpack it, for example with funpack");
    if (size > 0 && count > 0 && (isPrimary || header.text("XTENSION") == "IMAGE")) image(header, type, sides);
    return next;
  }

  void image(const FitsHeader& header, NumberType type, const std::vector<std::size_t>& sides) {
    const std::size_t width = sides[0], height = sides.size() > 1 ? sides[1] : 1, planes = sides.size() > 2 ? sides[2] : 1;
    for (std::size_t k = 3; k < sides.size(); ++k)
      if (sides[k] != 1) throw UserError(where_, "an image has more than three axes", "at most three", "cut the image");
    if (width > kMostPictureSide || height > kMostPictureSide)
      throw UserError(where_, print("an image is %zu x %zu pixels", width, height), "at most 32768 on a side", "cut the image");
    if (planes > kMostPictures || file_.pictures.size() + planes > kMostPictures)
      throw UserError(where_, "the file has more than 1024 images", "at most 1024", "split the file");
    if (!file_.pictures.empty() && (static_cast<int>(width) != file_.width || static_cast<int>(height) != file_.height))
      throw UserError(where_, print("images are %d x %d and %zu x %zu pixels", file_.width, file_.height, width, height), "images of one size",
                      "split the file");
    file_.width = static_cast<int>(width), file_.height = static_cast<int>(height);
    const double zero = header.number("BZERO", 0.0), scale = header.number("BSCALE", 1.0), blank = header.number("BLANK", NAN);
    const bool plain = zero == 0.0 && scale == 1.0;
    const char* from = bytes_.data() + header.end;
    for (std::size_t k = 0; k < planes; ++k) {
      ReadPicture picture{header.text("EXTNAME"), header.text("BUNIT"), {}};
      if (planes > 1) picture.name += print("%s%03zu", picture.name.empty() ? "" : ".", k + 1);
      picture.pixels.resize(width * height);
      for (std::size_t y = height; y-- > 0; from += width * bytesOf(type)) {
        float* to = picture.pixels.data() + y * width;
        eachNumber(type, from, width, true, [&](std::size_t i, auto value) {
          const bool none = std::numeric_limits<decltype(value)>::is_integer && static_cast<double>(value) == blank;
          to[i] = none ? NAN : plain ? static_cast<float>(value) : static_cast<float>(zero + scale * static_cast<double>(value));
        });
      }
      file_.pictures.push_back(std::move(picture));
    }
  }

  const std::string& bytes_;
  Location where_;
  PictureFile file_;
};

}  // namespace

PictureFile readFits(const std::filesystem::path& path) {
  const std::string bytes = readWholeFile(path, {.what = "a FITS file"});
  try {
    return FitsReader(bytes, path.string()).all();
  } catch (const std::bad_alloc&) {
    throw UserError({.file = path.string()}, "the image is too large for this machine's memory", "a smaller image", "use a machine with more memory");
  }
}

}  // namespace pitviper

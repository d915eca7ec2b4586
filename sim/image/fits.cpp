#include "sim/image/fits.hpp"

#include <fitsio.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <stdexcept>

#include "sim/image/whole_values.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

/// A FITS file that the library writes into memory: a full disk then shows in our own checked write.
class MemoryFile {
 public:
  MemoryFile() { fits_create_memfile(&file_, &bytes_, &size_, 1 << 20, std::realloc, &status_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() {
    close();
    std::free(bytes_);
  }

  void image(int width, int height, const FitsImage& image) {
    long axes[2] = {width, height};
    const long long count = static_cast<long long>(image.pixels.size());
    fits_create_img(file_, image.isWhole ? USHORT_IMG : FLOAT_IMG, 2, axes, &status_);
    const auto upsideDown = [&](auto values) {
      for (int top = 0, bottom = height - 1; top < bottom; ++top, --bottom)
        std::swap_ranges(values.begin() + static_cast<std::ptrdiff_t>(top) * width, values.begin() + static_cast<std::ptrdiff_t>(top + 1) * width,
                         values.begin() + static_cast<std::ptrdiff_t>(bottom) * width);
      return values;
    };
    if (image.isWhole) {
      auto codes = upsideDown(wholeValues(image.pixels));
      fits_write_img(file_, TUSHORT, 1, count, codes.data(), &status_);
    } else {
      auto values = upsideDown(image.pixels);
      fits_write_img(file_, TFLOAT, 1, count, values.data(), &status_);
    }
    add({"EXTNAME", image.name});
    add({"BUNIT", image.unit});
    for (const Attribute& a : image.keywords) add(a);
  }

  /// Curves whose names differ in their last part alone, one table for each.
  void tables(const std::vector<Attribute>& all) {
    std::map<std::string, std::vector<const Attribute*>> groups;
    for (const Attribute& a : all)
      if (std::holds_alternative<std::vector<float>>(a.value)) groups[a.name.substr(0, a.name.rfind('.'))].push_back(&a);
    for (const auto& [name, columns] : groups) {
      std::vector<std::string> titles, forms(columns.size(), "1E");
      std::vector<char*> ofTitles, ofForms;
      for (const Attribute* c : columns) titles.push_back(c->name.substr(c->name.rfind('.') + 1));
      for (std::size_t k = 0; k < columns.size(); ++k) ofTitles.push_back(titles[k].data()), ofForms.push_back(forms[k].data());
      const auto& first = std::get<std::vector<float>>(columns.front()->value);
      fits_create_tbl(file_, BINARY_TBL, static_cast<long long>(first.size()), static_cast<int>(columns.size()), ofTitles.data(), ofForms.data(), nullptr,
                      name.c_str(), &status_);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        std::vector<float> values = std::get<std::vector<float>>(columns[k]->value);
        values.resize(first.size());
        fits_write_col(file_, TFLOAT, static_cast<int>(k) + 1, 1, 1, static_cast<long long>(values.size()), values.data(), &status_);
      }
    }
  }

  void add(const Attribute& a) {
    if (std::holds_alternative<std::vector<float>>(a.value)) return;  // a table of its own
    if (const auto* text = std::get_if<std::string>(&a.value)) addText(a.name, *text);
    else if (const auto* number = std::get_if<double>(&a.value)) addNumber(a.name, *number);
    else if (const auto* whole = std::get_if<int>(&a.value)) fits_update_key_lng(file_, a.name.c_str(), *whole, nullptr, &status_);
    else addList(a);
  }

  /// What the library says of what went wrong.
  std::string failure() const {
    char words[FLEN_STATUS] = "";
    fits_get_errstatus(status_, words);
    return words;
  }
  /// Empty where something went wrong.
  std::string bytes() {
    close();
    return status_ ? std::string() : std::string(static_cast<const char*>(bytes_), size_);
  }

 private:
  void addText(const std::string& name, std::string text) {
    // FITS 4.0 section 4.2.1: printable ASCII only.
    for (char& c : text)
      if (c < 32 || c > 126) c = '?';
    constexpr std::size_t kLongestName = 50;
    if (name.size() > kLongestName) {
      fits_write_comment(file_, (name + " = " + text).c_str(), &status_);
      return;
    }
    if (text.size() > 60) fits_write_key_longwarn(file_, &status_);
    fits_update_key_longstr(file_, name.c_str(), text.c_str(), nullptr, &status_);
  }
  void addNumber(const std::string& name, double value) {
    // A card has 80 letters: "HIERARCH ", the name, " = ", a number of so many digits and its exponent. What is too long for that is told in words.
    const int digits = name.size() <= 8 ? 15 : std::min(15, 80 - 9 - static_cast<int>(name.size()) - 3 - 8);
    if (digits < 6) {
      fits_write_comment(file_, (name + " = " + print("%.15g", value)).c_str(), &status_);
    } else if (std::isfinite(value)) fits_update_key_dbl(file_, name.c_str(), value, -digits, nullptr, &status_);
    else addText(name, std::isnan(value) ? "nan" : "inf");  // section 4.2.4 has no such numbers
  }
  template <class List>
  void addNumbers(const std::string& name, const List& list) {
    for (std::size_t k = 0; k < list.size(); ++k) addNumber(name + "." + std::to_string(k + 1), static_cast<double>(list[k]));
  }
  void addList(const Attribute& a) {
    if (const auto* list = std::get_if<std::vector<double>>(&a.value)) addNumbers(a.name, *list);
  }
  void close() {
    if (!file_) return;
    fits_close_file(file_, &status_);
    file_ = nullptr;
  }
  fitsfile* file_ = nullptr;
  void* bytes_ = nullptr;
  std::size_t size_ = 0;
  int status_ = 0;
};

}  // namespace

void writeFits(const std::filesystem::path& path, int width, int height, const std::vector<FitsImage>& images, const std::vector<Attribute>& keywords,
               const MayReplace& mayReplace) {
  const bool wrong = std::any_of(images.begin(), images.end(), [&](const FitsImage& i) {
    return i.pixels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  });
  if (images.empty() || wrong) throw std::invalid_argument("writeFits: no images, or one that is not width * height");
  MemoryFile file;
  for (const FitsImage& image : images) {
    file.image(width, height, image);
    if (&image == &images.front())
      for (const Attribute& a : keywords) file.add(a);
  }
  file.tables(keywords);
  const std::string bytes = file.bytes();
  if (bytes.empty()) throw OutputError(path, "cannot encode the FITS file: " + file.failure(), 0, "shorten names, free memory, or write fewer layers");
  writeFileAtomically(path, bytes, mayReplace);
}

std::optional<std::string> readFitsText(const std::filesystem::path& path, std::string_view keyword) {
  constexpr std::size_t kLongestHeader = 1u << 20, kCard = 80;
  std::string start;
  try {
    start = readFileStart(path, kLongestHeader);
  } catch (const UserError&) {
    return std::nullopt;
  }
  if (!start.starts_with("SIMPLE  =")) return std::nullopt;
  std::string name(keyword);
  name.resize(8, ' ');
  name += "= '";
  for (std::size_t at = 0; at + kCard <= start.size() && !start.substr(at, kCard).starts_with("END     "); at += kCard) {
    const std::string card = start.substr(at, kCard);
    if (!card.starts_with(name)) continue;
    const std::string text = card.substr(name.size(), card.find('\'', name.size()) - name.size());
    return text.substr(0, text.find_last_not_of(' ') + 1);
  }
  return std::nullopt;
}

}  // namespace pitviper

#pragma once
// Words and numbers of a text file with their line and column. Throws ImportFailure.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "sim/parameters/readable_text.hpp"
#include "sim/scene/import/import_failure.hpp"

namespace pitviper {

class TextCursor {
 public:
  TextCursor(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {}

  bool atEnd() const { return at_ >= text_.size(); }
  std::size_t offset() const { return at_; }

  /// Next word of this line, empty at its end. A backslash before the end of the line joins the next one.
  std::string_view wordOfLine() {
    while (!atEnd() && text_[at_] != '\n') {
      if (text_[at_] == '\\' && endOfLineAt(at_ + 1)) {
        at_ = text_.find('\n', at_);
        newLine();
      } else if (isSpace(text_[at_])) {
        ++at_;
      } else {
        return take();
      }
    }
    wordColumn_ = column();
    wordLine_ = line_;
    return {};
  }

  /// Next word, on this line or a later one; empty at the end of the text.
  std::string_view word() {
    while (!atEnd() && isSpace(text_[at_])) {
      if (text_[at_] == '\n') newLine();
      else ++at_;
    }
    if (!atEnd()) return take();
    wordColumn_ = column();
    wordLine_ = line_;
    return {};
  }

  /// Leaves the rest of this line out (joined lines too). The next word is the next line's first.
  void skipLine() {
    while (!atEnd() && text_[at_] != '\n') {
      if (text_[at_] == '\\' && endOfLineAt(at_ + 1)) {
        at_ = text_.find('\n', at_);
        newLine();
      } else {
        ++at_;
      }
    }
    if (!atEnd()) newLine();
  }

  /// Place of the last word taken.
  Location here() const { return {file_, wordLine_, wordColumn_}; }

  [[noreturn]] void fail(const std::string& wrong, const std::string& expected = "", const std::string& fix = "") const {
    throw ImportFailure{here(), wrong, expected, fix};
  }

  /// The word as a number within the range of single precision. Numbers too small for it become 0.
  double number(std::string_view word) const {
    double value = 0.0;
    const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* last = word.data() + word.size();
    const auto [end, error] = std::from_chars(first, last, value);
    const bool tooSmall = error == std::errc::result_out_of_range && word.find_first_of("eE") != word.npos &&
                          word[std::min(word.find_first_of("eE") + 1, word.size() - 1)] == '-';
    if (word.empty() || end != last || (error != std::errc{} && !tooSmall))
      fail(word.empty() ? "a number is missing here" : "'" + shown(word) + "' is not a number", "a finite number");
    if (tooSmall || std::abs(value) < static_cast<double>(std::numeric_limits<float>::min())) return 0.0;
    if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
      fail("'" + shown(word) + "' is not a finite number in single precision", "a finite number");
    return value;
  }

  long long integer(std::string_view word, long long least, long long most) const {
    long long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || value < least || value > most)
      fail(word.empty() ? "a whole number is missing here" : "'" + shown(word) + "' is not possible here",
           "a whole number in " + std::to_string(least) + ".." + std::to_string(most));
    return value;
  }

  /// Fit for a message, whatever it is: one readable line.
  static std::string shown(std::string_view word) {
    const std::string quoted = tokenOf(word);
    return quoted.substr(1, quoted.size() - 2);
  }

 private:
  static bool isSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  bool endOfLineAt(std::size_t i) const { return i < text_.size() && (text_[i] == '\n' || (text_[i] == '\r' && i + 1 < text_.size() && text_[i + 1] == '\n')); }
  int column() const { return static_cast<int>(at_ - lineStart_) + 1; }
  void newLine() {
    lineStart_ = ++at_;
    ++line_;
  }
  std::string_view take() {
    const std::size_t first = at_;
    wordColumn_ = column();
    wordLine_ = line_;
    while (!atEnd() && !isSpace(text_[at_])) ++at_;
    return text_.substr(first, at_ - first);
  }

  std::string file_;
  std::string_view text_;
  std::size_t at_ = 0, lineStart_ = 0;
  int line_ = 1, wordLine_ = 1, wordColumn_ = 1;
};

}  // namespace pitviper

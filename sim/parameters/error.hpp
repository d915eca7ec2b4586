#pragma once
// What a user did wrong, where, and what to do about it. Every mistake in a user's files ends here:
// one line `file:line:col: what is wrong; expected ...; fix: ...` and exit code 2.
#include <memory>
#include <stdexcept>
#include <string>

namespace pitviper {

/// Place in a user's file. Lines and columns count from 1; 0 means unknown. `byte` >= 0 is used for binary files.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
  long long byte = -1;

  std::string text() const {
    if (file.empty()) return "command line";
    if (byte >= 0) return file + ": byte " + std::to_string(byte);
    if (line <= 0) return file;
    return file + ":" + std::to_string(line) + ":" + std::to_string(column > 0 ? column : 1);
  }
};

/// A user's mistake. `expected` and `fix` may be empty.
class UserError : public std::runtime_error {
 public:
  UserError(const Location& where, const std::string& wrong, const std::string& expected = "", const std::string& fix = "")
      : std::runtime_error(compose(where, wrong, expected, fix)),
        parts_(std::make_shared<const Parts>(Parts{where, wrong, expected, fix})) {}

  /// What its message is made of.
  struct Parts {
    Location where;
    std::string wrong, expected, fix;
  };
  const Parts& parts() const { return *parts_; }

 private:
  std::shared_ptr<const Parts> parts_;  ///< shared: copying an exception must not throw
  static std::string compose(const Location& where, const std::string& wrong, const std::string& expected, const std::string& fix) {
    std::string message = where.text() + ": " + wrong;
    if (!expected.empty()) message += "; expected " + expected;
    if (!fix.empty()) message += "; fix: " + fix;
    for (char& c : message)
      if (static_cast<unsigned char>(c) < 32) c = ' ';  // one line, whatever the input held
    return message;
  }
};

}  // namespace pitviper

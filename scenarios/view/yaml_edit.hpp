#pragma once
// Values that were changed by hand, written back into a scenario's text: its comments, order and layout stay.
#include <filesystem>
#include <string>
#include <vector>

namespace pitviper {

struct YamlChange {
  std::string path;   ///< as `--set` has it: "cameras.seeker.position"
  std::string value;  ///< YAML: "300 K", "[1 m, 2 m, 3 m]"
};

/// The text with the changes, one after the other. Of a value that stands there just its characters change, and a list or map that keeps its length or keys
/// changes value by value where it has brackets or comments within; a key that does not is added, before a closing brace or below the last key. All else
/// stays byte for byte. Read again it is the tree that `--set` with the same changes gives.
/// Errors: UserError where a change cannot be written here, as the value comes from another file, a parameter or a repeated entry, or is shared by an anchor.
std::string withChanges(const std::string& text, const std::string& fileName, const std::vector<YamlChange>& changes);

/// The same of a file, which is replaced when whole; a link stays a link. Errors: UserError, OutputError; then the file is as before.
void writeChanges(const std::filesystem::path& file, const std::vector<YamlChange>& changes);

/// "--set cameras.seeker.position='[1 m, 2 m, 3 m]' --set ...", for a POSIX shell.
std::string asSetOptions(const std::vector<YamlChange>& changes);

/// The shortest decimal text that lies within half of `resolution` of a finite value: "3.25 deg". A resolution of 0 asks for the same double.
std::string numberText(double value, const char* unit, double resolution);

}  // namespace pitviper

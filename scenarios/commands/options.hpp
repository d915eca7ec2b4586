#pragma once
// Command-line options: --name value, flags and positional words; anything unknown is a user's mistake.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/commands/commands.hpp"

namespace pitviper {

struct OptionSpec {
  std::string name;   ///< "--out"
  bool value = true;  ///< takes a value
  bool many = false;  ///< may be repeated
};

class Options {
 public:
  /// Throws UserError for unknown options, missing values and a wrong number of positional words.
  Options(const std::string& command, const Arguments& arguments, const std::vector<OptionSpec>& specs, size_t leastWords, size_t mostWords);
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  std::string value(const std::string& name, const std::string& otherwise = "") const;
  std::vector<std::string> values(const std::string& name) const;
  const std::vector<std::string>& words() const { return words_; }

 private:
  std::map<std::string, std::vector<std::string>> values_;
  std::vector<std::string> words_;
};

/// `--root FOLDER`, repeatable: folders from which a scenario may take parts, besides its own. For the list of a command's options.
const OptionSpec& rootOption();
std::vector<std::filesystem::path> rootsOf(const Options& options);

/// "a:b" or "a" as whole numbers; UserError otherwise.
std::pair<long long, long long> readRange(const std::string& text, const std::string& option);

}  // namespace pitviper

#pragma once
// A folder for what a program keeps between runs, which nothing else has filled: this program's own plans, tables and meshes, and the driver's programs.
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

namespace pitviper {

class OwnCache {
 public:
  /// In the folder for temporary files. Errors: OutputError.
  OwnCache();
  ~OwnCache();
  OwnCache(const OwnCache&) = delete;
  OwnCache& operator=(const OwnCache&) = delete;

  /// What a process needs to know to keep its things there.
  std::map<std::string, std::string> environment() const;
  /// Files in which the driver keeps programs.
  std::size_t driverFiles() const;
  void clear();
  /// Notes what is in it; back() makes it so again.
  void mark();
  void back();

 private:
  std::filesystem::path folder_;
};

}  // namespace pitviper

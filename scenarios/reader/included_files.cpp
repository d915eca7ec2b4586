#include "scenarios/reader/included_files.hpp"

#include <algorithm>

#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

/// Of all files together: as much text as sixteen of the largest.
constexpr std::size_t kMostText = 16 * kLargestYamlBytes;

fs::path orHere(const fs::path& folder) { return folder.empty() ? fs::path(".") : folder; }

bool isYaml(const fs::path& name) { return name.extension() == ".yaml" || name.extension() == ".yml"; }

bool isWithin(const fs::path& path, const fs::path& folder) {
  const auto below = path.lexically_relative(folder);
  return !below.empty() && *below.begin() != "..";
}

/// Whether a path leads from a folder to somewhere below the folder above it, by its words and where links on the way lead.
bool isNear(const fs::path& folder, const fs::path& name) {
  if (name.empty() || name.is_absolute()) return false;
  if (name.has_parent_path() && !isYaml(name)) return false;  // elsewhere nothing but scenarios is read
  const auto plain = name.lexically_normal();
  int up = 0;
  for (const auto& part : plain) up += part == "..";
  if (up > 1) return false;
  std::error_code failed;
  const auto here = fs::canonical(orHere(folder), failed);
  if (failed) return false;
  const auto at = fs::weakly_canonical(here / plain, failed);
  return !failed && isWithin(at, here.parent_path());
}

/// Where a name leads, links resolved; empty where that cannot be known.
fs::path resolved(const fs::path& path) {
  std::error_code failed;
  auto at = fs::weakly_canonical(path, failed);
  return failed ? fs::path() : at;
}

bool isThere(const fs::path& path) {
  std::error_code failed;
  return fs::exists(path, failed) && !failed;
}

}  // namespace

std::size_t sizeOf(const Value& v) {
  std::size_t n = 1;
  for (const auto& i : v.items) n += sizeOf(i);
  for (const auto& [k, e] : v.entries) n += sizeOf(e);
  return n;
}

FileChain chainOf(const IncludedFile& file, const FileChain& above) { return {&above, file.path, file.shown, above.depth + 1}; }

IncludedFiles::IncludedFiles(const std::string& scenario, const fs::path& base, const Libraries& libraries, const std::vector<fs::path>& roots) : base_(base) {
  scenario_.path = resolved(orHere(base) / fs::path(scenario).filename());
  scenario_.shown = scenario;
  roots_.push_back({resolved(orHere(base)), "the folder of the scenario", false});
  for (const auto& root : roots) {
    std::error_code failed;
    const auto at = fs::canonical(root, failed);
    if (failed || !fs::is_directory(at, failed))
      throw UserError({"--root " + root.string(), 0, 0, -1}, "not a folder", "a folder from which scenarios may take parts", "check the name");
    roots_.push_back({at, "'" + root.string() + "' (--root)", true});
  }
  for (const auto& library : {libraries.materials, libraries.atmosphere, libraries.sensors})
    if (!library.empty()) roots_.push_back({resolved(library), "", true});
}

bool IncludedFiles::isAllowed(const fs::path& path) const {
  return !path.empty() && std::any_of(roots_.begin(), roots_.end(), [&](const Root& r) { return !r.path.empty() && isWithin(path, r.path); });
}

void IncludedFiles::refuse(const Value& name, bool extends) const {
  std::string folders;
  for (const Root& r : roots_)
    if (!r.shown.empty()) folders += (folders.empty() ? "" : ", ") + r.shown;
  const std::string shown = "'" + readable(name.text.substr(0, 60)) + "'";
  if (extends)
    throw UserError(name.where, "not the name of a scenario near this one (" + shown + ")",
                    "a relative path to a .yaml file below the folder that holds this scenario's own folder, or one in " + folders + " or the libraries",
                    "write 'extends: first_light.yaml', 'extends: base/scene.yaml' or 'extends: ../common/scene.yaml', or allow its folder by --root FOLDER");
  throw UserError(name.where, shown + " is not a file that a scenario may include",
                  "a .yaml file, links resolved, in " + folders + ", folders below, or the libraries", "put it there, or allow its folder by --root FOLDER");
}

fs::path IncludedFiles::find(const Value& name, bool extends, const FileChain& chain) const {
  const fs::path word = name.text;
  if (word.empty()) refuse(name, extends);
  const fs::path* own = folderOf(name.where.file);
  const fs::path folder = own ? *own : base_;
  const fs::path beside = folder / word;
  if (extends && chain.above == nullptr && isNear(base_, word)) return beside;
  if (!isYaml(word)) refuse(name, extends);
  if (word.is_relative() && !isThere(beside))
    for (const Root& r : roots_)
      if (r.searched && isThere(r.path / word)) {
        if (!isAllowed(resolved(r.path / word))) refuse(name, extends);
        return r.path / word;
      }
  if (!isAllowed(resolved(beside))) refuse(name, extends);
  return beside;
}

const IncludedFile& IncludedFiles::open(const Value& name, bool extends, const FileChain& chain) {
  if (name.kind != Value::Kind::Scalar || name.text.size() > 4000)
    throw UserError(name.where,
                    std::string(extends ? "extends" : "include") + " is " + (name.kind == Value::Kind::Scalar ? "longer than 4000 bytes" : name.kindName()),
                    "the name of a .yaml file", extends ? "write 'extends: base.yaml'" : "write 'include: parts.yaml'");
  const fs::path path = find(name, extends, chain);
  const fs::path real = resolved(path);
  for (const FileChain* c = &chain; c; c = c->above)
    if (!real.empty() && c->path == real) {
      std::string way = path.string();
      for (const FileChain* up = &chain; up; up = up->above) {
        way = up->shown + " -> " + way;
        if (up == c) break;
      }
      throw UserError(name.where, "files that include each other without end: " + way, "files that do not include themselves", "remove one of these includes");
    }
  if (chain.depth >= kDeepestInclude)
    throw UserError(name.where, "files include each other more than " + std::to_string(kDeepestInclude) + " deep", "fewer", "include them from one file");
  if (const auto known = files_.find(real); known != files_.end() && !real.empty()) return known->second;
  std::string text;
  IncludedFile file;
  file.shown = path.string();
  file.tree = loadYaml(real.empty() ? path : real, name.where, &text, file.shown);
  file.path = real;
  file.folder = path.parent_path();
  values_ += sizeOf(file.tree);
  if (values_ > kMostYamlNodes || identity_.size() + text.size() > kMostText)
    throw UserError(name.where, "the files of this scenario hold more than " + std::to_string(kMostYamlNodes) + " values, or 64 MB", "fewer or smaller files",
                    "put large tables into CSV files");
  identity_ += (extends ? "\n--extends\n" : "\n--include\n") + text;
  folders_.emplace(file.shown, file.folder);
  // What a scenario beside this one includes from its own folder is as near as itself.
  if (extends && !isAllowed(real) && !real.empty()) roots_.push_back({real.parent_path(), "", false});
  return files_.emplace(real.empty() ? path : real, std::move(file)).first->second;
}

const fs::path* IncludedFiles::folderOf(const std::string& shown) const {
  const auto found = folders_.find(shown);
  return found == folders_.end() ? nullptr : &found->second;
}

}  // namespace pitviper

#include "sim/scene/mesh_cache.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <type_traits>

#include "sim/image/atomic_file.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

constexpr std::uint64_t kMagic = 0x33304853'4d565450u;  // "PTVMSH03" in little-endian order: form and version

std::uint64_t mix(std::uint64_t h, std::uint64_t word, std::uint64_t multiplier) {
  h = (std::rotl(h, 27) ^ word) * multiplier;
  return h ^ (h >> 29);
}

template <class T>
void put(std::string& out, const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

void putWord(std::string& out, std::uint64_t value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

/// Takes values off the front; after the first that does not fit, everything fails.
struct Source {
  std::string_view left;
  bool ok = true;

  std::string_view take(std::uint64_t count) {
    ok = ok && count <= left.size();
    if (!ok) return {};
    const std::string_view taken = left.substr(0, count);
    left.remove_prefix(count);
    return taken;
  }
  std::uint64_t word() {
    const std::string_view bytes = take(sizeof(std::uint64_t));
    std::uint64_t value = 0;
    if (ok) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  template <class T>
  void array(std::vector<T>& values, std::uint64_t count) {
    ok = ok && count <= left.size() / sizeof(T);
    if (!ok) return;
    const std::string_view bytes = take(count * sizeof(T));
    values.resize(count);
    if (count > 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  }
};

constexpr const char* kPrefix = "mesh-";

std::filesystem::path cacheFile(const ContentKey& key) {
  const std::filesystem::path folder = meshCacheFolder();
  if (folder.empty()) return {};
  char name[64];
  std::snprintf(name, sizeof name, "%s%016llx%016llx.bin", kPrefix, static_cast<unsigned long long>(key[0]), static_cast<unsigned long long>(key[1]));
  return folder / name;
}

}  // namespace

ContentKey contentKey(std::string_view bytes, ContentKey seed) {
  // The two multipliers are those of MurmurHash3 (Appleby, public domain); any odd constants with mixed bits would do.
  constexpr std::uint64_t kFirst = 0xff51afd7ed558ccdu, kSecond = 0xc4ceb9fe1a85ec53u;
  std::uint64_t a = mix(seed[0], bytes.size(), kFirst), b = mix(seed[1], ~bytes.size(), kSecond);
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
    a = mix(a, word, kFirst);
    b = mix(b, word, kSecond);
  }
  return {mix(a, b, kFirst), mix(b, a, kSecond)};
}

std::string serializeMesh(const Mesh& mesh, const std::vector<NamedFile>& named) {
  std::string body;
  body.reserve(64 + mesh.positions.size() * 32 + mesh.triangles.size() * 12);
  putWord(body, named.size());
  for (const NamedFile& file : named) {
    putWord(body, file.key[0]);
    putWord(body, file.key[1]);
    putWord(body, file.name.size());
    body += file.name;
  }
  putWord(body, mesh.positions.size());
  putWord(body, mesh.normals.size());
  putWord(body, mesh.uv.size());
  putWord(body, mesh.triangles.size());
  putWord(body, mesh.parts.size());
  putWord(body, mesh.closed ? 1 : 0);
  putWord(body, mesh.notes.size());
  for (int k = 0; k < 3; ++k) putWord(body, std::bit_cast<std::uint64_t>(mesh.offset_m[k]));
  put(body, mesh.positions);
  put(body, mesh.normals);
  put(body, mesh.uv);
  put(body, mesh.triangles);
  for (const MeshPart& part : mesh.parts) {
    putWord(body, part.firstTriangle);
    putWord(body, part.triangleCount);
    putWord(body, part.name.size());
    body += part.name;
  }
  for (const std::string& note : mesh.notes) {
    putWord(body, note.size());
    body += note;
  }
  const ContentKey sum = contentKey(body);
  std::string out;
  out.reserve(body.size() + 32);
  putWord(out, kMagic);
  putWord(out, body.size());
  putWord(out, sum[0]);
  putWord(out, sum[1]);
  return out += body;
}

std::optional<Mesh> deserializeMesh(std::string_view bytes, std::vector<NamedFile>* named) {
  Source in{bytes};
  if (in.word() != kMagic || !in.ok) return std::nullopt;
  const std::uint64_t size = in.word();
  const ContentKey sum{in.word(), in.word()};
  if (!in.ok || size != in.left.size() || contentKey(in.left) != sum) return std::nullopt;
  std::vector<NamedFile> files;
  for (std::uint64_t left = in.word(); left > 0 && in.ok; --left) {
    NamedFile file;
    file.key[0] = in.word();
    file.key[1] = in.word();
    file.name = std::string(in.take(in.word()));
    files.push_back(std::move(file));
  }
  const std::uint64_t positions = in.word(), normals = in.word(), uv = in.word(), triangles = in.word(), parts = in.word();
  Mesh mesh;
  mesh.closed = in.word() != 0;
  const std::uint64_t notes = in.word();
  for (int k = 0; k < 3; ++k) mesh.offset_m[k] = std::bit_cast<double>(in.word());
  in.array(mesh.positions, positions);
  in.array(mesh.normals, normals);
  in.array(mesh.uv, uv);
  in.array(mesh.triangles, triangles);
  for (std::uint64_t i = 0; i < parts && in.ok; ++i) {
    MeshPart part;
    part.firstTriangle = static_cast<std::uint32_t>(in.word());
    part.triangleCount = static_cast<std::uint32_t>(in.word());
    part.name = std::string(in.take(in.word()));
    mesh.parts.push_back(std::move(part));
  }
  for (std::uint64_t i = 0; i < notes && in.ok; ++i) mesh.notes.emplace_back(in.take(in.word()));
  if (!in.ok || !in.left.empty()) return std::nullopt;
  if (named != nullptr) *named = std::move(files);
  return mesh;
}

std::filesystem::path meshCacheFolder() {
  // XDG Base Directory Specification: a path that is not absolute is to be ignored.
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && cache[0] == '/') return std::filesystem::path(cache) / "pitviper";
  if (const char* home = std::getenv("HOME"); home != nullptr && home[0] == '/') return std::filesystem::path(home) / ".cache" / "pitviper";
  return {};
}

std::optional<Mesh> readCachedMesh(const ContentKey& key, const std::function<bool(const NamedFile&)>& isUnchanged) {
  try {
    const std::filesystem::path file = cacheFile(key);
    std::vector<NamedFile> named;
    std::optional<Mesh> mesh = deserializeMesh(readWholeFile(file), &named);
    if (!mesh) return std::nullopt;
    for (const NamedFile& other : named)
      if (!isUnchanged || !isUnchanged(other)) return std::nullopt;
    std::error_code ignored;  // a cache that may only be read
    std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), ignored);
    return mesh;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void writeCachedMesh(const ContentKey& key, const Mesh& mesh, const std::vector<NamedFile>& named) {
  try {
    const std::filesystem::path file = cacheFile(key);
    if (file.empty()) return;
    std::filesystem::create_directories(file.parent_path());
    writeFileAtomically(file, serializeMesh(mesh, named));
    pruneCache(file.parent_path(), kPrefix, kMostCachedBytes, file);
  } catch (const std::exception&) {
    // Nothing is lost but time: see the header.
  }
}

void pruneCache(const std::filesystem::path& folder, std::string_view prefix, std::uintmax_t mostBytes, const std::filesystem::path& keep) {
  try {
    removeAbandonedTemporaries(folder);
    struct Kept {
      std::filesystem::file_time_type used;
      std::uintmax_t bytes;
      std::filesystem::path file;
    };
    std::vector<Kept> kept;
    std::uintmax_t total = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      std::error_code gone;  // another run may have been quicker
      if (!entry.path().filename().string().starts_with(prefix) || !entry.is_regular_file(gone)) continue;
      const auto used = entry.last_write_time(gone);
      const std::uintmax_t bytes = gone ? 0 : entry.file_size(gone);
      if (gone) continue;
      total += bytes;
      if (entry.path() != keep) kept.push_back({used, bytes, entry.path()});
    }
    std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
    std::error_code ignored;
    for (const Kept& oldest : kept) {
      if (total <= mostBytes) return;
      std::filesystem::remove(oldest.file, ignored);
      total -= oldest.bytes;
    }
  } catch (const std::exception&) {
    // Too large a cache is no reason to end.
  }
}

}  // namespace pitviper

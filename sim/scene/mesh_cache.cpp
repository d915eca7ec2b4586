#include "sim/scene/mesh_cache.hpp"

#include <bit>
#include <cstring>
#include <type_traits>

#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

constexpr std::uint64_t kMagic = 0x33304853'4d565450u;  // "PTVMSH03" in little-endian order: form and version

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

}  // namespace

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

std::optional<Mesh> readCachedMesh(const ContentKey& key, const std::function<bool(const NamedFile&)>& isUnchanged) {
  try {
    const std::filesystem::path file = cacheFile(kPrefix, key);
    std::error_code ignored;  // a cache that may only be read
    if (file.empty() || !std::filesystem::exists(file, ignored)) return std::nullopt;
    std::vector<NamedFile> named;
    std::optional<Mesh> mesh = deserializeMesh(readWholeFile(file), &named);
    if (!mesh) {
      removeDamaged(file);
      return std::nullopt;
    }
    for (const NamedFile& other : named)
      if (!isUnchanged || !isUnchanged(other)) return std::nullopt;
    std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), ignored);
    return mesh;
  } catch (const std::exception& e) {
    tellOfCacheTrouble(e.what());
    return std::nullopt;
  }
}

void writeCachedMesh(const ContentKey& key, const Mesh& mesh, const std::vector<NamedFile>& named) {
  writeCacheFile(cacheFile(kPrefix, key), serializeMesh(mesh, named), kPrefix, kMostCachedBytes);
}

}  // namespace pitviper

#include "sim/scene/import/mesh_builder.hpp"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/scene/import/far_origin.hpp"
#include "sim/scene/import/import_failure.hpp"
#include "sim/scene/import/import_reply.hpp"

namespace pitviper {
namespace {

/// Texture coordinates of the points, under whatever name the reader gave them; null if there are none.
vtkDataArray* uvOf(vtkPointData* data) {
  for (const char* name : {"TCoords", "TEXCOORD_0"})
    if (vtkDataArray* found = data->GetArray(name); found != nullptr && found->GetNumberOfComponents() >= 2) return found;
  vtkDataArray* found = data->GetTCoords();
  return found != nullptr && found->GetNumberOfComponents() >= 2 ? found : nullptr;
}

}  // namespace

void MeshBuilder::add(vtkPolyData* data, const CheckedFile& checked, const std::string& partName, const glm::dmat4& placement) {
  if (data == nullptr || data->GetPoints() == nullptr) return;
  const vtkIdType points = data->GetNumberOfPoints();
  firstVertex_ = places_.size();
  vtkDataArray* normals = data->GetPointData()->GetNormals();
  vtkDataArray* uv = uvOf(data->GetPointData());
  if (normals != nullptr && (normals->GetNumberOfComponents() != 3 || normals->GetNumberOfTuples() != points)) normals = nullptr;
  if (uv != nullptr && uv->GetNumberOfTuples() != points) uv = nullptr;
  // Every triangle has three vertices: more than that many can only be unused ones.
  if (places_.size() + static_cast<std::size_t>(points) > 3 * kMostImportedTriangles)
    throw ImportFailure{{file_}, "the mesh has too many vertices", "at most " + std::to_string(3 * kMostImportedTriangles), "simplify the mesh"};
  addPoints(data, normals, uv, checked.origin, placement);

  const auto checkedCells = [&](vtkCellArray* cells, auto&& perCell) {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    for (vtkIdType cell = 0; cells != nullptr && cell < cells->GetNumberOfCells(); ++cell) {
      cells->GetCellAtId(cell, count, corners);
      for (vtkIdType k = 0; k < count; ++k)
        if (corners[k] < 0 || corners[k] >= points)
          throw ImportFailure{
              {file_}, "face " + std::to_string(cell + 1) + " uses vertex " + std::to_string(corners[k]), "0.." + std::to_string(points - 1), ""};
      perCell(cell, corners, count);
    }
  };
  const std::size_t before = mesh_.triangles.size();
  std::vector<std::uint32_t> numbers;
  for (const std::string& name : checked.partNames) numbers.push_back(partNumber(name));
  const std::uint32_t whole = checked.partNames.empty() ? partNumber(partName) : 0;
  const double noise = noiseOf();
  checkedCells(data->GetPolys(), [&](vtkIdType cell, const vtkIdType* corners, vtkIdType count) {
    if (count > kMostCorners)
      throw ImportFailure{
          {file_}, "face " + std::to_string(cell + 1) + " has " + std::to_string(count) + " corners", "at most " + std::to_string(kMostCorners), ""};
    const auto face = static_cast<std::size_t>(cell);
    const std::uint32_t part = face < checked.partOfFace.size() ? numbers[checked.partOfFace[face]] : whole;
    if (count == 3) return addTriangle(corners[0], corners[1], corners[2], part);
    polygon_.clear();
    for (vtkIdType k = 0; k < count; ++k) polygon_.push_back(places_[firstVertex_ + static_cast<std::size_t>(corners[k])]);
    if (cutter_.cut(polygon_, noise, cut_) == PolygonCutter::Result::Crossing)
      throw ImportFailure{placeOf(checked, face), "face " + std::to_string(cell + 1) + " crosses itself", "a face whose edges meet at corners only",
                          "mend that face, or cut the mesh into triangles where it was made"};
    for (const auto& t : cut_) addTriangle(corners[t[0]], corners[t[1]], corners[t[2]], part);
  });
  checkedCells(data->GetStrips(), [&](vtkIdType, const vtkIdType* corners, vtkIdType count) {
    for (vtkIdType k = 2; k < count; ++k)  // every other triangle of a strip runs the other way
      addTriangle(corners[k - 2], corners[k - (k % 2 == 0 ? 1 : 0)], corners[k - (k % 2 == 0 ? 0 : 1)], whole);
  });
  if (mesh_.triangles.size() == before) {  // nothing visible: its lack of normals doesn't matter
    places_.resize(firstVertex_);
    mesh_.normals.resize(firstVertex_);
    mesh_.uv.resize(firstVertex_);
    return;
  }
  allNormals_ = allNormals_ && normals != nullptr;
  allUv_ = allUv_ && uv != nullptr;
}

void MeshBuilder::addPoints(vtkPolyData* data, vtkDataArray* normals, vtkDataArray* uv, const glm::dvec3& origin, const glm::dmat4& placement) {
  const glm::dmat3 linear(placement);
  mirrored_ = glm::determinant(linear) < 0.0;
  // The cofactor matrix takes normals to normals without a division; its sign is wrong for a mirror.
  const glm::dmat3 cofactor =
      (mirrored_ ? -1.0 : 1.0) * glm::dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]), glm::cross(linear[0], linear[1]));
  const bool moved = placement != glm::dmat4(1.0);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    double p[3], n[9] = {}, t[9] = {};
    data->GetPoint(i, p);
    if (normals != nullptr) normals->GetTuple(i, n);
    if (uv != nullptr) t[0] = uv->GetComponent(i, 0), t[1] = uv->GetComponent(i, 1);
    const glm::dvec3 place = glm::dvec3(p[0], p[1], p[2]) + origin;
    places_.push_back(moved ? linear * place + glm::dvec3(placement[3]) : place);
    constexpr auto kMost = static_cast<double>(std::numeric_limits<float>::max());
    if (!glm::all(glm::lessThanEqual(glm::abs(places_.back()), glm::dvec3(kMost))))
      throw ImportFailure{
          {file_}, "vertex " + std::to_string(i + 1) + " is not finite", "finite numbers in single precision", "correct the mesh, its unit or its scale"};
    glm::dvec3 normal(n[0], n[1], n[2]);
    if (moved) normal = cofactor * normal;
    if (moved && glm::length(normal) > 0.0) normal = glm::normalize(normal);  // of a small scale it may be beyond single precision
    mesh_.normals.emplace_back(normal);
    mesh_.uv.emplace_back(t[0], t[1]);
  }
}

/// How far a vertex may be off in single precision, of those added last.
double MeshBuilder::noiseOf() const {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (std::size_t i = firstVertex_; i < places_.size(); ++i) low = glm::min(low, places_[i]), high = glm::max(high, places_[i]);
  const glm::dvec3 size = high - low;
  const double extent = std::max({size.x, size.y, size.z});
  return std::isfinite(extent) ? std::ldexp(extent, -23) : 0.0;
}

Location MeshBuilder::placeOf(const CheckedFile& checked, std::size_t face) const {
  if (face >= checked.placeOfFace.size()) return {file_};
  const std::uint64_t at = checked.placeOfFace[face];
  if (checked.placesAreBytes) return {file_, 0, 0, static_cast<long long>(at)};
  return {file_, static_cast<int>(at), 1};
}

void MeshBuilder::addTriangle(long long a, long long b, long long c, std::uint32_t part) {
  if (mesh_.triangles.size() == kMostImportedTriangles)
    throw ImportFailure{{file_}, "the mesh has too many triangles", "at most " + std::to_string(kMostImportedTriangles), "simplify the mesh"};
  const auto vertex = [&](long long i) { return static_cast<std::uint32_t>(firstVertex_ + static_cast<std::size_t>(i)); };
  mesh_.triangles.emplace_back(vertex(a), vertex(mirrored_ ? c : b), vertex(mirrored_ ? b : c));
  partOfTriangle_.push_back(part);
}

std::uint32_t MeshBuilder::partNumber(const std::string& name) {
  const auto [entry, isNew] = partNumbers_.try_emplace(name.empty() ? "all" : name, static_cast<std::uint32_t>(partNames_.size()));
  if (isNew) partNames_.push_back(entry->first);
  return entry->second;
}

void MeshBuilder::turnFromGltf() {
  for (glm::dvec3& p : places_) p = {p.z, p.x, p.y};
  for (glm::vec3& n : mesh_.normals) n = {n.z, n.x, n.y};
}

/// Leaves out vertices that no triangle has, and takes what is far from the origin off all.
void MeshBuilder::place() {
  constexpr std::uint32_t kUnused = ~0u;
  std::vector<std::uint32_t> number(places_.size(), kUnused);
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::uvec3& t : mesh_.triangles)
    for (int k = 0; k < 3; ++k) number[t[k]] = 0, low = glm::min(low, places_[t[k]]), high = glm::max(high, places_[t[k]]);
  mesh_.offset_m = farOrigin(low, high);
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (number[i] == kUnused) continue;
    mesh_.positions.emplace_back(places_[i] - mesh_.offset_m);
    mesh_.normals[used] = mesh_.normals[i];
    mesh_.uv[used] = mesh_.uv[i];
    number[i] = used++;
  }
  mesh_.normals.resize(used);
  mesh_.uv.resize(used);
  for (glm::uvec3& t : mesh_.triangles) t = {number[t.x], number[t.y], number[t.z]};
}

Mesh MeshBuilder::take() {
  place();
  std::vector<std::uint32_t> counts(partNames_.size(), 0);
  for (const std::uint32_t part : partOfTriangle_) ++counts[part];
  std::vector<std::uint32_t> next;
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    next.push_back(first);
    if (counts[i] > 0) mesh_.parts.push_back({partNames_[i], first, counts[i]});
    first += counts[i];
  }
  std::vector<glm::uvec3> sorted(mesh_.triangles.size());
  for (std::size_t t = 0; t < sorted.size(); ++t) sorted[next[partOfTriangle_[t]]++] = mesh_.triangles[t];
  mesh_.triangles = std::move(sorted);
  if (!allNormals_) mesh_.normals.clear();
  if (!allUv_) mesh_.uv.clear();
  return std::move(mesh_);
}

}  // namespace pitviper

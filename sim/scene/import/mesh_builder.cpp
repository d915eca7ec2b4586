#include "sim/scene/import/mesh_builder.hpp"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolygon.h>

#include <limits>

#include "sim/scene/import/import_failure.hpp"
#include "sim/scene/import/import_reply.hpp"

namespace pitviper {
namespace {

/// The triangles of a polygon as triples of places in it. Ear cutting (vtkPolygon) suits concave faces too; what it
/// gives up on (corners on one line, crossing edges) becomes a fan.
void cutPolygon(vtkPolyData* data, const vtkIdType* corners, vtkIdType count, vtkIdList* triples) {
  triples->Reset();
  if (count > 3) {
    vtkNew<vtkPolygon> polygon;
    polygon->Points->SetNumberOfPoints(count);
    polygon->PointIds->SetNumberOfIds(count);
    for (vtkIdType k = 0; k < count; ++k) {
      polygon->Points->SetPoint(k, data->GetPoint(corners[k]));
      polygon->PointIds->SetId(k, k);
    }
    if (polygon->Triangulate(triples) != 0 && triples->GetNumberOfIds() == 3 * (count - 2)) return;
    triples->Reset();
  }
  for (vtkIdType k = 2; k < count; ++k)
    for (const vtkIdType corner : {vtkIdType{0}, k - 1, k}) triples->InsertNextId(corner);
}

/// Texture coordinates of the points, under whatever name the reader gave them; null if there are none.
vtkDataArray* uvOf(vtkPointData* data) {
  for (const char* name : {"TCoords", "TEXCOORD_0"})
    if (vtkDataArray* found = data->GetArray(name); found != nullptr && found->GetNumberOfComponents() >= 2) return found;
  vtkDataArray* found = data->GetTCoords();
  return found != nullptr && found->GetNumberOfComponents() >= 2 ? found : nullptr;
}

}  // namespace

void MeshBuilder::add(vtkPolyData* data, const CheckedFile& checked, const std::string& partName) {
  if (data == nullptr || data->GetPoints() == nullptr) return;
  const vtkIdType points = data->GetNumberOfPoints();
  firstVertex_ = mesh_.positions.size();
  vtkDataArray* normals = data->GetPointData()->GetNormals();
  vtkDataArray* uv = uvOf(data->GetPointData());
  if (normals != nullptr && (normals->GetNumberOfComponents() != 3 || normals->GetNumberOfTuples() != points)) normals = nullptr;
  if (uv != nullptr && uv->GetNumberOfTuples() != points) uv = nullptr;
  // Every triangle has three vertices: more than that many can only be unused ones.
  if (mesh_.positions.size() + static_cast<std::size_t>(points) > 3 * kMostImportedTriangles)
    throw ImportFailure{{file_}, "the mesh has too many vertices", "at most " + std::to_string(3 * kMostImportedTriangles), "simplify the mesh"};
  addPoints(data, normals, uv);

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
  vtkNew<vtkIdList> triples;
  std::vector<std::uint32_t> numbers;
  for (const std::string& name : checked.partNames) numbers.push_back(partNumber(name));
  const std::uint32_t whole = checked.partNames.empty() ? partNumber(partName) : 0;
  checkedCells(data->GetPolys(), [&](vtkIdType cell, const vtkIdType* corners, vtkIdType count) {
    if (count > kMostCorners)
      throw ImportFailure{
          {file_}, "face " + std::to_string(cell + 1) + " has " + std::to_string(count) + " corners", "at most " + std::to_string(kMostCorners), ""};
    const auto face = static_cast<std::size_t>(cell);
    const std::uint32_t part = face < checked.partOfFace.size() ? numbers[checked.partOfFace[face]] : whole;
    cutPolygon(data, corners, count, triples);
    for (vtkIdType k = 0; k + 2 < triples->GetNumberOfIds(); k += 3)
      addTriangle(corners[triples->GetId(k)], corners[triples->GetId(k + 1)], corners[triples->GetId(k + 2)], part);
  });
  checkedCells(data->GetStrips(), [&](vtkIdType, const vtkIdType* corners, vtkIdType count) {
    for (vtkIdType k = 2; k < count; ++k)  // every other triangle of a strip runs the other way
      addTriangle(corners[k - 2], corners[k - (k % 2 == 0 ? 1 : 0)], corners[k - (k % 2 == 0 ? 0 : 1)], whole);
  });
  if (mesh_.triangles.size() == before) {  // nothing visible: its lack of normals doesn't matter
    mesh_.positions.resize(firstVertex_);
    mesh_.normals.resize(firstVertex_);
    mesh_.uv.resize(firstVertex_);
    return;
  }
  allNormals_ = allNormals_ && normals != nullptr;
  allUv_ = allUv_ && uv != nullptr;
}

void MeshBuilder::addPoints(vtkPolyData* data, vtkDataArray* normals, vtkDataArray* uv) {
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    double p[3], n[9] = {}, t[9] = {};
    data->GetPoint(i, p);
    if (normals != nullptr) normals->GetTuple(i, n);
    if (uv != nullptr) t[0] = uv->GetComponent(i, 0), t[1] = uv->GetComponent(i, 1);
    mesh_.positions.emplace_back(p[0], p[1], p[2]);
    mesh_.normals.emplace_back(n[0], n[1], n[2]);
    mesh_.uv.emplace_back(t[0], t[1]);
  }
}

void MeshBuilder::addTriangle(long long a, long long b, long long c, std::uint32_t part) {
  if (mesh_.triangles.size() == kMostImportedTriangles)
    throw ImportFailure{{file_}, "the mesh has too many triangles", "at most " + std::to_string(kMostImportedTriangles), "simplify the mesh"};
  const auto vertex = [&](long long i) { return static_cast<std::uint32_t>(firstVertex_ + static_cast<std::size_t>(i)); };
  mesh_.triangles.emplace_back(vertex(a), vertex(b), vertex(c));
  partOfTriangle_.push_back(part);
}

std::uint32_t MeshBuilder::partNumber(const std::string& name) {
  const auto [entry, isNew] = partNumbers_.try_emplace(name.empty() ? "all" : name, static_cast<std::uint32_t>(partNames_.size()));
  if (isNew) partNames_.push_back(entry->first);
  return entry->second;
}

void MeshBuilder::turnFromGltf() {
  for (glm::vec3& p : mesh_.positions) p = {p.z, p.x, p.y};
  for (glm::vec3& n : mesh_.normals) n = {n.z, n.x, n.y};
}

Mesh MeshBuilder::take() {
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

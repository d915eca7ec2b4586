#pragma once
// Gathers VTK's polygons into one Mesh: cuts them into triangles, sorts them by part, checks every index.
#include <map>
#include <string>
#include <vector>

#include "sim/scene/import/checks.hpp"
#include "sim/scene/import/polygon_cutter.hpp"
#include "sim/scene/mesh.hpp"

class vtkDataArray;
class vtkPolyData;

namespace pitviper {

class MeshBuilder {
 public:
  explicit MeshBuilder(std::string file) : file_(std::move(file)) {}

  /// Polygons and strips; lines and points are left out. Parts by `checked` if it has any, else all become `partName`.
  /// Throws ImportFailure for indices out of range and for too many triangles.
  /// `placement` (affine) moves it; a mirroring one turns its triangles round. At its line, for faces that cross themselves.
  void add(vtkPolyData* data, const CheckedFile& checked, const std::string& partName, const glm::dmat4& placement = glm::dmat4(1.0));

  /// From glTF's axes (z forward, x left, y up) to ours.
  void turnFromGltf();

  /// Triangles ordered by part, vertices without any left out. Normals and uv only if all that was added had them.
  Mesh take();

 private:
  void addPoints(vtkPolyData* data, vtkDataArray* normals, vtkDataArray* uv, const glm::dvec3& origin, const glm::dmat4& placement);
  double noiseOf() const;
  Location placeOf(const CheckedFile& checked, std::size_t face) const;
  void place();
  void addTriangle(long long a, long long b, long long c, std::uint32_t part);
  std::uint32_t partNumber(const std::string& name);

  std::string file_;
  Mesh mesh_;
  std::vector<glm::dvec3> places_;  ///< of the mesh's vertices
  PolygonCutter cutter_;
  std::vector<glm::dvec3> polygon_;
  PolygonCutter::Triangles cut_;
  bool mirrored_ = false;  ///< what is being added
  std::vector<std::uint32_t> partOfTriangle_;
  std::vector<std::string> partNames_;
  std::map<std::string, std::uint32_t> partNumbers_;
  std::size_t firstVertex_ = 0;
  bool allNormals_ = true, allUv_ = true;
};

}  // namespace pitviper

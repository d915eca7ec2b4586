#include "scenarios/commands/charts/space_shapes.hpp"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkConeSource.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>
#include <vtkTubeFilter.h>

#include <cmath>

namespace pitviper {
namespace {

void show(vtkRenderer& renderer, vtkAlgorithm& source, Rgb8 colour, bool shaded) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source.GetOutputPort());
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
  // Mostly its own colour, so that it is that of the legend.
  actor->GetProperty()->SetAmbient(shaded ? 0.65 : 1.0);
  actor->GetProperty()->SetDiffuse(shaded ? 0.4 : 0.0);
  actor->GetProperty()->SetLighting(shaded);
  renderer.AddActor(actor);
}

vtkIdType put(vtkPoints& points, const glm::dvec3& p) { return points.InsertNextPoint(p.x, p.y, p.z); }

}  // namespace

void addTubes(vtkRenderer& renderer, const std::vector<SpaceLine>& lines, double radius_px, Rgb8 colour, bool shaded) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  for (const SpaceLine& line : lines) {
    // A tube has no direction where two points are one.
    constexpr double kApart_px = 0.05;
    SpaceLine apart;
    for (const glm::dvec3& p : line)
      if (apart.empty() || glm::distance(apart.back(), p) > kApart_px) apart.push_back(p);
    if (apart.size() < 2) continue;
    cells->InsertNextCell(static_cast<int>(apart.size()));
    for (const glm::dvec3& p : apart) cells->InsertCellPoint(put(*points, p));
  }
  if (cells->GetNumberOfCells() == 0) return;
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  vtkNew<vtkTubeFilter> tubes;
  tubes->SetInputData(data);
  tubes->SetRadius(radius_px);
  tubes->SetNumberOfSides(8);
  tubes->CappingOn();
  show(renderer, *tubes, colour, shaded);
}

void addBalls(vtkRenderer& renderer, const std::vector<glm::dvec3>& places, double radius_px, Rgb8 colour) {
  for (const glm::dvec3& p : places) {
    vtkNew<vtkSphereSource> ball;
    ball->SetCenter(p.x, p.y, p.z);
    ball->SetRadius(radius_px);
    ball->SetThetaResolution(14);
    ball->SetPhiResolution(10);
    show(renderer, *ball, colour, true);
  }
}

void addCone(vtkRenderer& renderer, const glm::dvec3& tip, const glm::dvec3& along, double length_px, double radius_px, Rgb8 colour) {
  if (!(glm::length(along) > 0.0)) return;
  const glm::dvec3 direction = glm::normalize(along), middle = tip - 0.5 * length_px * direction;
  vtkNew<vtkConeSource> cone;
  cone->SetCenter(middle.x, middle.y, middle.z);
  cone->SetDirection(direction.x, direction.y, direction.z);
  cone->SetHeight(length_px);
  cone->SetRadius(radius_px);
  cone->SetResolution(16);
  show(renderer, *cone, colour, true);
}

void addPlane(vtkRenderer& renderer, const SpaceLine& corners, Rgb8 colour) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(corners.size()));
  for (const glm::dvec3& p : corners) cells->InsertCellPoint(put(*points, p));
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
  actor->GetProperty()->SetLighting(false);
  renderer.AddActor(actor);
}

std::vector<SpaceLine> dashed(const glm::dvec3& from, const glm::dvec3& to, double dash_px) {
  std::vector<SpaceLine> pieces;
  const double length = glm::distance(from, to);
  if (!(length > 0.0) || !std::isfinite(length)) return pieces;
  constexpr double kMost = 2000.0;
  const double step = std::max(dash_px, length / kMost);
  for (double at = 0.0; at < length; at += 2.0 * step)
    pieces.push_back({glm::mix(from, to, at / length), glm::mix(from, to, std::min(1.0, (at + step) / length))});
  return pieces;
}

}  // namespace pitviper

#include "sim/render/geometry/view_data.hpp"

#include "sim/radiometry/physics.hpp"
#include "sim/render/geometry/pixel_classes.hpp"

namespace pitviper {

GpuView viewData(const Simulation& simulation, const View& v, double apertureArea_m2, glm::ivec2 corner) {
  const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
  GpuView g{};
  g.pixel = {v.tanPerPixelX, v.tanPerPixelY, v.axisX + corner.x, v.axisY + corner.y};
  const double halfX = 0.5 * v.width, halfY = 0.5 * v.height;
  g.film = {1.0 / (halfX * v.tanPerPixelX), 1.0 / (halfY * v.tanPerPixelY), v.axisX / halfX - 1.0, v.axisY / halfY - 1.0};
  g.depth = {v.near_m, v.onlyEntity >= 0 ? 0.5 * glm::length(v.depthCentre - v.position) / v.depthRadius_m : 0.0, 0.0, 0.0};
  g.up = glm::vec4(cameraFromLocal * simulation.frame.up(v.position), simulation.frame.height(v.position));
  g.earth = {simulation.frame.earthRadius_m(), simulation.air ? simulation.air->top_m() : physics::kFar, v.onlyEntity + 1, 0.0};
  g.sun = glm::vec4(simulation.sun ? cameraFromLocal * simulation.sun->toSun : glm::dvec3(0.0), 0.0);
  g.aperture = {apertureArea_m2, v.pixelTan2, 0.0, 0.0};
  g.east = glm::vec4(cameraFromLocal * glm::dvec3(1, 0, 0), 0.0);
  g.north = glm::vec4(cameraFromLocal * glm::dvec3(0, 1, 0), 0.0);
  if (simulation.sunShade) {
    const SunShadeGrid& grid = simulation.sunShade->grid();
    for (std::size_t k = 0; k < 3; ++k) g.shade[k] = glm::vec4(cameraFromLocal * grid.axis[k], glm::dot(grid.axis[k], v.position - grid.origin));
  }
  return g;
}

GpuDraw drawData(const Simulation& simulation, const DrawItem& item, const View& v, const WorldState& state) {
  GpuDraw g{};
  const Pose pose = item.entity < 0 ? Pose{v.position, {1, 0, 0, 0}} : state.entities[static_cast<size_t>(item.entity)];
  const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
  const glm::dmat3 bodyFromCamera = glm::transpose(glm::mat3_cast(pose.orientation)) * v.localFromCamera;
  const glm::dvec3 origin = cameraFromLocal * (pose.position - v.position);
  for (int r = 0; r < 3; ++r) g.row[r] = glm::vec4(bodyFromCamera[0][r], bodyFromCamera[1][r], bodyFromCamera[2][r], origin[r]);
  const Surface* s = item.kind == DrawKind::Ground ? &*simulation.ground
                     : item.entity < 0             ? nullptr
                                                   : &simulation.entities[static_cast<size_t>(item.entity)].surfaces[static_cast<size_t>(item.surface)];
  g.table = {item.row, item.material, s ? static_cast<unsigned>(s->temperatureTexture + 1) : 0u, static_cast<unsigned>(item.entity + 1)};
  const double fromCentre = (cameraFromLocal * (pose.position - v.depthCentre)).z;
  g.state = {item.entity >= 0 ? item.temperature_K : s ? s->temperature_K : 0.0, item.surface + 1, static_cast<double>(item.entity + 1), fromCentre};
  g.fine = {origin.z - static_cast<double>(static_cast<float>(origin.z)), PixelClasses::depthOf(static_cast<size_t>(item.surfaceClass)),
            PixelClasses::depthOf(static_cast<size_t>(item.everyLight)), 0.0};
  return g;
}

}  // namespace pitviper

// Grids of floats from OpenVDB files, made dense. The module's border: one C function, no exceptions out.
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <new>
#include <sstream>

#include "sim/scene/import/grid_reply.hpp"
#include "sim/scene/import/import_failure.hpp"

namespace pitviper {
namespace {

GridData readVdb(const GridRequest& request) {
  openvdb::initialize();
  std::istringstream text{std::string(request.bytes)};
  openvdb::io::Stream stream(text, false);  // all at once: there is no file to come back to
  const openvdb::GridPtrVecPtr all = stream.getGrids();
  std::string names;
  for (const auto& g : *all) names += (names.empty() ? "'" : ", '") + g->getName().substr(0, 60) + "'";

  std::vector<openvdb::FloatGrid::Ptr> wanted;
  openvdb::CoordBBox box;
  for (const std::string& name : request.names) {
    openvdb::FloatGrid::Ptr found;
    for (const auto& g : *all)
      if (g->getName() == name) found = openvdb::gridPtrCast<openvdb::FloatGrid>(g);
    if (!found)
      throw ImportFailure{{request.file},
                          "there is no grid of floats '" + name.substr(0, 60) + "'",
                          names.empty() ? "one; the file has none" : "one of " + names,
                          "correct the name under 'arrays'"};
    if (!wanted.empty() && found->transform() != wanted.front()->transform())
      throw ImportFailure{{request.file},
                          "grids '" + name.substr(0, 60) + "' and '" + request.names.front().substr(0, 60) + "' lie differently",
                          "one transform for all",
                          "resample them onto one"};
    box.expand(found->evalActiveVoxelBoundingBox());
    wanted.push_back(found);
  }
  if (wanted.empty() || box.empty()) throw ImportFailure{{request.file}, "the grids have no active voxels", "some", ""};
  const openvdb::math::Transform& to = wanted.front()->transform();
  const openvdb::Vec3d corner = to.indexToWorld(box.min()), size = to.voxelSize();
  // Scaled and moved only: a step along an index is one along its axis.
  const openvdb::Vec3d next = to.indexToWorld(openvdb::Vec3d(box.min().x() + 1.0, box.min().y() + 1.0, box.min().z() + 1.0)) - corner;
  const openvdb::Vec3d alongX = to.indexToWorld(openvdb::Vec3d(box.min().x() + 1.0, box.min().y(), box.min().z())) - corner;
  if (!to.isLinear() || std::abs(alongX.y()) + std::abs(alongX.z()) > 1e-6 * size.x() || !(next.x() > 0.0 && next.y() > 0.0 && next.z() > 0.0))
    throw ImportFailure{
        {request.file}, "the grids are turned or sheared", "a transform that scales and moves", "resample them, or turn them by 'forward' and 'up'"};
  const openvdb::Coord dim = box.dim();
  const double count = static_cast<double>(dim.x()) * dim.y() * dim.z();
  if (count > static_cast<double>(kMostGridNodes))
    throw ImportFailure{{request.file},
                        "active voxels over a box of " + std::to_string(static_cast<long long>(count)),
                        "at most " + std::to_string(kMostGridNodes),
                        "cut or thin it out"};
  GridData grid;
  grid.nodes = {dim.x(), dim.y(), dim.z()};
  grid.origin = {corner.x(), corner.y(), corner.z()};
  grid.spacing = {next.x(), next.y(), next.z()};
  for (std::size_t a = 0; a < wanted.size(); ++a) {
    grid.arrays.push_back({request.names[a], std::vector<float>(grid.count())});
    openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, grid.arrays.back().values.data());
    openvdb::tools::copyToDense(*wanted[a], dense, true);
  }
  return grid;
}

}  // namespace
}  // namespace pitviper

extern "C" __attribute__((visibility("default"))) void pitviperImportGrid(const pitviper::GridRequest& request, pitviper::GridReply* reply) {
  try {
    reply->grid = pitviper::readVdb(request);
  } catch (const pitviper::ImportFailure& failure) {
    *reply = {{}, true, failure.where, failure.wrong, failure.expected, failure.fix};
  } catch (const std::bad_alloc&) {
    *reply = {{}, true, {request.file}, "reading this file takes too much memory", "at most 1 GiB and sixteen times its size", "thin the grid out"};
  } catch (const std::exception& problem) {
    *reply = {{}, true, {request.file}, std::string("the reader failed on this file (") + problem.what() + ")", "a sound file", ""};
  }
}

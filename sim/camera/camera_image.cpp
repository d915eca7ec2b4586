#include "sim/camera/camera_image.hpp"

namespace pitviper {

void putPointsIntoPixels(CameraImage& image) {
  for (const FilmPoint& p : image.points) {
    const auto pixel = static_cast<std::size_t>(p.pixel);
    image.slots[static_cast<std::size_t>(p.slot)][pixel] += p.flux / image.solidAngles->projected_sr[pixel];
  }
  image.points.clear();
}

}  // namespace pitviper

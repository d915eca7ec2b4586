#pragma once
// What fields show beside unresolved bodies: a field varies within a subpixel, so that what shows of it there is not its mean, and where a cold body hides a
// bright jet the difference of two means would be all that is left. Such subpixels are drawn once more without the bodies, cell by cell; cells count as far as
// nothing covers them.
#include "sim/camera/fine_subpixels.hpp"
#include "sim/world/field_lines.hpp"

namespace pitviper {

class BesideBodies {
 public:
  BesideBodies(const Simulation& simulation, const WorldState& state, const View& film);
  /// Takes what bodies cover; null where no field is in the picture.
  CoveredCells* cells() { return fields_.empty() ? nullptr : &cells_; }
  /// Subpixels that a sheet of bodies has lines in: near each other.
  void touch(const SheetShares& shares);
  /// Puts what is there without the bodies in place of the picture's means, and takes away what of it they cover. `without`: what is in the picture but for
  /// them.
  void draw(Subpixels& image, LineDrawer& drawer, const WorldState& state, const std::vector<char>& without, FineSubpixels& fine) const;

 private:
  void drawPart(Subpixels& image, LineDrawer& drawer, const WorldState& state, const std::vector<char>& without, const std::vector<std::size_t>& part,
                FineSubpixels& fine) const;
  std::size_t width_;
  CoveredCells cells_;
  std::vector<FieldLines> fields_;               ///< those that may show
  std::vector<std::vector<std::size_t>> parts_;  ///< subpixels to be drawn together
};

}  // namespace pitviper

#pragma once
// What a component does over wavelength besides bending at its knots: fringes of films, which a grid of wavelengths must not step over.

namespace pitviper {

class HasFringes {
 public:
  virtual ~HasFringes() = default;
  /// Bins no wider than this [um] see its fringes; infinite where it has none.
  virtual double resolvedBy_um(double wavelength_um) const = 0;
  /// From one fringe to the next [um] where they are closer together than the reference's wavelengths, so that it is a mean over them; 0 elsewhere.
  virtual double averagedFringe_um(double wavelength_um) const = 0;
};

}  // namespace pitviper

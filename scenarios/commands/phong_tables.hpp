#pragma once
// Tables of a spectral Phong lobe's colour, as "A fast rendering algorithm for spectral Phong reflectance" makes them, and a better one.
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace pitviper {

using PhongColour = std::array<double, 3>;
/// The lobe's colour at cos(alpha) = t, 0..1.
using PhongLobe = std::function<PhongColour(double t)>;

class PhongTable {
 public:
  virtual ~PhongTable() = default;
  virtual PhongColour at(double t) const = 0;
};

/// Equal steps of t; the nearest entry below is read.
class UniformTable final : public PhongTable {
 public:
  UniformTable(const PhongLobe& lobe, int entries);
  PhongColour at(double t) const override;

 private:
  std::vector<PhongColour> entries_;
};

/// The paper's: `segments` of equal share of the integral of the lobe over t, as many equal steps in each, a parabola through three entries of one.
class ImportanceTable final : public PhongTable {
 public:
  ImportanceTable(const PhongLobe& lobe, int entries, int segments);
  PhongColour at(double t) const override;

 private:
  int steps_;                 ///< in a segment; even
  std::vector<double> ends_;  ///< of the segments, rising from 0 to 1
  std::vector<PhongColour> entries_;
};

/// Equal steps of the angle alpha, linear between, up to where the lobe has gone.
class AngleTable final : public PhongTable {
 public:
  AngleTable(const PhongLobe& lobe, int entries);
  PhongColour at(double t) const override;

 private:
  double perRadian_ = 0.0;
  std::vector<PhongColour> entries_;
};

}  // namespace pitviper

#pragma once
// All that an edited surface is: curves, a film, where they come from; its text and the material that it means.
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/reader/scenario_reader.hpp"
#include "scenarios/view/edited_curve.hpp"
#include "sim/model/material.hpp"

namespace pitviper {

enum class CurveKind { Diffuse, Specular, Exponent, Emissivity, FilmIndex, FilmAbsorption };
constexpr std::array kAllCurves{CurveKind::Diffuse,    CurveKind::Specular,  CurveKind::Exponent,
                                CurveKind::Emissivity, CurveKind::FilmIndex, CurveKind::FilmAbsorption};

/// How a kind of curve is shown.
struct CurveAxis {
  const char* name;
  const char* meaning;
  CurveBounds bounds;
  bool logarithmic = false;  ///< of the values: best of value + 1
};
const CurveAxis& axisOf(CurveKind kind);

/// One film over a substrate whose facets mirror by Fresnel's formulas. What scatters beneath is the diffuse curve.
struct EditedFilm {
  double thickness_um = 0.1;
  std::string substrate = "titanium";  ///< a substance of materials/substances, or its index as a number
  double roughness = 0.2;              ///< 0.002 to 1
  bool normalSlopes = false;           ///< otherwise Trowbridge and Reitz's
  bool pigmentApparent = true;         ///< the diffuse curve counts all that comes out of what went in, else one scattering beneath
  std::optional<bool> coherent = {};   ///< none: by thickness
  bool operator==(const EditedFilm&) const = default;
};

struct EditedSurface {
  std::string name = "edited";
  std::string description = {}, source = {};
  std::vector<std::string> notes = {};  ///< what was changed or left out of what it was made from
  /// Shared with the states before and after; by kind. Null: emissivity that is not given (Kirchhoff's then).
  std::array<std::shared_ptr<const EditedCurve>, kAllCurves.size()> curves;
  /// Given: a microfacet component of diffuse, film index and film absorption. None: spectral_phong of diffuse, specular, exponent, and emissivity. The curves
  /// that are not in force stay.
  std::optional<EditedFilm> film = {};

  /// White to 0.3, without a lobe.
  EditedSurface();
  const std::shared_ptr<const EditedCurve>& curve(CurveKind kind) const { return curves[static_cast<std::size_t>(kind)]; }
  std::shared_ptr<const EditedCurve>& curve(CurveKind kind) { return curves[static_cast<std::size_t>(kind)]; }
  bool inForce(CurveKind kind) const;
  bool operator==(const EditedSurface& other) const;
};

/// A material file that loads anywhere. What is not in force is not in it; without any specular reflectance it is lambertian.
std::string materialText(const EditedSurface& surface, const std::string& description, const std::string& source);

/// What that text means, made from the curves themselves: to rounding of twelve digits. UserError for a film that cannot be.
std::shared_ptr<const Material> madeMaterial(const EditedSurface& surface, const Libraries& libraries);

}  // namespace pitviper

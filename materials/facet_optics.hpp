#pragma once
// A rough face under thin films: what its facets, what lies beneath, and what goes through return and let pass, wavelength by wavelength.
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "materials/film_stack.hpp"
#include "materials/lobe_shares.hpp"
#include "materials/refractive_index.hpp"
#include "sim/model/component.hpp"

namespace pitviper {

/// What films are made of; their thickness as given.
struct FilmSpec {
  RefractiveIndex index;
  double thickness_um = 0.0;
  bool coherent = true;
  bool varies = false;  ///< its thickness is a state: others stand beside it
};

/// How the slopes of facets are distributed: of Trowbridge and Reitz (GGX), or normally.
enum class Slopes { Trowbridge, Normal };

struct FacetSpec {
  std::vector<FilmSpec> layers;  ///< from outside in
  RefractiveIndex beneath{Spectrum(1.5), Spectrum(0.0)};
  double roughness = 0.1;  ///< root of twice the mean square slope along one direction
  Slopes slopes = Slopes::Trowbridge;
  std::optional<Spectrum> pigment;         ///< albedo of what scatters beneath; of a real index n
  bool pigmentApparent = false;            ///< the albedo is that of what comes out per what goes in, inner reflections and all
  std::optional<double> paneThickness_um;  ///< light goes through to another face
  std::vector<FilmSpec> back;              ///< on that face, from the pane outwards
  double share = 1.0;                      ///< of the face that is facets; the rest is components of its own
};

/// Everything at one wavelength: by equally spaced angles from 0 to 90 degrees.
struct FacetRow {
  std::vector<double> facet;          ///< reflectance of a facet by its angle of incidence
  std::vector<double> hemispherical;  ///< of the facets together, by view angle
  std::vector<double> beneath;        ///< of what they lose among themselves and of what scatters beneath, by view angle
  std::vector<double> through;        ///< what gets past the facets, by view angle; where nothing is absorbed, all that does not come back
  std::vector<double> transmitted;    ///< through a pane, by view angle
  std::vector<double> returned;       ///< by way of several facets, by view angle; empty: hardly anything
  double again = 0.0;                 ///< f of light that several facets return = again x returned(in) returned(out) [1/sr]
  double scattered = 0.0;             ///< f of what scatters beneath = scattered x through(in) through(out) [1/sr]
};

class FacetOptics {
 public:
  static constexpr int kViews = kShareViews;
  /// Hemispherical mean of what facets send on to each other, from which it has a component of its own.
  static constexpr double kWorthBeneath = 1e-3;
  explicit FacetOptics(FacetSpec spec);
  /// Holds until this thread asks for another.
  const FacetRow& at(double wavelength_um) const;
  const FacetSpec& spec() const { return spec_; }
  /// Share of an ideal mirror's light that one facet alone does not send on, by view angle.
  const std::vector<double>& lost() const { return lost_; }
  int facetAngles() const { return facetAngles_; }
  /// Of linear reading between a facet's angles, the largest seen.
  double angleError() const { return angleError_; }
  /// So many thicknesses resolve the fringes of the film whose thickness is a state; 0: there is none.
  double statesPerUm() const { return statesPerUm_; }
  bool hasBeneath() const { return spec_.pigment || mostLost_ > kWorthBeneath; }
  double validLow_um() const { return low_um_; }
  double validHigh_um() const { return high_um_; }
  /// Of its substances; of fringes see HasFringes.
  std::vector<double> knots_um() const;
  double resolvedBy_um(double wavelength_um) const;
  double averagedFringe_um(double wavelength_um) const;
  void addTo(Fingerprint& fingerprint) const;

 private:
  FacetRow rowAt(double wavelength_um) const;
  std::vector<FilmLayer> layersAt(const std::vector<FilmSpec>& films, double wavelength_um) const;
  /// All that a facet has on and in it, down to the half space at its end.
  struct Stack {
    std::vector<FilmLayer> layers;
    std::complex<double> last;
  };
  Stack stackAt(double wavelength_um) const;
  double findStates() const;
  void chooseAngles();

  FacetSpec spec_;
  double low_um_, high_um_, mostLost_ = 0.0, angleError_ = 0.0, statesPerUm_ = 0.0;
  int facetAngles_ = 46;
  std::shared_ptr<const std::vector<AngleShares>> share_;  ///< by view
  std::vector<double> lost_;
  std::uint64_t number_;  ///< no other has it
  mutable std::mutex mutex_;
  mutable std::map<double, std::shared_ptr<const FacetRow>> rows_;
};

/// The lobe of facets that reflect everything.
Lobe facetLobe(Slopes slopes, double roughness);
double facetLobeAt(Slopes slopes, double roughness, const glm::dvec3& light, const glm::dvec3& view);

}  // namespace pitviper

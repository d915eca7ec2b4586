#pragma once
// A sink that writes a line of sight down as a sum of products: what a plan's wavelengths are fitted to.
//
// Simpler than the equation, alike for every wavelength, in four things: the air's emission between two places is that of one black body at steps of 4 K;
// textured temperatures are mixtures of two such; view angles go in steps of 5 degrees; what media and air send on the same stretch each pass half
// of the other; light scattered again is that of few heights and directions. Errors are measured on sums (line_check.hpp),
// which take none of these liberties.
#include "sim/plan/sights.hpp"

namespace pitviper {

class ProductSink final : public TermSink {
 public:
  /// All must outlive it. `shortest_um`: the shortest wavelength at which a channel sees thermal light.
  ProductSink(const Simulation& simulation, SightBook& book, double shortest_um, std::shared_ptr<DiffuseOnGrids> diffuse = nullptr);
  /// A new line begins.
  void begin(bool fromFilm);
  /// What was told since.
  Sight finish();

  void restart() override;
  void term(const Term& term) override;
  void segment(const Segment& segment) override;
  void pane(const Factor& transmittance, double modifier) override;

 private:
  /// `more`: a material and how much of it besides.
  int pathOf(const AirAmounts& powered, double ownPart, std::pair<int, double> more = {0, 0.0});
  void add(ProductTerm term);
  void addFactor(const ProductTerm& term, std::span<const Factor> rest);
  void emission(const Segment& segment);
  void emissionOfMedia(const Segment& segment);
  double strengthOf(int material);
  std::array<int, 2> drops(const MediumInside& medium, double cosine);
  void scattered(const Segment& segment);
  void scatteredAgain(const Segment& segment);
  void tellAgain();

  const Simulation& sim_;
  SightBook& book_;
  std::shared_ptr<DiffuseOnGrids> diffuse_;
  double step_K_;  ///< between temperatures of black bodies
  Sight sight_;
  std::map<int, double> strength_;    ///< of materials
  std::vector<size_t> scatterers_;    ///< absorbers of the air that scatter
  AirNode scattered_;                 ///< what they scatter, at a wavelength that tells much from little
  AirAmounts here_;                   ///< from the eye to the place reached, raised to their powers
  std::vector<double> media_m_;       ///< on the way so far, by material; empty: none
  std::vector<double> inside_m_;      ///< of the segment being told
  int herePath_ = -1, sunPath_ = -1;  ///< as far as the place reached, and with the way on to the sun; -1: not written down yet
  /// Light scattered again on segments told since the last pane or medium: together they are told as few.
  struct Again {
    AirAmounts middle, passed;
    DiffuseOnGrids::Place place;
    double weight = 0.0;    ///< of what it scatters, what is seen: exp(-depth) integrated over depth
    double scatters = 0.0;  ///< depth of scattering
  };
  std::vector<Again> again_;
  struct Pane {
    int transmittance;
    double modifier;
  };
  std::vector<Pane> panes_;
};

}  // namespace pitviper

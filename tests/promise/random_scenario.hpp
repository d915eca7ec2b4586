#pragma once
// Random scenarios over the whole library, as YAML text: what the promise of an accuracy is tried on.
#include <cstdint>
#include <string>

namespace pitviper::test {

struct ScenarioDraw {
  std::uint64_t seed = 1;
  int attempt = 0;               ///< another scenario of the same seed, where one was refused
  int mostWavelengths = 100000;  ///< of the reference, all channels together: bands are narrowed to it
  bool fields = true;            ///< plumes, smokes, flares in a third of them; the others are the same without
};

/// The same text on every machine. One camera of 20x20 pixels; a cluster of bodies 1 m to 50 km away; 0 to 4 transparent things in a row before it
/// (panes, a dome round the camera, media), none inside or across another except media of true form; lamps, sun, air, motion, textures; in a
/// fifth of them an exhaust, in a seventh smoke or flares.
std::string randomScenario(const ScenarioDraw& draw);

}  // namespace pitviper::test

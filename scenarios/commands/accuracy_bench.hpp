#pragma once
// Speed against accuracy of a scenario: its first camera at a ladder of accuracies and of even sampling, against the reference.
#include <optional>
#include <string>
#include <vector>

#include "scenarios/commands/accuracy_error.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// One way to choose wavelengths.
struct AccuracySetting {
  enum class Kind { Planned, Even, Gauss };
  Kind kind = Kind::Planned;
  std::string name;  ///< "1 %", "even 16"
  SpectralSampling sampling;
};

struct AccuracyRow {
  struct Channel {
    std::string name;
    int nodes = 0;                    ///< that count in it
    std::optional<double> predicted;  ///< error that the plan expects
    ChannelErrors errors;
  };
  AccuracySetting setting;
  int nodes = 0;  ///< of the plan
  double framesPerSecond = 0.0;
  std::vector<Channel> channels;
};

/// The accuracies, even samples and Gauss points that are compared.
std::vector<AccuracySetting> accuracyLadder();

struct AccuracyReport {
  std::string heading;  ///< scenario, camera, frames, driver
  std::vector<AccuracyRow> rows;
  std::vector<std::string> missing;  ///< settings that could not be drawn, and why
};

/// Film of `columns` with the same field of view.
void resizeFilm(Pinhole& pinhole, int columns);

}  // namespace pitviper

#include "sensors/spot_detection.hpp"

#include <cmath>
#include <stdexcept>

namespace pitviper {

double falseAlarms(double threshold) { return 0.5 * std::erfc(threshold / std::sqrt(2.0)); }

double thresholdFor(double probability) {
  if (!(probability > 0.0 && probability < 1.0)) throw std::invalid_argument("a probability that is not between 0 and 1");
  double low = -40.0, high = 40.0;  // beyond, Q is less than a double holds
  constexpr int kHalvings = 90;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (falseAlarms(middle) > probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double thresholdForRate(double alarms_per_hour, double pixels_per_s) { return thresholdFor(alarms_per_hour / (3600.0 * pixels_per_s)); }

double thresholdByCrossings(double alarms_per_hour, double pixels_per_s) {
  const double ofMean = pixels_per_s / (2.0 * std::sqrt(3.0)) * 3600.0;
  if (!(alarms_per_hour > 0.0 && alarms_per_hour <= ofMean)) throw std::invalid_argument("more alarms than noise crosses its mean");
  return std::sqrt(2.0 * std::log(ofMean / alarms_per_hour));
}

double detection(double tnr, double threshold) { return falseAlarms(threshold - tnr); }

double tnrFor(double probability, double threshold) { return threshold - thresholdFor(probability); }

}  // namespace pitviper

#pragma once
// What the values of a sweep's factor are drawn from: inverse distribution functions.
#include <limits>
#include <vector>

namespace pitviper {

class Distribution {
 public:
  /// Between two values, low < high.
  static Distribution uniform(double low, double high);
  /// Its logarithm is uniform; 0 < low < high.
  static Distribution logUniform(double low, double high);
  /// Of a standard deviation sigma > 0, cut off below `low` and above `high`; the mean and sigma are those before the cut.
  static Distribution normal(double mean, double sigma, double low = -std::numeric_limits<double>::infinity(),
                             double high = std::numeric_limits<double>::infinity());
  /// One of at least one value: equally often, or by weights >= 0 of finite sum > 0, one for each.
  static Distribution oneOf(std::vector<double> values, const std::vector<double>& weights = {});

  /// The value that a share u of all draws lies below, 0 < u < 1. Of a list: the shares of its values follow each other in the order of the list.
  double quantile(double u) const;
  bool isLogarithmic() const { return kind_ == Kind::LogUniform; }
  /// Number of values of a list; 0: any between its bounds.
  int levels() const { return static_cast<int>(values_.size()); }

 private:
  enum class Kind { Uniform, LogUniform, Normal, OneOf };
  Kind kind_ = Kind::Uniform;
  double low_ = 0.0, high_ = 1.0, mean_ = 0.0, sigma_ = 1.0;
  std::vector<double> values_, cumulative_;  ///< cumulative shares; none where all are equal
};

/// Share of a normal distribution that lies from `low` to `high`, good in both of its tails.
double normalShare(double mean, double sigma, double low, double high);

}  // namespace pitviper

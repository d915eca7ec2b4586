#include "scenarios/view/channel_table.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/on_threads.hpp"

namespace pitviper {
namespace {

/// So many entries are worth a thread.
constexpr std::size_t kLeastEntries = 16;
/// Stretches of an axis that are looked into, each at its ends and quarters.
constexpr int kStretches = 32;

class Bisection {
 public:
  Bisection(const AngleAxis& axis, std::size_t channels, double accuracy, const ValuesAtAngles& at)
      : axis_(axis),
        channels_(channels),
        accuracy_(accuracy),
        at_(at),
        known_(static_cast<std::size_t>(axis.count), false),
        values_(known_.size() * channels) {}

  std::vector<double> values() {
    std::vector<std::pair<int, int>> open;
    const int last = axis_.count - 1, stretches = std::min(kStretches, last);
    for (int k = 0; k < stretches; ++k) open.emplace_back(k * last / stretches, (k + 1) * last / stretches);
    while (!open.empty()) {
      for (const auto& [a, b] : open) {
        if (b - a <= 4)
          for (int j = a; j <= b; ++j) want(j);
        else
          for (int j : placesOf(a, b)) want(j);
      }
      ask();
      std::vector<std::pair<int, int>> next;
      for (const auto& [a, b] : open) {
        if (b - a <= 4) continue;
        const auto p = placesOf(a, b);
        if (off(p[0], p[2], p[4]) || off(p[0], p[1], p[2]) || off(p[2], p[3], p[4])) {
          next.emplace_back(a, p[2]);
          next.emplace_back(p[2], b);
        } else {
          for (std::size_t k = 0; k + 1 < p.size(); ++k) fill(p[k], p[k + 1]);
        }
      }
      open = std::move(next);
    }
    return std::move(values_);
  }

 private:
  static std::array<int, 5> placesOf(int a, int b) {
    const int middle = (a + b) / 2;
    return {a, (a + middle) / 2, middle, (middle + b) / 2, b};
  }
  double& value(int entry, std::size_t channel) { return values_[static_cast<std::size_t>(entry) * channels_ + channel]; }
  void want(int entry) {
    if (known_[static_cast<std::size_t>(entry)]) return;
    known_[static_cast<std::size_t>(entry)] = true;
    wanted_.push_back(entry);
  }
  void ask() {
    onStretches(wanted_.size(), kLeastEntries, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) at_({axis_.at(wanted_[k]), 0.0}, &value(wanted_[k], 0));
    });
    most_.resize(channels_, 0.0);
    for (int entry : wanted_)
      for (std::size_t c = 0; c < channels_; ++c) most_[c] = std::max(most_[c], std::abs(value(entry, c)));
    wanted_.clear();
  }
  /// Whether the line between two misses what lies between.
  bool off(int a, int between, int b) {
    const double f = static_cast<double>(between - a) / (b - a);
    for (std::size_t c = 0; c < channels_; ++c) {
      const double is = value(between, c), line = value(a, c) + f * (value(b, c) - value(a, c));
      if (std::abs(line - is) > accuracy_ * std::max(std::abs(is), 1e-3 * most_[c])) return true;
    }
    return false;
  }
  void fill(int a, int b) {
    for (int j = a + 1; j < b; ++j)
      for (std::size_t c = 0; c < channels_; ++c) value(j, c) = value(a, c) + (value(b, c) - value(a, c)) * (j - a) / (b - a);
  }

  AngleAxis axis_;
  std::size_t channels_;
  double accuracy_;
  const ValuesAtAngles& at_;
  std::vector<bool> known_;
  std::vector<double> values_, most_;
  std::vector<int> wanted_;
};

ChannelTable byChannel(const std::array<AngleAxis, 2>& axes, std::size_t channels, const std::vector<double>& values) {
  ChannelTable table{axes, std::vector<std::vector<float>>(channels, std::vector<float>(values.size() / channels))};
  for (std::size_t k = 0; k < values.size(); ++k) table.values[k % channels][k / channels] = static_cast<float>(values[k]);
  return table;
}

}  // namespace

ChannelTable filledTable(const std::array<AngleAxis, 2>& axes, std::size_t channels, const ValuesAtAngles& at) {
  const auto inner = static_cast<std::size_t>(axes[0].count), entries = inner * static_cast<std::size_t>(axes[1].count);
  std::vector<double> values(entries * channels);
  onStretches(entries, kLeastEntries, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) at({axes[0].at(static_cast<int>(k % inner)), axes[1].at(static_cast<int>(k / inner))}, &values[k * channels]);
  });
  return byChannel(axes, channels, values);
}

ChannelTable bisectedTable(const AngleAxis& axis, std::size_t channels, double accuracy, const ValuesAtAngles& at) {
  return byChannel({axis, AngleAxis{}}, channels, Bisection(axis, channels, accuracy, at).values());
}

}  // namespace pitviper

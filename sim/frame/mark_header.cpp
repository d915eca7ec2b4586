#include "sim/frame/mark_header.hpp"

#include <algorithm>
#include <array>

namespace pitviper {
namespace {

const std::string kBegin = "pitviper.saturated.";

struct Kind {
  CountMark mark;
  const char* name;
  int MarkTally::*number;
};
constexpr std::array<Kind, 3> kKinds{
    Kind{CountMark::Full, ".full", &MarkTally::full}, {CountMark::Lowest, ".lowest", &MarkTally::lowest}, {CountMark::Bad, ".bad", &MarkTally::bad}};

}  // namespace

void addMarks(Frame& frame, const CountMarks& marks) {
  for (const auto& [channel, pixels] : marks)
    for (const Kind& k : kKinds) frame.attributes.push_back({kBegin + channel + k.name, static_cast<int>(std::count(pixels.begin(), pixels.end(), k.mark))});
}

std::map<std::string, MarkTally> markTallies(const Frame& frame) {
  std::map<std::string, MarkTally> tallies;
  for (const Attribute& a : frame.attributes) {
    const int* number = std::get_if<int>(&a.value);
    if (!number || !a.name.starts_with(kBegin)) continue;
    for (const Kind& k : kKinds)
      if (a.name.ends_with(k.name)) tallies[a.name.substr(kBegin.size(), a.name.size() - kBegin.size() - std::string(k.name).size())].*k.number = *number;
  }
  return tallies;
}

}  // namespace pitviper

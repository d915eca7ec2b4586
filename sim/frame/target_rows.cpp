#include "sim/frame/target_rows.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/print.hpp"

namespace pitviper {

void finishTargets(Frame& frame, const CountMarks& marks) {
  for (TargetRow& t : frame.targets) {
    for (TargetRow::Channel& c : t.channels) {
      const auto own = marks.find(c.channel);
      if (own == marks.end() || std::isnan(t.left)) continue;
      c.saturated = 0;
      // A pixel around, which the lens reaches.
      const int left = std::max(0, static_cast<int>(t.left) - 1), right = std::min(frame.width - 1, static_cast<int>(t.right) + 1),
                top = std::max(0, static_cast<int>(t.top) - 1), bottom = std::min(frame.height - 1, static_cast<int>(t.bottom) + 1);
      for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x)
          c.saturated += own->second[static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x)] == CountMark::Full;
    }
    const std::string name = "target." + t.name + ".";
    frame.attributes.push_back({name + "place", std::vector<double>{t.column, t.row, t.left, t.top, t.right, t.bottom}});
    frame.attributes.push_back({name + "sight", std::vector<double>{t.range_m, t.rangeRate_m_s, t.sightRight_rad_s, t.sightUp_rad_s, t.visible}});
    for (const TargetRow::Channel& c : t.channels)
      frame.attributes.push_back({name + c.channel, std::vector<double>{c.own, c.total, c.contrast, c.signalToNoise, static_cast<double>(c.saturated)}});
  }
}

std::string targetTableHead(const std::vector<TargetRow>& rows) {
  std::string text =
      "frame,time [s],name,kind,column,row,left,top,right,bottom,range [m],range rate [m/s],sight right [rad/s],sight up [rad/s],visible";
  if (!rows.empty())
    for (const TargetRow::Channel& c : rows.front().channels)
      text += "," + c.channel + ".own [" + c.unit + "]," + c.channel + ".total [" + c.unit + "]," + c.channel + ".contrast [" + c.unit + "]," + c.channel +
              ".snr," + c.channel + ".saturated";
  return text + "\n";
}

std::string targetTable(const Frame& frame) {
  std::string text;
  const auto add = [&text](double value) { text += std::isnan(value) ? "," : print(",%.9g", value); };
  for (const TargetRow& t : frame.targets) {
    text += std::to_string(frame.number);
    add(frame.time_s);
    text += "," + t.name + "," + t.kind;
    for (double v : {t.column, t.row, t.left, t.top, t.right, t.bottom, t.range_m, t.rangeRate_m_s, t.sightRight_rad_s, t.sightUp_rad_s, t.visible}) add(v);
    for (const TargetRow::Channel& c : t.channels) {
      for (double v : {c.own, c.total, c.contrast, c.signalToNoise}) add(v);
      text += c.saturated < 0 ? "," : "," + std::to_string(c.saturated);
    }
    text += "\n";
  }
  return text;
}

}  // namespace pitviper

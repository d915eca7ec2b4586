#include "sim/frame/target_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

const std::string kTarget = "target.", kUnit = "target_unit.";

}  // namespace

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
    const std::string name = kTarget + t.name + ".";
    frame.attributes.push_back({name + "kind", t.kind});
    frame.attributes.push_back({name + "place", std::vector<double>{t.column, t.row, t.left, t.top, t.right, t.bottom}});
    frame.attributes.push_back({name + "sight", std::vector<double>{t.range_m, t.rangeRate_m_s, t.sightRight_rad_s, t.sightUp_rad_s, t.visible}});
    for (const TargetRow::Channel& c : t.channels)
      frame.attributes.push_back({name + c.channel, std::vector<double>{c.own, c.total, c.contrast, c.signalToNoise, static_cast<double>(c.saturated)}});
  }
  if (!frame.targets.empty())
    for (const TargetRow::Channel& c : frame.targets.front().channels) frame.attributes.push_back({kUnit + c.channel, c.unit});
}

void restoreTargets(Frame& frame) {
  std::map<std::string, std::string> units;
  for (const Attribute& a : frame.attributes)
    if (const auto* unit = std::get_if<std::string>(&a.value); unit && a.name.starts_with(kUnit)) units[a.name.substr(kUnit.size())] = *unit;
  const auto numbers = [&](const Attribute& a, std::size_t count) {
    const auto values = numbersOf(a);
    return values && values->size() == count ? *values : std::vector<double>();
  };
  const auto rowNamed = [&](const std::string& name) -> TargetRow& {
    for (TargetRow& t : frame.targets)
      if (t.name == name) return t;
    frame.targets.emplace_back().name = name;
    return frame.targets.back();
  };
  for (const Attribute& a : frame.attributes) {
    const std::size_t dot = a.name.rfind('.');
    if (!a.name.starts_with(kTarget) || dot < kTarget.size() + 1) continue;
    const std::string name = a.name.substr(kTarget.size(), dot - kTarget.size()), what = a.name.substr(dot + 1);
    if (what == "kind") {
      if (const auto* kind = std::get_if<std::string>(&a.value)) rowNamed(name).kind = *kind;
    } else if (what == "place") {
      const auto v = numbers(a, 6);
      if (v.empty()) continue;
      TargetRow& t = rowNamed(name);
      t.column = v[0], t.row = v[1], t.left = v[2], t.top = v[3], t.right = v[4], t.bottom = v[5];
    } else if (what == "sight") {
      const auto v = numbers(a, 5);
      if (v.empty()) continue;
      TargetRow& t = rowNamed(name);
      t.range_m = v[0], t.rangeRate_m_s = v[1], t.sightRight_rad_s = v[2], t.sightUp_rad_s = v[3], t.visible = v[4];
    } else if (const auto v = numbers(a, 5); !v.empty()) {
      rowNamed(name).channels.push_back({what, units[what], v[0], v[1], v[2], v[3], static_cast<int>(v[4])});
    }
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

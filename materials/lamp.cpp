// A lamp: a spectrum of intensity, and a factor over time.
#include "materials/lights.hpp"

namespace pitviper {
namespace {

/// Rows [time, factor].
void readLevel(const Value& rows, PointLight& light) {
  for (const Value& row : rows.items) {
    if (row.kind != Value::Kind::List || row.items.size() != 2) throw UserError(row.where, "not a row [time, factor]", "[0.5 s, 1]", "write two values");
    const double t = readNumber(row.items[0], "s", "time"), f = readNumber(row.items[1], "", "factor");
    if (!(f >= 0.0 && f <= 1e6))
      throw UserError(row.items[1].where, "a factor of a light's level is out of range (" + row.items[1].text.substr(0, 40) + ")", "0 to 1e6",
                      "correct the row");
    if (!light.level.empty() && t <= light.level.back().first)
      throw UserError(row.items[0].where, "the times of a light's level do not rise", "each row later than the one before", "sort the rows");
    light.level.emplace_back(t, f);
  }
}

}  // namespace

LightModel lampModel() {
  return {"lamp",
          "A point light (flare, beacon, lamp) of a given intensity.",
          {required(atLeast(spectrum("intensity", "W/(sr um)", "spectral radiant intensity"), 0)),
           list("level", "rows [time, factor]: intensity over time, linear between, dark outside", 1, 100000)},
          [](const ModelRecord& r, PointLight& light) {
            light.intensity = r.spectrum("intensity");
            if (r.record.given("level")) readLevel(r.record.value("level"), light);
          }};
}

}  // namespace pitviper

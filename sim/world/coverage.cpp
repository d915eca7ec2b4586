#include "sim/world/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// Something with data over a range of wavelengths.
struct Source {
  std::string what;
  Location where;
  double low_um = 0.0, high_um = 0.0;
  bool table = false;  ///< made by a program that counts in wavenumbers: nothing may be declared of what is outside it
  bool isAir = false;
};

std::vector<Source> sourcesOf(const Simulation& sim, const Location& channel) {
  std::vector<Source> all;
  auto add = [&](std::string what, const Location& where, const Spectrum& s) { all.push_back({std::move(what), where, s.validLow(), s.validHigh()}); };
  for (const auto& m : sim.materials) all.push_back({"material '" + m->name + "'", m->where, m->validLow_um(), m->validHigh_um()});
  if (sim.air) {
    const bool table = !sim.air->where().file.empty();
    all.push_back({"the atmosphere", table ? sim.air->where() : channel, sim.air->validLow_um(), sim.air->validHigh_um(), table, true});
  }
  for (const auto& l : sim.lights) add("light '" + l.name + "'", channel, l.intensity);
  if (sim.sun) add("the sun", channel, sim.sun->irradiance);
  if (sim.ambient) add("ambient", channel, *sim.ambient);
  add("the background", channel, sim.background);
  return all;
}

/// 1e-12: ends of tables made in wavenumbers are rounded.
bool covers(const Source& s, double low, double high) { return s.low_um <= low * (1 + 1e-12) && s.high_um >= high * (1 - 1e-12); }

std::string micrometres(double v) { return print("%.6g um", v); }

std::string percent(double share) { return print("%.2g %%", 100.0 * share); }

/// Part of a kernel's integral outside [from, to]; 1 where that is everything or the kernel itself has gaps.
double shareOutside(const Spectrum& kernel, double from, double to) {
  const double low = kernel.supportLow(), high = kernel.supportHigh();
  if (kernel.validLow() > low || kernel.validHigh() < high || !(from < high && to > low)) return 1.0;
  const double whole = kernel.integral(low, high);
  double lost = 0.0;
  if (from > low) lost += kernel.integral(low, from);
  if (to < high) lost += kernel.integral(to, high);
  return whole > 0.0 ? lost / whole : 1.0;
}

std::string fixFor(const Source& s, double low, double high) {
  const double from = std::max(low, s.low_um), to = std::min(high, s.high_um);
  std::string narrow = "narrow the channel";
  if (from < to) {  // rounded inwards: what is written here is taken
    narrow += print(" ('response: {product: [<the response>, {band: [%.6g um, %.6g um]}]}')", std::ceil(from * 1e4) * 1e-4, std::floor(to * 1e4) * 1e-4);
  }
  if (s.table) {
    return print("make the table from %.0f to %.0f 1/cm or more, or ", std::floor(1e4 / high), std::ceil(1e4 / low)) + narrow;
  }
  if (s.isAir) return narrow + ", or take other air";
  return "extend its table, " + narrow + ", or declare 'outside: hold' or 'outside: zero' if that is true";
}

[[noreturn]] void refuse(const Source& s, const ChannelOutput& output, double share) {
  const double low = output.kernel.supportLow(), high = output.kernel.supportHigh();
  throw UserError(s.where,
                  s.what + " has no data for channel '" + output.channel + "' (" + micrometres(low) + " to " + micrometres(high) +
                      "): " + (share < 1.0 ? percent(share) + " of its response's integral lies" : std::string("all of its response lies")) + " beyond",
                  "a spectrum that covers the channel's band; this one covers " + micrometres(s.low_um) + " to " + micrometres(s.high_um),
                  fixFor(s, low, high));
}

}  // namespace

double cutToData(const Simulation& sim, ChannelOutput& output) {
  const double low = output.kernel.supportLow(), high = output.kernel.supportHigh();
  double from = low, to = high, worst = 0.0;
  Source ends;
  for (const Source& s : sourcesOf(sim, output.where)) {
    if (covers(s, low, high)) continue;
    const double share = shareOutside(output.kernel, s.low_um, s.high_um);
    if (!(share < kMostCut)) refuse(s, output, share);
    from = std::max(from, s.low_um);
    to = std::min(to, s.high_um);
    if (share > worst || ends.what.empty()) worst = share, ends = s;  // of several alike the first: ambient light may be made of the air
  }
  if (from == low && to == high) return 1.0;
  const double share = shareOutside(output.kernel, from, to);
  if (!(share < kMostCut)) refuse(ends, output, share);
  output.kernel = output.kernel * Spectrum::band(from, to);
  output.bandLow_um = std::max(output.bandLow_um, from);
  output.bandHigh_um = std::min(output.bandHigh_um, to);
  std::string side = from > low ? "below " + micrometres(from) : "";
  if (to < high) side += (side.empty() ? "beyond " : " and beyond ") + micrometres(to);
  output.cut = percent(share) + " of its response's integral lies " + side + ", where " + ends.what + " has no data, and is left out";
  return 1.0 - share;
}

void requireData(const Simulation& sim, const ChannelOutput& output) {
  const double low = output.kernel.supportLow(), high = output.kernel.supportHigh();
  for (const Source& s : sourcesOf(sim, output.where))
    if (!covers(s, low, high)) refuse(s, output, shareOutside(output.kernel, s.low_um, s.high_um));
}

}  // namespace pitviper

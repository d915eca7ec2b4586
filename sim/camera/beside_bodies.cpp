#include "sim/camera/beside_bodies.hpp"

#include <algorithm>
#include <set>

#include "sim/camera/wanted_lines.hpp"
#include "sim/world/field_states.hpp"

namespace pitviper {
namespace {

constexpr int kAcross = CoveredCells::kAcross;

}  // namespace

BesideBodies::BesideBodies(const Simulation& sim, const WorldState& state, const View& v) : width_(static_cast<size_t>(v.width)), cells_(v) {
  for (size_t f = 0; f < sim.fields.size(); ++f)
    if (const FieldState* field = fieldOf(state, f))
      if (const FieldLines lines = fieldLines(v, *field); !lines.isEmpty()) fields_.push_back(lines);
}

void BesideBodies::touch(const SheetShares& shares) {
  std::vector<size_t> near;
  for (const auto& [p, share] : shares) {
    const double x = static_cast<double>(p % width_), y = static_cast<double>(p / width_);
    if (share.covered_sr > 0.0 && std::any_of(fields_.begin(), fields_.end(),
                                              [&](const FieldLines& f) { return f.low.x < x + 1.0 && f.low.y < y + 1.0 && f.high.x > x && f.high.y > y; }))
      near.push_back(p);
  }
  if (!near.empty()) parts_.push_back(std::move(near));
}

void BesideBodies::draw(Subpixels& image, LineDrawer& drawer, const WorldState& state, const std::vector<char>& without, FineSubpixels& fine) const {
  constexpr double kNothing = 1e-9;  // of a subpixel: its lines make up the whole of it but for rounding
  std::set<size_t> done;
  for (std::vector<size_t> part : parts_) {
    std::erase_if(part, [&](size_t p) { return fine.at(p).covered_sr > (1.0 - kNothing) * fine.at(p).whole_sr || !done.insert(p).second; });
    if (!part.empty()) drawPart(image, drawer, state, without, part, fine);
  }
}

void BesideBodies::drawPart(Subpixels& image, LineDrawer& drawer, const WorldState& state, const std::vector<char>& without, const std::vector<size_t>& part,
                            FineSubpixels& fine) const {
  const auto width = width_;
  const auto placeOf = [&](size_t p) { return glm::ivec2(p % width, p / width); };
  glm::ivec2 low = placeOf(part.front()), high = low;
  for (size_t p : part) low = glm::min(low, placeOf(p)), high = glm::max(high, placeOf(p) + 1);
  const glm::ivec2 size(powerOfTwo(kAcross * (high.x - low.x)), powerOfTwo(kAcross * (high.y - low.y)));
  View z = magnified(image.view(), {low, size / kAcross}, kAcross);
  const auto firstOf = [&](size_t p) {
    const glm::ivec2 at = (placeOf(p) - low) * kAcross;
    return static_cast<size_t>(at.y) * static_cast<size_t>(z.width) + static_cast<size_t>(at.x);
  };
  auto marks = std::make_shared<std::vector<char>>(static_cast<size_t>(z.width) * static_cast<size_t>(z.height), 0);
  for (size_t p : part)
    for (int c = 0; c < kAcross * kAcross; ++c) (*marks)[firstOf(p) + static_cast<size_t>(c / kAcross * z.width + c % kAcross)] = 1;
  z.wanted = marks;
  const RawImage seen = drawWanted(drawer, z, state, without, true);
  for (size_t p : part) {
    const CoveredCells::Cells* covered = cells_.of(p);
    FineSubpixel& f = fine.at(p);
    for (size_t s = 0; s < image.slotCount(); ++s) {
      double hidden = 0.0, left = 0.0, hides = 0.0, leaves = 0.0, all = 0.0;
      for (int c = 0; c < kAcross * kAcross; ++c) {
        const double here = static_cast<double>(seen.groups[s / 4][4 * (firstOf(p) + static_cast<size_t>(c / kAcross * z.width + c % kAcross)) + s % 4]);
        const double share = covered ? std::clamp((*covered)[static_cast<size_t>(c)], 0.0, 1.0) : 0.0;
        hides += share, hidden += share * here;
        leaves += 1.0 - share, left += (1.0 - share) * here;
        all += here / (kAcross * kAcross);
      }
      const double behind = hides > 0.0 ? hidden / hides : all, beside = leaves > 0.0 ? left / leaves : all;
      f.under[s] = f.covered_sr * behind;
      image.add(s, p, (f.under[s] + (f.whole_sr - f.covered_sr) * beside) / f.whole_sr - image.slot(s, p));
    }
  }
}

}  // namespace pitviper

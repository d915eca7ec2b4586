// Rows of what has no outline: exhaust and burning clouds.
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/camera/visible_lights.hpp"
#include "sim/frame/truth_table.hpp"
#include "sim/frame/truth_work.hpp"
#include "sim/model/field_drift.hpp"
#include "sim/plan/line_check.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/reference/reference_pixel.hpp"
#include "sim/world/field_lines.hpp"
#include "sim/world/field_states.hpp"

namespace pitviper {
namespace {

/// A film that holds all that lies within 83 degrees of the axis; of what is many times as wide as the camera's film only what is near that counts.
constexpr int kWide = 1 << 20;
constexpr double kWidest = 8.0, kMuchWider = 8.0;
/// Lines of a pixel of the grid at most, each way, and how far apart they lie compared with the reference's: 1.7 of a Gaussian's widths leave 1e-3.
constexpr int kMostLines = 48;
constexpr double kCoarser = 2.0, kCoarseFrom = 0.005;
/// Steps along a line: as of pictures at 1 %, and of the reference. Air is then looked at where plans do, which changes what it sends by some 1e-4.
constexpr int kCoarseSteps = 48;
/// Its box holds what sends this part of what its brightest line does.
constexpr double kOfBrightest = 0.01;

/// The rectangle of a camera's axes in which a field shows, in squares.
View gridOver(const View& film, const FieldState& field, int cells) {
  View wide = film;
  wide.width = wide.height = kWide;
  wide.tanPerPixelX = wide.tanPerPixelY = 2.0 * kWidest / kWide;
  wide.axisX = wide.axisY = 0.5 * kWide;
  const FieldLines all = fieldLines(wide, field);
  View grid = wide;
  grid.width = grid.height = 0;
  if (all.isEmpty()) return grid;
  const glm::dvec2 axis(0.5 * kWide);
  glm::dvec2 low = (all.low - axis) * wide.tanPerPixelX, high = (all.high - axis) * wide.tanPerPixelY;
  const glm::dvec2 size = glm::dvec2(film.width * film.tanPerPixelX, film.height * film.tanPerPixelY),
                   corner = -glm::dvec2(film.axisX * film.tanPerPixelX, film.axisY * film.tanPerPixelY);
  if (high.x - low.x > kMuchWider * size.x || high.y - low.y > kMuchWider * size.y) {
    low = glm::max(low, corner - size);
    high = glm::min(high, corner + 2.0 * size);
    if (!(high.x > low.x && high.y > low.y)) return grid;
  }
  const double cell = std::max(high.x - low.x, high.y - low.y) / cells;
  grid.width = std::max(1, static_cast<int>(std::ceil((high.x - low.x) / cell - 1e-9)));
  grid.height = std::max(1, static_cast<int>(std::ceil((high.y - low.y) / cell - 1e-9)));
  grid.tanPerPixelX = grid.tanPerPixelY = cell;
  grid.axisX = -low.x / cell;
  grid.axisY = -low.y / cell;
  grid.subpixels = grid.grouped = 1;
  grid.wanted = nullptr;
  return grid;
}

/// The largest sum, whatever its sign, over squares of so many cells.
double largestSum(const std::vector<double>& cells, int width, int height, int across) {
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * (width + 1) + x); };
  std::vector<double> upTo(static_cast<std::size_t>((width + 1) * (height + 1)), 0.0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      upTo[at(x + 1, y + 1)] = cells[static_cast<std::size_t>(y * width + x)] + upTo[at(x, y + 1)] + upTo[at(x + 1, y)] - upTo[at(x, y)];
  double most = 0.0;
  for (int y = 0; y == 0 || y + across <= height; ++y)
    for (int x = 0; x == 0 || x + across <= width; ++x) {
      const int right = std::min(x + across, width), top = std::min(y + across, height);
      most = std::max(most, std::abs(upTo[at(right, top)] - upTo[at(x, top)] - upTo[at(right, y)] + upTo[at(x, y)]));
    }
  return most;
}

}  // namespace

void TruthMeter::addField(TargetRow& row, std::size_t f, const WorldState& state) const {
  const auto slots = static_cast<std::size_t>(plan_.slotCount), channels = radianceOf_.size();
  const auto slotOf = [&](std::size_t c) { return static_cast<std::size_t>(plan_.slotOfOutput[radianceOf_[c]]); };
  std::vector<double> own(slots, 0.0), total = own, contrast = own;
  const View film = cameraView(camera_, state, 1);
  const FieldState& field = *fieldOf(state, f);
  const View grid = gridOver(cameraView(drawnCamera(camera_), state, 1), field, static_cast<int>(0.5 * lines_));
  if (grid.width == 0) return addChannels(row, own, total, contrast, 0.0, state);
  const FieldLines places = fieldLines(grid, field);
  const bool coarse = asked_ >= kCoarseFrom;
  const int steps = coarse ? kCoarseSteps : kReferenceFieldSteps;
  ReferenceShader shader(simulation_, plan_, grid, state, present_, spectra_);
  if (coarse) shader.setAirPlaces(kUsualPlaces);
  const CameraState eye = cameraAt(camera_, state);
  const glm::ivec4 window = camera_.window.value_or(glm::ivec4(0, 0, film.width, film.height));

  /// A line that it would be seen along if nothing hid it.
  struct Seen {
    glm::dvec2 at{0.0};
    double sr = 0.0;
    bool isSeen = false;
    std::vector<double> own = {};    ///< by channel, that it sends along it
    std::vector<double> whole = {};  ///< what it would if nothing hid it
  };
  struct Row {
    std::vector<double> own, total, contrast, ofCell;  ///< the last by channel and cell
    double seen_sr = 0.0;
    std::vector<Seen> lines = {};
    std::vector<TargetLine> counted = {};
  };
  std::vector<Row> rows(static_cast<std::size_t>(grid.height));
  eachPiece(grid.height, [&](int y) {
    NodeSum sum(*spectra_);
    sum.watchField(static_cast<int>(f));
    Row here{own, own, own, std::vector<double>(channels * static_cast<std::size_t>(grid.width), 0.0)};
    std::vector<FieldStep> alone;
    for (int x = 0; x < grid.width; ++x)
      for (const FilmLine& through : pixelLines(std::array{&places}, x, y, kMostLines, {coarse ? kCoarser : 1.0}).within) {
        const glm::dvec3 ray = grid.ray(through.at.x, through.at.y);
        const double length = glm::length(ray), nearest_m = grid.near_m * length;
        LineOfSight line{grid.position, grid.localFromCamera * ray / length, {}, 0.0};
        field.along({line.origin, line.direction, nearest_m, physics::kFar}, steps, alone);
        if (alone.empty()) continue;
        const glm::dvec2 pinhole = filmPosition(film, ray);
        Seen seen{placeOnFilm(camera_, eye.pinhole.focalLength_m, {pinhole.x, film.height - pinhole.y}),
                  through.share * grid.tanPerPixelX * grid.tanPerPixelY / (length * length * length)};
        line.hits = castRay(simulation_, state, line.origin, line.direction, nearest_m, &present_, false, steps);
        const auto isIts = [&](const Slab& s) { return s.field == static_cast<int>(f); };
        const bool isOnFilm = seen.at.x >= window.x && seen.at.y >= window.y && seen.at.x < window.x + window.z && seen.at.y < window.y + window.w;
        seen.isSeen = isOnFilm && std::any_of(line.hits.slabs.begin(), line.hits.slabs.end(), isIts);
        const auto channelsOf = [&](const std::vector<double>& its) {
          std::vector<double> some;
          for (std::size_t c = 0; c < channels; ++c) some.push_back(its[slotOf(c)]);
          return some;
        };
        if (!seen.isSeen || line.hits.solid.distance < alone.back().leave_m) {  // all or some of it is hidden
          setDrifts(alone);
          LineOfSight bare{line.origin, line.direction, {}, 0.0};
          for (const FieldStep& s : alone) bare.hits.slabs.push_back({static_cast<int>(f), s});
          shader.shade(bare, sum);
          seen.own = seen.whole = channelsOf(slotsOf(plan_, sum.ofEntity()));
        }
        if (seen.isSeen) {
          const std::vector<double> all = shader.shade(line, sum).slots, its = slotsOf(plan_, sum.ofEntity());
          seen.own = channelsOf(its);
          if (seen.whole.empty()) seen.whole = seen.own;
          const std::vector<double> without = slotsOf(plan_, sum.withoutField());
          TargetLine counted{ReferenceShader::things(line.hits), through.at, seen.sr, all};
          for (std::size_t s = 0; s < slots; ++s) {
            counted.contrast[s] -= without[s];
            here.own[s] += seen.sr * its[s];
            here.total[s] += seen.sr * all[s];
            here.contrast[s] += seen.sr * counted.contrast[s];
          }
          here.counted.push_back(std::move(counted));
          for (std::size_t c = 0; c < channels; ++c)
            here.ofCell[c * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(x)] += seen.sr * (all[slotOf(c)] - without[slotOf(c)]);
          here.seen_sr += seen.sr;
        }
        here.lines.push_back(std::move(seen));
      }
    rows[static_cast<std::size_t>(y)] = std::move(here);
  });

  // In their order, whichever was done first: the same bits every time.
  double seen_sr = 0.0, all_sr = 0.0;
  std::vector<double> brightest(channels, 0.0), whole(channels, 0.0), shown(channels, 0.0), faces_sr;
  for (const Row& r : rows) {
    seen_sr += r.seen_sr;
    for (std::size_t s = 0; s < slots; ++s) own[s] += r.own[s], total[s] += r.total[s], contrast[s] += r.contrast[s];
    for (const Seen& l : r.lines) {
      all_sr += l.sr;
      for (std::size_t c = 0; c < channels; ++c) {
        brightest[c] = std::max(brightest[c], l.own[c]);
        whole[c] += l.sr * l.whole[c];
        if (l.isSeen) shown[c] += l.sr * l.own[c];
      }
    }
  }
  for (const Row& r : rows)
    for (const Seen& l : r.lines) {
      bool shows = false;
      for (std::size_t c = 0; c < channels; ++c) shows |= l.own[c] > 0.0 && l.own[c] >= kOfBrightest * brightest[c];
      if (!shows) continue;
      row.left = std::fmin(row.left, l.at.x), row.right = std::fmax(row.right, l.at.x);
      row.top = std::fmin(row.top, l.at.y), row.bottom = std::fmax(row.bottom, l.at.y);
    }
  // By what it sends: where it ends nobody sees. All channels count alike.
  double parts = 0.0, counted = 0.0;
  for (std::size_t c = 0; c < channels; ++c)
    if (whole[c] > 0.0) parts += std::min(shown[c] / whole[c], 1.0), counted += 1.0;
  row.visible = counted > 0.0 ? parts / counted : all_sr > 0.0 ? seen_sr / all_sr : 0.0;
  // Its signal in the best pixel is that of a face as bright as its brightest pixel.
  const int across = std::max(1, static_cast<int>(std::lround(std::min(std::sqrt(film.tanPerPixelX * film.tanPerPixelY) / grid.tanPerPixelX, 1e6))));
  const double square_sr = std::pow(across * grid.tanPerPixelX, 2.0);
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<double> cells;
    for (const Row& r : rows)
      cells.insert(cells.end(), r.ofCell.begin() + static_cast<long>(c * static_cast<std::size_t>(grid.width)),
                   r.ofCell.begin() + static_cast<long>((c + 1) * static_cast<std::size_t>(grid.width)));
    const double most = largestSum(cells, grid.width, grid.height, across);
    faces_sr.push_back(most > 0.0 ? std::abs(contrast[slotOf(c)]) / most * square_sr : 0.0);
  }
  std::vector<TargetLine> lines;
  for (const Row& r : rows) lines.insert(lines.end(), r.counted.begin(), r.counted.end());
  lost_.addTo({&own, &total, &contrast}, lines, [&](const glm::dvec2& at, const Plan& plan, const std::shared_ptr<const NodeSpectra>& spectra) {
    ReferenceShader all(simulation_, plan, grid, state, present_, spectra);
    if (coarse) all.setAirPlaces(kUsualPlaces);
    NodeSum sum(*spectra);
    sum.watchField(static_cast<int>(f));
    const glm::dvec3 ray = grid.ray(at.x, at.y);
    LineOfSight line{grid.position, grid.localFromCamera * ray / glm::length(ray), {}, 0.0};
    line.hits = castRay(simulation_, state, line.origin, line.direction, grid.near_m * glm::length(ray), &present_, false, steps);
    const std::vector<double> seen = all.shade(line, sum).slots;
    std::vector<double> sums = slotsOf(plan, sum.ofEntity());
    const std::vector<double> without = slotsOf(plan, sum.withoutField());
    sums.insert(sums.end(), seen.begin(), seen.end());
    for (std::size_t s = 0; s < seen.size(); ++s) sums.push_back(seen[s] - without[s]);
    return sums;
  });
  const double range2 = row.range_m * row.range_m;
  for (auto* sums : {&own, &total, &contrast})
    for (double& v : *sums) v *= range2;
  addChannels(row, own, total, contrast, seen_sr, state, faces_sr);
}

}  // namespace pitviper

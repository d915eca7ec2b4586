#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "materials/fields/cloud_field.hpp"
#include "materials/fields/cloud_light.hpp"
#include "sim/parameters/on_threads.hpp"
#include "sim/scene/content_cache.hpp"

namespace pitviper {
namespace {

constexpr const char *kLight = "clouds", *kShade = "cloud_shade";
/// An optical depth of other clouds before the sun below which a cloud is lit as if it stood alone: of what it sends by sunlight 1.3 %.
constexpr double kLittle = 0.05;
/// Nodes of the shade: twice as close together as those of the finest cloud, and so many at most.
constexpr double kCloser = 0.5;
constexpr double kMostShade = 4e6;
constexpr int kMostLevels = 25;

glm::dvec3 middleOf(const DensityGrid& frame) { return 0.5 * (frame.first + frame.last()); }
double radiusOf(const DensityGrid& frame) { return 0.5 * glm::length(frame.last() - frame.first); }

std::size_t countOf(const glm::ivec3& n) { return static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z); }

std::shared_ptr<const FieldTexels> texelsOf(const CloudBody& body, const std::optional<glm::dvec3>& toSun, const std::vector<glm::vec4>& nodes) {
  const DensityGrid& frame = body.frame();
  auto all = std::make_shared<FieldTexels>();
  auto& t = all->texel;
  t.reserve(5 + nodes.size());
  t.emplace_back(frame.first, frame.nodes.x);
  t.emplace_back(1.0 / frame.spacing, frame.nodes.y);
  t.emplace_back(frame.last(), frame.nodes.z);
  t.emplace_back(toSun.value_or(glm::dvec3(0.0, 0.0, 1.0)), toSun ? 1.0 : 0.0);
  t.emplace_back(body.options().base_K, body.options().lapse_K_m, 0.0, 0.0);
  t.insert(t.end(), nodes.begin(), nodes.end());
  return all;
}

/// What is kept between runs, or made anew; `isGood` tells whether what was kept is of the kind.
template <class T>
std::vector<T> kept(const char* what, const Fingerprint& f, const auto& isGood, const auto& make) {
  const ContentKey key = contentKey(f.bytes());
  if (const auto bytes = readCachedTable(what, key)) {
    TableReader in(*bytes);
    std::vector<T> values = in.all<T>();
    if (in.isWhole() && isGood(values)) return values;
  }
  std::vector<T> values = make();
  TableWriter out;
  out.all(values);
  writeCachedTable(what, key, out.bytes());
  return values;
}

}  // namespace

CloudSet::CloudSet(std::optional<glm::dvec3> toSun, bool shadows) : toSun_(toSun && toSun->z > 0.0 ? toSun : std::nullopt), shadows_(shadows) {}

std::size_t CloudSet::add(std::shared_ptr<const CloudBody> body, const glm::dvec3& base) {
  if (!body) throw std::invalid_argument("cloud: none");
  clouds_.push_back({std::move(body), base, nullptr});
  return clouds_.size() - 1;
}

std::vector<std::size_t> CloudSet::before(std::size_t cloud) const {
  std::vector<std::size_t> all;
  if (!toSun_ || !shadows_) return all;
  const DensityGrid& own = clouds_[cloud].body->frame();
  for (std::size_t c = 0; c < clouds_.size(); ++c) {
    const DensityGrid& frame = clouds_[c].body->frame();
    const glm::dvec3 way = clouds_[c].base + middleOf(frame) - clouds_[cloud].base - middleOf(own);
    const double along = glm::dot(way, *toSun_), near = radiusOf(own) + radiusOf(frame);
    if (c != cloud && along > -near && glm::length(way - along * *toSun_) < near) all.push_back(c);
  }
  return all;
}

/// At the nodes of a cloud; empty where it is too little to count.
std::vector<float> CloudSet::depthBefore(std::size_t cloud, const std::vector<std::size_t>& others) const {
  const DensityGrid& frame = clouds_[cloud].body->frame();
  std::vector<float> depth(countOf(frame.nodes), 0.0f);
  for (std::size_t c : others) clouds_[c].body->density();
  onStretches(static_cast<std::size_t>(frame.nodes.z), 1, [&](std::size_t from, std::size_t to) {
    for (int k = static_cast<int>(from); k < static_cast<int>(to); ++k)
      for (int j = 0; j < frame.nodes.y; ++j)
        for (int i = 0; i < frame.nodes.x; ++i) {
          double sum = 0.0;
          for (std::size_t c : others) sum += clouds_[c].body->density().along(clouds_[cloud].base + frame.place(i, j, k) - clouds_[c].base, *toSun_, 1.0);
          depth[frame.index(i, j, k)] = static_cast<float>(sum);
        }
  });
  if (std::all_of(depth.begin(), depth.end(), [](float d) { return d < kLittle; })) depth.clear();
  return depth;
}

std::shared_ptr<const FieldTexels> CloudSet::make(std::size_t cloud, const std::vector<std::size_t>& others) const {
  const CloudBody& body = *clouds_[cloud].body;
  const std::size_t nodes = kCloudTexels * countOf(body.frame().nodes);
  Fingerprint f;
  body.addTo(f);
  f.add(toSun_.value_or(glm::dvec3(0.0, 0.0, 1.0))).add(toSun_.has_value());
  for (std::size_t c : others) {
    clouds_[c].body->addTo(f);
    f.add(clouds_[c].base - clouds_[cloud].base);
  }
  // Nothing: the others take too little.
  const auto numbers = kept<glm::vec4>(
      kLight, f, [&](const auto& v) { return v.size() == nodes || (v.empty() && !others.empty()); },
      [&]() -> std::vector<glm::vec4> {
        const std::vector<float> depth = others.empty() ? std::vector<float>() : depthBefore(cloud, others);
        if (depth.empty() && !others.empty()) return {};
        return cloudNumbers(body.density(), toSun_.value_or(glm::dvec3(0.0, 0.0, 1.0)), toSun_.has_value(), depth);
      });
  return numbers.empty() ? nullptr : texelsOf(body, toSun_, numbers);
}

std::shared_ptr<const FieldTexels> CloudSet::texels(std::size_t cloud) const {
  const std::lock_guard lock(busy_);
  auto& own = clouds_[cloud].texels;
  if (own) return own;
  if (const auto others = before(cloud); !others.empty()) own = make(cloud, others);
  if (own) return own;
  // Alone: those of one body are the same.
  for (const Cloud& c : clouds_)
    if (c.body == clouds_[cloud].body && c.alone) return own = c.texels;
  clouds_[cloud].alone = true;
  return own = make(cloud, {});
}

const SunShadeGrid& CloudSet::grid() const {
  std::call_once(once_, [&] { grid_ = makeGrid(); });
  return grid_;
}

SunShadeGrid CloudSet::makeGrid() const {
  const glm::dvec3 toSun = toSun_.value(),
                   across = glm::normalize(std::abs(toSun.z) < 0.9999 ? glm::cross(glm::dvec3(0.0, 0.0, 1.0), toSun) : glm::dvec3(1.0, 0.0, 0.0)),
                   upwards = glm::cross(toSun, across);
  glm::dvec3 low(INFINITY), high(-INFINITY);  // across, upwards, height
  double apart = INFINITY, up = INFINITY;
  Fingerprint f;
  f.add(toSun);
  for (const Cloud& c : clouds_) {
    const DensityGrid& frame = c.body->frame();
    apart = std::min({apart, kCloser * frame.spacing.x, kCloser * frame.spacing.y}), up = std::min(up, frame.spacing.z);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p = c.base + glm::mix(frame.first, frame.last(), glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2));
      const glm::dvec3 at(glm::dot(p, across), glm::dot(p, upwards), p.z);
      low = glm::min(low, at), high = glm::max(high, at);
    }
    c.body->addTo(f);
    f.add(c.base);
  }
  SunShadeGrid grid;
  grid.nodes.z = std::clamp(static_cast<int>(std::ceil((high.z - low.z) / up)) + 1, 2, kMostLevels);
  apart = std::max(apart, std::sqrt((high.x - low.x) * (high.y - low.y) * grid.nodes.z / kMostShade));
  low -= glm::dvec3(apart, apart, 0.0);  // around them there is none
  for (int a = 0; a < 2; ++a) grid.nodes[a] = static_cast<int>(std::ceil((high[a] - low[a]) / apart)) + 2;
  const auto onLowest = [&](const glm::dvec3& p) { return p + (low.z - p.z) / toSun.z * toSun; };
  grid.origin = onLowest(low.x * across + low.y * upwards);
  grid.axis = {across / apart, upwards / apart, glm::dvec3(0.0, 0.0, (grid.nodes.z - 1) / (high.z - low.z))};
  const double rise = (high.z - low.z) / (grid.nodes.z - 1) / toSun.z;  // along the line, from level to level
  grid.depth = kept<float>(
      kShade, f, [&](const auto& v) { return v.size() == countOf(grid.nodes); },
      [&] {
        for (const Cloud& c : clouds_) c.body->density();
        std::vector<float> depth(countOf(grid.nodes), 0.0f);
        const std::size_t plane = static_cast<std::size_t>(grid.nodes.x) * static_cast<std::size_t>(grid.nodes.y);
        onStretches(static_cast<std::size_t>(grid.nodes.y), 1, [&](std::size_t from, std::size_t to) {
          for (std::size_t n = from * static_cast<std::size_t>(grid.nodes.x); n < to * static_cast<std::size_t>(grid.nodes.x); ++n) {
            const std::size_t j = n / static_cast<std::size_t>(grid.nodes.x), i = n % static_cast<std::size_t>(grid.nodes.x);
            const glm::dvec3 foot = onLowest(grid.origin + apart * (static_cast<double>(i) * across + static_cast<double>(j) * upwards));
            for (const Cloud& c : clouds_) {
              const DensityGrid& drops = c.body->density();
              const glm::dvec2 chord = drops.chord(foot - c.base, toSun);
              for (int k = grid.nodes.z - 1; k >= 0 && chord.y > chord.x; --k)
                if (const double at = k * rise; at < chord.y)
                  depth[static_cast<std::size_t>(k) * plane + n] += static_cast<float>(drops.along(foot + at * toSun - c.base, toSun, 1.0));
            }
          }
        });
        return depth;
      });
  return grid;
}

}  // namespace pitviper

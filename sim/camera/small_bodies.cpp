#include "sim/camera/small_bodies.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <set>

#include "sim/camera/covered_cells.hpp"
#include "sim/camera/light_places.hpp"
#include "sim/camera/zoomed_lines.hpp"
#include "sim/model/field_lines.hpp"
#include "sim/model/field_states.hpp"
#include "sim/model/ray_hits.hpp"

namespace pitviper {
Ball ballOf(const Simulation& sim, const WorldState& state, int entity) {
  const auto e = static_cast<size_t>(entity);
  return {entity, -1, state.entities[e].position + state.entities[e].orientation * glm::dvec3(sim.entities[e].boundingCentre),
          static_cast<double>(sim.entities[e].boundingRadius_m)};
}

/// Rolled so that silhouettes are sampled evenly (an edge along the grid would be off by up to a whole row), nor does its middle lie on a place of the grid
/// that one shares with it: what is round would be off all around alike.
View zoomedView(const Ball& ball, const View& v, int size) {
  constexpr double kRoll_rad = 0.3926, kAcross = 0.31, kUp = 0.17;
  const glm::dvec3 line = ball.centre - v.position;
  const double distance = glm::length(line), radius = ball.radius_m;
  View z = v;
  z.subpixels = z.grouped = 1;
  z.kept = glm::ivec4(0);
  z.width = z.height = size;
  z.localFromCamera = localFromCamera({v.position, orientationAlong(line, kRoll_rad)});
  z.tanPerPixelX = z.tanPerPixelY = 2.04 * radius / std::sqrt(distance * distance - radius * radius) / (size - 2.0 * kAcross);
  z.axisX = 0.5 * size + kAcross;
  z.axisY = 0.5 * size + kUp;
  z.onlyEntity = ball.entity;
  z.zoomed = true;
  z.depthCentre = ball.centre;
  z.depthRadius_m = 1.02 * radius;
  return z;
}

namespace {

/// Sizes of pictures of fields: few are ever made, and llvmpipe compiles programs again for textures whose sizes are no powers of two (half a minute each).
int powerOfTwo(int lines) {
  constexpr unsigned kFewest = 16;
  return static_cast<int>(std::bit_ceil(std::max(static_cast<unsigned>(lines), kFewest)));
}

/// What zoomed samples say of one subpixel of the image.
struct Share {
  double looked = 0.0;   ///< projected solid angle of all zoomed samples in it [sr]
  double covered = 0.0;  ///< of those that count: what they see takes the place of what the image has there
  std::vector<double> sum;
  Moments placed{};              ///< of those that count, by their solid angle
  std::vector<Moments> moments;  ///< by slot, by what they send; empty where no points are kept
  double shown = 0.0;            ///< of those whose surface is a small body's
  size_t sample = 0;             ///< the one of them that is nearest to the subpixel's middle
  double off2 = INFINITY;        ///< how far it is from there, squared
  double cosPsi = 1.0;
};
using Shares = std::map<size_t, Share>;

/// Calls visit(zoomed pixel, subpixel, projected solid angle, cosine to the image's axis, place from the subpixel's middle) for each zoomed sample that falls
/// into the image.
template <class Visit>
void eachSample(const Subpixels& image, const View& z, const Visit& visit) {
  const View& v = image.view();
  const glm::dmat3 mainFromZoom = glm::transpose(v.localFromCamera) * z.localFromCamera;
  for (int j = 0; j < z.height; ++j)
    for (int i = 0; i < z.width; ++i) {
      const glm::dvec3 ray = z.ray(i + 0.5, j + 0.5), seen = mainFromZoom * ray;
      if (seen.z >= 0.0) continue;
      const glm::dvec2 at = filmPosition(v, seen);
      if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < v.width && at.y < v.height)) continue;
      const double l2 = glm::dot(ray, ray), cosPsi = -seen.z / std::sqrt(l2);
      const double etendue = z.tanPerPixelX * z.tanPerPixelY / (l2 * std::sqrt(l2)) * cosPsi;
      visit(static_cast<size_t>(j) * static_cast<size_t>(z.width) + static_cast<size_t>(i), image.index(static_cast<int>(at.x), static_cast<int>(at.y)),
            etendue, cosPsi, glm::dvec2(at.x - std::floor(at.x) - 0.5, at.y - std::floor(at.y) - 0.5));
    }
}

/// A sample that does not count.
constexpr std::uint32_t kNone = 0xffffffffu;

/// By subpixel. `colourOf(q)`: the sample whose colour a sample has (itself, nearly always), or kNone; `isShown(entity)`: of what surface truth is.
/// `cells`: takes what those cover that count, or null.
template <class ColourOf, class IsShown>
Shares sharesOf(const Subpixels& image, const View& z, const RawImage& zoomed, const ColourOf& colourOf, const IsShown& isShown,
                CoveredCells* cells = nullptr) {
  Shares shares;
  const View& v = image.view();
  eachSample(image, z, [&](size_t q, size_t p, double etendue, double cosPsi, const glm::dvec2& off) {
    Share& share = shares[p];
    share.looked += etendue;
    const std::uint32_t from = colourOf(q);
    if (from == kNone) return;
    share.covered += etendue;
    share.sum.resize(image.slotCount(), 0.0);
    for (size_t s = 0; s < image.slotCount(); ++s) share.sum[s] += etendue * static_cast<double>(zoomed.groups[s / 4][4 * from + s % 4]);
    if (cells) {
      const auto width = static_cast<size_t>(v.width);
      const double subpixel_sr = v.tanPerPixelX * v.tanPerPixelY * std::pow(cosPsi, 4);
      cells->add(glm::dvec2(p % width, p / width) + 0.5 + off, etendue / subpixel_sr);
    }
    if (image.keepsPoints()) {
      share.moments.resize(image.slotCount());
      addMoments(share.placed, off, etendue);
      for (size_t s = 0; s < image.slotCount(); ++s) addMoments(share.moments[s], off, etendue * static_cast<double>(zoomed.groups[s / 4][4 * from + s % 4]));
    }
    if (!isShown(zoomed.entity[from])) return;
    share.shown += etendue;
    if (const double off2 = glm::dot(off, off); off2 < share.off2) share.off2 = off2, share.sample = from, share.cosPsi = cosPsi;
  });
  return shares;
}

/// True where a subpixel lies wholly inside the zoomed picture: its samples then make up the whole of it.
bool isInside(const View& main, const View& zoomed, const glm::dmat3& zoomFromMain, int x, int y) {
  for (int corner = 0; corner < 4; ++corner) {
    const glm::dvec3 p = zoomFromMain * main.ray(x + (corner & 1), y + (corner >> 1));
    if (p.z >= 0.0) return false;
    const glm::dvec2 at = filmPosition(zoomed, p);
    if (at.x < 0.0 || at.y < 0.0 || at.x > zoomed.width || at.y > zoomed.height) return false;
  }
  return true;
}

/// The truth of a subpixel that a body covers by half or more, though its middle may not see it: of the nearest place that does.
void takeTruth(Subpixels& image, const RawImage& zoomed, const Share& share, double whole, size_t pixel) {
  if (!image.hasTruth() || share.shown < 0.5 * whole) return;
  TruthPixel truth = truthAt(zoomed, share.sample);  // the zoomed view's axis points at the body: put the angle off the real one in
  truth.area_m2 = static_cast<float>(truth.area_m2 * std::pow(share.cosPsi, 3));
  truth.solidAngleFromLight_sr = static_cast<float>(truth.solidAngleFromLight_sr * std::pow(share.cosPsi, 3));
  truth.solidAngleOfAperture_sr = static_cast<float>(truth.solidAngleOfAperture_sr * share.cosPsi);
  image.setTruth(pixel, truth);
}

/// At least 8 a subpixel; 4 where the accuracy leaves few to the body as a whole: an edge then leaves a subpixel off by 3 % of its contrast, not 1.
int zoomedSize(double extent, int samples) {
  constexpr int kFew = 64;
  int size = samples;
  while (size < (samples <= kFew ? 4.0 : 8.0) * extent && size < 4096) size *= 2;
  return size;
}

/// Whether some part of a field may show in the same pixels: its mean over them is not what the body hides.
bool nearField(const Simulation& sim, const WorldState& state, const Ball& ball, const View& v) {
  for (size_t f = 0; f < sim.fields.size(); ++f) {
    const FieldState* field = fieldOf(state, f);
    if (!field) continue;
    const FieldLines lines = fieldLines(v, *field);
    if (lines.isEmpty()) continue;
    const glm::dvec3 p = glm::transpose(v.localFromCamera) * (ball.centre - v.position);
    if (!(-p.z > ball.radius_m)) return true;
    const glm::dvec2 at = filmPosition(v, p);
    const double pixels = ball.radius_m / -p.z / std::min(v.tanPerPixelX, v.tanPerPixelY) + 1.0;
    if (at.x + pixels > lines.low.x && at.y + pixels > lines.low.y && at.x - pixels < lines.high.x && at.y - pixels < lines.high.y) return true;
  }
  return false;
}

/// Flags, in order, the bodies that are transparent or overlap one that is, directly or through others, or show beside a field.
std::vector<char> overlapTransparent(const Simulation& sim, const WorldState& state, const View& v, const std::vector<int>& bodies) {
  std::vector<char> mixed(bodies.size(), 0);
  std::vector<size_t> open;
  std::vector<glm::dvec3> line;
  std::vector<double> sine;  // of the angular radius
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Ball ball = ballOf(sim, state, bodies[i]);
    const glm::dvec3 to = ball.centre - v.position;
    line.push_back(glm::normalize(to));
    sine.push_back(ball.radius_m / glm::length(to));
    if (!sim.isTransparent(sim.entities[static_cast<size_t>(bodies[i])]) && !nearField(sim, state, ball, v)) continue;
    mixed[i] = 1;
    open.push_back(i);
  }
  while (!open.empty()) {
    const size_t i = open.back();
    open.pop_back();
    for (size_t j = 0; j < bodies.size(); ++j)
      if (!mixed[j] && glm::length(line[i] - line[j]) < 1.1 * (sine[i] + sine[j])) {  // small angles, with some room
        mixed[j] = 1;
        open.push_back(j);
      }
  }
  return mixed;
}

/// What is sampled finely in a subpixel, by all zoomed views that look at it, each at directions of its own.
struct Fine {
  double covered = 0.0;  ///< projected solid angle [sr]
  double whole = 0.0;    ///< of the subpixel
  bool shown = false;    ///< some of it sees the surface of a small body
  std::vector<double> sum;
  std::vector<double> under;  ///< what the image has where they are
  Moments placed{};           ///< as of Share
  std::vector<Moments> moments;
};
using FineSubpixels = std::map<size_t, Fine>;

/// `wholeOnly`: subpixels alone count that lie in the zoomed picture as a whole.
void gather(Subpixels& image, const View& z, const RawImage& zoomed, const Shares& shares, FineSubpixels& fine, bool wholeOnly = false) {
  const View& v = image.view();
  const glm::dmat3 zoomFromMain = glm::transpose(z.localFromCamera) * v.localFromCamera;
  for (const auto& [p, share] : shares) {
    if (share.covered <= 0.0) continue;
    const int x = static_cast<int>(p % static_cast<size_t>(v.width)), y = static_cast<int>(p / static_cast<size_t>(v.width));
    const bool inside = isInside(v, z, zoomFromMain, x, y);
    if (wholeOnly && !inside) continue;
    const double whole = image.projectedSolidAngle_sr(x, y);
    Fine& f = fine[p];
    f.sum.resize(image.slotCount(), 0.0);
    f.under.resize(image.slotCount(), 0.0);
    f.whole = whole;
    // Samples fall to one side or the other of a subpixel's edge: all of them are all of it, and no more than finer views have left.
    const double all = inside ? whole / share.looked : 1.0;
    const double each = std::min(all, std::max(whole - f.covered, 0.0) / share.covered);
    f.covered += each * share.covered;
    for (size_t s = 0; s < f.sum.size(); ++s) {
      f.sum[s] += each * share.sum[s];
      f.under[s] += each * share.covered * image.slot(s, p);
    }
    f.moments.resize(share.moments.size());
    for (size_t k = 0; k < f.placed.size(); ++k) {
      f.placed[k] += each * share.placed[k];
      for (size_t s = 0; s < share.moments.size(); ++s) f.moments[s][k] += each * share.moments[s][k];
    }
    f.shown |= share.shown > 0.0;
    takeTruth(image, zoomed, share, whole / all, p);
  }
}

/// What a subpixel's small bodies send beyond what the image has there, as points that have its middle and its spread.
void putPoints(Subpixels& image, size_t subpixel, const Fine& f) {
  const auto width = static_cast<size_t>(image.view().width);
  const glm::dvec2 corner(static_cast<double>(subpixel % width), static_cast<double>(subpixel / width));
  const Place whole = placeOf(f.covered, f.placed).value_or(Place{});
  for (size_t s = 0; s < f.sum.size(); ++s) {
    const double behind = f.covered > 0.0 ? f.under[s] / f.covered : 0.0, flux = f.sum[s] - f.under[s];
    if (flux == 0.0) continue;
    Moments m = f.moments[s];
    for (size_t k = 0; k < m.size(); ++k) m[k] -= behind * f.placed[k];
    const Place p = placeOf(flux, m).value_or(whole);
    const glm::dvec2 at = corner + 0.5 + p.middle;
    const std::vector<glm::dvec2> steps = pointsOf(p);
    for (const glm::dvec2& step : steps) image.addPoint(at + step, subpixel, s, flux / static_cast<double>(steps.size()));
  }
}

/// The image keeps what it has in the rest of a subpixel: a mean of radiances, none of which is below 0.
void put(Subpixels& image, const FineSubpixels& fine) {
  // More are no point: on so many subpixels a picture is as good.
  constexpr size_t kMostPoints = 16;
  if (image.keepsPoints() && fine.size() <= kMostPoints) {
    for (const auto& [p, f] : fine) putPoints(image, p, f);
    return;
  }
  for (const auto& [p, f] : fine)
    for (size_t s = 0; s < f.sum.size(); ++s) image.add(s, p, (f.sum[s] - f.under[s]) / f.whole);
}

bool anyOf(const std::vector<char>& flags) {
  return std::any_of(flags.begin(), flags.end(), [](char f) { return f != 0; });
}

/// The samples of a zoomed view that fall into some subpixels.
std::shared_ptr<const std::vector<char>> marksOf(const Subpixels& image, const View& z, const std::vector<char>& subpixels) {
  auto marks = std::make_shared<std::vector<char>>(static_cast<size_t>(z.width) * static_cast<size_t>(z.height), 0);
  eachSample(image, z, [&](size_t q, size_t p, double, double, const glm::dvec2&) { (*marks)[q] = subpixels[p]; });
  return marks;
}

/// A part of a zoomed view: first sample, how many.
struct Box {
  glm::ivec2 low{0}, size{0};
  int area() const { return size.x * size.y; }
};

/// The samples that are wanted of a box; of no size where none is.
Box shrunk(const std::vector<char>& wanted, int width, const Box& in) {
  glm::ivec2 low(std::numeric_limits<int>::max()), high(0);
  for (int y = in.low.y; y < in.low.y + in.size.y; ++y)
    for (int x = in.low.x; x < in.low.x + in.size.x; ++x)
      if (wanted[static_cast<size_t>(y * width + x)]) low = glm::min(low, glm::ivec2(x, y)), high = glm::max(high, glm::ivec2(x, y) + 1);
  return high.x > 0 ? Box{low, high - low} : Box{};
}

/// Samples that take as long as what a picture costs besides: 22 ms of 1 us a sample (llvmpipe, 26 media); 5 ms of 20 us a sample through a jet.
constexpr int kPicture = 16384, kPictureOfFields = 256;

/// Boxes that hold all that are wanted: parted while that leaves out more samples than a picture of its own is worth.
void partBox(const std::vector<char>& wanted, int width, const Box& box, int picture, std::vector<Box>& boxes) {
  constexpr int kStep = 8, kSteps = 16;
  Box first, second;
  int least = box.area() - picture;
  for (int k = 0; k < 2; ++k)
    for (int step = std::max(kStep, box.size[k] / kSteps), at = step; at < box.size[k]; at += step) {
      Box one = box, other = box;
      one.size[k] = at, other.low[k] += at, other.size[k] -= at;
      one = shrunk(wanted, width, one), other = shrunk(wanted, width, other);
      if (one.area() + other.area() < least) least = one.area() + other.area(), first = one, second = other;
    }
  if (first.area() == 0) return boxes.push_back(box);
  partBox(wanted, width, first, picture, boxes);
  partBox(wanted, width, second, picture, boxes);
}

/// Pictures are kept, by size: larger zoomed views are drawn as a whole.
constexpr int kLargest = 512;

/// Draws what is wanted of a zoomed view, and not much more where `fields` may show: a sample through one costs as much as a hundred others.
RawImage drawWanted(ScenePass& pass, const View& z, const WorldState& state, const std::vector<char>& drawn, bool fields, int largest = kLargest) {
  const glm::ivec2 all(z.width, z.height), most = fields ? glm::ivec2(powerOfTwo(all.x), powerOfTwo(all.y)) : all;
  const Box whole{glm::ivec2(0), most};
  std::vector<Box> boxes;
  if (z.width <= largest) partBox(*z.wanted, z.width, shrunk(*z.wanted, z.width, {glm::ivec2(0), all}), fields ? kPictureOfFields : kPicture, boxes);
  int area = 0;
  for (Box& box : boxes) {
    for (int k = 0; k < 2; ++k) box.size[k] = std::min(fields ? powerOfTwo(box.size[k]) : evenSize(box.size[k]), most[k]);
    box.low = glm::min(box.low, most - box.size);
    area += box.area();
  }
  if (boxes.empty() || area >= whole.area()) boxes = {whole};
  RawImage image;
  image.width = z.width, image.height = z.height;
  const auto samples = static_cast<size_t>(z.width) * static_cast<size_t>(z.height);
  image.entity.assign(samples, -1);
  for (const Box& box : boxes) {
    View part = z;
    part.width = box.size.x, part.height = box.size.y;
    part.axisX -= box.low.x, part.axisY -= box.low.y;
    const glm::ivec2 seen = glm::min(box.size, all - box.low);  // the rest is beyond the view
    // Calls copy(first in the view, first in the part, how many) for each row.
    const auto rows = [&](const auto& copy) {
      for (int y = 0; y < seen.y; ++y)
        copy(static_cast<size_t>((box.low.y + y) * z.width + box.low.x), static_cast<size_t>(y * box.size.x), static_cast<size_t>(seen.x));
    };
    auto wanted = std::make_shared<std::vector<char>>(static_cast<size_t>(box.area()), 0);
    rows([&](size_t view, size_t own, size_t count) { std::copy_n(&(*z.wanted)[view], count, &(*wanted)[own]); });
    part.wanted = wanted;
    pass.draw(part, state, drawn);
    pass.startReadback(true);
    const RawImage picture = pass.finishReadback();
    rows([&](size_t view, size_t own, size_t count) { std::copy_n(&picture.entity[own], count, &image.entity[view]); });
    for (const auto& [from, to] : {std::pair{&picture.groups, &image.groups}, {&picture.truth, &image.truth}}) {
      to->resize(from->size(), std::vector<float>(4 * samples, 0.0f));
      for (size_t g = 0; g < from->size(); ++g)
        rows([&](size_t view, size_t own, size_t count) { std::copy_n(&(*from)[g][4 * own], 4 * count, &(*to)[g][4 * view]); });
    }
  }
  return image;
}

/// A field varies within a subpixel: what shows of it beside a body is not its mean, and where a cold body hides a bright jet the difference of two means would
/// be all that is left. Such subpixels are drawn once more without the bodies, cell by cell; cells count as far as nothing covers them.
class BesideBodies {
 public:
  BesideBodies(const Simulation& sim, const WorldState& state, const View& v) : cells_(v) {
    for (size_t f = 0; f < sim.fields.size(); ++f)
      if (const FieldState* field = fieldOf(state, f))
        if (const FieldLines lines = fieldLines(v, *field); !lines.isEmpty()) fields_.push_back(lines);
  }
  /// Takes what bodies cover; null where no field is in the picture.
  CoveredCells* cells() { return fields_.empty() ? nullptr : &cells_; }
  /// Subpixels that a view has samples in: near each other.
  void touch(const Subpixels& image, const Shares& shares) {
    std::vector<size_t> near;
    for (const auto& [p, share] : shares) {
      const auto width = static_cast<size_t>(image.view().width);
      const double x = static_cast<double>(p % width), y = static_cast<double>(p / width);
      if (share.covered > 0.0 && std::any_of(fields_.begin(), fields_.end(),
                                             [&](const FieldLines& f) { return f.low.x < x + 1.0 && f.low.y < y + 1.0 && f.high.x > x && f.high.y > y; }))
        near.push_back(p);
    }
    if (!near.empty()) parts_.push_back(std::move(near));
  }
  /// Puts what is there without the bodies in place of the image's means, and takes away what of it they cover. `without`: what is in the picture but for them.
  void draw(Subpixels& image, ScenePass& pass, const WorldState& state, const std::vector<char>& without, FineSubpixels& fine) const {
    constexpr double kNothing = 1e-9;  // of a subpixel: its samples make up the whole of it but for rounding
    std::set<size_t> done;
    for (std::vector<size_t> part : parts_) {
      std::erase_if(part, [&](size_t p) { return fine.at(p).covered > (1.0 - kNothing) * fine.at(p).whole || !done.insert(p).second; });
      if (!part.empty()) drawPart(image, pass, state, without, part, fine);
    }
  }

 private:
  static constexpr int kAcross = CoveredCells::kAcross;
  void drawPart(Subpixels& image, ScenePass& pass, const WorldState& state, const std::vector<char>& without, const std::vector<size_t>& part,
                FineSubpixels& fine) const {
    const auto width = static_cast<size_t>(image.view().width);
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
    const RawImage seen = drawWanted(pass, z, state, without, true);
    for (size_t p : part) {
      const CoveredCells::Cells* covered = cells_.of(p);
      Fine& f = fine.at(p);
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
        f.under[s] = f.covered * behind;
        image.add(s, p, (f.under[s] + (f.whole - f.covered) * beside) / f.whole - image.slot(s, p));
      }
    }
  }
  CoveredCells cells_;
  std::vector<FieldLines> fields_;          ///< those that may show
  std::vector<std::vector<size_t>> parts_;  ///< subpixels to be drawn together
};

/// Solid bodies that nothing transparent is near: where one shows it takes the place of what is behind it.
class SolidBodies {
 public:
  /// `only`: subpixels that are wanted, or null.
  SolidBodies(Subpixels& image, const Simulation& sim, const WorldState& state, const std::vector<int>& bodies, const std::vector<int>& lines,
              const std::vector<char>* only)
      : image_(image), only_(only) {
    for (int e : bodies) {
      View z = zoomedView(ballOf(sim, state, e), image.view(), zoomedSize(extentOf(ballOf(sim, state, e), image.view()), lines[static_cast<size_t>(e)]));
      if (only) {
        z.wanted = marksOf(image, z, *only);
        if (!anyOf(*z.wanted)) continue;
      }
      views_.push_back(z);
    }
    std::stable_sort(views_.begin(), views_.end(), [](const View& x, const View& y) { return x.width < y.width; });
  }
  /// `drawn`: what may hide them, themselves too.
  void draw(ScenePass& pass, const WorldState& state, const std::vector<char>& drawn, FineSubpixels& fine) const {
    for (auto first = views_.begin(); first != views_.end();) {
      const auto last = std::find_if(first, views_.end(), [&](const View& z) { return z.width != first->width; });
      if (pass.drawsTiles()) {
        pass.drawTiles({first, last}, state, drawn, [&](size_t i, const RawImage& zoomed) { add(*(first + static_cast<long>(i)), zoomed, fine); });
      } else {
        for (auto z = first; z != last; ++z) {
          pass.draw(*z, state, drawn);
          pass.startReadback(true);
          add(*z, pass.finishReadback(), fine);
        }
      }
      first = last;
    }
  }

 private:
  void add(const View& z, const RawImage& zoomed, FineSubpixels& fine) const {
    const auto own = [&](size_t q) { return zoomed.entity[q] == z.onlyEntity && (!only_ || (*z.wanted)[q]) ? static_cast<std::uint32_t>(q) : kNone; };
    gather(image_, z, zoomed, sharesOf(image_, z, zoomed, own, [](int) { return true; }), fine);
  }
  Subpixels& image_;
  const std::vector<char>* only_;
  std::vector<View> views_;  ///< by size
};

/// Bodies that are seen through something or that something is seen through, all in their places in every picture, and bright parts of large bodies. A
/// direction is sampled by the finest view that looks at it: a small hot thing behind a large puff by its own, not by the puff's.
class MixedBodies {
 public:
  /// `small`: which entities have a view of their own, these or others.
  MixedBodies(const Simulation& sim, const WorldState& state, const View& v, const std::vector<int>& bodies, const std::vector<int>& lines,
              const std::vector<Ball>& parts, const std::vector<char>& small)
      : sim_(sim), state_(state), bodies_(bodies), small_(small) {
    std::vector<Zoom> zooms;
    for (int e : bodies) {
      const Ball ball = ballOf(sim, state, e);
      const int most = lines[static_cast<size_t>(e)];
      zooms.push_back({ball, zoomedSize(extentOf(ball, v), sim.mediumOf(sim.entities[static_cast<size_t>(e)]) ? most / 2 : most)});
    }
    join(zooms, v);
    const size_t ofBodies = zooms.size();
    for (const Ball& part : parts) zooms.push_back({part, evenSize(std::min(2.0 * part.radius_m * part.lines_per_m, kMostOfParts))});
    std::vector<size_t> order(zooms.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t x, size_t y) { return zooms[x].density(v) > zooms[y].density(v); });
    for (size_t i : order) {
      views_.push_back(zoomedView(zooms[i].ball, v, zooms[i].size));
      views_.back().onlyEntity = -1;
      whole_.push_back(i >= ofBodies);
      partOf_.push_back(zooms[i].ball);
    }
  }
  /// `others`: what else is in the picture; `all`: what may show at all, that is in the pictures of parts.
  void draw(Subpixels& image, ScenePass& pass, std::vector<char> others, const std::vector<char>& all, const std::vector<char>* only,
            FineSubpixels& fine) const {
    const std::vector<char> without = others;
    BesideBodies beside(sim_, state_, image.view());
    for (int e : bodies_) others[static_cast<size_t>(e)] = 1;
    for (size_t i = 0; i < views_.size(); ++i) {
      View z = views_[i];
      std::vector<std::uint32_t> colour = colours(z, sets(image, i));
      const auto leave = [&](const std::vector<char>& subpixels) {
        const auto marks = marksOf(image, z, subpixels);
        for (size_t q = 0; q < colour.size(); ++q)
          if (!(*marks)[q]) colour[q] = kNone;
      };
      if (only) leave(*only);
      if (whole_[i]) leave(subpixelsOf(partOf_[i], image));
      z.wanted = wanted(colour);
      if (!anyOf(*z.wanted)) continue;
      const RawImage zoomed = drawWanted(pass, z, state_, whole_[i] ? all : others, beside.cells() != nullptr);
      const auto colourOf = [&](size_t q) { return whole_[i] && colour[q] != kNone && hasOwnView(zoomed.entity[colour[q]]) ? kNone : colour[q]; };
      const Shares shares = sharesOf(
          image, z, zoomed, colourOf, [&](int e) { return isOne(e); }, beside.cells());
      // What sees anything of a part lies wholly in its view; at the view's border others are cut.
      gather(image, z, zoomed, shares, fine, whole_[i]);
      if (!whole_[i]) beside.touch(image, shares);
    }
    beside.draw(image, pass, state_, without, fine);
  }

 private:
  struct Zoom {
    Ball ball;
    int size = 0;
    double density(const View& v) const { return size / extentOf(ball, v); }  ///< lines a subpixel
  };
  /// The smallest ball that holds two.
  static Ball around(const Ball& a, const Ball& b) {
    const glm::dvec3 between = b.centre - a.centre;
    const double apart = glm::length(between);
    if (apart + b.radius_m <= a.radius_m) return a;
    if (apart + a.radius_m <= b.radius_m) return b;
    const double radius = 0.5 * (apart + a.radius_m + b.radius_m);
    return {a.entity, -1, a.centre + between * ((radius - a.radius_m) / apart), radius};
  }
  /// Bodies side by side (slices of a plume) share a view of the finest one's density: each view is a picture of its own, with all that is transparent in it.
  static void join(std::vector<Zoom>& zooms, const View& v) {
    constexpr double kAlike = 2.0, kMostLines = 512.0, kEmpty = 1.5;  // densities; a view; samples beside the bodies
    for (size_t i = 0; i < zooms.size(); ++i)
      for (size_t j = i + 1; j < zooms.size();) {
        const double one = zooms[i].density(v), other = zooms[j].density(v);
        Zoom both{around(zooms[i].ball, zooms[j].ball)};
        const double needed = std::max(one, other) * extentOf(both.ball, v);
        const auto samples = [](double lines) { return lines * lines; };
        if (!(needed <= kMostLines) || std::max(one, other) > kAlike * std::min(one, other) ||
            samples(both.size = evenSize(needed)) > kEmpty * (samples(zooms[i].size) + samples(zooms[j].size)) + kPicture) {
          ++j;
          continue;
        }
        zooms[i] = both;
        zooms.erase(zooms.begin() + static_cast<long>(j));
        j = i + 1;
      }
  }
  /// Lines across a bright part at most.
  static constexpr double kMostOfParts = 512.0;
  /// Of a sample that counts whatever it meets.
  static constexpr std::uint64_t kAny = std::uint64_t{1} << 63;
  bool isOne(int e) const { return std::find(bodies_.begin(), bodies_.end(), e) != bodies_.end(); }
  bool hasOwnView(int e) const { return e >= 0 && small_[static_cast<size_t>(e)] && !isOne(e); }
  /// Which of the bodies a ray meets, whatever hides them: one bit each, the first again after 63.
  std::uint64_t setOf(const View& z, double x, double y) const {
    const glm::dvec3 ray = z.ray(x, y), direction = z.localFromCamera * ray / glm::length(ray);
    std::uint64_t set = 0;
    for (size_t b = 0; b < bodies_.size(); ++b)
      if (meetsBody(sim_, state_, z.position, direction, z.near_m * glm::length(ray), bodies_[b])) set |= std::uint64_t{1} << b % 63;
    return set;
  }
  /// What each sample of a view meets; none where a finer view has it, as it has all that meets a body, or all where it is of a part.
  std::vector<std::uint64_t> sets(const Subpixels& image, size_t index) const {
    const View& z = views_[index];
    std::vector<std::uint64_t> all(static_cast<size_t>(z.width) * static_cast<size_t>(z.height), 0);
    eachSample(image, z, [&](size_t q, size_t, double, double, const glm::dvec2&) {
      const double x = static_cast<double>(q % static_cast<size_t>(z.width)) + 0.5, y = static_cast<double>(q / static_cast<size_t>(z.width)) + 0.5;
      const glm::dvec3 direction = z.localFromCamera * z.ray(x, y);
      const std::uint64_t set = setOf(z, x, y);
      for (size_t j = 0; j < index; ++j)
        if ((set != 0 || whole_[j]) && looksAt(views_[j], direction)) return;
      all[q] = set | (whole_[index] ? kAny : 0);
    });
    return all;
  }
  /// Flags of those that a part of a body may show in: of all surfaces within its ball, around each triangle.
  std::vector<char> subpixelsOf(const Ball& part, const Subpixels& image) const {
    constexpr double kMargin = 0.01;  // of a subpixel
    const View& v = image.view();
    const auto width = static_cast<size_t>(v.width), all = width * static_cast<size_t>(v.height);
    std::vector<char> flags(all, 0);
    const Entity& entity = sim_.entities[static_cast<size_t>(part.entity)];
    const Pose& pose = state_.entities[static_cast<size_t>(part.entity)];
    const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
    for (const Surface& surface : entity.surfaces) {
      const MeshPart& own = entity.mesh->parts[surface.meshPart];
      std::vector<glm::dvec2> corners;
      bool within = true;
      for (std::uint32_t t = own.firstTriangle; t < own.firstTriangle + own.triangleCount && within; ++t)
        for (int k = 0; k < 3 && within; ++k) {
          const glm::dvec3 at = pose.position + pose.orientation * glm::dvec3(entity.mesh->positions[entity.mesh->triangles[t][k]]);
          within = glm::length(at - part.centre) <= part.radius_m;  // which lies before the camera
          corners.push_back(filmPosition(v, cameraFromLocal * (at - v.position)));
        }
      for (size_t c = 0; within && c < corners.size(); c += 3) {
        const glm::dvec2 size(v.width - 1, v.height - 1), low = glm::min(glm::min(corners[c], corners[c + 1]), corners[c + 2]) - kMargin,
                                                          high = glm::max(glm::max(corners[c], corners[c + 1]), corners[c + 2]) + kMargin;
        if (high.x < 0.0 || high.y < 0.0 || low.x > v.width || low.y > v.height) continue;
        const glm::ivec2 from(glm::clamp(low, glm::dvec2(0.0), size)), to(glm::clamp(high, glm::dvec2(0.0), size));
        for (int y = from.y; y <= to.y; ++y)
          for (int x = from.x; x <= to.x; ++x) flags[image.index(x, y)] = 1;
      }
    }
    return flags;
  }
  /// Whose colour a sample has. One on an outline, where a ray and the rasteriser may see different things (it counts in 1/256 of a pixel), has that of
  /// a neighbour that meets the same.
  std::vector<std::uint32_t> colours(const View& z, const std::vector<std::uint64_t>& set) const {
    constexpr double kMargin_px = 0.02;
    const size_t width = static_cast<size_t>(z.width);
    const auto neighbours = [&](size_t q, auto&& visit) {
      if (q % width > 0) visit(q - 1);
      if (q % width + 1 < width) visit(q + 1);
      if (q >= width) visit(q - width);
      if (q + width < set.size()) visit(q + width);
    };
    std::vector<std::uint32_t> colour(set.size(), kNone);
    std::vector<size_t> outline;
    for (size_t q = 0; q < set.size(); ++q) {
      if (set[q] == 0) continue;
      bool border = false, clear = true;
      neighbours(q, [&](size_t n) { border |= set[n] != set[q]; });
      for (int corner = 0; border && clear && corner < 4; ++corner)
        clear = setOf(z, static_cast<double>(q % width) + 0.5 + ((corner & 1) ? kMargin_px : -kMargin_px),
                      static_cast<double>(q / width) + 0.5 + ((corner & 2) ? kMargin_px : -kMargin_px)) == (set[q] & ~kAny);
      if (clear) colour[q] = static_cast<std::uint32_t>(q);
      else outline.push_back(q);
    }
    for (size_t q : outline)
      neighbours(q, [&](size_t n) {
        if (set[n] == set[q] && colour[n] == n) colour[q] = static_cast<std::uint32_t>(n);
      });
    return colour;
  }
  static std::shared_ptr<const std::vector<char>> wanted(const std::vector<std::uint32_t>& colour) {
    auto marks = std::make_shared<std::vector<char>>(colour.size(), 0);
    for (std::uint32_t from : colour)
      if (from != kNone) (*marks)[from] = 1;
    return marks;
  }
  static bool looksAt(const View& z, const glm::dvec3& direction) {
    const glm::dvec3 p = glm::transpose(z.localFromCamera) * direction;
    if (p.z >= 0.0) return false;
    const glm::dvec2 at = filmPosition(z, p);
    return at.x >= 0.0 && at.y >= 0.0 && at.x < z.width && at.y < z.height;
  }
  const Simulation& sim_;
  const WorldState& state_;
  std::vector<int> bodies_;
  std::vector<char> small_;
  std::vector<View> views_;   ///< the finest first
  std::vector<char> whole_;   ///< of each: it is a part's, and all it sees counts
  std::vector<Ball> partOf_;  ///< what each looks at
};

/// The truth of what is small is that of a subpixel's middle, as of what is large: where its truth is asked for such subpixels are drawn once more, with all
/// that is there.
void putMiddles(Subpixels& image, ScenePass& pass, const Simulation& sim, const WorldState& state, const std::vector<char>& small, const std::vector<char>& present,
                const FineSubpixels& fine) {
  if (!image.hasTruth()) return;
  const View& v = image.view();
  const auto width = static_cast<size_t>(v.width);
  auto marks = std::make_shared<std::vector<char>>(width * static_cast<size_t>(v.height), 0);
  for (const auto& [p, f] : fine) (*marks)[p] = f.shown && image.isMiddle(static_cast<int>(p % width), static_cast<int>(p / width));
  if (!anyOf(*marks)) return;
  View middles = magnified(v, {0, 0, v.width, v.height}, 1);
  middles.wanted = marks;
  const RawImage seen = drawWanted(pass, middles, state, present, !sim.fields.empty(), std::numeric_limits<int>::max());
  for (size_t p = 0; p < marks->size(); ++p)
    if ((*marks)[p] && seen.entity[p] >= 0 && small[static_cast<size_t>(seen.entity[p])]) image.setTruth(p, truthAt(seen, p));
}

}  // namespace

std::vector<char> findSmallBodies(const Simulation& sim, const WorldState& state, const View& v, double limit) {
  std::vector<char> small(sim.entities.size(), 0);
  for (size_t e = 0; e < sim.entities.size(); ++e) small[e] = state.isThere(e) && extentOf(ballOf(sim, state, static_cast<int>(e)), v) < limit;
  return small;
}

glm::ivec4 smallBodiesIn(const Simulation& sim, const WorldState& state, const View& v, const std::vector<char>& small, const std::vector<char>& present,
                         const std::vector<Ball>& parts) {
  // Half the diagonal of the square picture of the ball that zoomedView() makes, by the ball: 1.02 x 16 / 15.38 / sqrt(2) where it has fewest lines, its
  // middle shifted; and two subpixels.
  constexpr double kHalf = 0.8, kRoom = 2.0;
  std::vector<Ball> balls = parts;
  for (size_t e = 0; e < small.size(); ++e)
    if (small[e] && present[e]) balls.push_back(ballOf(sim, state, static_cast<int>(e)));
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (const Ball& ball : balls) {
    const double extent = extentOf(ball, v);
    if (!mayShow(v, ball.centre, ball.radius_m) || !std::isfinite(extent)) continue;
    const glm::dvec2 at = filmPosition(v, glm::transpose(v.localFromCamera) * (ball.centre - v.position));
    // Off the axis a ball's picture is longer.
    const glm::dvec2 off((at.x - v.axisX) * v.tanPerPixelX, (at.y - v.axisY) * v.tanPerPixelY);
    const double reach = kHalf * extent * (1.0 + glm::dot(off, off)) + kRoom;
    low = glm::min(low, at - reach), high = glm::max(high, at + reach);
  }
  const glm::ivec2 size(v.width, v.height);
  if (!(low.x < high.x) || high.x <= 0.0 || high.y <= 0.0 || low.x >= size.x || low.y >= size.y) return glm::ivec4(0);
  const glm::ivec2 first = glm::clamp(glm::ivec2(glm::floor(low)), glm::ivec2(0), size - 1),
                   last = glm::clamp(glm::ivec2(glm::ceil(high)), glm::ivec2(1), size);
  return {first, last - first};
}

void addSmallBodies(Subpixels& image, ScenePass& pass, const Simulation& sim, const WorldState& state, const std::vector<char>& small,
                    const std::vector<char>& present, const std::vector<int>& lines, const std::vector<Ball>& parts, const std::vector<char>* wanted) {
  const View& v = image.view();
  std::vector<int> bodies;
  std::vector<char> others = present;
  for (size_t e = 0; e < small.size(); ++e) {
    if (!small[e] || !present[e]) continue;
    others[e] = 0;
    const Ball ball = ballOf(sim, state, static_cast<int>(e));
    if (mayShow(v, ball.centre, ball.radius_m)) bodies.push_back(static_cast<int>(e));
  }
  const std::vector<char> mixed = overlapTransparent(sim, state, v, bodies);

  // Each zoomed view shows what the others hide, and directions are shared out among them: their order does not matter.
  std::vector<char> solids = others;
  std::vector<int> together, apart;
  for (size_t i = 0; i < bodies.size(); ++i) {
    solids[static_cast<size_t>(bodies[i])] = !mixed[i];
    (mixed[i] ? together : apart).push_back(bodies[i]);
  }
  FineSubpixels fine;
  SolidBodies(image, sim, state, apart, lines, wanted).draw(pass, state, solids, fine);
  MixedBodies(sim, state, v, together, lines, parts, small).draw(image, pass, others, present, wanted, fine);
  put(image, fine);
  putMiddles(image, pass, sim, state, small, present, fine);
}

}  // namespace pitviper

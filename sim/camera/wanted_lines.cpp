#include "sim/camera/wanted_lines.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "sim/camera/zoomed_lines.hpp"

namespace pitviper {

int powerOfTwo(int lines) {
  constexpr unsigned kFewest = 16;
  return static_cast<int>(std::bit_ceil(std::max(static_cast<unsigned>(lines), kFewest)));
}

namespace {

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

}  // namespace

RawImage drawWanted(LineDrawer& drawer, const View& z, const WorldState& state, const std::vector<char>& drawn, bool fields, int largest) {
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
    drawer.draw(part, state, drawn);
    drawer.startReadback(true);
    const RawImage picture = drawer.finishReadback();
    rows([&](size_t view, size_t own, size_t count) { std::copy_n(&picture.entity[own], count, &image.entity[view]); });
    for (const auto& [from, to] : {std::pair{&picture.groups, &image.groups}, {&picture.truth, &image.truth}}) {
      to->resize(from->size(), std::vector<float>(4 * samples, 0.0f));
      for (size_t g = 0; g < from->size(); ++g)
        rows([&](size_t view, size_t own, size_t count) { std::copy_n(&(*from)[g][4 * own], 4 * count, &(*to)[g][4 * view]); });
    }
  }
  return image;
}

}  // namespace pitviper

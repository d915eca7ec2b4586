#pragma once
// Lines that a picture takes besides its own: through sheets, zoomed views of what its pixels do not resolve. One rule says which count, whatever is seen
// through, overlaps or hides: a line counts in the finest sheet of those unresolved things that it meets, and in no other. The picture's own lines, which see
// all but unresolved bodies, have what is left of each pixel: so all lines of a pixel weigh 1 together.
#include <functional>
#include <memory>
#include <vector>

#include "sim/camera/zoomed_view.hpp"

namespace pitviper {

struct Sheet {
  View view;                       ///< View::onlyEntity: of a solid body with nothing near that is seen through, which alone is shaded then
  Ball ball;                       ///< looked at
  std::vector<int> bodies;         ///< unresolved ones that it is of; none: it is of a bright part of a large body ...
  std::vector<char> subpixels;     ///< ... that may show in these of the film (one flag each): there all that it sees counts
  std::vector<std::size_t> finer;  ///< sheets that look at some of the same
  double density = 0.0;            ///< lines a subpixel
};

class Sheets {
 public:
  /// `film`: the picture's view; `small`: unresolved bodies; `present`: all that can be seen or hide (one flag per entity each); `lines`: as zoomedLines();
  /// `parts`: of other bodies, with lines of their own. Both of the first must outlive it.
  Sheets(const Simulation& simulation, const WorldState& state, const View& film, const std::vector<char>& small, const std::vector<char>& present,
         const std::vector<int>& lines, const std::vector<Ball>& parts);
  /// The finest first.
  const std::vector<Sheet>& all() const { return sheets_; }
  /// Which of a sheet's lines may count, row by row from below, by what they would meet if nothing hid it; null: any. `only`: subpixels that are wanted, or
  /// null.
  std::shared_ptr<const std::vector<char>> mayCount(const Sheet& sheet, const std::vector<char>* only) const;
  /// Whether one does: through a place of the sheet's view, in a subpixel, to an entity that is solid (-1: none).
  bool counts(const Sheet& sheet, const glm::dvec2& place, std::size_t subpixel, int seen) const;

 private:
  void addBodies(const std::vector<int>& lines);
  bool isAlone(int entity) const;
  std::vector<char> subpixelsOf(const Ball& part) const;
  /// `meets`: of an unresolved body.
  template <class Meets>
  bool isOf(const Sheet& sheet, const glm::dvec3& direction, std::size_t subpixel, const Meets& meets) const;
  const Simulation& sim_;
  const WorldState& state_;
  View film_;
  std::vector<int> bodies_;
  std::vector<char> transparent_;  ///< one flag per entity
  std::vector<Sheet> sheets_;
};

/// A line of a sheet that falls on the film.
struct SheetLine {
  std::size_t number = 0;      ///< in the sheet, row by row from below
  glm::dvec2 place{0.0};       ///< on it
  std::size_t subpixel = 0;    ///< of the film
  glm::dvec2 fromMiddle{0.0};  ///< of that [subpixels]
  double etendue_sr = 0.0;     ///< its projected solid angle on the film
  double cosPsi = 1.0;         ///< to the film's axis
};
void eachLine(const View& film, const View& sheet, const std::function<void(const SheetLine&)>& visit);

}  // namespace pitviper

#include "sim/scene/mesh_orientation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "sim/parameters/readable_text.hpp"
#include "sim/scene/mesh_edges.hpp"
#include "sim/scene/mesh_normals.hpp"
#include "sim/scene/mesh_shells.hpp"
#include "sim/scene/triangle_tree.hpp"

namespace pitviper {
namespace {

/// Of a mesh's size: what single precision may be off by, several times over.
constexpr double kRounding = 1e-6;
/// Corners of a shell that must all lie within another.
constexpr std::size_t kLooked = 64;

std::string counted(std::size_t n, const char* one, const char* many) { return std::to_string(n) + " " + (n == 1 ? one : many); }
std::string were(std::size_t n) { return n == 1 ? "was" : "were"; }

class Nesting {
 public:
  Nesting(const Mesh& mesh, const std::vector<MeshShell>& shells)
      : mesh_(mesh), shells_(shells), shellOf_(mesh.triangles.size(), kNone), boxes_(shells.size()) {
    std::vector<std::uint32_t> closed;
    for (std::uint32_t s = 0; s < shells.size(); ++s)
      if (shells[s].kind == MeshShell::Kind::Closed)
        for (std::uint32_t t : shells[s].triangles) {
          shellOf_[t] = s, closed.push_back(t);
          for (int k = 0; k < 3; ++k) boxes_[s].add(mesh.positions[mesh.triangles[t][k]]);
        }
    tree_ = std::make_unique<TriangleTree>(mesh, std::move(closed));
    if (!tree_->nodes().empty()) size_ = glm::length(glm::dvec3(tree_->nodes()[0].high) - glm::dvec3(tree_->nodes()[0].low));
  }

  /// The smallest closed shell that holds all of a closed shell without touching it; kNone: there is none.
  std::uint32_t holderOf(std::uint32_t shell) const {
    const std::vector<std::uint32_t>& own = shells_[shell].triangles;
    std::set<std::uint32_t> holders = around(corner(own[0], 0), shell);
    const Box& box = boxes_[shell];
    std::erase_if(holders,
                  [&](std::uint32_t h) { return !glm::all(glm::lessThan(boxes_[h].low, box.low)) || !glm::all(glm::greaterThan(boxes_[h].high, box.high)); });
    const std::size_t step = own.size() / kLooked + 1;
    for (std::size_t k = 0; k < own.size() && !holders.empty(); k += step)
      for (int c = 0; c < 3 && !holders.empty(); ++c) {
        const std::set<std::uint32_t> here = around(corner(own[k], c), shell);
        std::erase_if(holders, [&](std::uint32_t h) { return !here.contains(h); });
      }
    std::uint32_t smallest = kNone;
    for (std::uint32_t h : holders)
      if (shells_[h].volume_m3 > shells_[shell].volume_m3 && (smallest == kNone || shells_[h].volume_m3 < shells_[smallest].volume_m3)) smallest = h;
    return smallest;
  }

  static constexpr std::uint32_t kNone = ~0u;

 private:
  struct Box {
    glm::vec3 low{INFINITY}, high{-INFINITY};
    void add(const glm::vec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  };

  glm::dvec3 corner(std::uint32_t t, int k) const { return glm::dvec3(mesh_.positions[mesh_.triangles[t][k]]); }

  /// Other shells that a place is inside of: a line from it leaves them once more than it enters them, or the other way round.
  std::set<std::uint32_t> around(const glm::dvec3& place, std::uint32_t except) const {
    std::map<std::uint32_t, int> crossed;
    std::set<std::uint32_t> touched;
    static const glm::dvec3 kAlong = glm::normalize(glm::dvec3(0.5377, 0.2113, 0.8163));  // no direction that shapes have
    tree_->along(place, kAlong, -kRounding * size_, INFINITY, [&](std::uint32_t t) {
      const std::uint32_t other = shellOf_[t];
      if (other == except) return false;
      const TriangleMeeting m = meetTriangle(mesh_, t, place, kAlong);
      if (!m.met || m.along < -kRounding * size_) return false;
      if (m.along <= kRounding * size_) touched.insert(other);
      else ++crossed[other];
      return false;
    });
    std::set<std::uint32_t> inside;
    for (const auto& [shell, times] : crossed)
      if (times % 2 != 0 && !touched.contains(shell)) inside.insert(shell);
    return inside;
  }

  const Mesh& mesh_;
  const std::vector<MeshShell>& shells_;
  std::vector<std::uint32_t> shellOf_;
  std::vector<Box> boxes_;
  std::unique_ptr<TriangleTree> tree_;
  double size_ = 0.0;
};

/// Turns the walls of hollows the other way round.
void turnHollows(Mesh& mesh, const std::vector<MeshShell>& shells, std::vector<char>& turn) {
  std::vector<std::uint32_t> bySize;
  for (std::uint32_t s = 0; s < shells.size(); ++s)
    if (shells[s].kind == MeshShell::Kind::Closed) bySize.push_back(s);
  if (bySize.size() < 2) return;
  std::stable_sort(bySize.begin(), bySize.end(), [&](std::uint32_t a, std::uint32_t b) { return shells[a].volume_m3 > shells[b].volume_m3; });
  const Nesting nesting(mesh, shells);
  const auto partsOf = [&](std::uint32_t s) {
    std::set<std::uint32_t> parts;
    for (std::uint32_t t : shells[s].triangles) {
      const auto after = std::upper_bound(mesh.parts.begin(), mesh.parts.end(), t, [](std::uint32_t a, const MeshPart& p) { return a < p.firstTriangle; });
      parts.insert(static_cast<std::uint32_t>(after - mesh.parts.begin()) - 1u);
    }
    return parts;
  };
  const auto named = [&](std::uint32_t part) { return "'" + readable(mesh.parts[part].name.substr(0, 60)) + "'"; };
  std::vector<char> hollow(shells.size(), 0);
  std::set<std::string> bodies;
  for (std::uint32_t s : bySize) {
    const std::uint32_t holder = nesting.holderOf(s);
    if (holder == Nesting::kNone || hollow[holder]) continue;
    const std::set<std::uint32_t> own = partsOf(s), theirs = partsOf(holder);
    const bool apart = std::none_of(own.begin(), own.end(), [&](std::uint32_t p) { return theirs.contains(p); });
    if (apart && (shells[s].fileVolume_m3 > 0.0) == (shells[holder].fileVolume_m3 > 0.0)) {
      if (bodies.empty())
        mesh.notes.push_back("a closed shell of " + named(*own.begin()) + " lies within one of " + named(*theirs.begin()) +
                             " and is wound like it: taken as a body of its own, not as the wall of a hollow; for a hollow turn its faces");
      bodies.insert(mesh.parts[*own.begin()].name);
      continue;
    }
    hollow[s] = 1;
    for (std::uint32_t t : shells[s].triangles) turn[t] = !turn[t];
  }
}

/// Whether the normals of the triangles that are turned went with their winding, shell by shell: they are then turned too.
void turnNormals(const Mesh& mesh, const std::vector<MeshShell>& shells, const std::vector<char>& turn, std::vector<CornerNormal>& wish) {
  for (const MeshShell& shell : shells) {
    double agreed = 0.0;
    for (std::uint32_t t : shell.triangles) {
      const glm::uvec3& i = mesh.triangles[t];
      if (turn[t]) agreed += glm::dot(areaVector(mesh, i), glm::dvec3(mesh.normals[i.x]) + glm::dvec3(mesh.normals[i.y]) + glm::dvec3(mesh.normals[i.z]));
    }
    for (std::uint32_t t : shell.triangles)
      if (turn[t] && agreed > 0.0) std::fill_n(wish.begin() + 3 * static_cast<std::ptrdiff_t>(t), 3, CornerNormal::Turned);
  }
}

/// Corners whose normals point against their triangles, which are as they shall be.
std::size_t findContrary(const Mesh& mesh, std::vector<CornerNormal>& wish) {
  double farthest = 0.0;
  for (const glm::vec3& p : mesh.positions) farthest = std::max(farthest, glm::length(glm::dvec3(p)));
  std::size_t found = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3& i = mesh.triangles[t];
    const glm::dvec3 area = areaVector(mesh, i), a(mesh.positions[i.x]), b(mesh.positions[i.y]), c(mesh.positions[i.z]);
    // A sliver as narrow as its corners are rounded faces anywhere.
    if (glm::length(area) <= kRounding * farthest * std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)})) continue;
    for (int k = 0; k < 3; ++k) {
      CornerNormal& w = wish[3 * t + static_cast<std::size_t>(k)];
      constexpr double kEdgeOn = -1e-3;  // files round normals to three digits and more
      if ((w == CornerNormal::Turned ? -1.0 : 1.0) * glm::dot(area, glm::dvec3(mesh.normals[i[k]])) >= kEdgeOn * glm::length(area)) continue;
      w = CornerNormal::Made;
      ++found;
    }
  }
  return found;
}

}  // namespace

void orientShells(Mesh& mesh, bool hasNormals, double creaseAngle_rad) {
  std::vector<char> turn;
  const std::vector<MeshShell> shells = shellsOf(mesh, turn);
  turnHollows(mesh, shells, turn);
  mesh.closed = std::all_of(shells.begin(), shells.end(), [](const MeshShell& s) { return s.kind == MeshShell::Kind::Closed; });

  std::size_t closed = 0, turned = 0, against = 0;
  for (const MeshShell& shell : shells) {
    const auto count = static_cast<std::size_t>(std::count_if(shell.triangles.begin(), shell.triangles.end(), [&](std::uint32_t t) { return turn[t] != 0; }));
    if (shell.kind == MeshShell::Kind::Closed) ++closed;
    if (count == shell.triangles.size()) ++turned;
    else against += count;
  }
  if (turned > 0)
    mesh.notes.push_back(std::to_string(turned) + " of " + counted(closed, "closed shell", "closed shells") + " faced the wrong way, and " + were(turned) +
                         " turned");
  if (against > 0)
    mesh.notes.push_back(counted(against, "triangle", "triangles") + " went round another way than those beside, and " + were(against) + " turned");

  std::vector<CornerNormal> wish(mesh.triangles.size() * 3, CornerNormal::Kept);
  if (hasNormals) turnNormals(mesh, shells, turn, wish);
  for (std::size_t t = 0; t < turn.size(); ++t)
    if (turn[t]) {
      std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
      std::swap(wish[3 * t + 1], wish[3 * t + 2]);
    }
  if (!hasNormals) return;
  const std::size_t contrary = findContrary(mesh, wish);
  if (contrary > 0)
    mesh.notes.push_back("the normals at " + std::to_string(contrary) + " of " + std::to_string(wish.size()) +
                         " corners point against their triangles' winding, and are made anew from the surface");
  if (std::any_of(wish.begin(), wish.end(), [](CornerNormal w) { return w != CornerNormal::Kept; })) changeNormals(mesh, wish, creaseAngle_rad);
}

}  // namespace pitviper

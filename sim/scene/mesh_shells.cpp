#include "sim/scene/mesh_shells.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "sim/scene/mesh_edges.hpp"
#include "sim/scene/triangle_tree.hpp"

namespace pitviper {
namespace {

/// A volume below this share of what the surface could enclose is rounding: sums of doubles are good to 1e-16 a term.
constexpr double kNoVolume = 1e-12;
/// Pieces of a tangle that are looked at one by one; of more both sides are drawn, which is always right.
constexpr std::size_t kMostPieces = 20'000;

/// A forest of triangles, each wound like its root or the other way round.
class Winding {
 public:
  explicit Winding(std::size_t count) : parent_(count), turned_(count, 0), oneSided_(count, 0) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t root(std::uint32_t t) {
    std::uint32_t top = t;
    char turned = 0;
    while (parent_[top] != top) turned ^= turned_[top], top = parent_[top];
    while (parent_[t] != top && t != top) {
      const std::uint32_t next = parent_[t];
      const char rest = turned ^ turned_[t];
      parent_[t] = top;
      turned_[t] = turned;
      t = next;
      turned = rest;
    }
    return top;
  }
  bool isTurned(std::uint32_t t) { return root(t) != t && turned_[t]; }
  bool isOneSided(std::uint32_t t) { return oneSided_[root(t)]; }

  /// Two triangles go round alike, once one of them is turned if they are `opposed`.
  void join(std::uint32_t a, std::uint32_t b, bool opposed) {
    const std::uint32_t ra = root(a), rb = root(b);
    const bool differ = isTurned(a) != isTurned(b);
    if (ra == rb) {
      if (differ != opposed) oneSided_[ra] = 1;
      return;
    }
    parent_[rb] = ra;
    turned_[rb] = differ != opposed;
    oneSided_[ra] |= oneSided_[rb];
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<char> turned_, oneSided_;
};

/// Triangles that meet at one edge and could not be told apart.
using Knot = std::vector<MeshEdge>;

class ShellFinder {
 public:
  ShellFinder(const Mesh& mesh, std::vector<char>& turn) : mesh_(mesh), turn_(turn), winding_(mesh.triangles.size()), part_(mesh.triangles.size(), 0) {
    for (std::uint32_t p = 0; p < mesh.parts.size(); ++p) std::fill_n(part_.begin() + mesh.parts[p].firstTriangle, mesh.parts[p].triangleCount, p);
  }

  std::vector<MeshShell> run() {
    std::vector<MeshEdge> edges = sortedEdges(mesh_, weldByPosition(mesh_));
    for (std::size_t i = 0, end; i < edges.size(); i = end) {
      for (end = i + 1; end < edges.size() && edges[end].places == edges[i].places;) ++end;
      if (!edges[i].hasLength()) continue;
      if (end - i == 1) borders_.push_back(edges[i].triangle);
      else if (end - i == 2) join(edges[i], edges[i + 1]);
      else knots_.emplace_back(edges.begin() + static_cast<std::ptrdiff_t>(i), edges.begin() + static_cast<std::ptrdiff_t>(end));
    }
    edges = {};
    const auto byPiece = [this](const MeshEdge& e) { return winding_.root(e.triangle); };
    for (Knot& knot : knots_) joinPairs(knot, byPiece, true);
    for (Knot& knot : knots_)
      joinPairs(
          knot, [this](const MeshEdge& e) { return part_[e.triangle]; }, false);
    for (Knot& knot : knots_) joinPairs(knot, byPiece, true);
    for (Knot& knot : knots_)
      if (knot.size() == 1) borders_.push_back(knot[0].triangle), knot.clear();
    std::erase_if(knots_, [](const Knot& knot) { return knot.empty(); });
    gather();
    std::vector<MeshShell> shells;
    for (std::uint32_t b = 0; b < bundles_.size(); ++b)
      if (!bundles_[b].empty()) settle(bundles_[b], knotsOf_[b], shells);
    return shells;
  }

 private:
  struct Piece {
    std::vector<std::uint32_t> triangles;
    bool open = false;
  };

  void join(const MeshEdge& a, const MeshEdge& b) { winding_.join(a.triangle, b.triangle, a.forward == b.forward); }

  /// Joins those of which there are just two of a kind, and leaves the others. `opposedToo`: also where they go round differently.
  template <class KindOf>
  void joinPairs(Knot& at, const KindOf& kindOf, bool opposedToo) {
    std::map<std::uint32_t, Knot> kinds;
    for (const MeshEdge& e : at) kinds[kindOf(e)].push_back(e);
    at.clear();
    for (const auto& [kind, same] : kinds) {
      if (same.size() == 2 && (opposedToo || same[0].forward != same[1].forward)) join(same[0], same[1]);
      else at.insert(at.end(), same.begin(), same.end());
    }
  }

  /// Pieces by root, and those that knots tie together.
  void gather() {
    constexpr std::uint32_t kNone = ~0u;
    std::vector<std::uint32_t> number(mesh_.triangles.size(), kNone);
    pieceOf_.resize(mesh_.triangles.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      std::uint32_t& p = number[winding_.root(t)];
      if (p == kNone) p = static_cast<std::uint32_t>(pieces_.size()), pieces_.emplace_back();
      pieces_[p].triangles.push_back(t);
      pieceOf_[t] = p;
      turn_[t] = winding_.isTurned(t);
    }
    for (std::uint32_t t : borders_) pieces_[pieceOf_[t]].open = true;
    std::vector<std::uint32_t> parent(pieces_.size());
    std::iota(parent.begin(), parent.end(), 0u);
    for (const Knot& knot : knots_)
      for (const MeshEdge& e : knot) parent[rootOf(parent, pieceOf_[e.triangle])] = rootOf(parent, pieceOf_[knot[0].triangle]);
    bundles_.resize(pieces_.size());
    knotsOf_.resize(pieces_.size());
    for (std::uint32_t p = 0; p < pieces_.size(); ++p) bundles_[rootOf(parent, p)].push_back(p);
    for (std::uint32_t k = 0; k < knots_.size(); ++k) knotsOf_[rootOf(parent, pieceOf_[knots_[k][0].triangle])].push_back(k);
  }

  double volumeOf(const std::vector<std::uint32_t>& triangles, bool asCame) const {
    const glm::dvec3 origin(mesh_.positions[mesh_.triangles[triangles[0]].x]);
    double sum = 0.0;
    for (std::uint32_t t : triangles) {
      const glm::uvec3& i = mesh_.triangles[t];
      sum += (!asCame && turn_[t] ? -1.0 : 1.0) * glm::dot(areaVector(mesh_, i), glm::dvec3(mesh_.positions[i.x]) - origin) / 6.0;
    }
    return sum;
  }
  double areaOf(const std::vector<std::uint32_t>& triangles) const {
    double sum = 0.0;
    for (std::uint32_t t : triangles) sum += 0.5 * glm::length(areaVector(mesh_, mesh_.triangles[t]));
    return sum;
  }
  void turnAll(const std::vector<std::uint32_t>& triangles) {
    for (std::uint32_t t : triangles) turn_[t] = !turn_[t];
  }
  void leave(const std::vector<std::uint32_t>& triangles) {
    for (std::uint32_t t : triangles) turn_[t] = 0;
  }

  /// Its two sides by the volume that it encloses.
  void close(MeshShell& shell) {
    const double volume = volumeOf(shell.triangles, false);
    if (!(std::abs(volume) > kNoVolume * std::pow(areaOf(shell.triangles), 1.5))) return unclear(shell);
    shell.kind = MeshShell::Kind::Closed;
    shell.volume_m3 = std::abs(volume);
    shell.fileVolume_m3 = volumeOf(shell.triangles, true);
    if (volume < 0.0) turnAll(shell.triangles);
  }
  void unclear(MeshShell& shell) {
    shell.kind = MeshShell::Kind::Unclear;
    leave(shell.triangles);
  }

  void settle(const std::vector<std::uint32_t>& bundle, const std::vector<std::uint32_t>& knots, std::vector<MeshShell>& shells) {
    const bool open = std::any_of(bundle.begin(), bundle.end(), [&](std::uint32_t p) { return pieces_[p].open; });
    if (bundle.size() == 1 || open) {
      for (std::uint32_t p : bundle) settleOne(pieces_[p], open, knots, shells);
      return;
    }
    MeshShell& shell = shells.emplace_back();
    for (std::uint32_t p : bundle) shell.triangles.insert(shell.triangles.end(), pieces_[p].triangles.begin(), pieces_[p].triangles.end());
    const bool oneSided = std::any_of(bundle.begin(), bundle.end(), [&](std::uint32_t p) { return winding_.isOneSided(pieces_[p].triangles[0]); });
    if (oneSided || bundle.size() > kMostPieces || !untangle(bundle, knots, shell)) return unclear(shell);
    close(shell);
  }

  void settleOne(Piece& piece, bool open, const std::vector<std::uint32_t>& knots, std::vector<MeshShell>& shells) {
    MeshShell& shell = shells.emplace_back();
    shell.triangles = std::move(piece.triangles);
    if (winding_.isOneSided(shell.triangles[0])) return unclear(shell);
    if (!open) return imbalance(knots) == 0 ? close(shell) : unclear(shell);
    double balance = 0.0;
    for (std::uint32_t t : shell.triangles) balance += (turn_[t] ? -1.0 : 1.0) * glm::length(areaVector(mesh_, mesh_.triangles[t]));
    if (balance < 0.0) turnAll(shell.triangles);
  }

  enum class Side { Right, Wrong, Wall };

  /// What lies before a piece: seen from its largest triangle along the normal, an even number of others is met where that is outside. A second one in the same
  /// place makes a wall between two bodies.
  Side sideOf(const std::vector<std::uint32_t>& piece, const TriangleTree& tree, double size) const {
    std::uint32_t largest = piece[0];
    for (std::uint32_t t : piece)
      if (glm::length(areaVector(mesh_, mesh_.triangles[t])) > glm::length(areaVector(mesh_, mesh_.triangles[largest]))) largest = t;
    const glm::uvec3& i = mesh_.triangles[largest];
    // Beside the middle, and aside of the normal, so that the lines of regular meshes are no edges.
    const glm::dvec3 from = 0.31 * glm::dvec3(mesh_.positions[i.x]) + 0.36 * glm::dvec3(mesh_.positions[i.y]) + 0.33 * glm::dvec3(mesh_.positions[i.z]);
    const glm::dvec3 normal = glm::normalize(areaVector(mesh_, i)) * (turn_[largest] ? -1.0 : 1.0);
    const glm::dvec3 along = glm::normalize(normal + 0.1 * glm::dvec3(0.577, 0.211, 0.789));
    constexpr double kSamePlace = 1e-6;  // of the size: the rounding of single precision
    int before = 0, here = 0;
    tree.along(from, along, -kSamePlace * size, INFINITY, [&](std::uint32_t t) {
      const TriangleMeeting m = t == largest ? TriangleMeeting{} : meetTriangle(mesh_, t, from, along);
      if (m.met && m.along > kSamePlace * size) ++before;
      else if (m.met && m.along >= -kSamePlace * size) ++here;
      return false;
    });
    return here > 0 ? Side::Wall : before % 2 == 0 ? Side::Right : Side::Wrong;
  }

  /// By how much the windings at a piece's knots do not cancel.
  int imbalance(const std::vector<std::uint32_t>& knots) const {
    int sum = 0;
    for (std::uint32_t k : knots) {
      int at = 0;
      for (const MeshEdge& e : knots_[k]) at += e.forward != static_cast<bool>(turn_[e.triangle]) ? 1 : -1;
      sum += std::abs(at);
    }
    return sum;
  }

  /// Turns each piece of a bundle its outside out; false where that cannot be told.
  bool untangle(const std::vector<std::uint32_t>& bundle, const std::vector<std::uint32_t>& knots, const MeshShell& shell) {
    if (std::any_of(knots.begin(), knots.end(), [&](std::uint32_t k) { return knots_[k].size() % 2 != 0; })) return false;
    const TriangleTree tree(mesh_, shell.triangles);
    const double size = glm::length(glm::dvec3(tree.nodes()[0].high) - glm::dvec3(tree.nodes()[0].low));
    std::vector<std::uint32_t> walls;
    for (std::uint32_t p : bundle) {
      const Side side = sideOf(pieces_[p].triangles, tree, size);
      if (side == Side::Wrong) turnAll(pieces_[p].triangles);
      if (side == Side::Wall) walls.push_back(p);
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> knotsOfPiece;
    for (std::uint32_t k : knots)
      for (const MeshEdge& e : knots_[k]) {
        std::vector<std::uint32_t>& own = knotsOfPiece[pieceOf_[e.triangle]];
        if (own.empty() || own.back() != k) own.push_back(k);
      }
    for (bool better = true; better;) {
      better = false;
      for (std::uint32_t p : walls) {
        const int before = imbalance(knotsOfPiece[p]);
        turnAll(pieces_[p].triangles);
        if (imbalance(knotsOfPiece[p]) < before) better = true;
        else turnAll(pieces_[p].triangles);
      }
    }
    return imbalance(knots) == 0;
  }

  const Mesh& mesh_;
  std::vector<char>& turn_;
  Winding winding_;
  std::vector<std::uint32_t> part_, borders_, pieceOf_;
  std::vector<Knot> knots_;
  std::vector<Piece> pieces_;
  std::vector<std::vector<std::uint32_t>> bundles_, knotsOf_;
};

}  // namespace

std::vector<MeshShell> shellsOf(const Mesh& mesh, std::vector<char>& turn) {
  turn.assign(mesh.triangles.size(), 0);
  return mesh.triangles.empty() ? std::vector<MeshShell>{} : ShellFinder(mesh, turn).run();
}

}  // namespace pitviper

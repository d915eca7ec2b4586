#include "sim/scene/import/gltf_nodes.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <set>

namespace pitviper {
namespace {

std::vector<Json>& items(Json& in, const char* name) {
  static std::vector<Json> none;
  const auto found = in.members.find(name);
  return found == in.members.end() ? none : found->second.items;
}

std::size_t indexOf(const Json& number) { return static_cast<std::size_t>(number.number); }

Json numbers(const double* values, std::size_t count) {
  Json out;
  out.kind = Json::Kind::Array;
  for (std::size_t k = 0; k < count; ++k) {
    Json& number = out.items.emplace_back();
    number.kind = Json::Kind::Number;
    number.number = values[k];
  }
  return out;
}

/// In its parent's axes: a matrix, column by column, or translation x rotation x scale.
glm::dmat4 localOf(Json& node) {
  const auto vector = [&](const char* name, double otherwise) {
    const std::vector<Json>& v = items(node, name);
    return v.empty() ? glm::dvec3(otherwise) : glm::dvec3(v[0].number, v[1].number, v[2].number);
  };
  glm::dmat4 m(1.0);
  if (const std::vector<Json>& matrix = items(node, "matrix"); !matrix.empty()) {
    for (int k = 0; k < 16; ++k) m[k / 4][k % 4] = matrix[static_cast<std::size_t>(k)].number;
    return m;
  }
  glm::dquat turn(1.0, 0.0, 0.0, 0.0);
  if (const std::vector<Json>& q = items(node, "rotation"); !q.empty()) turn = glm::dquat(q[3].number, q[0].number, q[1].number, q[2].number);
  if (glm::length(turn) > 0.0) turn = glm::normalize(turn);  // files round it
  return glm::translate(m, vector("translation", 0.0)) * glm::mat4_cast(turn) * glm::scale(m, vector("scale", 1.0));
}

class Flattening {
 public:
  explicit Flattening(Json& root) : root_(root), nodes_(items(root, "nodes")), global_(nodes_.size(), glm::dmat4(1.0)) {}

  std::vector<glm::dmat4> run() {
    std::vector<char> isChild(nodes_.size(), 0);
    for (Json& node : nodes_)
      for (const Json& child : items(node, "children")) isChild[indexOf(child)] = 1;
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      if (!isChild[n]) place(n, glm::dmat4(1.0));
    for (Json& scene : items(root_, "scenes")) {
      std::vector<Json> all;
      for (const Json& top : items(scene, "nodes")) gather(top, all);
      if (!all.empty()) scene.members["nodes"].items = std::move(all);
    }
    std::vector<glm::dmat4> left = global_;
    std::optional<glm::dvec3> first;
    for (Json& skin : items(root_, "skins"))
      for (const Json& joint : items(skin, "joints"))
        if (joint.kind == Json::Kind::Number && joint.number >= 0.0 && indexOf(joint) < nodes_.size()) keep(indexOf(joint), first, left);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      if (first && nodes_[n].find("skin") != nullptr) left[n] = glm::translate(glm::dmat4(1.0), *first);  // its own transform has no say
      nodes_[n].members.erase("children");
      for (const char* name : {"translation", "rotation", "scale"}) nodes_[n].members.erase(name);
      if (!kept_.contains(n)) nodes_[n].members.erase("matrix");
    }
    return left;
  }

 private:
  void place(std::size_t n, const glm::dmat4& parent) {
    global_[n] = parent * localOf(nodes_[n]);
    for (const Json& child : items(nodes_[n], "children")) place(indexOf(child), global_[n]);
  }

  void gather(const Json& node, std::vector<Json>& all) {
    all.push_back(node);
    for (const Json& child : items(nodes_[indexOf(node)], "children")) gather(child, all);
  }

  void keep(std::size_t n, std::optional<glm::dvec3>& first, std::vector<glm::dmat4>& left) {
    if (!first) first = glm::dvec3(global_[n][3]);
    glm::dmat4 near = global_[n];
    near[3] -= glm::dvec4(*first, 0.0);
    nodes_[n].members["matrix"] = numbers(&near[0][0], 16);
    left[n] = glm::translate(glm::dmat4(1.0), *first);
    kept_.insert(n);
  }

  Json& root_;
  std::vector<Json>& nodes_;
  std::vector<glm::dmat4> global_;
  std::set<std::size_t> kept_;
};

}  // namespace

std::vector<glm::dmat4> takePlacements(Json& root) { return Flattening(root).run(); }

}  // namespace pitviper

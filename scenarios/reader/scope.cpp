#include "scenarios/reader/scope.hpp"

#include <algorithm>

#include "scenarios/reader/expression.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

std::pair<Variable*, Scope*> Scope::find(std::string_view name) {
  for (Scope* s = this; s; s = s->outer)
    if (const auto found = s->variables.find(name); found != s->variables.end()) return {&found->second, s};
  return {nullptr, nullptr};
}

std::vector<std::string> Scope::namesLike(std::string_view word) const {
  std::vector<std::string> rest, names;
  for (const Scope* s = this; s; s = s->outer)
    for (const auto& [name, variable] : s->variables) rest.push_back(name);
  std::sort(rest.begin(), rest.end());
  constexpr size_t kMostShown = 12;  // a line of a terminal
  while (names.size() < kMostShown) {
    const std::string near = nearestWord(word, rest);
    if (near.empty()) break;
    names.push_back(near);
    rest.erase(std::find(rest.begin(), rest.end(), near));
  }
  for (size_t k = 0; k < rest.size() && names.size() < kMostShown; ++k) names.push_back(rest[k]);
  return names;
}

void checkName(const std::string& name, const Location& where) {
  constexpr size_t kLongest = 100;
  if (name.empty() || name.size() > kLongest || nameLength(name) != name.size())
    throw UserError(where, "a parameter cannot be called '" + name.substr(0, 60) + "'", "letters, digits and '_', no digit first, at most 100",
                    "choose another name");
}

}  // namespace pitviper

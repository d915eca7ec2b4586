#pragma once
// Models of a kind, by the word that scenarios call them. One row registers one.
#include <algorithm>
#include <deque>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace pitviper {

/// Model: has a `name`, and nearly always a list of `parameters`.
template <class Model>
class Registry {
 public:
  /// `kind`: of them all, for messages.
  Registry(std::string kind, std::initializer_list<Model> shipped) : kind_(std::move(kind)) {
    for (const Model& m : shipped) add(m);
  }
  /// Two of one name, or one without parameters, are refused by whoever asks for models first: what registers one at the start of a program has nobody to
  /// tell. True, so that a constant can be made of it.
  bool add(Model model) {
    if (find(model.name)) fault_ = "two " + kind_ + " models are called '" + model.name + "'";
    if constexpr (requires { model.parameters; })
      if (model.parameters.empty()) fault_ = "the " + kind_ + " model '" + model.name + "' has no table of parameters";
    models_.push_back(std::move(model));
    return true;
  }
  /// Throws std::logic_error where one was registered that cannot be.
  const std::deque<Model>& all() const {
    if (!fault_.empty()) throw std::logic_error(fault_);
    return models_;
  }
  /// Null where there is none.
  const Model* named(std::string_view name) const {
    all();  // which tells faults
    return find(name);
  }

 private:
  const Model* find(std::string_view name) const {
    const auto at = std::find_if(models_.begin(), models_.end(), [&](const Model& m) { return m.name == name; });
    return at == models_.end() ? nullptr : &*at;
  }
  std::string kind_, fault_;
  std::deque<Model> models_;  ///< which stay where they are
};

}  // namespace pitviper

#include "materials/models.hpp"

#include <algorithm>

#include "materials/reflection.hpp"
#include "sim/model/scene_fingerprint.hpp"

namespace pitviper {
namespace {

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const ReflectionModel& m : reflectionModels().all()) all.push_back(m.name);
  return all;
}

Parameter reflection() { return required(choice("reflection", names(), "kind")); }
Parameter modifier() { return map("modifier", "texture that multiplies it, 0..1"); }

/// A value as it was written.
void addTo(Fingerprint& f, const Value& v) {
  f.add(static_cast<int>(v.kind)).add(v.text).add(static_cast<double>(v.items.size())).add(static_cast<double>(v.entries.size()));
  for (const Value& item : v.items) addTo(f, item);
  for (const auto& [key, value] : v.entries) {
    f.add(key);
    addTo(f, value);
  }
}

}  // namespace

Registry<ReflectionModel>& reflectionModels() {
  static Registry<ReflectionModel> all("reflection", {lambertianModel(), phongModel(), tabulatedModel()});
  return all;
}

ParameterTable componentTable(const ReflectionModel& model) {
  ParameterTable t{"component: " + model.name, model.description, {reflection()}};
  t.parameters.insert(t.parameters.end(), model.parameters.begin(), model.parameters.end());
  t.parameters.push_back(modifier());
  return t;
}

ParameterTable anyComponentTable() {
  ParameterTable t{"component", "", {reflection(), modifier()}};
  for (const ReflectionModel& m : reflectionModels().all())
    for (const Parameter& p : m.parameters)
      if (!t.find(p.key)) t.parameters.push_back(any(p.key, p.description));
  return t;
}

std::shared_ptr<const ReflectionComponent> makeComponent(const ReflectionModel& model, const Record& record,
                                                         const std::function<Spectrum(const Value&, const Parameter&)>& spectrum) {
  Fingerprint f;
  f.add(model.name);
  std::map<std::string, Spectrum> spectra;
  for (const Parameter& p : model.parameters) {
    f.add(p.key).add(record.has(p.key));
    if (!record.has(p.key)) continue;
    if (p.type == ParameterType::Spectrum) addTo(f, spectra.emplace(p.key, spectrum(record.value(p.key), p)).first->second);
    else addTo(f, record.value(p.key));
  }
  auto component = model.make({record, spectra});
  component->setFingerprint(f.bytes());
  return component;
}

}  // namespace pitviper

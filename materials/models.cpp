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

Parameter stateOf(const StateParameter& s) {
  Parameter p = any(s.key, s.description + "; a number, or a texture of them over the surface");
  p.unit = s.unit;
  return p;
}

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
  static Registry<ReflectionModel> all("reflection", {lambertianModel(), phongModel(), tabulatedModel(), microfacetModel(), seaModel(), spectralPhongModel(),
                                                      wardModel(), sandfordRobertsonModel(), beardMaxwellModel(), measuredModel()});
  return all;
}

ParameterTable componentTable(const ReflectionModel& model) {
  ParameterTable t{"component: " + model.name, model.description, {reflection()}};
  t.parameters.insert(t.parameters.end(), model.parameters.begin(), model.parameters.end());
  if (model.state) t.parameters.push_back(stateOf(*model.state));
  t.parameters.push_back(modifier());
  return t;
}

ParameterTable anyComponentTable() {
  ParameterTable t{"component", "", {reflection(), modifier()}};
  for (const ReflectionModel& m : reflectionModels().all())
    for (const Parameter& p : m.parameters)
      if (!t.find(p.key)) t.parameters.push_back(any(p.key, p.description));
  for (const ReflectionModel& m : reflectionModels().all())
    if (m.state && !t.find(m.state->key)) t.parameters.push_back(stateOf(*m.state));
  return t;
}

ComponentMaker componentMaker(const ReflectionModel& model, const Record& record, const SpectrumOf& spectrum, const SubstanceOf& substance,
                              const std::filesystem::path& base) {
  Fingerprint f;
  f.add(model.name);
  auto spectra = spectraOf(model.parameters, record, spectrum);
  for (const Parameter& p : model.parameters) {
    f.add(p.key).add(record.has(p.key));
    if (!record.has(p.key)) continue;
    if (p.type == ParameterType::Spectrum) addTo(f, spectra.at(p.key));
    else addTo(f, record.value(p.key));
  }
  return [&model, &record, spectrum, substance, base, spectra = std::move(spectra), f = std::move(f)](double state) {
    const ComponentRecord own{{record, spectra}, state, spectrum, substance, base};
    MadeReflection made;
    if (model.makeAll) made = model.makeAll(own);
    else made.components.push_back(model.make(own));
    Fingerprint whole = f;
    whole.add(state).add(made.within.bytes());
    for (const auto& component : made.components) component->setFingerprint(whole.add("component").bytes());
    return made;
  };
}

}  // namespace pitviper

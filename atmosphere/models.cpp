#include "atmosphere/models.hpp"

#include <algorithm>

#include "atmosphere/homogeneous.hpp"

namespace pitviper {
namespace {

bool has(const AirModel& m, const std::string& key) {
  return std::any_of(m.parameters.begin(), m.parameters.end(), [&](const Parameter& p) { return p.key == key; });
}

std::vector<std::string> allMarks() {
  std::vector<std::string> all;
  for (const AirModel& m : airModels().all()) all.insert(all.end(), m.marks.begin(), m.marks.end());
  return all;
}

std::vector<Parameter> common() {
  std::vector<std::string> names{"none", "air"};
  for (const AirModel& m : airModels().all()) names.push_back(m.name);
  return {withDefault(choice("model", names, "none: whatever else is given, there is no air; air: as its other keys say"), "air"),
          text("library", "named air, atmosphere/library/<name>.yaml: its keys hold where they are not given here")};
}

/// The only model with a mark among the keys.
const AirModel& onlyMarkedModel(const Value& air) {
  const auto marks = marksOf(air);
  if (marks.empty())
    throw UserError(air.where, "air that does not say which", "'library', 'model', or one of " + listed(allMarks()),
                    "add 'library: hazy_us76' or 'extinction: 0.2 /km'");
  for (const AirMark& m : marks)
    if (m.model != marks.front().model)
      throw UserError(air.find(m.key)->where, "the air is given twice, by '" + marks.front().key + "' and by '" + m.key + "'", "one of " + listed(allMarks()),
                      "remove one");
  return *marks.front().model;
}

}  // namespace

Registry<AirModel>& airModels() {
  static Registry<AirModel> all("air", {homogeneousModel(), layeredModel(), tape7Model(), csvModel(), columnsModel()});
  return all;
}

ParameterTable commonAirTable() {
  return {"atmosphere", "The air: `none`, the name of a library air, or a map with these keys and those of one of the airs below.", common()};
}

ParameterTable airTable(const AirModel& model) {
  ParameterTable t{"atmosphere: " + model.name, model.description, common()};
  t.parameters.insert(t.parameters.end(), model.parameters.begin(), model.parameters.end());
  return t;
}

ParameterTable anyAirTable() {
  ParameterTable t{"atmosphere", "", common()};
  for (const AirModel& m : airModels().all())
    for (const Parameter& p : m.parameters)
      if (!t.find(p.key)) t.parameters.push_back(any(p.key, p.description));
  return t;
}

namespace {

/// Errors: UserError where a key is of another model.
void refuseForeignKeys(const Value& air, const AirModel& model) {
  for (size_t i = 0; i < air.entries.size(); ++i) {
    const std::string& key = air.entries[i].first;
    if (key == "model" || key == "library" || has(model, key)) continue;
    std::vector<std::string> owners;
    for (const AirModel& m : airModels().all())
      if (has(m, key)) owners.push_back(m.name);
    throw UserError(air.entries[i].second.where, "'" + key + "' is of " + listed(owners, " or ") + " air, and this air is " + model.name,
                    "the keys of 'atmosphere: " + model.name + "'", "remove '" + key + "'");
  }
}

}  // namespace

std::vector<AirMark> marksOf(const Value& air) {
  std::vector<AirMark> marks;
  for (const AirModel& m : airModels().all())
    for (const std::string& own : m.marks)
      if (air.find(own)) marks.push_back({own, &m});
  return marks;
}

std::shared_ptr<const Atmosphere> makeAir(const Value& air, const std::filesystem::path& folder, const std::filesystem::path& library, double ground_m,
                                          const SpectrumOf& spectrum) {
  const ParameterTable all = anyAirTable();
  const std::string asked = Record(air, all).text("model");
  if (asked == "none") return makeNoAir();
  const AirModel& model = asked == "air" ? onlyMarkedModel(air) : *airModels().named(asked);
  refuseForeignKeys(air, model);
  const ParameterTable table = airTable(model);
  const Record record(air, table);
  const auto spectra = spectraOf(model.parameters, record, spectrum);
  return model.make({{record, spectra}, folder, library, ground_m});
}

}  // namespace pitviper

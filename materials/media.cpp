#include "materials/media.hpp"

#include "sim/parameters/asked_model.hpp"

namespace pitviper {
namespace {

/// Everything that absorbs and does not scatter, its spectra given.
MediumModel gasModel() {
  return {"gas",
          "Fills a closed body: gas, smoke. Its temperature is the entity's.",
          {required(within(spectrum("absorption", "1/m", "absorption coefficient; optical depth is its product with the path length inside the body"), 0, 1e9)),
           atLeast(spectrum("radiance", "W/(m2 sr um)", "further radiance at great depth, for instance scattered sunlight"), 0)},
          [](const ModelRecord& r) {
            Medium medium{r.spectrum("absorption"), {}};
            if (r.spectra.contains("radiance")) medium.radiance = r.spectrum("radiance");
            return medium;
          }};
}

}  // namespace

Registry<MediumModel>& mediumModels() {
  static Registry<MediumModel> all("medium", {gasModel()});
  return all;
}

const MediumModel* askedMedium(const Value& material) {
  if (material.find("medium")) return &askedModel(mediumModels(), material, "medium");
  return material.find("absorption") ? mediumModels().named("gas") : nullptr;
}

}  // namespace pitviper

#include "sim/plan/plan_origin.hpp"

#include "sim/model/scene_fingerprint.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/scene/laws_digest.hpp"

namespace pitviper {
namespace {

constexpr const char* kBegin = "# plan ";

std::string percent(double accuracy) { return accuracy > 0.0 ? print("%.6g %%", 100.0 * accuracy) : "none"; }

}  // namespace

PlanOrigin originOf(const Simulation& sim, const Camera& camera) {
  PlanOrigin o;
  o.laws = lawsDigest();
  Camera own = camera;
  own.learnt.clear();
  own.spectral.accuracy = 0.0;
  o.scene = contentKeyOf([&](Fingerprint& f) { addTo(f, sim); });
  o.eye = contentKeyOf([&](Fingerprint& f) { addTo(f, own); });
  o.accuracy = camera.spectral.accuracy;
  o.samples = camera.samples;
  o.sharesShading = camera.sharesShading;
  o.camera = camera.name;
  return o;
}

std::string originLine(const PlanOrigin& o) {
  return kBegin + o.laws + " scene " + digitsOf(o.scene) + " eye " + digitsOf(o.eye) +
         print(" accuracy %a samples %d shared %d", o.accuracy, o.samples, o.sharesShading ? 1 : 0) + " of camera " + o.camera + "\n";
}

std::optional<PlanOrigin> readOrigin(const std::string& text) {
  for (size_t from = 0; from < text.size() && text[from] == '#';) {
    const size_t end = text.find('\n', from);
    if (end == std::string::npos) return std::nullopt;
    const std::string line = text.substr(from, end - from);
    from = end + 1;
    PlanOrigin o;
    unsigned long long key[4];
    char laws[17] = {};
    int shared = 0, name = 0;
    if (std::sscanf(line.c_str(), "# plan %16[0-9a-f] scene %16llx%16llx eye %16llx%16llx accuracy %la samples %d shared %d of camera %n", laws, &key[0],
                    &key[1], &key[2], &key[3], &o.accuracy, &o.samples, &shared, &name) != 8 ||
        name == 0)
      continue;
    // A camera takes no others.
    if (!(o.accuracy >= 0.0 && o.accuracy < 1.0) || o.samples < 1 || o.samples > 16) return std::nullopt;
    o.laws = laws;
    o.scene = {key[0], key[1]};
    o.eye = {key[2], key[3]};
    o.sharesShading = shared != 0;
    o.camera = line.substr(static_cast<size_t>(name));
    return o;
  }
  return std::nullopt;
}

std::string withoutOrigin(const std::string& text) {
  size_t from = 0;
  while (from < text.size() && text[from] == '#') {
    const size_t end = text.find('\n', from);
    if (end == std::string::npos) return {};
    from = end + 1;
  }
  return text.substr(from);
}

void refuseForeignPlan(const Simulation& sim, const Camera& camera) {
  const Location where{camera.planFile, 0, 0, -1};
  const std::string remedy = "leave --plan out, or name the .plan file of a run of this scenario as it is";
  const auto given = readOrigin(camera.plan);
  const PlanOrigin own = originOf(sim, camera);
  const std::string expected = "the plan that a run of this scenario wrote for camera '" + camera.name + "', whole";
  if (!given) throw UserError(where, "not a plan, or not one that says what it was made for", expected, remedy);
  if (given->laws != own.laws) throw UserError(where, "a plan of another version of this program", expected, remedy);
  if (given->scene != own.scene)
    throw UserError(where, "a plan of another scenario, or of this one before something in it was changed (bodies, materials, air, lights, times)", expected,
                    remedy);
  if (given->eye != own.eye)
    throw UserError(where,
                    "a plan of a camera '" + given->camera.substr(0, 60) + "' that is another, or had another film, optics, place, channels or subpixels",
                    expected, remedy);
  if (given->accuracy != own.accuracy)
    throw UserError(where, "a plan for an accuracy of " + percent(given->accuracy) + "; " + percent(own.accuracy) + " is asked for", expected, remedy);
}

Camera plannedCamera(const Camera& reference) {
  Camera planned = reference;
  planned.spectral.reference = false;
  return planned;
}

void drawOnLinesOf(Camera& c, const PlanOrigin& origin) {
  c.spectral.accuracy = c.outlineAccuracy = c.textureAccuracy = origin.accuracy;
  c.samples = origin.samples;
  c.sharesShading = false;
}

}  // namespace pitviper

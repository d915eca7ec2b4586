// pitviper material: what a named surface or substance is, in words, tables, charts and a picture; spectra and optical constants of others as YAML.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scenarios/commands/charts.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/surroundings_loss.hpp"
#include "scenarios/import/material_import.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/camera/camera_renderer.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/frame/make_frame.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kViews_deg[] = {0.0, 45.0, 75.0, 85.0};
constexpr double kTable_um[] = {0.35, 0.45, 0.55, 0.65, 0.9, 1.06, 1.6, 2.2, 3.5, 4.0, 4.6, 8.0, 9.5, 10.6, 12.0, 14.0, 20.0};

/// As YAML.
std::string asYaml(const std::string& text) {
  std::string out = "'";
  for (char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

/// A material as a scenario names it.
struct Named {
  std::string name;
  std::string materials = {};         ///< what the scenario has to say of it
  std::string temperature = "320 K";  ///< at which it is known
  std::string description = {};
};

/// A sphere of the material on its own: under a sun and a dome of daylight for an eye where it has data there, else as hot as a body that radiates most in
/// the middle of its infrared.
std::string sceneOf(const Named& own, bool eye, double low_um, double high_um) {
  std::string scene = "accuracy: 1 %\n" + own.materials;
  if (eye)
    scene +=
        "sun: {azimuth: 60 deg, elevation: 40 deg, irradiance: {product: [\"0.4 W/(m2 um)\", cie_d65]}}\n"
        "ambient: {radiance: {product: [\"0.3 W/(m2 sr um)\", cie_d65]}}\nbackground: {radiance: {product: [\"0.03 W/(m2 sr um)\", cie_d65]}}\n";
  else scene += "ambient: {temperature: 280 K}\nbackground: {temperature: 250 K}\n";
  scene += "entities: [{name: s, shape: {model: sphere, radius: 1 m}, material: " + asYaml(own.name) + ", temperature: " + own.temperature +
           "}]\ncameras: [{name: sphere, film: {width: 256, height: 256}, field_of_view: 12.5 deg, aperture: 5 mm, position: [10 m, 0 m, 0 m], look_at: s, ";
  return scene + (eye ? "eye: true}]\n" : print("channels: [{name: ir, response: {band: [%.6g um, %.6g um]}}]}]\n", low_um, high_um));
}

/// Under a sky by day.
std::string lossOf(const Named& own, const Material& m, const Libraries& libraries) {
  const double low = std::max(m.validLow_um(), 0.41), high = std::min(m.validHigh_um(), 14.0);
  if (!(high > low)) return "";
  const std::string scene =
      own.materials +
      "atmosphere: clear_us76\nsun: {azimuth: 200 deg, elevation: 40 deg, temperature: 5772 K}\nambient: {from: sky}\n"
      "ground: {material: soil, temperature: 295 K}\nentities: [{name: s, shape: {model: sphere, radius: 1 m}, material: " +
      asYaml(own.name) + ", temperature: " + own.temperature +
      "}]\ncameras: [{name: c, film: {width: 4, height: 4}, field_of_view: 1 deg, aperture: 5 mm, position: [10 m, 0 m, 0 m], look_at: s, " +
      print("channels: [{name: c, response: {band: [%.6g um, %.6g um]}}]}]\n", low, high);
  return surroundingsLoss(readScenarioText(scene, "material " + own.name, ".", {}, libraries));
}

struct Shown {
  Simulation simulation;
  std::shared_ptr<const Material> material;
  bool eye = false;
};

Shown shown(const Named& own, const Libraries& libraries) {
  const auto made = [&](bool eye, double low, double high) {
    Shown s{readScenarioText(sceneOf(own, eye, low, high), "material " + own.name, ".", {}, libraries), nullptr, eye};
    s.material = s.simulation.materials[static_cast<size_t>(s.simulation.entities[0].surfaces[0].material)];
    return s;
  };
  // Its range says what it can be seen in: any band it surely has, to find out.
  std::string why;
  for (const auto& [low, high] : {std::pair{3.0, 3.01}, std::pair{1.0, 1.01}, std::pair{0.6, 0.61}, std::pair{10.0, 10.01}}) {
    try {
      const Shown first = made(false, low, high);
      const double from = first.material->validLow_um(), to = first.material->validHigh_um();
      // All that the observer's functions span.
      if (from <= 0.3601 && to >= 0.8303) return made(true, 0, 0);
      const double begin = std::max(from, 3.0), end = std::min(to, 5.0);
      return begin < end ? made(false, begin, end) : made(false, from, std::min(to, 1.2 * from));
    } catch (const UserError& e) {
      why = e.what();
      if (why.find("has no data for channel") == std::string::npos) throw;
    }
  }
  throw UserError({}, "the material '" + own.name + "' has no data between 0.6 and 10 um", "a surface with data there", why);
}

std::string describe(const Material& m, const std::string& description) {
  std::string out = description.empty() ? "" : description + "\n";
  if (!m.provenance.empty()) out += "source: " + m.provenance + "\n";
  for (const std::string& note : m.notes) out += "note: " + note + "\n";
  out += print("%.4g to %.4g um; %zu component%s", m.validLow_um(), m.validHigh_um(), m.reflections.size(), m.reflections.size() == 1 ? "" : "s");
  const char* before = ": ";
  for (size_t k = 0; k < m.reflections.size();) {
    const auto told = [](const ReflectionComponent& r) {
      const auto axes = r.axes();
      const int entries = axes[0].count * axes[1].count;
      return (r.lobe().function.empty() ? std::string("no lobe") : r.lobe().function) +
             (entries > 1 ? print(" x a table of %d angles", entries) : std::string()) +
             (r.angleError() > 0.0 ? print(" (linear between them, off by %.2g at most)", r.angleError()) : std::string());
    };
    const std::string own = told(*m.reflections[k]);
    size_t alike = 1;
    while (k + alike < m.reflections.size() && told(*m.reflections[k + alike]) == own) ++alike;
    out += before + (alike > 1 ? print("%zu of ", alike) : std::string()) + own;
    before = ", ";
    k += alike;
  }
  out += "\n\n| wavelength [um] | reflectance at 0 deg | 45 | 75 | 85 | emissivity at 0 deg | 45 | 75 | 85 |";
  out += m.transmission ? " transmittance at 0 deg | 45 | 75 | 85 |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n"
                        : "\n|---|---|---|---|---|---|---|---|---|\n";
  for (double w : kTable_um) {
    if (w < m.validLow_um() || w > m.validHigh_um()) continue;
    out += print("| %.4g |", w);
    for (double v : kViews_deg) out += print(" %.4f |", m.reflectance(w, v * kDegree));
    for (double v : kViews_deg) out += print(" %.4f |", m.emissivity(w, v * kDegree));
    for (double v : kViews_deg)
      if (m.transmission) out += print(" %.4f |", m.transmittance(w, v * kDegree));
    out += "\n";
  }
  return out;
}

/// Of one that changes with temperature: what it emits, at each.
std::string byTemperature(const Material& m) {
  if (!m.states || m.states->texture >= 0) return "";
  const auto& entries = m.states->entries;
  std::string out = "\nWhat it emits along its normal changes with its temperature; above is the first.\n| wavelength [um] |", rule = "\n|---|";
  for (size_t k = 0; k < entries.size(); ++k) {
    out += print(" %.4g K |", m.states->low + (m.states->high - m.states->low) * static_cast<double>(k) / static_cast<double>(entries.size() - 1));
    rule += "---|";
  }
  out += rule + "\n";
  for (double w : kTable_um) {
    if (w < m.validLow_um() || w > m.validHigh_um()) continue;
    out += print("| %.4g |", w);
    for (const auto& entry : entries) out += print(" %.4f |", entry->emissivity(w, 0.0));
    out += "\n";
  }
  return out;
}

std::vector<Chart> chartsOf(const Material& m, const std::string& name) {
  const double low = std::max(m.validLow_um(), 0.3), high = std::min(m.validHigh_um(), 30.0);
  constexpr int kPoints = 800;
  Chart spectra{name + ": spectra at normal view", "wavelength [um]", "", true, false, true, {}, {}, {}};
  spectra.series = {{"reflectance", {}, {}}, {"emissivity", {}, {}}};
  if (m.transmission) spectra.series.push_back({"transmittance", {}, {}});
  for (int i = 0; i <= kPoints; ++i) {
    const double w = std::clamp(low * std::pow(high / low, i / double(kPoints)), low, high);
    const double values[] = {m.reflectance(w, 0.0), m.emissivity(w, 0.0), m.transmittance(w, 0.0)};
    for (size_t k = 0; k < spectra.series.size(); ++k) spectra.series[k].x.push_back(w), spectra.series[k].y.push_back(values[k]);
  }
  Chart views{name + ": emissivity by view angle", "view angle [deg]", "emissivity", false, false, true, {}, {}, {}};
  Chart lobes{name + ": light from 45 deg", "view angle in its plane [deg]", "BRDF [1/sr]", false, true, false, {}, {}, {}};
  const glm::dvec3 light(-std::sin(45.0 * kDegree), 0.0, std::cos(45.0 * kDegree));
  for (double w : {0.55, 1.6, 4.0, 10.0}) {
    if (w < m.validLow_um() || w > m.validHigh_um()) continue;
    Series byView{print("%.3g um", w), {}, {}}, byLobe = byView;
    for (int i = 0; i <= 178; ++i) byView.x.push_back(0.5 * i), byView.y.push_back(m.emissivity(w, 0.5 * i * kDegree));
    for (int i = -356; i <= 356; ++i) {
      const double v = 0.25 * i * kDegree;
      double f = 0.0;
      for (const auto& r : m.reflections) f += r->brdf(w, light, {std::sin(v), 0.0, std::cos(v)});
      byLobe.x.push_back(0.25 * i), byLobe.y.push_back(f);
    }
    views.series.push_back(byView);
    lobes.series.push_back(byLobe);
  }
  return {spectra, views, lobes};
}

void draw(const Shown& s, const std::string& name, const std::filesystem::path& out) {
  const GlContext context;
  const auto scene = std::make_shared<const GpuScene>(s.simulation);
  CameraRenderer renderer(s.simulation, s.simulation.cameras[0], cameraPlan(s.simulation, s.simulation.cameras[0]), shaderLibrary(), scene);
  const WorldState state = advance(s.simulation, 0.0);
  const Frame frame = makeFrame(s.simulation, s.simulation.cameras[0], renderer.render(state), state, 0, nullptr);
  writePreviewFile(out / (name + "_sphere.png"), frame);
}

std::string descriptionOf(const std::filesystem::path& file) {
  const Value tree = loadYaml(file, {file.string(), 0, 0, -1});
  const Value* text = tree.find("description");
  return text ? text->text : "";
}

/// Of a material's file.
Named namedOf(const std::filesystem::path& file) {
  Named own;
  own.name = file.stem().string();
  own.description = descriptionOf(file);
  const Value tree = loadYaml(file, {file.string(), 0, 0, -1});
  const Value* states = tree.find("temperatures");
  if (states && !states->items.empty())
    if (const Value* first = states->items.front().find("temperature")) own.temperature = first->text;
  return own;
}

void list(const Libraries& libraries) {
  for (const auto& [title, folder] :
       {std::pair{"materials", libraries.materials}, std::pair{"substances (what 'index:' names)", libraries.materials.parent_path() / "substances"}}) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::printf("%s:\n", title);
    for (const auto& file : files) {
      std::printf("  %-28s %s\n", file.stem().string().c_str(), descriptionOf(file).c_str());
    }
  }
}

struct MaterialWish {
  std::string out;
  ImportChoices choices;  ///< what is said of a spectrum where its file does not
};

int show(const MaterialWish& w, const std::string& word) {
  const Libraries libraries = findLibraries();
  const std::filesystem::path file = word;
  std::error_code ignored;
  Named own{word};
  if (std::filesystem::is_regular_file(file, ignored)) {
    if (const auto imported = importedMaterial(file, w.choices)) {
      if (!w.out.empty())
        throw UserError({"--out", 0, 0, -1}, "charts of a file of others", "one of this project's",
                        "keep what 'pitviper material " + word + "' prints in a file, and show that");
      for (const std::string& note : imported->notes) std::fprintf(stderr, "%s: note: %s\n", file.string().c_str(), note.c_str());
      std::printf("%s", imported->yaml.c_str());
      return 0;
    }
    own = namedOf(file);
    own.materials = "materials: {" + asYaml(own.name) + ": {file: " + asYaml(std::filesystem::absolute(file).string()) + "}}\n";
  } else if (const ImportChoices& c = w.choices; c.axis || c.scale || c.quantity || c.column || !c.wavelengths.empty()) {
    throw UserError({word, 0, 0, -1}, "there is no such file", "the file of a spectrum", "check the name");
  } else if (const auto known = libraries.materials / (word + ".yaml"); std::filesystem::is_regular_file(known, ignored)) {
    own = namedOf(known);
  } else if (const auto substance = libraries.materials.parent_path() / "substances" / (word + ".yaml"); std::filesystem::is_regular_file(substance, ignored)) {
    own.name = word + "_facets";
    own.materials = "materials: {" + own.name + ": {components: [{reflection: microfacet, index: " + word + ", roughness: 0.05}]}}\n";
    own.description = descriptionOf(substance) + "; as facets of roughness 0.05";
  }
  const Shown s = shown(own, libraries);
  if (s.material->medium) throw UserError({}, "'" + own.name + "' is a medium", "a surface", "'check' of a scenario shows what media do");
  std::printf("%s: %s", own.name.c_str(), describe(*s.material, own.description).c_str());
  std::printf("%s", byTemperature(*s.material).c_str());
  std::printf("%s", lossOf(own, *s.material, libraries).c_str());
  if (w.out.empty()) return 0;
  const std::filesystem::path out = w.out;
  ensureWritableFolder(out);
  drawCharts(chartsOf(*s.material, own.name), 3, out / (own.name + ".png"));
  draw(s, own.name, out);
  std::printf("\n%s and %s written\n", (out / (own.name + ".png")).string().c_str(), (out / (own.name + "_sphere.png")).string().c_str());
  return 0;
}

}  // namespace

CommandLine materialCommand() {
  const auto w = std::make_shared<MaterialWish>();
  ImportChoices& c = w->choices;
  const std::string own = "NAME|FILE";
  return {
      {"material", "[NAME|FILE]", "what a surface or a substance of the library, or of a file, is: tables, charts, a sphere of it"},
      "Without an argument: the library's materials and substances. NAME: one of them; FILE.yaml: a material of your own (what stands below its name under "
      "'materials:'). Prints reflectance, emissivity and transmittance by wavelength and view angle.\n"
      "FILE of others: refractiveindex.info's YAML, or a spectrum in columns (ECOSTRESS, the USGS's libraries 6 and 7, field and Fourier spectrometers' text, "
      "JCAMP-DX): prints it as a substance or a material, to be kept in a file of its own, and says on the standard error what it changed or took for granted. "
      "What the words above a spectrum's numbers leave open is refused; these say it, and count before those words:",
      {{"--axis", "UNIT", "of the wavelengths: wavenumbers and photon energies too",
        oneOf(c.axis, {{"um", SpectralAxis::Micrometre},
                       {"nm", SpectralAxis::Nanometre},
                       {"angstrom", SpectralAxis::Angstrom},
                       {"1/cm", SpectralAxis::PerCentimetre},
                       {"cm-1", SpectralAxis::PerCentimetre},
                       {"eV", SpectralAxis::ElectronVolt}}),
        own},
       {"--unit", "UNIT", "of the values: per cent, or shares of 1", oneOf(c.scale, {{"%", 0.01}, {"1", 1.0}}), own},
       {"--quantity", "WHAT", "emissivity: of an opaque surface, 1 - reflectance",
        oneOf(
            c.quantity,
            {{"reflectance", SpectrumQuantity::Reflectance}, {"transmittance", SpectrumQuantity::Transmittance}, {"emissivity", SpectrumQuantity::Emissivity}}),
        own},
       {"--column", "N", "the column of the values, counted from 1", number(c.column, {1, 100000}), own},
       {"--wavelengths", "FILE", "the wavelengths of a file with one column, as the USGS's library 7 keeps them", into(c.wavelengths), own},
       {"--out", "FOLDER",
        "also NAME.png, charts of spectra, emissivity by angle and reflection of light from 45 degrees (needs VTK), and NAME_sphere.png, a sphere of it under "
        "a sun and a dome of daylight as an eye sees it (of materials without data there: at 320 K in the infrared), in FOLDER; created if missing",
        into(w->out), own}},
      [w](const Arguments& words) {
        if (!words.empty()) return show(*w, words[0]);
        list(findLibraries());
        return 0;
      }};
}

}  // namespace pitviper

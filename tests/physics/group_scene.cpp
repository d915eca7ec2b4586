#include "tests/physics/group_scene.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>

#include "atmosphere/absorber_table.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

constexpr double kEarth_m = 6371230.0;
constexpr const char* kSurfaces[] = {"olive_gloss_paint", "grey_aircraft_paint", "green_grass", "sand", "soil", "snow", "calm_sea", "concrete"};
constexpr const char* kGases[] = {"afterburner_plume", "jet_exhaust"};

const AbsorberTable& air() {
  static const AbsorberTable table = AbsorberTable::read(std::filesystem::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air");
  return table;
}

/// Water under a broad Phong lobe: what these counts of groups were found with. The library's sea, by Fresnel, takes 44 where this takes 36.
constexpr const char* kCalmSea = R"(materials:
  calm_sea:
    components:
      - reflection: phong
        exponent: 30
        reflectance:
          wavelength: um
          unit: "1"
          outside: error
          values:
            [[0.3, 0.02171], [0.4, 0.021], [0.55, 0.02044], [0.7, 0.02006], [1, 0.01963], [1.5, 0.01888], [2, 0.01756],
             [2.4, 0.01531], [2.6, 0.01196], [2.7, 0.007844], [2.8, 0.00883], [2.9, 0.02254], [3, 0.03637], [3.1, 0.04073],
             [3.2, 0.037], [3.4, 0.03063], [3.6, 0.02626], [3.8, 0.02357], [4.1, 0.02183], [4.4, 0.02061], [4.7, 0.0201],
             [5, 0.01938], [5.4, 0.01741], [5.8, 0.0146], [6, 0.01546], [6.1, 0.02241], [6.3, 0.02246], [6.8, 0.01959],
             [7.5, 0.01764], [8.2, 0.0158], [9, 0.01347], [10, 0.01081], [10.5, 0.00826], [11, 0.007377], [11.5, 0.008395],
             [12, 0.014], [13, 0.02429], [14, 0.03562], [15, 0.044]]
      - reflection: lambertian
        reflectance:
          wavelength: um
          unit: "1"
          outside: error
          values:
            [[0.3, 0.008], [0.4, 0.015], [0.45, 0.02], [0.5, 0.02], [0.55, 0.012], [0.6, 0.005], [0.7, 0.002], [0.8, 0],
             [15, 0]]
)";

const Simulation& library() {
  static const Simulation sim = [] {
    std::string yaml = std::string(kCalmSea) + "entities: [";
    for (const char* name : kSurfaces)
      yaml += "{name: e_" + std::string(name) + ", shape: {model: plate, width: 1 m, height: 1 m}, material: " + name + ", temperature: 300 K}, ";
    for (const char* name : kGases)
      yaml += "{name: e_" + std::string(name) + ", shape: {model: sphere, radius: 1 m}, material: " + name + ", temperature: 900 K}, ";
    return scene(yaml +
                 "]\ncameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 2 deg, aperture: 20 mm, heading: 0 deg, channels: "
                 "[{name: a, response: {band: [3 um, 5 um]}}]}]\n");
  }();
  return sim;
}

const Material& material(const std::string& name) {
  for (const auto& m : library().materials)
    if (m->name == name) return *m;
  throw std::runtime_error("no material " + name);
}

/// A generator whose results do not depend on the standard library.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0); }
  double byFactor(double low, double high) { return std::exp((*this)(std::log(low), std::log(high))); }
  int below(int count) { return static_cast<int>((*this)(0.0, count)); }

 private:
  std::mt19937 engine_;
};

/// A paint with bands of 2 to 10 % of their wavelength: one or two deep ones, flat-topped with sloping sides.
std::vector<double> bandedPaint(const std::vector<double>& wavelength_um, Random& random) {
  const double low = wavelength_um.front(), high = wavelength_um.back();
  std::vector<double> value(wavelength_um.size(), random(0.1, 0.9));
  for (int bands = 1 + random.below(3); bands > 0; --bands) {
    const double centre = random(low, high), half = 0.5 * random(0.02, 0.1) * centre, level = random(0.03, 0.97);
    for (size_t i = 0; i < value.size(); ++i) {
      const double inside = std::clamp(2.0 * (1.0 - std::abs(wavelength_um[i] - centre) / half), 0.0, 1.0);
      value[i] += inside * (level - value[i]);
    }
  }
  return value;
}

/// Builds one problem; the grid, the columns and the surfaces are the scene's, the rest is drawn.
class Draw {
 public:
  Draw(const GroupScene& scene, const ProductDraw& draw) : scene_(scene), draw_(draw), random_(draw.seed) {
    makeGrid();
    makeSurfaces();
    for (int t = 0; t < (draw.fresh ? 47 : 14); ++t)
      temperature_K_.push_back(220.0 * std::pow(1200.0 / 220.0, (t + 0.5 * draw.fresh) / (draw.fresh ? 47.0 : 13.0)));
    for (int t = 0; t < (draw.fresh ? 29 : 8); ++t) gas_K_.push_back(600.0 * std::pow(2300.0 / 600.0, (t + 0.5 * draw.fresh) / (draw.fresh ? 29.0 : 7.0)));
  }

  SpectralProblem make() {
    clear_ = addPath({}, 0.0, 0.0);
    while (static_cast<int>(problem_.products.size()) < draw_.products) addProducts();
    problem_.products.resize(static_cast<size_t>(draw_.products));
    return std::move(problem_);
  }

 private:
  using Spectrum_ = std::vector<double>;

  void makeGrid() {
    const double low = std::ceil(1e4 / scene_.high_um / scene_.step_per_cm) * scene_.step_per_cm, high = 1e4 / scene_.low_um;
    for (double nu = low; nu <= high; nu += scene_.step_per_cm) {
      problem_.wavelength_um.push_back(1e4 / nu);
      problem_.weight.push_back(1e4 * scene_.step_per_cm / (nu * nu));
    }
    std::reverse(problem_.wavelength_um.begin(), problem_.wavelength_um.end());
    std::reverse(problem_.weight.begin(), problem_.weight.end());
    for (size_t k = 0; k < air().absorbers().size(); ++k) problem_.extinction.push_back(spectrum([k](double um) { return air().coefficients(um)[k]; }));
    if (scene_.band == SceneBand::MidwavePlume)
      for (const char* gas : kGases) problem_.extinction.push_back(spectrum([&m = *material(gas).medium](double um) { return m.absorption_per_m(um); }));
  }

  template <class F>
  Spectrum_ spectrum(const F& f) const {
    Spectrum_ s;
    for (double um : problem_.wavelength_um) s.push_back(f(um));
    return s;
  }

  // Emissivities: the library's paints and grounds and 14 banded ones, the same for every draw; fresh ones are mixtures of two.
  void makeSurfaces() {
    Random fixed(77);
    for (const char* name : kSurfaces) emissivity_.push_back(spectrum([&m = material(name)](double um) { return m.emissivity(um, 0.0); }));
    for (int j = 0; j < 14; ++j) emissivity_.push_back(bandedPaint(problem_.wavelength_um, fixed));
    if (!draw_.fresh) return;
    std::vector<Spectrum_> mixtures;
    for (int j = 0; j < 60; ++j) {
      const auto &a = emissivity_[static_cast<size_t>(random_.below(22))], &b = emissivity_[static_cast<size_t>(random_.below(22))];
      const double part = random_(0.0, 1.0);
      mixtures.push_back(a);
      for (size_t i = 0; i < a.size(); ++i) mixtures.back()[i] += part * (b[i] - a[i]);
    }
    emissivity_ = mixtures;
  }

  int addPath(const AbsorberAmounts& w, double plume_m, double jet_m) {
    std::vector<double> u;
    for (size_t k = 0; k < air().absorbers().size(); ++k) u.push_back(w.amount_km[k] > 0.0 ? std::pow(w.amount_km[k], air().absorbers()[k].exponent) : 0.0);
    if (scene_.band == SceneBand::MidwavePlume) u.insert(u.end(), {plume_m, jet_m});
    problem_.paths.push_back(std::move(u));
    return static_cast<int>(problem_.paths.size()) - 1;
  }

  /// One spectrum per kind, surface and temperature, made when first asked for. surface -1: black; sun: temperature 5772 K.
  int source(bool reflected, int surface, double temperature_K) {
    const auto [at, isNew] = sources_.try_emplace({reflected, surface, temperature_K}, static_cast<int>(problem_.spectra.size()));
    if (isNew) {
      Spectrum_ s = spectrum([&](double um) { return physics::planckRadiance(um, temperature_K); });
      for (size_t i = 0; i < s.size() && surface >= 0; ++i) {
        const double e = emissivity_[static_cast<size_t>(surface)][i];
        s[i] *= reflected ? 1.0 - e : e;
      }
      double whole = 0.0;
      for (size_t i = 0; i < s.size(); ++i) whole += s[i] * problem_.weight[i];
      problem_.spectra.push_back(std::move(s));
      whole_.push_back(whole);
    }
    return at->second;
  }

  void add(std::vector<ProductTerm> terms) {
    double most = 0.0;
    for (const ProductTerm& t : terms) most = std::max(most, std::abs(t.coefficient) * whole_[static_cast<size_t>(t.spectrum[0])]);
    problem_.products.push_back({std::move(terms), 1e-4 * most});
  }

  // What is planned for has its ends drawn with some weight: they are where an unseen one would be worst.
  static double atEnds(double value, double low, double high) { return std::clamp(value, low, high); }

  // One line of sight, level or slanting, and what may be at its end.
  void addProducts() {
    const double height_m = random_(0.0, 1.0) < 0.4 ? 0.0
                            : draw_.fresh           ? random_(0.0, 10000.0)
                                                    : atEnds(random_(0.0, 11000.0), 0.0, 10000.0),
                 range_m = draw_.fresh ? random_.byFactor(20.0, 20000.0) : atEnds(random_.byFactor(15.0, 26000.0), 20.0, 20000.0);
    const double least = std::max(-1.0, -height_m / range_m), most = std::min(1.0, (10000.0 - height_m) / range_m);
    const double sine = random_(0.0, 1.0) < 0.5 ? std::clamp(0.0, least, most)
                        : draw_.fresh           ? random_(least, most)
                                                : atEnds(least + random_(-0.15, 1.15) * (most - least), least, most);
    const AbsorberAmounts w = air().amounts(height_m, sine, range_m, kEarth_m);
    const int path = addPath(w, 0.0, 0.0), surface = random_.below(static_cast<int>(emissivity_.size()));
    const double end_m = std::clamp(height_m + sine * range_m, 0.0, 10000.0);
    if (scene_.band == SceneBand::Shortwave) {
      // Warm enough to be seen there at all.
      add({{{source(false, surface, std::max(pick(temperature_K_), 600.0))}, 1, path, 1.0}});
      add({{{source(true, surface, 2400.0)}, 1, path, 1.0}});
    } else {
      add({{{source(false, surface, pick(temperature_K_))}, 1, path, 1.0}});
      add({{{source(true, surface, std::min(pick(temperature_K_), 320.0))}, 1, path, 1.0}});
      if (random_(0.0, 1.0) < 0.25) addPathRadiance(height_m, sine, range_m);
    }
    if (scene_.band != SceneBand::Longwave) {
      const AbsorberAmounts sun = air().amounts(end_m, draw_.fresh ? random_(0.2, 1.0) : atEnds(random_(0.1, 1.05), 0.2, 1.0), INFINITY, kEarth_m);
      add({{{source(true, random_.below(static_cast<int>(emissivity_.size())), 5772.0)}, 1, addPath(w + sun, 0.0, 0.0), 1.0}});
    }
    if (scene_.band == SceneBand::MidwavePlume) {
      const bool burning = random_(0.0, 1.0) < 0.5;
      const double thickness_m = draw_.fresh ? random_.byFactor(0.05, 10.0) : atEnds(random_.byFactor(0.04, 16.0), 0.05, 10.0);
      const int through = addPath(w, burning ? thickness_m : 0.0, burning ? 0.0 : thickness_m), gas = source(false, -1, pick(gas_K_));
      add({{{gas}, 1, path, 1.0}, {{gas}, 1, through, -1.0}});
      add({{{source(false, surface, pick(temperature_K_))}, 1, through, 1.0}});
    }
  }

  // Sum of B at the middle of each stretch times what it adds to the opacity.
  void addPathRadiance(double height_m, double sine, double range_m) {
    std::vector<ProductTerm> terms;
    int before = clear_;
    AbsorberAmounts amounts;
    constexpr int kStretches = 6;
    for (int j = 1; j <= kStretches; ++j) {
      const auto at = [&](double part) { return part * part * range_m; };
      const int here = addPath(air().amounts(height_m, sine, at(static_cast<double>(j) / kStretches), kEarth_m), 0.0, 0.0);
      const double middle_m = 0.5 * (at(static_cast<double>(j) / kStretches) + at(static_cast<double>(j - 1) / kStretches));
      const double step_K = draw_.fresh ? 3.0 : 8.0;
      const int b = source(false, -1, step_K * std::round(air().temperature_K(std::clamp(height_m + sine * middle_m, 0.0, 10000.0)) / step_K));
      terms.push_back({{b}, 1, before, 1.0});
      terms.push_back({{b}, 1, here, -1.0});
      before = here;
    }
    add(std::move(terms));
  }

  double pick(const std::vector<double>& from) { return from[static_cast<size_t>(random_.below(static_cast<int>(from.size())))]; }

  GroupScene scene_;
  ProductDraw draw_;
  Random random_;
  SpectralProblem problem_;
  std::vector<Spectrum_> emissivity_;
  std::vector<double> temperature_K_, gas_K_, whole_;
  std::map<std::tuple<bool, int, double>, int> sources_;
  int clear_ = 0;
};

/// Running sums over the fine grid, so that any part of it, with parts of wavelengths at its ends, is a difference of two.
std::vector<double> running(const std::vector<double>& values) {
  std::vector<double> sum(1, 0.0);
  for (double v : values) sum.push_back(sum.back() + v);
  return sum;
}

double runningAt(const std::vector<double>& sum, double index) {
  const size_t i = std::min(static_cast<size_t>(index), sum.size() - 2);
  return sum[i] + (index - static_cast<double>(i)) * (sum[i + 1] - sum[i]);
}

}  // namespace

const GroupScene& groupScene(SceneBand band) {
  static const GroupScene scenes[] = {{"3-5.2 um", SceneBand::Midwave, 3.0, 5.2, 5.0},
                                      {"3-5.2 um with plumes", SceneBand::MidwavePlume, 3.0, 5.2, 5.0},
                                      {"7.5-12.5 um", SceneBand::Longwave, 7.5, 12.5, 5.0},
                                      {"1-2.5 um", SceneBand::Shortwave, 1.0, 2.5, 12.0}};
  return scenes[static_cast<int>(band)];
}

SpectralProblem drawProblem(const GroupScene& scene, const ProductDraw& draw) { return Draw(scene, draw).make(); }

double evenSamplesError(const SpectralProblem& p, int count) {
  const double low = p.wavelength_um.front() - 0.5 * p.weight.front(), high = p.wavelength_um.back() + 0.5 * p.weight.back();
  double whole = 0.0;
  for (double w : p.weight) whole += w;
  std::vector<SpectralGroup> samples;
  for (int j = 0; j < count; ++j) {
    const double um = low + (high - low) * (j + 0.5) / count;
    const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(p.wavelength_um.begin(), p.wavelength_um.end(), um) - p.wavelength_um.begin(), 1,
                                                  static_cast<std::ptrdiff_t>(p.wavelength_um.size()) - 1);
    const auto i = static_cast<size_t>(above);
    const double part = std::clamp((um - p.wavelength_um[i - 1]) / (p.wavelength_um[i] - p.wavelength_um[i - 1]), 0.0, 1.0);
    SpectralGroup sample{{{static_cast<int>(i) - 1, 1.0 - part}, {static_cast<int>(i), part}}, whole / count, {}};
    for (const auto& c : p.extinction) sample.extinction.push_back(c[i - 1] + part * (c[i] - c[i - 1]));
    samples.push_back(std::move(sample));
  }
  return evaluateGroups(p, samples).maximum;
}

EvenBins::EvenBins(const SpectralProblem& problem) : problem_(problem), weight_(running(problem.weight)) {
  const size_t n = problem.weight.size();
  std::vector<double> weighted(n), depth(n);
  for (const auto& s : problem.spectra) {
    for (size_t i = 0; i < n; ++i) weighted[i] = s[i] * problem.weight[i];
    spectra_.push_back(running(weighted));
  }
  const size_t airColumns = air().absorbers().size();
  fine_.assign(problem.products.size(), 0.0);
  std::vector<std::vector<double>> tau;
  for (const auto& u : problem.paths) {
    std::vector<std::vector<double>> factors;
    std::vector<double> whole(n, 1.0);
    for (size_t begin = 0; begin < u.size();) {
      const size_t end = begin < airColumns ? airColumns : begin + 1;
      std::fill(depth.begin(), depth.end(), 0.0);
      for (size_t k = begin; k < end; ++k)
        for (size_t i = 0; i < n && u[k] > 0.0; ++i) depth[i] += u[k] * problem.extinction[k][i];
      if (std::any_of(depth.begin(), depth.end(), [](double d) { return d > 0.0; })) {
        for (size_t i = 0; i < n; ++i) {
          whole[i] *= std::exp(-depth[i]);
          weighted[i] = std::exp(-depth[i]) * problem.weight[i];
        }
        factors.push_back(running(weighted));
      }
      begin = end;
    }
    paths_.push_back(std::move(factors));
    tau.push_back(std::move(whole));
  }
  for (size_t m = 0; m < fine_.size(); ++m)
    for (const ProductTerm& t : problem.products[m].terms) {
      const auto &s = problem.spectra[static_cast<size_t>(t.spectrum[0])], &through = tau[static_cast<size_t>(t.path)];
      for (size_t i = 0; i < n; ++i) fine_[m] += t.coefficient * problem.weight[i] * s[i] * through[i];
    }
}

std::vector<double> EvenBins::planned(const std::vector<double>& edges) const {
  const size_t bins = edges.size() - 1;
  const auto binned = [&](const std::vector<double>& sum) {
    std::vector<double> parts(bins);
    for (size_t b = 0; b < bins; ++b) parts[b] = runningAt(sum, edges[b + 1]) - runningAt(sum, edges[b]);
    return parts;
  };
  const std::vector<double> weight = binned(weight_);
  std::vector<std::vector<double>> spectra, paths;
  for (const auto& s : spectra_) spectra.push_back(binned(s));
  for (const auto& factors : paths_) {
    paths.emplace_back(bins, 1.0);
    for (const auto& factor : factors) {
      const std::vector<double> mean = binned(factor);
      for (size_t b = 0; b < bins; ++b) paths.back()[b] *= mean[b] / weight[b];
    }
  }
  std::vector<double> values;
  for (const auto& product : problem_.products) {
    double sum = 0.0;
    for (const ProductTerm& t : product.terms) {
      const auto &s = spectra[static_cast<size_t>(t.spectrum[0])], &tau = paths[static_cast<size_t>(t.path)];
      for (size_t b = 0; b < bins; ++b) sum += t.coefficient * s[b] * tau[b];
    }
    values.push_back(sum);
  }
  return values;
}

double EvenBins::error(int count) const {
  // Edges even in wavelength: the response is flat, so the running weight is the wavelength.
  std::vector<double> edges{0.0};
  for (int b = 1; b < count; ++b) {
    const double target = weight_.back() * b / count;
    const auto i = static_cast<size_t>(std::upper_bound(weight_.begin(), weight_.end(), target) - weight_.begin()) - 1;
    edges.push_back(static_cast<double>(i) + (target - weight_[i]) / (weight_[i + 1] - weight_[i]));
  }
  edges.push_back(static_cast<double>(weight_.size() - 1));
  const std::vector<double> values = planned(edges);
  double most = 0.0;
  for (size_t m = 0; m < values.size(); ++m) most = std::max(most, std::abs(values[m] - fine_[m]) / std::max(std::abs(fine_[m]), problem_.products[m].floor));
  return most;
}

}  // namespace pitviper::test

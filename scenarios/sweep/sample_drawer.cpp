#include "scenarios/sweep/sample_drawer.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "scenarios/sweep/frame_measures.hpp"
#include "sim/gl/context.hpp"

namespace pitviper {
namespace {

SceneSource sourceOf(const Sweep& sweep, const std::vector<std::filesystem::path>& roots) {
  return {sweep.scenario.string(), std::nullopt, {}, sweep.sets, roots};
}

std::vector<std::string> setsOf(const Sweep& sweep, const Sample& sample) {
  std::vector<std::string> sets = sweep.sets;
  sets.insert(sets.end(), sample.sets.begin(), sample.sets.end());
  return sets;
}

/// Samples that plans are made for besides those of the extremes of each factor.
constexpr std::size_t kExpected = 24;

/// Those of the extremes of each factor, and as many as kExpected evenly over the whole design: the same whoever draws it.
std::vector<const Sample*> spreadOver(const Sweep& sweep) {
  std::set<std::size_t> places;
  const std::size_t count = sweep.samples.size();
  for (std::size_t f = 0; f < sweep.factors.size(); ++f) {
    const auto byFactor = [f](const Sample& a, const Sample& b) { return a.values[f] < b.values[f]; };
    const auto [low, high] = std::minmax_element(sweep.samples.begin(), sweep.samples.end(), byFactor);
    places.insert({static_cast<std::size_t>(low - sweep.samples.begin()), static_cast<std::size_t>(high - sweep.samples.begin())});
  }
  for (std::size_t k = 0; k < std::min(kExpected, count); ++k) places.insert(k * count / std::min(kExpected, count));
  std::vector<const Sample*> samples;
  for (const std::size_t p : places) samples.push_back(&sweep.samples[p]);
  return samples;
}

}  // namespace

SampleDrawer::SampleDrawer(const Sweep& sweep, const std::vector<std::filesystem::path>& roots)
    : sweep_(sweep), scene_(sourceOf(sweep, roots)), simulation_(scene_.simulation()) {
  if (sweep.frame >= simulation_->time.frames)
    throw UserError({sweep.file, 0, 0, -1}, "the scenario has no frame " + std::to_string(sweep.frame), "0 to " + std::to_string(simulation_->time.frames - 1),
                    "write another 'frame:'");
  refuseUnknownMeasures(*simulation_, sweep.measures);
  for (const Measure& m : sweep.measures) {
    python_.push_back(m.kind == Measure::Kind::Python ? std::make_unique<PythonMeasure>(m) : nullptr);
    for (std::size_t k = 0; k < m.names.size(); ++k) units_.push_back(k < m.units.size() ? m.units[k] : std::string());
  }
  scene_.keepDrawings();
  readSome();
}

void SampleDrawer::readSome() {
  constexpr std::size_t kMostChoices = 32;
  std::set<std::size_t> some{0};
  for (std::size_t f = 0; f < sweep_.factors.size(); ++f)
    for (std::size_t c = 0; c < std::min(kMostChoices, sweep_.factors[f].choices.size()); ++c) {
      const auto has = std::find_if(sweep_.samples.begin(), sweep_.samples.end(), [&](const Sample& s) { return s.values[f] == static_cast<double>(c); });
      if (has != sweep_.samples.end()) some.insert(static_cast<std::size_t>(has - sweep_.samples.begin()));
    }
  for (const std::size_t s : some) try {
      scene_.change(setsOf(sweep_, sweep_.samples[s]));
    } catch (const UserError& e) {
      const UserError::Parts& p = e.parts();
      throw UserError({sweep_.file, 0, 0, -1}, "sample " + std::to_string(sweep_.samples[s].number) + ": " + p.where.text() + ": " + p.wrong, p.expected,
                      p.fix);
    }
}

void SampleDrawer::prepare() {
  std::vector<std::vector<std::string>> some;
  for (const Sample* s : spreadOver(sweep_)) some.push_back(s->sets);
  scene_.change(sweep_.sets);
  scene_.expect(some, simulation_->time.at(sweep_.frame));
}

DrawnSample SampleDrawer::draw(const Sample& sample, bool allCameras) {
  DrawnSample drawn{{sample.number, sample.seed, sample.values, std::vector<double>(units_.size(), NAN), {}}, {}};
  predicted_ = NAN, isOutside_ = false;
  try {
    scene_.change(setsOf(sweep_, sample));
    const auto sim = scene_.simulation();
    std::set<std::size_t> cameras;
    for (const Measure& m : sweep_.measures) cameras.insert(cameraOf(*sim, m));
    for (std::size_t c = 0; c < sim->cameras.size() && (allCameras || cameras.empty()); ++c) cameras.insert(c);
    for (const std::size_t c : cameras) {
      DrawWish wish;
      wish.camera = c;
      wish.time_s = sim->time.at(sweep_.frame);
      wish.noise = sample.seed;
      const DrawnFrame one = scene_.draw(wish);
      const std::shared_ptr<Frame>& frame = one.frame;
      for (const double e : one.predicted) predicted_ = std::isnan(predicted_) ? e : std::max(predicted_, e);
      isOutside_ = isOutside_ || one.isOutsideLimits;
      frame->number = sample.number;
      frame->attributes.push_back({"pitviper.sweep", sweep_.name});
      frame->attributes.push_back({"pitviper.sample", sample.number});
      frame->attributes.push_back({"pitviper.sample_seed", std::to_string(sample.seed)});
      for (std::size_t f = 0; f < sweep_.factors.size(); ++f) {
        const SweepFactor& factor = sweep_.factors[f];
        const std::string name = "factor." + factor.name;
        if (factor.choices.empty()) frame->attributes.push_back({name + (factor.unit.empty() ? "" : " [" + factor.unit + "]"), sample.values[f]});
        else frame->attributes.push_back({name, factor.choices[static_cast<std::size_t>(sample.values[f])]});
      }
      drawn.frames.push_back(frame);
    }
    measure(sample, drawn);
  } catch (const UserError& e) {
    drawn.row.why = e.what();
  } catch (const GlError& e) {
    drawn.row.why = e.what();
  }
  return drawn;
}

void SampleDrawer::measure(const Sample& sample, DrawnSample& drawn) {
  std::size_t column = 0;
  for (std::size_t k = 0; k < sweep_.measures.size(); ++k) {
    const Measure& m = sweep_.measures[k];
    if (m.kind == Measure::Kind::Expected) {
      drawn.row.measures[column++] = predicted_;
      drawn.row.measures[column++] = isOutside_ ? 1.0 : 0.0;
      continue;
    }
    const std::string& camera = scene_.simulation()->cameras[cameraOf(*scene_.simulation(), m)].name;
    const auto frame = std::find_if(drawn.frames.begin(), drawn.frames.end(), [&](const auto& f) { return f->camera == camera; });
    if (python_[k]) {
      for (const double v : python_[k]->of(**frame, sweep_.factors, sample)) drawn.row.measures[column++] = v;
      continue;
    }
    const MeasuredValue value = measured(**frame, m);
    if (units_[column].empty()) units_[column] = value.unit;
    drawn.row.measures[column++] = value.value;
  }
}

}  // namespace pitviper

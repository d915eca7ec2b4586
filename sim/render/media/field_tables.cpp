#include "sim/render/media/field_tables.hpp"

#include <algorithm>
#include <functional>

#include "sim/radiance/cloud_lights.hpp"
#include "sim/radiance/node_planck.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// A temperature above all.
constexpr float kNever_K = 1e30f;
/// Steps of c2/(lambda T) between entries of Planck's law: a straight line between two is off by an eighth of its square, 2e-4. How many there are.
constexpr double kBlackStep = 0.04, kFewestBlack = 128.0, kMostBlack = 8192.0;

void appendRow(std::vector<glm::vec4>& texels, const Plan& plan, const std::function<double(const SpectralNode&)>& value) {
  const size_t begin = texels.size(), nodes = plan.nodes.size();
  texels.resize(begin + (nodes + 3) / 4, glm::vec4(0.0f));
  for (size_t i = 0; i < nodes; ++i) texels[begin + i / 4][static_cast<int>(i % 4)] = static_cast<float>(value(plan.nodes[i]));
}

}  // namespace

FieldTables::FieldTables(const Simulation& sim, const Plan& plan, const FieldBody& field) : fours(static_cast<int>((plan.nodes.size() + 3) / 4)) {
  const auto mediumOf = [&](size_t gas) -> const Medium& { return *sim.materials[static_cast<size_t>(field.gases[gas].levels.front().material)]->medium; };
  std::vector<int> which = field.source->mixtures();
  for (size_t g = which.size(); g < field.gases.size(); ++g) which.push_back(static_cast<int>(g));
  size_t levels = 1;
  for (size_t g = 0; g < field.gases.size(); ++g) {
    const auto m = static_cast<size_t>(which[g]);
    mixed_.resize(std::max(mixed_.size(), m + 1));
    mixed_[m].gases.push_back(g);
    for (const FieldGas::Level& l : field.gases[g].levels) mixed_[m].temperature_K.push_back(l.temperature_K);
    scatters |= mediumOf(g).albedo.has_value() || mediumOf(g).radiance.has_value();
  }
  for (Mixture& m : mixed_) {
    std::sort(m.temperature_K.begin(), m.temperature_K.end());
    m.temperature_K.erase(std::unique(m.temperature_K.begin(), m.temperature_K.end()), m.temperature_K.end());
    levels = std::max(levels, m.temperature_K.size());
  }
  mixtures = static_cast<int>(mixed_.size());
  levelFours = static_cast<int>(levels / 4) + 1;  // of a single level the next is read, too
  const size_t places = 4 * static_cast<size_t>(levelFours);
  texels.resize(mixed_.size() * (1 + places), glm::vec4(0.0f));
  for (size_t n = 0; n < mixed_.size(); ++n) {
    Mixture& m = mixed_[n];
    m.at = texels.size();
    texels[n].x = static_cast<float>(m.at);
    texels[n].y = static_cast<float>(m.temperature_K.size());
    for (size_t l = 0; l < places; ++l) {
      const float at = l < m.temperature_K.size() ? static_cast<float>(m.temperature_K[l]) : kNever_K;
      texels[mixed_.size() + n * places + l].x = at;
      if (l % 4 == 0) temperatures.emplace_back();
      temperatures.back()[static_cast<int>(l % 4)] = at;
    }
    for (size_t g : m.gases) {
      m.rows.emplace_back();
      for (double temperature_K : m.temperature_K) {
        std::vector<double>& row = m.rows.back().emplace_back(plan.nodes.size(), 0.0);
        field.gases[g].at(temperature_K, [&](int material, double part) {
          for (size_t i = 0; i < row.size(); ++i) row[i] += part * plan.nodes[i].absorption_per_m[static_cast<size_t>(material)];
        });
      }
    }
    texels.resize(texels.size() + std::max(m.temperature_K.size(), size_t{2}) * static_cast<size_t>(fours), glm::vec4(0.0f));
  }
  for (size_t n = 0; scatters && n < mixed_.size(); ++n) {
    const Medium& m = mediumOf(mixed_[n].gases.front());
    texels[n].z = static_cast<float>(texels.size());
    std::vector<std::vector<glm::vec4>> rows(5);
    const auto mean = [&](const std::function<double(double)>& f) { return [&f](const SpectralNode& node) { return node.mean(f); }; };
    const auto put = [&](size_t k, const std::function<double(double)>& f) { appendRow(rows[k], plan, mean(f)); };
    put(0, [&](double w) { return 1.0 - m.albedoAt(w); });
    put(1, [&](double w) { return m.radiance ? (*m.radiance)(w) : 0.0; });
    put(2, [&](double w) { return m.albedo && sim.ambient ? m.albedoAt(w) * (*sim.ambient)(w) : 0.0; });
    put(3, [&](double w) { return m.albedo && sim.sun ? m.albedoAt(w) * sim.sun->irradiance(w) : 0.0; });
    put(4, [&](double w) { return m.asymmetry ? (*m.asymmetry)(w) : 0.0; });
    for (int four = 0; four < fours; ++four)
      for (const auto& row : rows) texels.push_back(row[static_cast<size_t>(four)]);
  }
  if (field.source->droplets()) {
    drops = true;
    texels[0].w = static_cast<float>(texels.size());
    std::vector<std::array<float, kCloudRows>> rows;
    for (const CloudLight& l : CloudLights(sim, field).of(plan.nodes)) {
      const physics::CloudOptics& o = l.optics;
      std::array<float, kCloudRows>& row = rows.emplace_back();
      const std::array<double, kCloudRows> of{o.albedo, o.asymmetry, l.sun, l.above, l.below, o.weight.x, o.weight.y, o.weight.z, o.weight.w, o.coordinate};
      std::transform(of.begin(), of.end(), row.begin(), [](double v) { return static_cast<float>(v); });
    }
    const std::array<float, kCloudRows> none{};
    for (std::size_t four = 0; four < static_cast<std::size_t>(fours); ++four)
      for (std::size_t k = 0; k < kCloudRows; ++k) {
        const auto at = [&](std::size_t i) { return (4 * four + i < rows.size() ? rows[4 * four + i] : none)[k]; };
        texels.emplace_back(at(0), at(1), at(2), at(3));
      }
  }
  const glm::dvec2 range = field.source->temperatures_K();
  const double coldest = std::max(range.x, 1.0), hottest = std::max(range.y, coldest * (1.0 + 1e-6));
  double shortest = 1e3;
  for (const SpectralNode& n : plan.nodes)
    for (const auto& [wavelength_um, share] : n.members) shortest = std::min(shortest, wavelength_um);
  const double first = 1.0 / hottest, range_perK = 1.0 / coldest - first;
  blackEntries = static_cast<int>(std::clamp(range_perK * kSecondRadiation_umK / (shortest * kBlackStep), kFewestBlack, kMostBlack));
  const double step = range_perK / (blackEntries - 1);
  firstInverse_K = static_cast<float>(first);
  entriesPerInverse = static_cast<float>(1.0 / step);
  blackAt = static_cast<int>(texels.size());
  const NodePlanck planck(plan.nodes);
  std::vector<double> black(plan.nodes.size());
  for (int k = 0; k < blackEntries; ++k) {
    planck.at(1.0 / (first + step * k), black);
    appendRow(texels, plan, [&](const SpectralNode& n) { return black[static_cast<size_t>(&n - plan.nodes.data())]; });
  }
}

bool FieldTables::mix(const std::array<double, kMostGases>& share) {
  if (share == share_) return false;
  share_ = share;
  for (const Mixture& m : mixed_) {
    const size_t rows = std::max(m.temperature_K.size(), size_t{2});
    for (size_t l = 0; l < rows; ++l)
      for (size_t i = 0; i < m.rows[0][0].size(); ++i) {
        double sum = 0.0;
        for (size_t g = 0; g < m.gases.size(); ++g) sum += share[m.gases[g]] * m.rows[g][std::min(l, m.temperature_K.size() - 1)][i];
        texels[m.at + l * static_cast<size_t>(fours) + i / 4][static_cast<int>(i % 4)] = static_cast<float>(sum);
      }
  }
  return true;
}

}  // namespace pitviper

#include "sim/render/field_tables.hpp"

#include <algorithm>
#include <functional>

namespace pitviper {
namespace {

void appendRow(std::vector<glm::vec4>& texels, const Plan& plan, const std::function<double(const SpectralNode&)>& value) {
  const size_t begin = texels.size(), nodes = plan.nodes.size();
  texels.resize(begin + (nodes + 3) / 4, glm::vec4(0.0f));
  for (size_t i = 0; i < nodes; ++i) texels[begin + i / 4][static_cast<int>(i % 4)] = static_cast<float>(value(plan.nodes[i]));
}

}  // namespace

FieldTables makeFieldTables(const Simulation& sim, const Plan& plan, const FieldBody& field) {
  FieldTables t;
  t.gases = static_cast<int>(field.gases.size());
  t.fours = static_cast<int>((plan.nodes.size() + 3) / 4);
  const auto mediumOf = [&](const FieldGas::Level& level) -> const Medium& { return *sim.materials[static_cast<size_t>(level.material)]->medium; };
  for (const FieldGas& g : field.gases) {
    t.levels = std::max(t.levels, static_cast<int>(g.levels.size()));
    const Medium& m = mediumOf(g.levels.front());
    t.scatters |= m.albedo.has_value() || m.radiance.has_value();
  }
  ++t.levels;  // of a single level the next is read, too
  t.texels.resize(field.gases.size() * static_cast<size_t>(1 + t.levels), glm::vec4(0.0f));
  for (size_t g = 0; g < field.gases.size(); ++g) {
    const std::vector<FieldGas::Level>& levels = field.gases[g].levels;
    glm::vec4& head = t.texels[g];
    head.x = static_cast<float>(t.texels.size());
    head.y = static_cast<float>(levels.size());
    for (size_t l = 0; l < static_cast<size_t>(t.levels); ++l)
      t.texels[field.gases.size() + g * static_cast<size_t>(t.levels) + l].x =
          l < levels.size() ? static_cast<float>(levels[l].temperature_K) : static_cast<float>(levels.back().temperature_K + 1.0);
    for (size_t l = 0; l < std::max(levels.size(), size_t{2}); ++l) {
      const auto material = static_cast<size_t>(levels[std::min(l, levels.size() - 1)].material);
      appendRow(t.texels, plan, [&](const SpectralNode& n) { return n.absorption_per_m[material]; });
    }
  }
  for (size_t g = 0; t.scatters && g < field.gases.size(); ++g) {
    const Medium& m = mediumOf(field.gases[g].levels.front());
    t.texels[g].z = static_cast<float>(t.texels.size());
    std::vector<std::vector<glm::vec4>> rows(5);
    const auto mean = [&](const std::function<double(double)>& f) { return [&f](const SpectralNode& n) { return n.mean(f); }; };
    const auto put = [&](size_t k, const std::function<double(double)>& f) { appendRow(rows[k], plan, mean(f)); };
    put(0, [&](double w) { return 1.0 - m.albedoAt(w); });
    put(1, [&](double w) { return m.radiance ? (*m.radiance)(w) : 0.0; });
    put(2, [&](double w) { return m.albedo && sim.ambient ? m.albedoAt(w) * (*sim.ambient)(w) : 0.0; });
    put(3, [&](double w) { return m.albedo && sim.sun ? m.albedoAt(w) * sim.sun->irradiance(w) : 0.0; });
    put(4, [&](double w) { return m.asymmetry ? (*m.asymmetry)(w) : 0.0; });
    for (int four = 0; four < t.fours; ++four)
      for (const auto& row : rows) t.texels.push_back(row[static_cast<size_t>(four)]);
  }
  const glm::dvec2 range = field.source->temperatures_K();
  const double coldest = std::max(range.x, 1.0), hottest = std::max(range.y, coldest * (1.0 + 1e-6));
  const double first = 1.0 / hottest, step = (1.0 / coldest - first) / (kBlackEntries - 1);
  t.firstInverse_K = static_cast<float>(first);
  t.entriesPerInverse = static_cast<float>(1.0 / step);
  t.blackAt = static_cast<int>(t.texels.size());
  for (int k = 0; k < kBlackEntries; ++k) {
    const double temperature_K = 1.0 / (first + step * k);
    appendRow(t.texels, plan, [temperature_K](const SpectralNode& n) { return n.planck(temperature_K); });
  }
  return t;
}

int fieldLinesAcross(double accuracy) { return accuracy >= 0.03 ? 8 : 16; }

}  // namespace pitviper

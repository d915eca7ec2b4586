#include "sim/render/assembly/material_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/model/scene_fingerprint.hpp"
#include "sim/parameters/fingerprint.hpp"
#include "sim/parameters/on_threads.hpp"
#include "sim/radiance/node_surroundings.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/content_cache.hpp"

namespace pitviper {
namespace {

using AxisPair = std::array<AngleAxis, 2>;

/// The angles that a material's tables of columns run over, and which of the two each component stands in.
struct MaterialAxes {
  std::array<AxisPair, 2> table;
  std::vector<std::size_t> tableOf;
  bool hasSecond() const { return table[1][0].count > 1; }
};

/// A component's column at angles on a table's axes.
double columnAt(const ReflectionComponent& r, double w, double angle1, double angle2, const AxisPair& axes) {
  // Its own axes, in the order of the table's.
  const auto own = r.axes();
  const auto pick = [&](Angle a) { return a == Angle::None ? 0.0 : a == axes[0].angle ? angle1 : angle2; };
  return r.column(w, pick(own[0].angle), pick(own[1].angle));
}

constexpr const char* kAngleNames[] = {"none", "incidence", "view", "specular", "half", "difference", "root of half"};
/// Cells of an axis that several components share, and entries of the two axes together: 1024 x 1024 of 16 wavelengths are 256 MB.
constexpr int kMostCells = 1024;
constexpr long long kMostEntries = 1025LL * 1025LL;

/// The coarsest grid that has all entries of the axes (of one angle) on its own, so that linear between its entries is what each component
/// is by itself. Beyond its own last entry a component is held.
AngleAxis commonAxis(const Material& m, const std::vector<AngleAxis>& axes) {
  AngleAxis longest = axes.front();
  for (const AngleAxis& a : axes)
    if (a.last_rad > longest.last_rad) longest = a;
  for (int cells = longest.count - 1; cells <= kMostCells; cells += longest.count - 1) {
    const bool fits = std::all_of(axes.begin(), axes.end(), [&](const AngleAxis& a) {
      const double perStep = a.at(1) * cells / longest.last_rad;  // grid cells in one step of this axis
      return perStep > 0.5 && std::abs(perStep - std::round(perStep)) * (a.count - 1) < 1e-6;
    });
    if (fits) return {longest.angle, cells + 1, longest.last_rad};
  }
  std::string all;
  for (const AngleAxis& a : axes) {
    char text[80];
    std::snprintf(text, sizeof text, "%s%d entries to %.6g deg", all.empty() ? "" : " and ", a.count, a.last_rad * 180.0 / kPi);
    all += text;
  }
  throw UserError(m.where,
                  "the tables of material '" + m.name + "' run over the angle '" + kAngleNames[static_cast<int>(longest.angle)] +
                      "' in steps that do not fit each other (" + all + ")",
                  "steps of which all are multiples of one step, 1/1024 of the longest axis or more", "give their axes the same 'count' and 'last'");
}

/// Two tables of up to two angles each: a component stands in the first that has its angles, or room for them.
MaterialAxes materialAxes(const Material& m) {
  std::array<std::array<std::vector<AngleAxis>, 2>, 2> found;
  MaterialAxes all;
  for (const auto& r : m.reflections) {
    std::size_t table = 0;
    for (; table < 2; ++table) {
      auto with = found[table];
      const auto own = r->axes();
      const bool fits = std::all_of(own.begin(), own.end(), [&](const AngleAxis& axis) {
        if (axis.angle == Angle::None) return true;
        size_t k = 0;
        while (k < 2 && !with[k].empty() && with[k].front().angle != axis.angle) ++k;
        if (k < 2) with[k].push_back(axis);
        return k < 2;
      });
      if (!fits) continue;
      found[table] = std::move(with);
      break;
    }
    if (table == 2)
      throw UserError(m.where, "the tables of material '" + m.name + "' run over more than two pairs of angles together",
                      "components over at most two different pairs of angles in one material", "bring its components to the same angles");
    all.tableOf.push_back(table);
  }
  long long pairs = 0;
  for (std::size_t table = 0; table < 2; ++table) {
    for (size_t k = 0; k < 2; ++k)
      if (!found[table][k].empty()) all.table[table][k] = commonAxis(m, found[table][k]);
    pairs += static_cast<long long>(all.table[table][0].count) * all.table[table][1].count;
  }
  if (pairs > kMostEntries + 1)
    throw UserError(m.where, "the tables of material '" + m.name + "' have " + std::to_string(pairs) + " pairs of angles together",
                    "at most " + std::to_string(kMostEntries), "give them fewer entries");
  return all;
}

/// Entries of the grid of view angles: the fewest from kViewAngles on that have all angles at which the material bends among them.
int viewAngles(const Material& m) {
  const auto knots = m.viewKnots_rad();
  for (int cells = kViewAngles - 1; cells <= kMostViewAngles - 1; ++cells) {
    const bool fits = std::all_of(knots.begin(), knots.end(), [&](double a) {
      const double x = a / (0.5 * kPi) * cells;
      return std::abs(x - std::round(x)) < 1e-6;
    });
    if (fits) return cells + 1;
  }
  return kMostViewAngles;
}

double viewAngle(int entry, int views) { return views > 1 ? 0.5 * kPi * entry / (views - 1) : 0.0; }

/// Means over a node of what a material's components are at each of some places; wavelength by wavelength, as what takes long to work out belongs to one.
/// `at(component, wavelength_um, place)`.
template <class At>
std::vector<double> meansOver(const SpectralNode& node, std::size_t places, std::size_t components, const At& at) {
  std::vector<double> sums(places * components, 0.0);
  for (const SpectralNode::Member& m : node.members)
    for (std::size_t k = 0; k < components; ++k)
      for (std::size_t place = 0; place < places; ++place) sums[place * components + k] += m.share * at(k, m.wavelength_um, place);
  return sums;
}

/// Of each node of a plan, on all cores.
template <class Of>
std::vector<std::vector<double>> ofNodes(const Plan& plan, const Of& of) {
  std::vector<std::vector<double>> all(plan.nodes.size());
  onAllThreads(all.size(), [&](const auto& next) {
    for (std::size_t i = next(); i < all.size(); i = next()) all[i] = of(plan.nodes[i]);
  });
  return all;
}

/// Columns that take so many values of components to work out are kept between runs: a tenth of a second of a film's.
constexpr std::size_t kWorthKeeping = 200000;
/// Of what meansOver() and columnAt() make of a material; to be raised where either changes.
constexpr int kColumnsAre = 1;

/// The means of columns, by node.
std::vector<std::vector<double>> columnMeans(const Material& m, const MaterialAxes& axes, std::size_t table, const Plan& plan) {
  const AxisPair& own = axes.table[table];
  const auto along = static_cast<std::size_t>(own[0].count), cells = along * static_cast<std::size_t>(own[1].count), parts = m.reflections.size();
  const auto make = [&] {
    return ofNodes(plan, [&](const SpectralNode& n) {
      return meansOver(n, cells, parts, [&](std::size_t k, double w, std::size_t cell) {
        if (axes.tableOf[k] != table) return 0.0;
        return columnAt(*m.reflections[k], w, own[0].at(static_cast<int>(cell % along)), own[1].at(static_cast<int>(cell / along)), own);
      });
    });
  };
  std::size_t wavelengths = 0;
  for (const SpectralNode& n : plan.nodes) wavelengths += n.members.size();
  if (wavelengths * cells * parts < kWorthKeeping) return make();
  constexpr const char* kWhat = "columns";
  const ContentKey key = contentKeyOf([&](Fingerprint& f) {
    f.add(kColumnsAre).add(static_cast<int>(table));
    for (const AngleAxis& a : own) f.add(static_cast<int>(a.angle)).add(a.count).add(a.last_rad);
    for (std::size_t t : axes.tableOf) f.add(static_cast<int>(t));
    addTo(f, m);
    for (const SpectralNode& n : plan.nodes) f.all(n.members);
  });
  if (const auto kept = readCachedTable(kWhat, key)) {
    TableReader in(*kept);
    std::vector<std::vector<double>> all(plan.nodes.size());
    for (auto& each : all) each = in.all<double>();
    if (in.isWhole() && std::all_of(all.begin(), all.end(), [&](const auto& each) { return each.size() == cells * parts; })) return all;
  }
  const std::vector<std::vector<double>> all = make();
  TableWriter out;
  for (const auto& each : all) out.all(each);
  writeCachedTable(kWhat, key, out.bytes());
  return all;
}

/// By angle 2, angle 1 and node.
void appendColumns(SurfaceTables& t, const Material& m, const MaterialAxes& axes, std::size_t table, const Plan& plan) {
  if (!t.lit) return;
  const auto means = columnMeans(m, axes, table, plan);
  const AxisPair& own = axes.table[table];
  const auto cells = static_cast<std::size_t>(own[0].count) * static_cast<std::size_t>(own[1].count);
  for (std::size_t cell = 0; cell < cells; ++cell)
    for (const auto& mean : means) appendComponents(t.columns, t, m, 0.0, [&](std::size_t k) { return mean[cell * m.reflections.size() + k]; });
}

/// By view angle and node.
void appendHemispherical(SurfaceTables& t, const Material& m, int views, const Plan& plan) {
  const std::size_t parts = m.reflections.size() + 1;
  const auto means = ofNodes(plan, [&](const SpectralNode& n) {
    return meansOver(n, static_cast<std::size_t>(views), parts, [&](std::size_t k, double w, std::size_t view) {
      const double angle = viewAngle(static_cast<int>(view), views);
      if (k + 1 < parts) return m.reflections[k]->hemispherical(w, angle);
      // In double precision: what a good window emits is nearly all digits of 1 less than what it lets through and reflects.
      return m.emissivity(w, angle);
    });
  });
  for (std::size_t view = 0; view < static_cast<std::size_t>(views); ++view)
    for (const auto& mean : means)
      appendComponents(t.hemispherical, t, m, mean[view * parts + parts - 1], [&](std::size_t k) { return mean[view * parts + k]; });
}

/// Factor and summand that make one texture's values out of another's; none where no two do. Shares of two covers, say, are 1 together: one is read.
std::optional<std::pair<float, float>> imageOf(const Simulation& sim, int from, int to) {
  if (from < 0 || to < 0) return {};
  const Texture &a = sim.textures[static_cast<size_t>(from)], &b = sim.textures[static_cast<size_t>(to)];
  if (a.width != b.width || a.height != b.height || a.repeats != b.repeats) return {};
  const auto [low, high] = std::minmax_element(a.texels.begin(), a.texels.end());
  const auto at = [&](auto where) { return static_cast<double>(b.texels[static_cast<size_t>(where - a.texels.begin())]); };
  const double first = static_cast<double>(*low), last = static_cast<double>(*high), factor = last > first ? (at(high) - at(low)) / (last - first) : 0.0,
               summand = at(low) - factor * first;
  constexpr double kRounding = 3e-7, kLargest = 4.0;
  const double scale = std::max(std::abs(at(low)), std::abs(at(high)));
  // Two large numbers that nearly cancel leave few digits.
  if (std::abs(factor) * std::max(std::abs(first), std::abs(last)) > kLargest * scale) return {};
  for (size_t k = 0; k < a.texels.size(); ++k)
    if (std::abs(factor * static_cast<double>(a.texels[k]) + summand - static_cast<double>(b.texels[k])) > kRounding * scale) return {};
  return std::pair{static_cast<float>(factor), static_cast<float>(summand)};
}

/// Components whose textures are the same, and are sharp or not, answer light from all around as one: by state, texture and view angle their mean aim, and
/// their sums by node.
std::array<std::uint32_t, 4> responsesOf(const Material& material, const std::vector<const Material*>& entries, const NodeSurroundings& around,
                                         std::size_t nodes, std::vector<float>& into) {
  const Material& first = *entries.front();
  std::vector<std::size_t> groups;  // the first component of each
  const auto areAlike = [&](std::size_t a, std::size_t b) {
    return first.modifiers[a] == first.modifiers[b] && around.responses(material, first, a).isSharp == around.responses(material, first, b).isSharp;
  };
  for (std::size_t k = 0; k < first.reflections.size(); ++k)
    if (std::none_of(groups.begin(), groups.end(), [&](std::size_t g) { return areAlike(g, k); })) groups.push_back(k);
  if (groups.size() > 8 || first.reflections.size() > 16)
    throw UserError(first.where, "material '" + first.name + "' has too many textured components for light from all around",
                    "up to 8 textures of components, and 16 components", "split its surface, or give 'ambient' one radiance");
  const bool plain = std::all_of(first.reflections.begin(), first.reflections.end(), [](const auto& r) { return HarmonicResponse::isPlain(*r); });
  const int views = plain ? 1 : HarmonicResponse::kViews;
  constexpr double kNearlyNone = 1e-12;  // where none has a lobe, aims still go on evenly
  const auto put = [&](double v) { into.push_back(static_cast<float>(v)); };
  for (const Material* entry : entries)
    for (std::size_t g : groups) {
      std::vector<const NodeSurroundings::Responses*> parts;
      for (std::size_t k = g; k < first.reflections.size(); ++k)
        if (areAlike(g, k)) parts.push_back(&around.responses(material, *entry, k));
      for (int j = 0; j < views; ++j) {
        std::vector<Response> sums(nodes, Response{});
        HarmonicResponse::Aim aim;
        double lobes = 0.0;
        for (const auto* part : parts) {
          const auto view = static_cast<std::size_t>(part->views > 1 ? j : 0);
          for (std::size_t i = 0; i < nodes; ++i) {
            const Response& at = part->at[view * nodes + i];
            for (std::size_t c = 0; c < at.size(); ++c) sums[i][c] += at[c];
            const double weight = at.back() + kNearlyNone;
            aim.tilt_rad += weight * part->aims[view].tilt_rad, aim.stretch += weight * part->aims[view].stretch, lobes += weight;
          }
        }
        put(aim.tilt_rad / lobes), put(aim.stretch / lobes), put(parts.front()->isSharp ? 1.0 : 0.0), put(0.0);
        for (const Response& sum : sums)
          for (double v : sum) put(v);
      }
    }
  std::uint32_t packed = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) packed |= static_cast<std::uint32_t>(groups[g]) << (4 * g);
  return {0, static_cast<std::uint32_t>(groups.size()), static_cast<std::uint32_t>(views), packed};
}

}  // namespace

void appendMaterial(SurfaceTables& t, const Simulation& sim, const Material& m, const std::set<std::pair<std::string, std::string>>& lobes, const Plan& plan,
                    const NodeSurroundings* around) {
  GpuMaterial g{};
  const MaterialAxes allAxes = materialAxes(m);
  const AxisPair& axes = allAxes.table[0];
  const int views = m.hemisphericalVaries() ? viewAngles(m) : 1;
  t.tabulated |= axes[0].count > 1;
  g.counts[0] = static_cast<std::uint32_t>(axes[0].count);
  g.counts[1] = static_cast<std::uint32_t>(axes[1].count);
  g.counts[2] = static_cast<std::uint32_t>(views);
  g.counts[3] = static_cast<std::uint32_t>(t.columns.size() / 4);
  g.kinds[0] = static_cast<std::uint32_t>(axes[0].angle);
  g.kinds[1] = static_cast<std::uint32_t>(axes[1].angle);
  g.kinds[2] = m.given ? 0 : 1;
  g.kinds[3] = static_cast<std::uint32_t>(t.hemispherical.size() / 4);
  for (int k = 0; k < 2; ++k)
    g.scale[k] =
        axes[static_cast<size_t>(k)].count > 1 ? static_cast<float>((axes[static_cast<size_t>(k)].count - 1) / axes[static_cast<size_t>(k)].last_rad) : 0.0f;
  g.scale[2] = views > 1 ? static_cast<float>((views - 1) / (0.5 * kPi)) : 0.0f;
  g.components.assign(3 * static_cast<size_t>(t.vectors), {0, -1, 0, 0});
  g.lobes.resize(g.components.size());
  g.images.resize(g.components.size());
  for (size_t k = 0; k < m.reflections.size(); ++k) {
    const Lobe& lobe = m.reflections[k]->lobe();
    const auto at = lobes.find({lobe.file, lobe.function});
    g.components[k] = {at == lobes.end() ? 0 : static_cast<std::int32_t>(std::distance(lobes.begin(), at)) + 1, m.modifiers[k], 1, 0};
    const auto image = k > 0 ? imageOf(sim, m.modifiers[k - 1], m.modifiers[k]) : std::nullopt;
    if (image) {
      g.components[k][3] = 1;
      g.images[k] = {image->first, image->second, 0.0f, 0.0f};
    }
    for (int c = 0; c < 4; ++c) g.lobes[k][static_cast<size_t>(c)] = static_cast<float>(lobe.parameters[c]);
  }
  g.transmission[0] = m.transmission ? m.transmission->modifier : -1;
  g.transmission[1] = static_cast<std::int32_t>(t.transmittance.size());
  g.transmission[2] = m.given ? m.given->modifier : -1;
  g.state = {-1, 1, 0, 0};
  if (m.states) {
    const auto entries = static_cast<std::int32_t>(m.states->entries.size());
    g.state = {m.states->texture, entries, 0, 0};
    g.stateScale = {static_cast<float>(m.states->low), static_cast<float>((entries - 1) / (m.states->high - m.states->low)), 0.0f, 0.0f};
    t.states = true;
  }
  if (allAxes.hasSecond()) {
    const AxisPair& second = allAxes.table[1];
    // Behind the first table of all states.
    const auto first = t.columns.size() / 4 + (t.lit ? static_cast<std::size_t>(g.state[1]) * static_cast<std::size_t>(axes[0].count * axes[1].count) *
                                                           plan.nodes.size() * static_cast<std::size_t>(t.vectors)
                                                     : 0);
    g.second = {static_cast<std::uint32_t>(second[0].count), static_cast<std::uint32_t>(second[1].count),
                static_cast<std::uint32_t>(second[0].angle) + 8 * static_cast<std::uint32_t>(second[1].angle), static_cast<std::uint32_t>(first)};
    for (size_t k = 0; k < 2; ++k) g.stateScale[2 + k] = second[k].count > 1 ? static_cast<float>((second[k].count - 1) / second[k].last_rad) : 0.0f;
    t.second = true;
  }
  std::vector<const Material*> entries{&m};
  if (m.states) {
    entries.clear();
    for (const auto& entry : m.states->entries) entries.push_back(entry.get());
  }
  std::vector<float> responses;
  if (around && t.general && !m.reflections.empty()) g.response = responsesOf(m, entries, *around, plan.nodes.size(), responses);
  t.materials.push_back(std::move(g));
  if (m.transmission)
    for (int j = 0; j < views; ++j)
      for (const SpectralNode& n : plan.nodes)
        t.transmittance.push_back(static_cast<float>(n.mean([&](double w) { return m.transmittance(w, viewAngle(j, views)); })));
  if (!t.general) return;
  for (std::size_t table = 0; table < (allAxes.hasSecond() ? 2 : 1); ++table)
    for (const Material* entry : entries) appendColumns(t, *entry, allAxes, table, plan);
  for (const Material* entry : entries) appendHemispherical(t, *entry, views, plan);
  t.materials.back().response[0] = static_cast<std::uint32_t>(t.hemispherical.size() / 4);
  t.hemispherical.insert(t.hemispherical.end(), responses.begin(), responses.end());
}

}  // namespace pitviper

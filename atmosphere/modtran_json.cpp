#include "atmosphere/modtran_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "atmosphere/json_places.hpp"
#include "atmosphere/modtran_names.hpp"
#include "atmosphere/tape7_rows.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

using Json = nlohmann::ordered_json;
using Way = std::vector<std::string>;

const char* const kAgain = "run MODTRAN 6 with JSONOPT = WRT_ALL, and give the file as it wrote it";
/// Its numbers are those of a float as text.
constexpr double kResolution = 1e-6;
/// MODTRAN's own has 9.
constexpr int kDeepest = 32;

constexpr const char* kModels[] = {"ATM_CONSTANT",      "ATM_TROPICAL",         "ATM_MIDLAT_SUMMER",    "ATM_MIDLAT_WINTER",     "ATM_SUBARC_SUMMER",
                                   "ATM_SUBARC_WINTER", "ATM_US_STANDARD_1976", "ATM_USER_ALT_PROFILE", "ATM_USER_PRESS_PROFILE"};
constexpr const char* kHazes[] = {"AER_NONE",         "AER_RURAL",        "AER_RURAL_DENSE",   "AER_MARITIME_NAVY", "AER_MARITIME", "AER_URBAN",
                                  "AER_TROPOSPHERIC", "AER_USER_DEFINED", "AER_FOG_ADVECTIVE", "AER_FOG_RADIATIVE", "AER_DESERT"};

class CaseReader {
 public:
  CaseReader(std::string_view text, const std::string& file, const Json& cases, size_t index) : text_(text), file_(file), index_(index), own_(cases[index]) {
    if (!own_.is_object()) fail({}, "a case that is no map", "MODTRANINPUT and MODTRANOUTPUT", kAgain);
    if (own_.contains("MODTRANINPUT")) input_ = own_.at("MODTRANINPUT");
    addTemplate(cases);
  }

  Tape7Run read() {
    run_.file = file_;
    run_.number = static_cast<int>(index_) + 1;
    run_.line = place({}).line;
    run_.resolution = kResolution;
    const Way spectra = {"MODTRANOUTPUT", "SPECTRA"};
    const Json* all = find(own_, spectra);
    if (!all || !all->is_object()) fail({}, "the case has no spectra (MODTRANOUTPUT: SPECTRA)", "those of a run", "run MODTRAN 6 with JSONOPT = WRT_ALL");
    const char* kind = nullptr;
    for (const char* each : {"TRANSMITTANCE", "RADIANCE"})
      if (all->contains(each)) kind = each;
    if (!kind)
      fail(spectra, "neither TRANSMITTANCE nor RADIANCE in SPECTRA", "one of the two", "run MODTRAN with IEMSCT = RT_THERMAL_ONLY, or another but irradiance");
    Way way = spectra;
    way.push_back(kind);
    readInput(way.back() == "TRANSMITTANCE", all->at(kind));
    readSpectra(way, all->at(kind));
    return std::move(run_);
  }

 private:
  Location place(Way way) const {
    way.insert(way.begin(), {"MODTRAN", std::to_string(index_)});
    return placeInJson(text_, file_, way);
  }
  [[noreturn]] void fail(const Way& way, const std::string& wrong, const std::string& expected, const std::string& fix) const {
    throw UserError(place(way), wrong, expected, fix);
  }

  static const Json* find(const Json& from, const Way& way) {
    const Json* at = &from;
    for (const std::string& step : way) {
      if (!at->is_object() || !at->contains(step)) return nullptr;
      at = &at->at(step);
    }
    return at;
  }

  /// What a case leaves to the one it is made after.
  void addTemplate(const Json& cases) {
    const Json* wanted = find(input_, {"CASE TEMPLATE"});
    if (!wanted || !wanted->is_number_integer()) return;
    for (const Json& other : cases) {
      const Json* base = find(other, {"MODTRANINPUT"});
      const Json* number = base ? find(*base, {"CASE"}) : nullptr;
      if (!number || *number != *wanted || &other == &own_) continue;
      Json whole = *base;
      whole.merge_patch(input_);
      input_ = std::move(whole);
      return;
    }
  }

  std::optional<double> number(const Way& way) const {
    const Json* found = find(input_, way);
    if (!found) return std::nullopt;
    if (!found->is_number()) failInput(way, way.back() + " is no number", "a number", kAgain);
    return found->get<double>();
  }

  /// Which of MODTRAN's words stands there, or its number; 0 where nothing does.
  template <size_t N>
  int wordOf(const Way& way, const char* const (&words)[N]) const {
    const Json* found = find(input_, way);
    if (!found) return 0;
    if (found->is_number_integer() && found->get<long long>() >= 0 && found->get<long long>() < static_cast<long long>(N)) return found->get<int>();
    if (found->is_string())
      for (size_t i = 0; i < N; ++i)
        if (found->get_ref<const std::string&>() == words[i]) return static_cast<int>(i);
    failInput(way, way.back() + " is unknown", words[1] + std::string(", or another of MODTRAN's words"), kAgain);
  }

  [[noreturn]] void failInput(Way way, const std::string& wrong, const std::string& expected, const std::string& fix) const {
    way.insert(way.begin(), "MODTRANINPUT");
    fail(way, wrong, expected, fix);
  }

  void readInput(bool transmittance, const Json& block) {
    static constexpr const char* kinds[] = {"RT_TRANSMITTANCE",    "RT_THERMAL_ONLY",      "RT_SOLAR_AND_THERMAL",
                                            "RT_SOLAR_IRRADIANCE", "RT_LUNAR_AND_THERMAL", "RT_LUNAR_IRRADIANCE"};
    const Way iemsct = {"RTOPTIONS", "IEMSCT"};
    const int kind = find(input_, iemsct) ? wordOf(iemsct, kinds) : transmittance ? 0 : find(block, {"SING_SCAT"}) ? 2 : 1;
    if (kind > 2 || transmittance != (kind == 0))
      failInput(iemsct, std::string("IEMSCT is ") + kinds[kind] + ", and the spectra are " + (transmittance ? "TRANSMITTANCE" : "RADIANCE"),
                "RT_TRANSMITTANCE, RT_THERMAL_ONLY or RT_SOLAR_AND_THERMAL with their own", "run MODTRAN with one of these");
    run_.kind = static_cast<Tape7Kind>(kind);
    run_.model = find(input_, {"ATMOSPHERE", "MODEL"}) ? wordOf({"ATMOSPHERE", "MODEL"}, kModels) : 7;
    run_.haze = wordOf({"AEROSOLS", "IHAZE"}, kHazes);
    if (const auto km = number({"AEROSOLS", "VIS"}); km && *km > 0.0) run_.visibility_km = km;
    readGeometry();
  }

  void readGeometry() {
    Tape7Geometry& g = run_.geometry;
    // Without its input a path may lead anywhere: it is taken as a slant one, whose range the user knows.
    const double type = number({"GEOMETRY", "ITYPE"}).value_or(2.0);
    if (type != 1.0 && type != 2.0 && type != 3.0)
      failInput({"GEOMETRY", "ITYPE"}, "ITYPE is " + briefNumber(type), "1 (horizontal), 2 (slant) or 3 (to space)", "run MODTRAN with one of these");
    g.path = static_cast<Tape7Path>(static_cast<int>(type));
    Json line = Json::object();
    if (const Json* lines = find(input_, {"GEOMETRY", "MLOS"}); lines && lines->is_array() && !lines->empty()) {
      if (lines->size() > 1)
        failInput({"GEOMETRY", "MLOS"}, std::to_string(lines->size()) + " lines of sight in one case", "one to a case",
                  "run MODTRAN with each line of sight as a case of its own");
      line = lines->front();
    }
    const auto of = [&](const char* key) -> std::optional<double> {
      if (const Json* own = find(line, {key}); own && own->is_number()) return own->get<double>();
      return number({"GEOMETRY", key});
    };
    g.h1_km = of("H1ALT"), g.range_km = of("HRANGE");
    if (g.path == Tape7Path::Horizontal) return;
    g.h2_km = of("H2ALT"), g.zenith_deg = of("OBSZEN"), g.earthCentreAngle_deg = of("BETA");
  }

  void readSpectra(const Way& way, const Json& block) {
    const auto under = [&](const std::string& key) {
      Way deeper = way;
      deeper.push_back(key);
      return deeper;
    };
    if (!block.is_object() || !block.contains("FREQ") || !block.at("FREQ").is_array())
      fail(way, "no wavenumbers (FREQ) beside the spectra", "FREQ: [2000.0, 2001.0, ..] in cm-1", kAgain);
    const bool transmittance = run_.kind == Tape7Kind::Transmittance;
    const Json& axis = block.at("FREQ");
    run_.bandLine = place(under("FREQ")).line;
    std::vector<std::pair<std::string, const Json*>> named;
    for (const auto& [key, values] : block.items()) {
      if (!values.is_array() || key == "FREQ") continue;
      const auto name = tape7Name(key, transmittance);
      if (!name) continue;
      if (values.size() != axis.size())
        fail(under(key), key + " has " + std::to_string(values.size()) + " values", std::to_string(axis.size()) + ", as FREQ", kAgain);
      const Location at = place(under(key));
      run_.columns.push_back({*name, transmittance ? Tape7Quantity::Transmittance : tape7::radianceQuantity(*name), {}, at.column, at.line});
      named.push_back({key, &values});
    }
    tape7::Rows rows(run_, "give MODTRAN's own JSON, in wavenumbers", kAgain);
    // The place of a single value is looked for where it is at fault: that takes as long as reading all.
    const auto use = [&](const std::string& key, size_t i, const Json& cell, const auto& take) {
      const auto at = [&](const Location& where) {
        if (!cell.is_number())
          throw UserError(where, (cell.is_string() ? tokenOf(cell.get<std::string>()) : std::string(cell.type_name())) + " in " + key, "a number", kAgain);
        take(cell.get<double>(), where);
      };
      try {
        at({});
      } catch (const UserError&) {
        Way single = under(key);
        single.push_back(std::to_string(i));
        at(place(single));
      }
    };
    for (size_t i = 0; i < axis.size(); ++i) {
      use("FREQ", i, axis[i], [&](double v, const Location& where) { rows.begin(v, where, "'" + briefNumber(v) + "'"); });
      for (size_t k = 0; k < named.size(); ++k) {
        const auto& [key, values] = named[k];
        Tape7Column& column = run_.columns[k];
        if ((*values)[i].is_null()) rows.addGap(column, column.line);
        else use(key, i, (*values)[i], [&](double v, const Location& where) { rows.add(column, v, where, "'" + briefNumber(v) + "'"); });
      }
    }
    if (axis.empty()) fail(under("FREQ"), "no wavenumbers", "two or more", kAgain);
    rows.finish();
  }

  std::string_view text_;
  const std::string& file_;
  size_t index_;
  const Json& own_;
  Json input_ = Json::object();
  Tape7Run run_;
};

}  // namespace

bool isModtranJson(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

std::vector<Tape7Run> parseModtranJson(std::string_view text, const std::string& name) {
  Json all;
  // Copying what is nested without an end would take all the stack.
  const auto shallow = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kDeepest) throw UserError({name, 1, 1, -1}, "this JSON is nested too deep", "MODTRAN 6's JSON output", kAgain);
    return true;
  };
  try {
    all = Json::parse(text, shallow);
  } catch (const Json::parse_error& e) {
    throw UserError(placeOfByte(text, name, e.byte > 0 ? e.byte - 1 : 0), "the file is no whole JSON", "MODTRAN 6's JSON output",
                    "copy the whole file again, or run MODTRAN again");
  } catch (const Json::exception&) {
    throw UserError({name, 1, 1, -1}, "a number in this JSON is too large", "numbers below 1e308", kAgain);
  }
  const auto cases = all.find("MODTRAN");
  if (cases == all.end() || !cases->is_array() || cases->empty())
    throw UserError({name, 1, 1, -1}, "this JSON is no output of MODTRAN 6: it has no list of cases (MODTRAN)", "{\"MODTRAN\": [{\"MODTRANOUTPUT\": ..}]}",
                    kAgain);
  std::vector<Tape7Run> runs;
  for (size_t i = 0; i < cases->size(); ++i) runs.push_back(CaseReader(text, name, *cases, i).read());
  return runs;
}

}  // namespace pitviper

#include "materials/refractive_index.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/scene_fingerprint.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// h c / (e x 1 um) [eV um]. Source: CODATA 2018.
constexpr double kPhotonEnergy_eV_um = 1.239841984;
constexpr double kLargestIndex = 1000.0;

std::vector<std::vector<double>> rowsOf(const Value& rows, size_t columns, const char* what) {
  std::vector<std::vector<double>> all;
  for (const Value& row : asList(rows, what).items) {
    if (row.kind != Value::Kind::List || row.items.size() != columns)
      throw UserError(row.where, std::string("a row of ") + what + " without " + std::to_string(columns) + " numbers", std::to_string(columns) + " numbers",
                      "write them in brackets");
    all.emplace_back();
    for (const Value& v : row.items) all.back().push_back(readNumber(v, "", what));
  }
  return all;
}

const ParameterTable& oscillatorTable() {
  static const ParameterTable t{
      "drude_lorentz",
      "Free and bound electrons: (n + ik)^2 = constant + sum of f plasma^2 / (resonance^2 - E^2 - i E width), in eV.",
      {withDefault(atLeast(number("constant", "", "of all resonances beyond"), 0), "1"), required(above(number("plasma", "", "plasma energy [eV]"), 0)),
       required(list("terms", "rows [f, width in eV, resonance in eV]; a resonance of 0 is Drude's free electrons", 1, 64))}};
  return t;
}

/// Rows [wavelength in um, n, k].
RefractiveIndex ofTable(const Value& rows) {
  Spectrum::Table n{{}, {}, Outside::Error, "refractive index"}, k = n;
  for (const Value& row : asList(rows, "table").items) {
    if (row.kind != Value::Kind::List || row.items.size() != 3)
      throw UserError(row.where, "a row of a table of n and k without three numbers", "[wavelength in um, n, k]", "fill the hole");
    const double w = readNumber(row.items[0], "", "wavelength");
    if (!(w >= kShortestWavelength_um && w <= kLongestWavelength_um) || (!n.wavelength_um.empty() && w <= n.wavelength_um.back()))
      throw UserError(row.where, "the wavelengths of a table of n and k do not rise or leave the spectral axis", "rising, within 0.1 to 1000 um", "sort them");
    n.wavelength_um.push_back(w);
    k.wavelength_um.push_back(w);
    n.value.push_back(readNumber(row.items[1], "", "n"));
    k.value.push_back(readNumber(row.items[2], "", "k"));
  }
  return {Spectrum(std::move(n)), Spectrum(std::move(k))};
}

RefractiveIndex ofMap(const Value& value, const SpectrumOf& spectrumOf) {
  const Record r(value, refractiveIndexTable());
  int forms = 0;
  for (const char* key : {"n", "cauchy", "sellmeier", "drude_lorentz", "table"}) forms += r.given(key) ? 1 : 0;
  if (forms != 1)
    throw UserError(value.where, forms ? "a refractive index in several forms" : "a refractive index without a form",
                    "one of 'n' (and 'k'), 'cauchy', 'sellmeier', 'drude_lorentz', 'table'", forms ? "keep one" : "add one");
  const auto k = [&] { return r.given("k") ? spectrumOf(r.value("k"), *refractiveIndexTable().find("k")) : Spectrum(0.0); };
  for (const char* key : {"table", "drude_lorentz"})
    if (r.given(key) && r.given("k")) throw UserError(r.where("k"), std::string("'k' beside '") + key + "', which has its own", "one of them", "remove it");
  const bool formula = !r.given("n") && !r.given("table");
  if (formula != (r.given("from") && r.given("to")) || (!formula && (r.given("from") || r.given("to"))))
    throw UserError(formula ? value.where : r.where(r.given("from") ? "from" : "to"),
                    formula ? "a formula without the range that it holds in" : "'from' and 'to' beside n, k or a table, which end where they end",
                    "'from' and 'to' with formulas", formula ? "add both" : "remove them");
  if (r.given("n")) return {spectrumOf(r.value("n"), *refractiveIndexTable().find("n")), k()};
  if (r.given("table")) return ofTable(r.value("table"));
  const double low = r.number("from"), high = r.number("to");
  if (!(low < high)) throw UserError(r.where("to"), "a range that ends before it begins", "'to' beyond 'from'", "exchange them");
  if (r.given("cauchy")) {
    RefractiveIndex::Cauchy c;
    for (const Value& v : r.value("cauchy").items) c.terms.push_back(readNumber(v, "", "a coefficient of Cauchy's"));
    return {c, k(), low, high};
  }
  if (r.given("sellmeier")) {
    RefractiveIndex::Sellmeier s{r.number("constant"), {}};
    for (const auto& row : rowsOf(r.value("sellmeier"), 2, "sellmeier")) s.terms.push_back({row[0], row[1]});
    return {s, k(), low, high};
  }
  const Record own(r.value("drude_lorentz"), oscillatorTable());
  RefractiveIndex::Oscillators o{own.number("constant"), own.number("plasma"), {}};
  for (const auto& row : rowsOf(own.value("terms"), 3, "terms")) o.terms.push_back({row[0], row[1], row[2]});
  return {o, Spectrum(0.0), low, high};
}

/// Looked at where it bends, between, and all over its range.
void check(const RefractiveIndex& index, const Location& where) {
  const double low = index.validLow_um(), high = index.validHigh_um();
  if (low > high) throw UserError(where, "a refractive index whose n and k have no wavelength in common", "ranges that overlap", "extend one");
  std::vector<double> all = index.knots_um();
  constexpr int kPlaces = 400;
  for (int i = 0; i <= kPlaces; ++i) all.push_back(std::clamp(low * std::pow(high / low, i / double(kPlaces)), low, high));
  for (double w : all) {
    const auto n = index(w);
    const std::string at = print("%.4g + %.4gi at %.4g um", n.real(), n.imag(), w);
    if (!(n.real() > 0.0 && n.real() <= kLargestIndex))
      throw UserError(where, std::string("a refractive index of ") + at, "n above 0, up to 1000", "correct it, or its range");
    if (!(n.imag() >= 0.0 && n.imag() <= kLargestIndex))
      throw UserError(where, std::string("a refractive index of ") + at + ": with k below 0 light would grow on its way", "k from 0 to 1000",
                      "tables printed as n - ik want the sign turned");
  }
}

}  // namespace

RefractiveIndex::RefractiveIndex(Spectrum n, Spectrum k)
    : real_(n), k_(std::move(k)), low_um_(std::max(n.validLow(), k_.validLow())), high_um_(std::min(n.validHigh(), k_.validHigh())) {}

RefractiveIndex::RefractiveIndex(std::variant<Cauchy, Sellmeier, Oscillators> formula, Spectrum k, double low_um, double high_um)
    : k_(std::move(k)), low_um_(std::max(low_um, k_.validLow())), high_um_(std::min(high_um, k_.validHigh())) {
  std::visit([this](auto&& f) { real_ = std::move(f); }, std::move(formula));
}

std::complex<double> RefractiveIndex::operator()(double w) const {
  if (w < low_um_ || w > high_um_) throw OutsideSpectrum("a refractive index has no data at " + std::to_string(w) + " um");
  if (const auto* n = std::get_if<Spectrum>(&real_)) return {(*n)(w), k_(w)};
  const double w2 = w * w;
  if (const auto* c = std::get_if<Cauchy>(&real_)) {
    double n = 0.0, power = 1.0;
    for (double a : c->terms) n += a * power, power /= w2;
    return {n, k_(w)};
  }
  if (const auto* s = std::get_if<Sellmeier>(&real_)) {
    double n2 = s->constant;
    for (const auto& [b, c] : s->terms) n2 += b * w2 / (w2 - c);
    return {n2 > 0.0 ? std::sqrt(n2) : 0.0, k_(w)};
  }
  const auto& o = std::get<Oscillators>(real_);
  const double energy = kPhotonEnergy_eV_um / w;
  std::complex<double> squared = o.constant;
  for (const auto& [f, width, resonance] : o.terms)
    squared += f * o.plasma_eV * o.plasma_eV / std::complex<double>(resonance * resonance - energy * energy, -energy * width);
  return std::sqrt(squared);  // the principal root: n >= 0, and k >= 0 where all widths are
}

std::vector<double> RefractiveIndex::knots_um() const {
  std::vector<double> all = k_.knots();
  if (const auto* n = std::get_if<Spectrum>(&real_)) {
    const auto own = n->knots();
    all.insert(all.end(), own.begin(), own.end());
  }
  std::erase_if(all, [&](double w) { return w < low_um_ || w > high_um_; });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void RefractiveIndex::addTo(Fingerprint& f) const {
  f.add(static_cast<double>(real_.index())).add(low_um_).add(high_um_);
  pitviper::addTo(f, k_);
  if (const auto* n = std::get_if<Spectrum>(&real_)) pitviper::addTo(f, *n);
  if (const auto* c = std::get_if<Cauchy>(&real_)) f.all(c->terms);
  if (const auto* s = std::get_if<Sellmeier>(&real_)) f.add(s->constant).all(s->terms);
  if (const auto* o = std::get_if<Oscillators>(&real_)) f.add(o->constant).add(o->plasma_eV).all(o->terms);
}

const ParameterTable& refractiveIndexTable() {
  static const ParameterTable t{
      "refractive index",
      "n + ik of a substance: a number (it does not absorb), the name of one in materials/substances, or a map of these keys.",
      {within(spectrum("n", "", "its real part"), 0, kLargestIndex),
       within(spectrum("k", "", "its imaginary part, above 0 where it absorbs (0 unless given)"), 0, kLargestIndex),
       list("cauchy", "a, b, c ... of n = a + b / lambda^2 + c / lambda^4 ..., lambda in um", 1, 8),
       list("sellmeier", "rows [B, C in um2] of n^2 = constant + sum of B lambda^2 / (lambda^2 - C)", 1, 16),
       withDefault(number("constant", "", "of Sellmeier's formula"), "1"), map("drude_lorentz", "free and bound electrons"),
       list("table", "rows [wavelength in um, n, k], linear between", 2, 100000), within(number("from", "um", "where a formula begins to hold"), 0.1, 1000),
       within(number("to", "um", "where it ends"), 0.1, 1000)}};
  return t;
}

RefractiveIndex readRefractiveIndex(const Value& value, const SpectrumOf& spectrumOf, const SubstanceOf& substanceOf) {
  if (value.kind == Value::Kind::Map) {
    RefractiveIndex index = ofMap(value, spectrumOf);
    check(index, value.where);
    return index;
  }
  const std::string word = readText(value, "refractive index");
  const bool number =
      !word.empty() && (std::isdigit(static_cast<unsigned char>(word.front())) || word.front() == '-' || word.front() == '+' || word.front() == '.');
  if (number) {
    RefractiveIndex index(Spectrum(readNumber(value, "", "refractive index")), Spectrum(0.0));
    check(index, value.where);
    return index;
  }
  if (!substanceOf) throw UserError(value.where, "a substance whose index is the name of another", "n and k, or a formula", "copy the other's index");
  const Value file = substanceOf(word, value.where);
  const Value* index = file.find("index");
  if (!index) throw UserError(file.where, "a substance without an 'index'", "'index: ...'", "add it");
  return readRefractiveIndex(*index, spectrumOf, {});
}

}  // namespace pitviper

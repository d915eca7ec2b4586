#include "atmosphere/tape7_cards.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper::tape7 {
namespace {

/// The line with column names, counted from card 1, where nothing is added to the ten lines of cards.
constexpr size_t kPlainCards = 10;

const char* const kNotTape7 = "give the tape7 (or .tp7) file of a MODTRAN run, unchanged from its first line on";

double needed(const Line& line, const Field& field) {
  const auto value = numberIn(line, field);
  if (!value)
    throw UserError(line.at(field.first), "no " + field.name + " (columns " + std::to_string(field.first) + "-" + std::to_string(field.last) + ")", "a number",
                    kNotTape7);
  return *value;
}

void readCard3(const Line& card, Tape7Geometry& g) {
  g.h1_km = numberIn(card, {1, 10, "H1"});
  const auto h2 = numberIn(card, {11, 20, "H2"}), angle = numberIn(card, {21, 30, "ANGLE"});
  g.range_km = numberIn(card, {31, 40, "RANGE"});
  const auto beta = numberIn(card, {41, 50, "BETA"});
  if (g.path == Tape7Path::Horizontal) return;  // the others are leftovers
  g.h2_km = h2, g.zenith_deg = angle, g.earthCentreAngle_deg = beta;
  // RO and LENN share fifteen columns, divided at 60 or 62.
  const std::string_view both = trim(card.cut(51, 65));
  if (const size_t blank = both.find_last_of(' '); blank != std::string_view::npos)
    if (const std::string_view lenn = both.substr(blank + 1); lenn == "0" || lenn == "1") g.longPath = lenn == "1";
}

void readCard4(const Line& card, Tape7Run& run) {
  run.bandLine = card.number;
  run.from_per_cm = needed(card, {1, 10, "V1 of card 4"});
  run.to_per_cm = needed(card, {11, 20, "V2 of card 4"});
  run.step_per_cm = needed(card, {21, 30, "DV of card 4"});
  run.resolution_per_cm = needed(card, {31, 40, "FWHM of card 4"});
  if (!(run.from_per_cm >= 0.0) || !(run.to_per_cm >= run.from_per_cm) || !(run.step_per_cm > 0.0))
    throw UserError(card.at(1), "card 4 does not hold a band: " + inQuotes(card.cut(1, 30)), "V1 <= V2 and a step above zero, in cm-1", kNotTape7);
  // In a card 4 given in micrometres or nanometres (FLAGS) V1 and V2 say nothing about the rows.
  const std::string_view unit = card.cut(51, 51);
  if (unit == "M" || unit == "N") run.from_per_cm = 0.0, run.to_per_cm = 0.0, run.step_per_cm = 0.0, run.resolution_per_cm = 0.0;
}

}  // namespace

void readFirstCard(const Line& card, Tape7Run& run) {
  const std::string_view t = card.text;  // only what is used is looked at: later versions put letters between the numbers
  const bool letter = t.size() >= 15 && std::string_view("TMCKFL ").find(t[0]) != std::string_view::npos;
  if (!letter || t[4] < '0' || t[4] > '9')
    throw UserError(card.at(letter ? 5 : 1), "not card 1 of a MODTRAN run", "its band model (T, M, C, K, F, L) in column 1, MODEL in column 5", kNotTape7);
  run.line = card.number;
  run.bandModel = t[0];
  if (t[2] == 'T' || t[2] == 't')
    throw UserError(card.at(3), "the run's BINARY flag is set: its spectra are in a binary file", "F or a blank in column 3",
                    "run MODTRAN with BINARY = F (card 1, column 3)");
  if (t[2] != 'F' && t[2] != 'f' && t[2] != ' ')
    throw UserError(card.at(3), inQuotes(t.substr(2, 1)) + " for the BINARY flag of card 1", "F or a blank in column 3", kNotTape7);
  run.model = t[4] - '0';
  // Column 6 holds a letter in later versions.
  const Field type{t[5] >= 'A' ? 7 : 6, 10, "ITYPE"}, mode{11, 15, "IEMSCT"};
  const double path = needed(card, type), kind = needed(card, mode);
  if (path != 1.0 && path != 2.0 && path != 3.0)
    throw UserError(card.at(6), "ITYPE of card 1 is " + inQuotes(card.cut(6, 10)), "1 (horizontal), 2 (slant) or 3 (to space)", kNotTape7);
  run.geometry.path = static_cast<Tape7Path>(static_cast<int>(path));
  if (kind == 4.0) throw UserError(card.at(11), "IEMSCT is 4: scattered sunlight without what the air emits", "0, 1, 2 or 3", "run MODTRAN with IEMSCT = 2");
  if (kind != 0.0 && kind != 1.0 && kind != 2.0 && kind != 3.0)
    throw UserError(card.at(11), "IEMSCT of card 1 is " + inQuotes(card.cut(11, 15)), "0 (transmittance), 1 (thermal), 2 (with the sun) or 3 (irradiance)",
                    kNotTape7);
  run.kind = static_cast<Tape7Kind>(static_cast<int>(kind));
  if (const auto kelvin = numberIn(card, {66, 73, "TPTEMP"}); kelvin && *kelvin > 0.0) run.boundaryTemperature_K = kelvin;
  run.surface = std::string(trim(card.cut(74, 80)));
}

void readOtherCards(const std::vector<Line>& lines, size_t card, size_t names, Tape7Run& run) {
  if (names - card < kPlainCards)
    throw UserError(lines[names].at(1), "the run's header is cut: " + std::to_string(names - card) + " lines before the names of the columns",
                    std::to_string(kPlainCards) + " or more", kNotTape7);
  // A user's profile stands between the first cards and the last ones, so these are counted from the names.
  const Line &second = lines[card + 1], &title = lines[card + 4], &third = lines[names - 5], &fourth = lines[names - 2];
  run.haze = integerIn(second, {3, 5, "IHAZE"}).value_or(0);
  if (const auto visibility = numberIn(second, {31, 40, "VIS"}); visibility && *visibility > 0.0) run.visibility_km = visibility;
  if (names - card == kPlainCards) run.title = std::string(trim(title.cut(6, 80)));
  // With MODEL 0, one layer of the user's, the line of card 3 holds that layer: pressure stands where H2 does.
  if (run.model != 0) readCard3(third, run.geometry);
  readCard4(fourth, run);
}

bool inBand(const Tape7Run& run, double v) {
  if (run.step_per_cm == 0.0) return true;
  const double slack = std::max({1.0, run.step_per_cm, run.resolution_per_cm});  // MODTRAN rounds the band to its own grid
  return v >= run.from_per_cm - slack && v <= run.to_per_cm + slack;
}

}  // namespace pitviper::tape7

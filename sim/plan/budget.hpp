#pragma once
// The accuracy that is asked for is spent here and nowhere else: every account with its share and why it has so much. A room that may lose some of it asks its
// account. It stands in `plan`, for no earlier room knows an accuracy; later ones and atmospheres ask too.
#include <array>
#include <string_view>

namespace pitviper {

/// What is asked where a scenario asks for no accuracy, and of what air in bands asks by itself.
constexpr double kUsualAccuracy = 0.01;

/// How what an account loses adds to what others lose.
enum class Adds {
  InFull,     ///< to a pixel's error: with what wavelengths lose, which have the rest, these are the error predicted
  AsSquares,  ///< to the error of a body's intensity: each is one standard deviation, and knows nothing of the others
  Within,     ///< to nothing: a limit on what is part of another account
  Apart       ///< to nothing: of another quantity than what a line of sight shows
};

struct Account {
  std::string_view name;
  double share;  ///< of the accuracy asked for
  Adds adds;
  std::string_view why;
  constexpr double of(double accuracy) const { return share * accuracy; }
};

namespace budget {

// In full.
inline constexpr Account kFields{
    "steps through plumes and clouds", 1.0 / 3.0, Adds::InFull,
    "taken whole where there are fields, for their steps and the lines through their pixels are chosen by it and not measured after"};
inline constexpr Account kSurroundings{"light from all around", 0.4, Adds::InFull,
                                       "by fewer harmonics; it changes evenly over surfaces, so that the loss on some lines needs no margin on others"};
inline constexpr Account kStreams{"light scattered again", 0.15, Adds::InFull,
                                  "by fewer streams, of the largest share that it has of any line; few lines have as much"};
inline constexpr Account kTables{"tables", 0.3, Adds::InFull,
                                 "up to this wavelengths make room for what tables of air were found to lose; finer groups help these no further"};
inline constexpr Account kTerms{"terms left out", 0.05, Adds::InFull,
                                "of each term: one that is nowhere more is dropped, and one that turns out more is learnt"};
inline constexpr Account kLampShadows{"shadows of lamps", 0.02, Adds::InFull, "looked for only where all lamps together are more than that of a pixel"};
inline constexpr Account kLamps{"lamps", 0.01, Adds::InFull, "left out where all of them together add less"};

// Within what wavelengths have.
inline constexpr Account kFitted{"groups, on lines they are fitted to", 0.33, Adds::Within, "as products; the rest is for lines that were not drawn"};
inline constexpr Account kUnseen{"groups, on lines they have not seen", 0.7, Adds::Within, "as products; checks go on until it holds"};
inline constexpr Account kBesideFields{"groups, with fields in view", 0.75, Adds::Within,
                                       "of the two before, as steps through fields have an account of their own"};
inline constexpr Account kHeld{"groups, on lines told by the equation", 0.6, Adds::Within,
                               "as sums; lines that no fit has seen may show more, and are learnt then"};
inline constexpr Account kLearnt{"lines that groups learn", 0.3, Adds::Within, "a line that shows more joins those they are fitted to"};
inline constexpr Account kAirPlaces{"places of air, for the fit", 0.4, Adds::Within,
                                    "the last lines, which the prediction is of, look at the air at no fewer than usual"};

// Within what tables have.
inline constexpr Account kTableSteps{"steps of a table of air", 0.05, Adds::Within, "each of elevations, ranges and what views share"};
inline constexpr Account kAzimuthSteps{"azimuths of a table of air", 0.1, Adds::Within, "each costs all rows anew; light scattered again changes with them"};
inline constexpr Account kSunSteps{"steps of the sun's elevation", 0.03, Adds::Within, "between two of them tables are the same"};
inline constexpr Account kProbeTables{"tables of a probe", 0.2, Adds::Within, "a guess: they are of the usual size, all around, and not measured"};
inline constexpr Account kTablesAnew{"tables made anew", 0.02, Adds::Within, "kept back until groups are final, as tables then may lose a little more"};

// Within what fields have.
inline constexpr Account kFaintFields{"fields not drawn", 0.05, Adds::Within, "elements that change no line by more, as with terms"};

// Squares.
inline constexpr Account kOutlines{"outlines of small bodies", 0.25, Adds::AsSquares, "one standard deviation of the area that a view's lines find"};
inline constexpr Account kBrightParts{"bright parts of bodies", 0.25, Adds::AsSquares, "of each part, by the share of the body's intensity that it is"};

// Of other quantities.
inline constexpr Account kBends{
    "coarse shading", 2.0, Adds::Apart,
    "of what a pixel bends from its neighbours' mean: an edge bends by all that lies between its sides, and the pixel is off by half at most"};
inline constexpr Account kMotion{"motion within an exposure", 1.0, Adds::Apart, "of the contrast at an edge that moves"};
inline constexpr Account kTruthPlaces{"truth between its places", 0.04, Adds::Apart, "of a body's contrast in truth's table, which the frame is held against"};

inline constexpr std::array kAccounts{kFields,      kSurroundings, kStreams,     kTables,   kTerms,       kLampShadows, kLamps,        kFitted,
                                      kUnseen,      kBesideFields, kHeld,        kLearnt,   kAirPlaces,   kTableSteps,  kAzimuthSteps, kSunSteps,
                                      kProbeTables, kTablesAnew,   kFaintFields, kOutlines, kBrightParts, kBends,       kMotion,       kTruthPlaces};

}  // namespace budget
}  // namespace pitviper

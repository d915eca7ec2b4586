#pragma once
// The cards of a MODTRAN run that head its table.
#include <vector>

#include "atmosphere/tape7_fields.hpp"

namespace pitviper::tape7 {

/// Card 1: kind of run, of path, model. Errors: UserError for a binary run, a kind of run that is not read, and what is no card 1.
void readFirstCard(const Line& card, Tape7Run& run);
/// The other cards: `card` is the place of card 1 in `lines`, `names` that of the column names. Errors: UserError.
void readOtherCards(const std::vector<Line>& lines, size_t card, size_t names, Tape7Run& run);

/// Whether a wavenumber can belong to the run, by card 4.
bool inBand(const Tape7Run& run, double wavenumber_per_cm);

}  // namespace pitviper::tape7

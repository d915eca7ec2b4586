#pragma once
// What the paper reached in 2006, for comparison. Source: Duvenhage 2006, section 6: GeForce 6600GT, sixteen channels; frames a second
// are those of buffered mode at 256x256.

namespace pitviper {

inline constexpr const char* kPaper = "Duvenhage 2006, GeForce 6600GT";
inline constexpr double kPaperDirect_Mpixel_s = 5.2, kPaperBuffered_Mpixel_s = 4.6;
inline constexpr double kPaperOverdrawOne_per_s = 70.0, kPaperOverdrawSeven_per_s = 10.0;

}  // namespace pitviper

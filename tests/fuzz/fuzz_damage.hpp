#pragma once
// What is done to a sound file's bytes.
#include <random>
#include <string>

namespace pitviper {

/// One damage: bits, bytes, the end, a number, a line.
void damageBytes(std::string& bytes, std::mt19937_64& random);

}  // namespace pitviper

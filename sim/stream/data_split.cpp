#include "sim/stream/data_split.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

const std::vector<std::string> kPartNames = {"train", "val", "test"};

/// Source: Steele, Lea and Flood 2014, the finalizer of SplitMix64.
std::uint64_t mixedBits(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace

std::string DataSplit::partOf(const std::string& camera, int number) const {
  if (shares.empty()) return "";
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (unsigned char c : camera) hash = (hash ^ c) * 0x100000001b3u;
  hash = mixedBits(mixedBits(hash ^ mixedBits(static_cast<std::uint64_t>(seed))) + static_cast<std::uint64_t>(number));
  const double u = std::ldexp(static_cast<double>(hash >> 11), -53);
  double upTo = 0.0;
  std::string last;
  for (const auto& [name, share] : shares) {
    if (share <= 0.0) continue;
    last = name;
    if (u < (upTo += share)) break;
  }
  return last;
}

std::vector<std::string> DataSplit::parts() const {
  std::vector<std::string> names;
  for (const auto& [name, share] : shares) names.push_back(name);
  return names.empty() ? std::vector<std::string>{""} : names;
}

std::vector<Parameter> splitParameters() {
  return {map("split",
              "shares of the pictures to train with, to validate and to test: `{train: 0.8, val: 0.1, test: 0.1}`. Which part a picture is in is a hash of "
              "`seed`, its camera and its frame's number; without it all are in one"),
          withDefault(integer("seed", "of the split", 0, 9007199254740992), "1")};
}

DataSplit readSplit(const Record& r) {
  DataSplit split;
  split.seed = r.integer("seed");
  if (!r.given("split")) return split;
  const Value& map = asMap(r.value("split"), "split");
  double sum = 0.0;
  for (std::size_t k = 0; k < map.entries.size(); ++k) {
    const auto& [name, value] = map.entries[k];
    if (std::find(kPartNames.begin(), kPartNames.end(), name) == kPartNames.end())
      throw unknownWord(map.keyPlaces[k], "there is no part of a split", name, kPartNames);
    const double share = readNumber(value, "", "a share of the split");
    if (!(share >= 0.0 && share <= 1.0)) throw UserError(value.where, "a share of " + briefNumber(share), "0 to 1", "write shares that sum to 1");
    sum += share;
  }
  for (const std::string& name : kPartNames)
    if (const Value* value = map.find(name)) split.shares.emplace_back(name, readNumber(*value, "", "a share of the split"));
  constexpr double kRounding = 1e-9;  // of decimal shares
  if (!(std::abs(sum - 1.0) <= kRounding))
    throw UserError(map.where, "the shares of the split sum to " + briefNumber(sum), "1", "write, for instance, 'split: {train: 0.8, val: 0.1, test: 0.1}'");
  return split;
}

}  // namespace pitviper

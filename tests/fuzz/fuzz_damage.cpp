#include "tests/fuzz/fuzz_damage.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace pitviper {

void damageBytes(std::string& bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random() % n); };
  const std::size_t at = below(bytes.size());
  switch (below(8)) {
    case 0:
      if (!bytes.empty()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      break;
    case 1:
      bytes.resize(at);
      break;
    case 2:
    case 3:
    case 4: {  // a number becomes another one
      constexpr const char* kNumbers[] = {"nan", "-inf", "1e308", "-1",   "0",     "4294967295", "99999999999999999999", "1e-320", "2147483647",
                                          "3.5", "",     "-",     "0x10", "65536", "1000000000"};
      std::size_t first = at;
      while (first < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[first])) == 0) ++first;
      std::size_t end = first;
      while (end < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[end])) != 0) ++end;
      bytes.replace(first, end - first, kNumbers[below(std::size(kNumbers))]);
      break;
    }
    case 5: {  // a line twice, or gone
      const std::size_t first = bytes.rfind('\n', at) == std::string::npos ? 0 : bytes.rfind('\n', at) + 1;
      const std::size_t end = bytes.find('\n', first);
      if (end == std::string::npos) break;
      if (below(2) == 0) bytes.insert(first, bytes.substr(first, end + 1 - first));
      else bytes.erase(first, end + 1 - first);
      break;
    }
    case 6:
      for (std::size_t k = at; k < std::min(at + 4, bytes.size()); ++k) bytes[k] = static_cast<char>(below(2) == 0 ? 0xff : random());
      break;
    default:
      bytes.insert(at, std::string(1 + below(40), static_cast<char>(random())));
      break;
  }
}

}  // namespace pitviper

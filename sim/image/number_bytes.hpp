#pragma once
// Numbers as files hold them, of any width and byte order.
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace pitviper {

enum class NumberType { UInt8, Int8, UInt16, Int16, UInt32, Int32, UInt64, Int64, Float32, Float64 };

inline std::size_t bytesOf(NumberType type) {
  switch (type) {
    case NumberType::UInt8:
    case NumberType::Int8:
      return 1;
    case NumberType::UInt16:
    case NumberType::Int16:
      return 2;
    case NumberType::UInt32:
    case NumberType::Int32:
    case NumberType::Float32:
      return 4;
    default:
      return 8;
  }
}

/// The first number at `from`.
template <class T>
T numberAt(const char* from, bool bigEndian) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof(T));
  if (bigEndian != (std::endian::native == std::endian::big)) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Calls `take(index, number)` for `count` numbers, each in its own type.
template <class Take>
void eachNumber(NumberType type, const char* from, std::size_t count, bool bigEndian, const Take& take) {
  const auto all = [&]<class T>(T) {
    for (std::size_t i = 0; i < count; ++i) take(i, numberAt<T>(from + i * sizeof(T), bigEndian));
  };
  switch (type) {
    case NumberType::UInt8:
      return all(std::uint8_t{});
    case NumberType::Int8:
      return all(std::int8_t{});
    case NumberType::UInt16:
      return all(std::uint16_t{});
    case NumberType::Int16:
      return all(std::int16_t{});
    case NumberType::UInt32:
      return all(std::uint32_t{});
    case NumberType::Int32:
      return all(std::int32_t{});
    case NumberType::UInt64:
      return all(std::uint64_t{});
    case NumberType::Int64:
      return all(std::int64_t{});
    case NumberType::Float32:
      return all(float{});
    case NumberType::Float64:
      return all(double{});
  }
}

}  // namespace pitviper

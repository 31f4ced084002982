#pragma once
// FNV-1a, 64 bits: for state hashes, never for security.

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace calot {

class Hash {
 public:
  void add_bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) {
      state_ ^= bytes[i];
      state_ *= 0x100000001b3ULL;
    }
  }
  /// Bits, not values: -0.0 differs from 0.0. Arithmetic types only, so that no padding is hashed.
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T value) { add_bytes(&value, sizeof value); }
  void add(std::span<const double> values) { add_bytes(values.data(), values.size_bytes()); }
  void add(std::string_view text) { add_bytes(text.data(), text.size()); }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

/// The same for much data, eight bytes at a time, of long lists four times eight at once.
class WordHash {
 public:
  void add_bytes(const void* data, std::size_t size);
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T value) {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof value);
    state_ = mixed(state_, word);
  }
  std::uint64_t value() const { return state_; }

 private:
  /// No two words lead from one state to the same.
  static std::uint64_t mixed(std::uint64_t state, std::uint64_t word) {
    state = (state ^ word) * 0x9e3779b97f4a7c15ULL;
    return state ^ state >> 32;
  }
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

/// Sixteen lower-case hexadecimal digits.
std::string hex(std::uint64_t value);

}  // namespace calot

#pragma once
// SHA-256 (FIPS 180-4): for what must not be taken for something else, where 64 bits of Hash would not do.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace calot {

class Digest {
 public:
  void add_bytes(const void* data, std::size_t size);
  /// Bits, not values. Arithmetic types only, so that no padding is taken.
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T value) { add_bytes(&value, sizeof value); }
  /// With their number, so that what follows is not taken for a part of them.
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(std::span<const T> values) {
    add(values.size());
    add_bytes(values.data(), values.size_bytes());
  }
  void add(std::string_view text) {
    add(text.size());
    add_bytes(text.data(), text.size());
  }
  /// Of all that was added: 64 lower-case hexadecimal digits. More may follow.
  std::string hex() const;

 private:
  void take_block(const unsigned char* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> waiting_{};  ///< what fills no block yet
  std::uint64_t size_ = 0;                   ///< bytes added
};

}  // namespace calot

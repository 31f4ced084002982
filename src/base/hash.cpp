#include "base/hash.h"

#include <fmt/format.h>

namespace calot {

void WordHash::add_bytes(const void* data, std::size_t size) {
  constexpr std::size_t word = sizeof(std::uint64_t), lanes = 4;
  const auto* bytes = static_cast<const unsigned char*>(data);
  const auto word_at = [&](std::size_t at, std::size_t count) {
    std::uint64_t out = 0;
    std::memcpy(&out, bytes + at, count);
    return out;
  };
  std::size_t at = 0;
  if (size >= lanes * word) {
    std::uint64_t each[lanes] = {state_, 1, 2, 3};
    for (; at + lanes * word <= size; at += lanes * word)
      for (std::size_t k = 0; k < lanes; ++k) each[k] = mixed(each[k], word_at(at + k * word, word));
    for (std::uint64_t lane : each) state_ = mixed(state_, lane);
  }
  for (; at + word <= size; at += word) state_ = mixed(state_, word_at(at, word));
  if (at < size) state_ = mixed(state_, word_at(at, size - at));
}

std::string hex(std::uint64_t value) { return fmt::format("{:016x}", value); }

}  // namespace calot

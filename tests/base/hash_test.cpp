#include "base/hash.h"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace calot {
namespace {

std::uint64_t hash_of(std::string_view text) {
  Hash hash;
  hash.add(text);
  return hash.value();
}

// Published 64-bit FNV-1a test vectors (Fowler, Noll, Vo; draft-eastlake-fnv).
TEST(Hash, IsFnv1a) {
  EXPECT_EQ(hash_of(""), 0xcbf29ce484222325ULL);
  EXPECT_EQ(hash_of("a"), 0xaf63dc4c8601ec8cULL);
  EXPECT_EQ(hash_of("foobar"), 0x85944171f73967e8ULL);
}

TEST(Hash, DependsOnBytesAndOrderNotOnHowTheyAreCut) {
  Hash cut;
  cut.add(std::string_view("foo"));
  cut.add(std::string_view("bar"));
  EXPECT_EQ(cut.value(), hash_of("foobar"));
  EXPECT_NE(hash_of("foobar"), hash_of("barfoo"));
}

TEST(Hash, SeesEveryBitOfANumber) {
  const auto of = [](double value) {
    Hash hash;
    hash.add(value);
    return hash.value();
  };
  EXPECT_EQ(of(1.0), of(1.0));
  EXPECT_NE(of(1.0), of(std::nextafter(1.0, 2.0)));
  EXPECT_NE(of(0.0), of(-0.0));
}

TEST(Hash, ASpanCountsAsItsNumbersInTurn) {
  const std::vector<double> values = {1.5, -2.0, 3e-9};
  Hash together, apart;
  together.add(std::span<const double>(values));
  for (const double value : values) apart.add(value);
  EXPECT_EQ(together.value(), apart.value());
}

TEST(WordHash, SeesEveryBitAndItsPlaceHoweverLongTheData) {
  const auto of = [](const std::vector<char>& bytes) {
    WordHash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    return hash.value();
  };
  for (const std::size_t size : {1u, 7u, 8u, 31u, 32u, 33u, 100u}) {
    const std::vector<char> plain(size, 0);
    std::set<std::uint64_t> seen{of(plain)};
    for (std::size_t bit = 0; bit < 8 * size; ++bit) {
      std::vector<char> other = plain;
      other[bit / 8] = static_cast<char>(1u << bit % 8);
      EXPECT_TRUE(seen.insert(of(other)).second) << size << " bytes, bit " << bit;
      if (bit + 1 == 8 * size) continue;
      // Two signs that change at once do not hide each other.
      other.back() = static_cast<char>(other.back() ^ 0x80);
      EXPECT_TRUE(seen.insert(of(other)).second) << size << " bytes, bit " << bit << " and the last";
    }
  }
}

TEST(Hash, HexIsSixteenLowerCaseDigits) {
  EXPECT_EQ(hex(0), "0000000000000000");
  EXPECT_EQ(hex(0xABCDEF), "0000000000abcdef");
  EXPECT_EQ(hex(~0ULL), "ffffffffffffffff");
}

}  // namespace
}  // namespace calot

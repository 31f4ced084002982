#include "base/suggest.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace calot {
namespace {

std::string random_word(Rng& rng) {
  std::string word(rng.next() % 7, 'a');
  for (char& c : word) c = static_cast<char>('a' + rng.next() % 3);
  return word;
}

TEST(Suggest, EditDistanceIsAMetric) {
  Rng rng(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const std::string a = random_word(rng), b = random_word(rng), c = random_word(rng);
    EXPECT_EQ(edit_distance(a, b) == 0, a == b);
    EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
    EXPECT_LE(edit_distance(a, c), edit_distance(a, b) + edit_distance(b, c));
    EXPECT_EQ(edit_distance(a, ""), static_cast<int>(a.size()));
  }
}

TEST(Suggest, OneEditIsAtDistanceOne) {
  EXPECT_EQ(edit_distance("fundus", "fundu"), 1);
  EXPECT_EQ(edit_distance("fundus", "funduss"), 1);
  EXPECT_EQ(edit_distance("fundus", "fandus"), 1);
  EXPECT_EQ(edit_distance("fundus", "fundsu"), 2);  // a swap is two replacements
}

TEST(Suggest, TheNearestNameWinsAndTheFirstOfEquals) {
  const std::vector<std::string> names = {"neck", "fundus", "body", "bed"};
  EXPECT_EQ(closest_name("fundsu", names), "fundus");
  EXPECT_EQ(closest_name("FUNDUS", names), "fundus");
  EXPECT_EQ(closest_name("nek", names), "neck");
  EXPECT_EQ(closest_name("bad", {"bid", "bed"}), "bid");
  EXPECT_EQ(closest_name("bed", names), "bed");
}

TEST(Suggest, NothingIsSuggestedForAWordUnlikeAny) {
  const std::vector<std::string> names = {"neck", "fundus", "body", "bed"};
  EXPECT_EQ(closest_name("liver", names), "");
  EXPECT_EQ(closest_name("", names), "");
  EXPECT_EQ(closest_name("x", {"y"}), "");
  EXPECT_EQ(closest_name("neck", {}), "");
}

TEST(Suggest, LongNamesAndListsAreToldInShort) {
  const std::string giant(1'000'000, 'x');
  EXPECT_EQ(closest_name(giant, {giant, "x"}), "");
  EXPECT_EQ(closest_name("x", {giant}), "");
  EXPECT_LT(suggestion("liver", {giant, "neck"}).size(), 200u);
  const std::vector<std::string> many(100'000, "neck");
  EXPECT_LT(suggestion("liver", many).size(), 500u);
  EXPECT_NE(suggestion("liver", many).find("and 99940 more"), std::string::npos);
}

TEST(Suggest, ShortenedTextsKeepWholeCharacters) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc... (4 bytes)");
  EXPECT_EQ(shortened("a\xC3\xA4z", 2), "a... (4 bytes)");
}

TEST(Suggest, TheHintNamesTheNearestOrAllThatAreKnown) {
  EXPECT_EQ(suggestion("nek", {"neck", "bed"}), "did you mean \"neck\"?");
  EXPECT_EQ(suggestion("liver", {"neck", "bed"}), "known: neck, bed");
  EXPECT_EQ(suggestion("liver", {}), "");
}

}  // namespace
}  // namespace calot

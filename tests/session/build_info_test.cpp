#include "session/build_info.h"

#include <gtest/gtest.h>

namespace calot {
namespace {

TEST(Make, NamesEverythingThatDecidesTheBitsOfAState) {
  const Make make = this_make();
  EXPECT_FALSE(make.toolchain.empty());
  EXPECT_FALSE(make.instruction_set.empty());
  for (const char* part : {"glibc ", "values ", "CHOLMOD "})
    EXPECT_NE(make.mathematics.find(part), std::string::npos) << make.mathematics;
}

TEST(Make, EachKnownPartThatDiffersChangesBitsAndAnUnknownOneClaimsNothing) {
  const Make here{"GNU 12.2.0", "x86-64-v3", "glibc 2.36 with FMA"};
  EXPECT_TRUE(same_bits(here, here));
  for (std::string Make::*part : {&Make::toolchain, &Make::instruction_set, &Make::mathematics}) {
    Make other = here;
    other.*part = "another";
    EXPECT_FALSE(same_bits(here, other));
    EXPECT_FALSE(same_bits(other, here));
    other.*part = "";
    EXPECT_TRUE(same_bits(here, other));
  }
  EXPECT_EQ(to_text(here), "GNU 12.2.0, x86-64-v3, glibc 2.36 with FMA");
  EXPECT_EQ(to_text(Make{}), "an unknown build");
}

}  // namespace
}  // namespace calot

// What scripts/setup decides before there is a program.

#include <gtest/gtest.h>

#include "app/program.h"

namespace calot::test {
namespace {

class Setup : public ProgramTest {
 protected:
  /// What it builds for in this environment ("NAME=value"), and what it says.
  std::pair<std::string, std::string> chosen(const std::string& environment) const {
    const std::string line = "env -u CALOT_ARCH " + environment + " bash -c 'set -euo pipefail; . \"" +
                             source_dir() +
                             "/scripts/setup\"; choose_architecture; echo \"$arch\"' >arch 2>said";
    EXPECT_EQ(shell(folder_, line), 0) << slurp(folder_ / "said");
    return {slurp(folder_ / "arch"), slurp(folder_ / "said")};
  }
};

TEST_F(Setup, BuildsForX86_64WhereTheLoaderFindsNoV3AndSaysSoInOneLine) {
  const auto [arch, said] = chosen("GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2");
  EXPECT_EQ(arch, "x86-64\n");
  EXPECT_NE(said.find("no x86-64-v3"), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

TEST_F(Setup, BuildsForWhatDoctorSaysThatTheProcessorOffers) {
  const bool offered = calot({"doctor"}).out.find("processor: offers x86-64-v3") != std::string::npos;
  EXPECT_EQ(chosen("").first, offered ? "x86-64-v3\n" : "x86-64\n");
}

TEST_F(Setup, BuildsForWhatItIsTold) {
  for (const std::string arch : {"x86-64", "x86-64-v3"}) {
    const auto [chose, said] = chosen("CALOT_ARCH=" + arch);
    EXPECT_EQ(chose, arch + "\n");
    EXPECT_EQ(said, "");
  }
}

}  // namespace
}  // namespace calot::test

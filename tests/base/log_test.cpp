#include "base/log.h"

#include <gtest/gtest.h>

#include "support/warnings.h"

namespace calot {
namespace {

TEST(Log, EachLineReachesTheSinkOfTheDayWithItsLevel) {
  std::vector<std::pair<LogLevel, std::string>> heard;
  const LogSink before =
      set_log_sink([&](LogLevel level, const std::string& text) { heard.emplace_back(level, text); });
  log_info("building");
  log_warning("odd");
  const LogSink mine = set_log_sink(before);
  log_info("not for mine");
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0], std::pair(LogLevel::info, std::string("building")));
  EXPECT_EQ(heard[1], std::pair(LogLevel::warning, std::string("odd")));
  EXPECT_TRUE(mine);
}

TEST(Log, TestsHearWarnings) {
  log_warning("expected here");
  EXPECT_EQ(test::warnings(), std::vector<std::string>{"expected here"});
  test::warnings().clear();
}

}  // namespace
}  // namespace calot

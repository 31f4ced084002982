// Runs the tests of one room; a warning that no test expects fails the test in which it was logged.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "base/log.h"
#include "support/warnings.h"

namespace calot::test {

std::vector<std::string>& warnings() {
  static std::vector<std::string> list;
  return list;
}

namespace {

class WarningsFail : public ::testing::EmptyTestEventListener {
  void OnTestStart(const ::testing::TestInfo&) override { warnings().clear(); }
  void OnTestEnd(const ::testing::TestInfo&) override {
    for (const std::string& text : warnings()) ADD_FAILURE() << "unexpected warning: " << text;
  }
};

}  // namespace
}  // namespace calot::test

int main(int argc, char** argv) {
  ::testing::InitGoogleMock(&argc, argv);
  // Nothing that an earlier run has kept may decide a test, of this program or of one that it starts.
  setenv("CALOT_CACHE", "", 1);
  calot::set_log_sink([](calot::LogLevel level, const std::string& text) {
    if (level == calot::LogLevel::warning) calot::test::warnings().push_back(text);
  });
  ::testing::UnitTest::GetInstance()->listeners().Append(new calot::test::WarningsFail);
  return RUN_ALL_TESTS();
}

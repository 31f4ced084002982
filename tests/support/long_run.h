#pragma once
// What a run of all tests in some minutes leaves to scripts/test --long, which takes up to an hour.

#include <gtest/gtest.h>

#include <cstdlib>

namespace calot::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

/// Set by scripts/test --long.
inline bool long_run() { return std::getenv("CALOT_LONG") != nullptr; }

/// How many random cases are tried.
inline int cases(int usually, int in_a_long_run) {
  return long_run() && !sanitized ? in_a_long_run : usually;
}

}  // namespace calot::test

/// First line of a test that is left out where the sanitizers make it take too long, unless the run is a long one.
#define CALOT_SLOW_WHEN_SANITIZED(reason)                 \
  if (calot::test::sanitized && !calot::test::long_run()) \
  GTEST_SKIP() << "left to scripts/test --long under sanitizers: " << reason

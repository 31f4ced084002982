#pragma once

#include <string>
#include <vector>

namespace calot::test {

/// Warnings logged since the running test started. A test that expects some checks them and clears the list.
std::vector<std::string>& warnings();

}  // namespace calot::test

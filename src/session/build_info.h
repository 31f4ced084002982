#pragma once
// What made this binary: state hashes may only be compared between equal ones.

#include <string>

namespace calot {

/// Of the program.
std::string version();
/// Compiler with version, e.g. "GNU 12.2.0".
std::string toolchain();
/// "x86-64-v3" or "x86-64": what the binary was compiled for, not what the processor offers.
std::string instruction_set();

}  // namespace calot

#include "session/build_info.h"

namespace calot {

std::string version() { return "0.1.0"; }

std::string toolchain() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#else
  return "GNU " __VERSION__;
#endif
}

std::string instruction_set() {
#if defined(__AVX512F__)
  return "x86-64-v4";
#elif defined(__AVX2__) && defined(__FMA__) && defined(__BMI2__)
  return "x86-64-v3";
#else
  return "x86-64";
#endif
}

}  // namespace calot

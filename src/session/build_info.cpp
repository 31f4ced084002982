#include "session/build_info.h"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <suitesparse/cholmod.h>

#include <cmath>

#include "base/hash.h"
#include "base/processor.h"
#if __has_include(<sys/platform/x86.h>)
#if !defined(_Bool)
#define _Bool bool  // the header is C
#endif
#include <sys/platform/x86.h>
#endif

namespace calot {
namespace {

std::string toolchain() {
#if defined(__clang__)
  return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return "GNU " __VERSION__;
#endif
}

std::string instruction_set() {
#if defined(__AVX512F__)
  return "x86-64-v4";
#else
  return built_for_x86_64_v3 ? "x86-64-v3" : "x86-64";
#endif
}

/// The C library has each function up to three times and picks one when the process starts.
std::string chosen_variant() {
#if __has_include(<sys/platform/x86.h>)
  if (CPU_FEATURE_ACTIVE(FMA) && CPU_FEATURE_ACTIVE(AVX2)) return " with FMA";
  return " without FMA";
#else
  return "";
#endif
}

/// A hash of what the C library's functions give. Rounding differs between variants and versions in one of a few
/// hundred arguments: a thousand of them tell the variants apart whatever they are called.
std::uint64_t value_hash() {
  Hash hash;
  for (int i = 1; i <= 1000; ++i) {
    const volatile double unfolded = i * 0.00137;  // not computed by the compiler
    const double x = unfolded;
    for (const double value :
         {std::sin(x), std::cos(x), std::tan(x), std::exp(x), std::log(x), std::pow(x, 1.7), std::atan(x),
          std::atan2(x, 0.7), std::acos(x / 2), std::asin(x / 2), std::cbrt(x), std::hypot(x, 0.3)})
      hash.add(value);
  }
  return hash.value();
}

std::string mathematics() {
  int solver[3];
  cholmod_version(solver);
  return fmt::format("glibc {}{}, values {}, CHOLMOD {}", gnu_get_libc_version(), chosen_variant(),
                     hex(value_hash()), fmt::join(solver, "."));
}

}  // namespace

std::string version() { return "0.1.0"; }

Make this_make() {
  static const Make make{toolchain(), instruction_set(), mathematics()};
  return make;
}

std::string to_text(const Make& make) {
  std::string text;
  for (const std::string& part : {make.toolchain, make.instruction_set, make.mathematics})
    if (!part.empty()) text += (text.empty() ? "" : ", ") + part;
  return text.empty() ? "an unknown build" : text;
}

bool same_bits(const Make& a, const Make& b) {
  const auto same = [](const std::string& x, const std::string& y) {
    return x.empty() || y.empty() || x == y;
  };
  return same(a.toolchain, b.toolchain) && same(a.instruction_set, b.instruction_set) &&
         same(a.mathematics, b.mathematics);
}

}  // namespace calot

#pragma once
// Which instruction set the processor offers, and which one this build uses.

namespace calot {

/// Whether this build uses AVX2, FMA and BMI2.
#if defined(__AVX2__) && defined(__FMA__) && defined(__BMI2__)
constexpr bool built_for_x86_64_v3 = true;
#else
constexpr bool built_for_x86_64_v3 = false;
#endif

/// Whether processor and kernel have x86-64-v3, as CPUID says: what came last of it is asked for (Clang 14 knows no name
/// of the whole). May be called before any initialiser.
inline bool processor_has_x86_64_v3() {
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2");
}

}  // namespace calot

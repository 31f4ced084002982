#include <malloc.h>

#include <cstdio>
#include <cstdlib>

#include "app/cli.h"

namespace {

/// Runs before any other initialiser, and uses nothing that an older processor lacks.
__attribute__((constructor(101))) void check_processor() {
#if defined(__AVX2__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
    return;
  std::fputs(
      "This processor lacks the instruction set that calot was built for (x86-64-v3).\n"
      "Next: CALOT_ARCH=x86-64 scripts/run\n",
      stderr);
  std::_Exit(7);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  // Matrices come and go with every step: pages that were given back would be fetched again, a quarter of its time.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that glibc takes
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  return calot::run_program(argc, argv);
}

#include <malloc.h>

#include <cstdio>
#include <cstdlib>

#include "app/cli.h"
#include "base/processor.h"

namespace {

/// Ends the process (7) where the processor lacks what this file was compiled for. Runs before any other initialiser,
/// and uses nothing that an older processor lacks.
__attribute__((constructor(101))) void check_processor() {
  if (!calot::built_for_x86_64_v3 || calot::processor_has_x86_64_v3()) return;
  std::fputs(
      "This processor lacks the instruction set that calot was built for (x86-64-v3).\n"
      "Next: scripts/run, which builds for the processor that it finds\n",
      stderr);
  std::_Exit(7);
}

}  // namespace

int main(int argc, char** argv) {
  // Matrices come and go with every step: pages that were given back would be fetched again, a quarter of its time.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that glibc takes
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  return calot::run_program(argc, argv);
}

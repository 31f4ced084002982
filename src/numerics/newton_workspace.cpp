#include "numerics/newton_workspace.h"

namespace calot {

void NewtonWorkspace::restore(const Kept& kept) {
  if (!matrix.same_pattern(kept.pattern)) matrix = kept.pattern.blank();
  factor = kept.factor;
  border = kept.border;
  factored = kept.factored;
  shifted = kept.shifted;
}

}  // namespace calot

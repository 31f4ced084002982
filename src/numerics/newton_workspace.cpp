#include "numerics/newton_workspace.h"

namespace calot {

void NewtonWorkspace::restore(const Kept& kept) {
  if (!matrix.same_pattern(kept.pattern)) matrix = kept.pattern.blank();
  factor = kept.factor;
  border = kept.border;
  factored = kept.factored;
  shifted = kept.shifted;
  sharp = kept.sharp;
}

void visit_members(MemberReader& read, NewtonWorkspace& work) {
  BlockMatrix pattern;
  std::vector<char> kept;
  bool factored = false, shifted = false;
  read(pattern, kept, factored, shifted);
  if (!kept.empty() && kept.size() != static_cast<std::size_t>(pattern.nodes())) read.refuse();
  if (read.lacks()) return;
  work = NewtonWorkspace(std::move(pattern), kept);
  work.shifted = shifted;
  if (!factored) return;
  std::vector<double> entries;
  read(work.border, entries, work.sharp);
  if (entries.size() != work.matrix.entries().size() || work.border.gradients.rows() != work.matrix.size())
    return read.refuse();
  work.matrix.assign(entries);
  work.factored = work.factor.factorise(work.matrix) == FactorStatus::ok;
  if (!work.factored) read.refuse();
}

}  // namespace calot

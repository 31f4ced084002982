#include "organs/organ.h"

#include <fmt/format.h>

namespace calot {

Organ::Organ(OrganDefinition of, BodyPointer with) : definition(std::move(of)), body(std::move(with)) {
  state.x = body->rest();
}

OrganSnapshot snapshot(const Organ& organ) { return {organ, organ.body}; }

void restore(Organ& organ, const OrganSnapshot& snapshot) {
  organ.body = snapshot.body;
  static_cast<OrganMotion&>(organ) = snapshot;
}

double raw_area(const Organ& organ) {
  if (!has_capsule(organ.definition.shape)) return 0;
  double sum = 0;  // J
  for (const Burn& burn : organ.burns) sum += burn.energy;
  return sum / organ.definition.wall.raw_energy;
}

std::string quoted(const Organ& organ) { return "'" + organ.definition.name + "'"; }

Failure at_organ(Failure failure, std::size_t index) {
  for (Problem& problem : failure.problems) {
    std::string& path = problem.place.path;
    if (problem.place.file.empty() && (path.empty() || path.front() == '.'))
      path = fmt::format("scene.anatomy.organs[{}]{}", index + 1, path);
  }
  return failure;
}

std::optional<OrganPoint> find_landmark(const std::vector<Organ>& organs, const std::string& name) {
  const std::size_t dot = name.rfind('.');  // a piece's name has one, too
  for (std::size_t k = 0; k < organs.size() && dot != std::string::npos; ++k) {
    if (organs[k].definition.name != name.substr(0, dot)) continue;
    const auto found = organs[k].landmarks.find(name.substr(dot + 1));
    if (found != organs[k].landmarks.end()) return OrganPoint{OrganIndex(k), found->second};
  }
  return std::nullopt;
}

Failure solve_failure(const NewtonResult& result, const std::string& organ, const std::string& when) {
  if (result.status == NewtonStatus::stopped)
    return fail(FailureKind::interrupted,
                fmt::format("interrupted while organ '{}' came to rest {}", organ, when));
  const std::string hint =
      result.status == NewtonStatus::mechanism
          ? "give the organ a held region (a rigid thing is not held), let something support it, or let it "
            "fall: solver = { motion = \"dynamic\" }"
          : "move more slowly or less far, raise solver.rate, or give the organ more "
            "nodes where it is handled";
  return fail(FailureKind::simulation,
              fmt::format("organ '{}' found no equilibrium {}: {} (residual {:.2g}, {} iterations)", organ,
                          when, to_text(result.status), result.residual, result.iterations),
              hint);
}

Failure no_rest_failure(const NewtonResult& result, const std::string& organ, const std::string& when) {
  Failure out = solve_failure(result, organ, when);
  const bool is_ours =
      result.status == NewtonStatus::not_finite || result.status == NewtonStatus::out_of_memory;
  if (out.kind != FailureKind::simulation || is_ours) return out;
  out.kind = FailureKind::scenario;
  if (result.status != NewtonStatus::mechanism)
    out.problems.front().hint = "let something hold or support it, or give it more nodes or a stiffer wall";
  return out;
}

}  // namespace calot

#include "organs/organ.h"

#include <fmt/format.h>

namespace calot {

OrganSnapshot snapshot(const Organ& organ) {
  return {organ.body,     organ.state, organ.grips,  organ.extensions, organ.refused_details,
          organ.friction, organ.clips, organ.unfelt, organ.openings,   organ.left_in,
          organ.burns};
}

void restore(Organ& organ, const OrganSnapshot& snapshot) {
  organ.body = snapshot.body;
  organ.state = snapshot.state;
  organ.grips = snapshot.grips;
  organ.extensions = snapshot.extensions;
  organ.refused_details = snapshot.refused_details;
  organ.friction = snapshot.friction;
  organ.clips = snapshot.clips;
  organ.unfelt = snapshot.unfelt;
  organ.openings = snapshot.openings;
  organ.left_in = snapshot.left_in;
  organ.burns = snapshot.burns;
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
  const std::string hint = result.status == NewtonStatus::mechanism
                               ? "give the organ a held region, or let something support it"
                               : "move more slowly or less far, raise solver.rate, or give the organ more "
                                 "nodes where it is handled";
  return fail(FailureKind::simulation,
              fmt::format("organ '{}' found no equilibrium {}: {} (residual {:.2g}, {} iterations)", organ,
                          when, to_text(result.status), result.residual, result.iterations),
              hint);
}

}  // namespace calot

#include "view/strand_lines.h"

namespace calot {
namespace {

Vec3 on_skin(const CarriedPlace& place, const std::vector<Vec3>& skin) {
  Vec3 out = Vec3::Zero();
  for (std::size_t i = 0; i < place.points.size(); ++i) out += place.weights[i] * skin[place.points[i]];
  return out;
}

}  // namespace

std::vector<StrandLine> strand_lines(const Tissue& tissue, const VecX& nodes,
                                     const std::vector<std::vector<Vec3>>& skins) {
  const auto& bodies = tissue.strands->bodies();
  std::vector<StrandLine> out;
  for (const PlacedStrand& strand : tissue.strands->strands())
    out.push_back({on_skin(strand.one, skins[bodies[0]]),
                   nodes.segment<3>(3 * static_cast<Eigen::Index>(out.size())),
                   on_skin(strand.other, skins[bodies[1]])});
  return out;
}

}  // namespace calot

#include "view/burnt_shares.h"

#include <algorithm>
#include <cmath>

#include "view/scatter.h"

namespace calot {
namespace {

/// A mark on the surface at rest.
struct SurfaceMark {
  Vec3 at;                            // m
  double most = 0, squared_wide = 0;  // share in its middle; m^2
};

double depth_at(const SurfaceMark& mark, const Vec3& place) {
  return mark.most * std::exp(-(place - mark.at).squaredNorm() / mark.squared_wide);
}

std::vector<SurfaceMark> burns_of(const Organ& organ) {
  constexpr double wide =
      1.7e-3;  // m, of a burn: the place that takes the heat, and what whitens around it (d)
  std::vector<SurfaceMark> marks;
  for (const Burn& burn : organ.burns)
    marks.push_back({burn.at, std::min(1.0, burn.energy / organ.definition.wall.burn_energy), wide * wide});
  return marks;
}

/// The fibrous sheet that a loose plane leaves on either side: whitish, more so where heat has divided its strands, and
/// charred here and there.
void add_bed(const Tissue& tissue, int side, const Body& body, std::vector<SurfaceMark>& marks) {
  constexpr double sheet_is = 0.15, heat_adds = 0.09, char_adds = 0.80, charred = 0.2;  // (d)
  for (std::size_t k = 0; k < tissue.strands->strands().size(); ++k) {
    const PlacedStrand& strand = tissue.strands->strands()[k];
    const double hot = tissue.heated_share(k);
    const double adds = heat_adds + (share_of(k, side, 0) < charred ? char_adds : 0);
    marks.push_back({carried_to(side == 0 ? strand.one : strand.other, body.skin_rest()),
                     std::min(1.0, sheet_is + adds * hot * hot), 0.6 * strand.area});
  }
}

/// By increasing z. Tubes have none: no strand ends on what is drawn of them.
std::vector<SurfaceMark> bed_of(const Field& field, OrganIndex organ) {
  std::vector<SurfaceMark> marks;
  for (const Tissue& tissue : field.tissues)
    for (const int side : {0, 1})
      if (!field.organ(organ).body->is_line() && tissue.definition.looks == TissueLooks::areolar &&
          tissue.strands->bodies()[static_cast<std::size_t>(side)] == organ.value)
        add_bed(tissue, side, *field.organ(organ).body, marks);
  std::sort(marks.begin(), marks.end(),
            [](const SurfaceMark& a, const SurfaceMark& b) { return a.at.z() < b.at.z(); });
  return marks;
}

/// Of marks that lie side by side, as burns do not, the deepest counts; none reaches farther than `reach`, m.
double deepest(const std::vector<SurfaceMark>& by_z, double reach, const Vec3& place) {
  double most = 0;
  const auto first = std::lower_bound(by_z.begin(), by_z.end(), place.z() - reach,
                                      [](const SurfaceMark& mark, double z) { return mark.at.z() < z; });
  for (auto mark = first; mark != by_z.end() && mark->at.z() < place.z() + reach; ++mark)
    if ((place - mark->at).squaredNorm() < reach * reach) most = std::max(most, depth_at(*mark, place));
  return most;
}

}  // namespace

std::vector<double> burnt_shares(const Field& field, OrganIndex organ, const std::vector<int>* points) {
  const std::vector<SurfaceMark> burns = burns_of(field.organ(organ)), bed = bed_of(field, organ);
  if (burns.empty() && bed.empty()) return {};
  double reach = 0;
  for (const SurfaceMark& mark : bed) reach = std::max(reach, std::sqrt(5 * mark.squared_wide));
  const std::vector<Vec3>& rest = field.organ(organ).body->drawn_rest();
  std::vector<double> shares(points == nullptr ? rest.size() : points->size());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const Vec3& place = rest[points == nullptr ? i : static_cast<std::size_t>((*points)[i])];
    double share = deepest(bed, reach, place);
    for (const SurfaceMark& burn : burns) share += depth_at(burn, place);
    shares[i] = std::min(1.0, share);
  }
  return shares;
}

}  // namespace calot

#include "world/critical_view.h"

#include <algorithm>
#include <cmath>

#include "collision/edge_distance.h"
#include "collision/simplex_distance.h"
#include "field/field.h"
#include "joins/skin_place.h"
#include "organs/strand_places.h"
#include "world/sight.h"

namespace calot {
namespace {

/// What the triangle is stretched between is as thick as that: it hides no place of the triangle, m.
constexpr double border = 2e-3;
/// Of a side that is open to less than this share nothing is known.
constexpr double least_open = 0.1;
/// How far beyond a ray that no organ stops is looked for tissue, m.
constexpr double farthest_looked = 60e-3;
/// Where a lens is put behind the triangle, m from its middle.
constexpr double lens_behind = 25e-3;
/// Tissue nearer to a structure's surface than that is on it, m.
constexpr double on_surface = 1e-3;

/// A strand that stands.
struct Standing {
  StrandLine line;
  double radius = 0;  ///< m, of its lobules
  double share = 0;   ///< of the gallbladder's way where it ends there
  bool of_plate = false;
};

/// Calls use(strand, torn) for all strands of all tissues.
template <class Use>
void for_strands(const Field& field, const CriticalViewQuestion& question, const Use& use) {
  const std::optional<OrganIndex> gallbladder = organ_called(field, question.gallbladder);
  for (const Tissue& tissue : field.tissues) {
    const std::vector<StrandLine> lines = strand_lines(tissue, field.organs);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const PlacedStrand& strand = tissue.strands->strands()[i];
      Standing one{lines[i], lobule_radius(strand), 0, tissue.definition.name == question.plate};
      for (int end = 0; end < 2; ++end)
        if (gallbladder && tissue.strands->bodies()[end] == gallbladder->value)
          one.share = share_along(field.organ(*gallbladder), end == 0 ? strand.one : strand.other);
      use(one, tissue.torn(i));
    }
  }
}

/// Whether a straight way, m, meets a strand's lobules.
bool meets(const Standing& strand, const Vec3& from, const Vec3& to) {
  const StrandLine& line = strand.line;
  return between_edges({from, to, line.from, line.by}).norm() < strand.radius ||
         between_edges({from, to, line.by, line.to}).norm() < strand.radius;
}

CriticalView::Side seen_side(const Sight& sight, const std::array<Vec3, 3>& corners,
                             const std::vector<Standing>& fat) {
  int open = 0, cleared = 0;
  for (const Vec3& weights : contact_rule) {
    const Vec3 place = weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
    if (!sight.sees(place, border)) continue;
    ++open;
    const Vec3 along = (place - sight.eye()).normalized();
    const double there = (place - sight.eye()).norm();
    const Vec3 end =
        sight.eye() + std::min(sight.first_organ(along, there + border), there + farthest_looked) * along;
    cleared += std::none_of(fat.begin(), fat.end(),
                            [&](const Standing& strand) { return meets(strand, sight.eye(), end); })
                   ? 1
                   : 0;
  }
  CriticalView::Side out;
  out.open = static_cast<double>(open) / static_cast<double>(contact_rule.size());
  if (out.open >= least_open) out.cleared = static_cast<double>(cleared) / open;
  return out;
}

/// Of a tube, the places on its line that are near the gallbladder, m.
struct Entering {
  std::vector<Vec3> places;
  double radius = 0;  ///< m, its thickest
};

Entering entering(const Organ& tube, const SkinFinder& gallbladder, double near) {
  Entering out;
  const std::vector<Vec3> skin = tube.body->skin_positions(tube.state.x);
  for (std::size_t row = 0; row < skin.size(); ++row) {
    const double radius = tube.body->skin_radii()[row];
    if (gallbladder.nearest(skin[row], near + radius).place.points.empty()) continue;
    out.places.push_back(skin[row]);
    out.radius = std::max(out.radius, radius);
  }
  return out;
}

bool is_on(const Standing& strand, const Entering& tube) {
  const std::array<Vec3, 2> first{strand.line.from, strand.line.by}, last{strand.line.by, strand.line.to};
  return std::any_of(tube.places.begin(), tube.places.end(), [&](const Vec3& place) {
    return std::min(nearest_point(place, first).distance, nearest_point(place, last).distance) <
           tube.radius + on_surface;
  });
}

/// A tube that is whole: what is left of a divided one ends blind.
bool is_whole_tube(const Field& field, const Organ& organ) {
  const std::vector<BodyRecord>& roll = field.membership.roll;
  return organ.body->as_tube() != nullptr &&
         std::none_of(roll.begin(), roll.end(), [&](const BodyRecord& record) {
           if (!record.gone) return false;
           const std::vector<std::string>& pieces = record.gone->pieces;
           return std::find(pieces.begin(), pieces.end(), organ.definition.name) != pieces.end();
         });
}

/// Tubes that are joined to it and have not been divided, in their order.
std::vector<OrganIndex> tubes_of(const Field& field, OrganIndex gallbladder) {
  std::vector<OrganIndex> out;
  for (const FieldJoint& joint : field.membership.joints)
    for (int k = 0; k < 2; ++k) {
      const std::array<int, 2>& bodies = joint.joint->links().bodies;
      if (bodies[k] != gallbladder.value) continue;
      const OrganIndex other(bodies[1 - k]);
      if (is_whole_tube(field, field.organ(other))) out.push_back(other);
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

int points_for(double share, const CriticalViewQuestion& question) {
  return share >= question.two_from ? 2 : share >= question.one_from ? 1 : 0;
}

/// Where a lens looks square at the middle of a triangle from the side that the eye is not on, m.
Vec3 square_behind(const std::array<Vec3, 3>& corners, const Vec3& eye) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const double side = normal.dot(eye - corners[0]) > 0 ? 1 : -1;
  return (corners[0] + corners[1] + corners[2]) / 3 - side * lens_behind * normal;
}

/// Judges the third criterion: counts the tubes that enter the gallbladder and those of them that are free (seen from
/// the front or from behind, no standing strand on them), and gives the points for structures.
void judge_structures(const Field& field, const CriticalViewQuestion& question,
                      const std::vector<Standing>& standing, const Sight& front, const Sight& back,
                      CriticalView& out) {
  const std::optional<OrganIndex> gallbladder = organ_called(field, question.gallbladder);
  if (!gallbladder) return;
  const Organ& bladder = field.organ(*gallbladder);
  const SkinFinder skin(*bladder.body, bladder.body->skin_positions(bladder.state.x));
  for (OrganIndex tube : tubes_of(field, *gallbladder)) {
    ++out.structures;
    const Entering part = entering(field.organ(tube), skin, question.near);
    const double thick = 2 * part.radius + on_surface;
    const bool seen = std::any_of(part.places.begin(), part.places.end(), [&](const Vec3& place) {
      return front.sees(place, thick) || back.sees(place, thick);
    });
    const bool free = std::none_of(standing.begin(), standing.end(),
                                   [&](const Standing& strand) { return is_on(strand, part); });
    out.free += seen && free ? 1 : 0;
  }
  if (out.structures == 2) out.structure_points = out.free;
}

}  // namespace

CriticalView critical_view(const Field& field, const HepatocysticTriangle& triangle, const Sight& front,
                           const CriticalViewQuestion& question) {
  std::vector<Standing> standing;
  int lower = 0, lower_torn = 0;
  for_strands(field, question, [&](const Standing& strand, bool torn) {
    const bool is_lower = strand.of_plate && strand.share <= question.lower_part;
    lower += is_lower ? 1 : 0;
    lower_torn += is_lower && torn ? 1 : 0;
    if (!torn && (!strand.of_plate || is_lower)) standing.push_back(strand);
  });

  CriticalView out;
  const std::array<Vec3, 3> corners{triangle.neck, triangle.junction, triangle.hilum};
  const Sight back = front.from(question.behind.value_or(square_behind(corners, front.eye())),
                                question.behind ? "" : question.liver);
  std::vector<Standing> fat;
  std::copy_if(standing.begin(), standing.end(), std::back_inserter(fat),
               [](const Standing& strand) { return !strand.of_plate; });
  do_at_once(
      field.workers(), [&] { out.front = seen_side(front.within(corners), corners, fat); },
      [&] { out.back = seen_side(back.within(corners), corners, fat); },
      [&] { judge_structures(field, question, standing, front, back, out); });
  out.triangle_points = points_for(std::min(out.front.cleared, out.back.cleared), question);

  out.plate = lower == 0 ? 1.0 : static_cast<double>(lower_torn) / lower;
  out.plate_points = points_for(out.plate, question);
  return out;
}

}  // namespace calot

#include "sim/hold.h"

#include <algorithm>

#include "sim/grip.h"

namespace calot {
namespace {

std::vector<Placement> placements(const Field& field) {
  std::vector<Placement> out;
  for (const Organ& organ : field.organs) out.push_back(placement(organ));
  return out;
}

void give_back(Field& field, const std::vector<Placement>& before) {
  for (std::size_t k = 0; k < before.size(); ++k) give_back(field.organs[k], before[k]);
}

/// Moves what a tool holds along its pads by `way` (m, patient's frame) and lets go what leaves them.
void slide(Field& field, int instrument, const Vec3& way) {
  const Tool& tool = field.tools[instrument];
  for (Organ& organ : field.organs) {
    for (GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      const Pose jaw = jaw_frame(tool.trocar, tool.pose, tool.geometry, grip.jaw);
      Vec3 along = jaw.linear().transpose() * way;
      along.x() = 0;  // never through the pad
      grip.local += along;
    }
    std::erase_if(organ.grips, [&](const GripPoint& grip) {
      return grip.instrument == instrument && !before_pad(grip.local, tool.geometry);
    });
  }
}

}  // namespace

Result<bool> release(Field& field, int instrument, SolveStatistics& statistics) {
  constexpr double weaken = 0.2, last_stiffness = 0.05;  // N/m a point, far below the wall's
  const std::vector<Placement> before = placements(field);
  const std::string when = "as a grip let it go";
  Result<bool> settled = true;
  for (double stiffness = grip_stiffness; settled && stiffness > last_stiffness; stiffness *= weaken) {
    loosen(field, instrument, weaken);
    settled = settle_field(field, when, statistics);
  }
  if (settled) {
    let_go(field, instrument);
    settled = settle_field(field, when, statistics);
  }
  if (!settled) give_back(field, before);
  return settled;
}

Vec3 pad_pull(const Field& field, int instrument) {
  const Tool& tool = field.tools[instrument];
  Vec3 pull = Vec3::Zero();
  for (const Organ& organ : field.organs) {
    const Links links = grip_links(organ, field.tools, present_poses(field));
    for (std::size_t g = 0; g < links.row.size(); ++g)
      if (organ.grips[g].instrument == instrument)
        pull += links.stiffness[g] * (organ.body.skin_point(links.row[g], organ.state.x) - links.target[g]);
  }
  const Vec3 across = hinge_frame(tool.trocar, tool.pose, tool.geometry).linear().col(0);
  return pull - across * across.dot(pull);
}

double holding_limit(const Tool& tool) {
  return 2.0 * tool.definition.pad_friction * tool.definition.pinch_force;
}

Result<double> slip(Field& field, int instrument, SolveStatistics& statistics) {
  constexpr double above = 1.001, below = 0.98;               // of the limit
  constexpr double first_way = 0.1e-3, longest_way = 0.5e-3;  // m, below half the skin's spacing
  constexpr int max_slides = 400;
  const double limit = holding_limit(field.tools[instrument]);
  Vec3 pull = pad_pull(field, instrument);
  const double at_start = pull.norm();
  if (at_start <= above * limit) return 0.0;
  const std::vector<Placement> before = placements(field);
  double way = first_way;
  for (int k = 0; k < max_slides; ++k) {
    slide(field, instrument, way * pull.normalized());
    if (Result<bool> settled = settle_field(field, "as it slipped from the jaws", statistics); !settled) {
      give_back(field, before);
      return settled.failure();
    }
    if (!both_pads_hold(field, instrument)) return at_start;
    const double force = pull.norm();
    pull = pad_pull(field, instrument);
    // Slid too far, it is drawn back once, by no more than it slid.
    if (pull.norm() <= above * limit && (pull.norm() >= below * limit || way <= 0)) return at_start;
    // By the secant; a fold that gives no more resistance is followed at the longest pace.
    const double stiffness = (force - pull.norm()) / way;
    const double next = stiffness > 0 ? (pull.norm() - 0.99 * limit) / stiffness : longest_way;
    way = std::clamp(next, -std::abs(way), longest_way);
  }
  give_back(field, before);
  return fail(FailureKind::simulation, "the fold slips through the jaws without end",
              "raise the instrument's pinch_force, or pull less far");
}

}  // namespace calot

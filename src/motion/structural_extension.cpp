#include "motion/structural_extension.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "base/timed.h"
#include "body/inertia.h"
#include "group/detail_fading.h"
#include "motion/settle_field.h"

namespace calot {
namespace {

/// A skin point near a shape, or held by it (at no distance, m).
struct NearPoint {
  int skin_point = 0, shape = 0;
  double distance = 0;
};

/// Points this much further from a shape than the nearest one say where its extension goes, m.
constexpr double middle_depth = 1e-3;

/// Skin points that say where a shape's extension goes: those it holds, else those near enough to it, ordered by point.
/// None where it needs none.
std::vector<NearPoint> points_near(int shape, const Field& field, const Organ& organ,
                                   const ContactLoads& loads) {
  std::vector<NearPoint> out;
  const FieldShape which = field.shape(shape);
  for (const GripPoint& grip : organ.grips)
    if (FieldShape::of_jaw(grip.instrument, grip.jaw) == which) out.push_back({grip.skin_point, shape, 0});
  if (!out.empty()) return out;  // what is held does not slide: it alone says where
  const bool served = std::any_of(organ.extensions.begin(), organ.extensions.end(),
                                  [&](const Extension& e) { return e.shape == shape; });
  const double reach = served ? extension_behind : extension_ahead;
  double counts = reach + middle_depth, nearest = counts;
  std::vector<ContactPair> pairs;
  organ.search.pairs_with(shape, *organ.body, organ.state.x, loads, counts, pairs);
  std::sort(pairs.begin(), pairs.end(),
            [](const ContactPair& a, const ContactPair& b) { return a.distance < b.distance; });
  // The nearest first, as their bounds say, until no other can count.
  std::vector<char> seen(organ.body->skin_rest().size(), 0);
  for (const ContactPair& pair : pairs) {
    if (pair.distance > counts) break;
    for (int row : organ.body->skin().triangles[pair.triangle]) {
      if (std::exchange(seen[row], 1)) continue;
      const double distance =
          signed_distance(loads.shapes[shape], organ.body->skin_point(row, organ.state.x));
      if (distance > counts) continue;
      out.push_back({row, shape, distance});
      nearest = std::min(nearest, distance);
      counts = std::min(counts, std::max(distance + middle_depth, field.barrier.range));
    }
  }
  if (nearest > reach) return {};
  std::erase_if(out, [&](const NearPoint& point) { return point.distance > counts; });
  // What was remembered must not decide their order, as sums follow it.
  std::sort(out.begin(), out.end(),
            [](const NearPoint& a, const NearPoint& b) { return a.skin_point < b.skin_point; });
  return out;
}

/// Shortest coarse edge near a skin point at rest, m.
double coarse_edge(const ShellBody& body, int row) {
  double edge = body.size();
  for (int node : body.control().triangles[body.skin().at[row].face])
    edge = std::min(edge, body.edge_lengths()[node]);
  return edge;
}

/// Middle, at rest, of the points within `radius` of the nearest one, `lead`: weighed by how near they are, so that it
/// moves evenly as the nearest point jumps from one to the next.
int middle_of(const ShellBody& body, const std::vector<NearPoint>& points, const NearPoint& lead,
              double radius) {
  Vec3 sum = Vec3::Zero();
  double total = 0;
  const auto counts = [&](const NearPoint& p) {
    return p.distance < lead.distance + middle_depth &&
           (body.skin_rest()[p.skin_point] - body.skin_rest()[lead.skin_point]).norm() < radius;
  };
  for (const NearPoint& p : points) {
    if (!counts(p)) continue;
    const double share = 1 - (p.distance - lead.distance) / middle_depth,
                 weight = share * share * body.skin_areas()[p.skin_point];
    sum += weight * body.skin_rest()[p.skin_point];
    total += weight;
  }
  const Vec3 middle = sum / total;
  int best = lead.skin_point;
  for (const NearPoint& p : points)
    if (counts(p) && (body.skin_rest()[p.skin_point] - middle).squaredNorm() <
                         (body.skin_rest()[best] - middle).squaredNorm())
      best = p.skin_point;
  return best;
}

bool clear_of_tools(const Organ& organ, const ContactLoads& loads) {
  const std::vector<ContactPair> near = gather_pairs(*organ.body, organ.state.x, loads, 0.0);
  bool clear = true;
  for_touching(*organ.body, organ.state.x, loads, near, std::numeric_limits<double>::infinity(),
               [&](int, int, const Vec3&, const DistanceSlope& d) { clear &= d.distance > -contact_guard; });
  return clear;
}

/// Whether no wall passes through another as the details that are left out go. Those that are new move nothing yet.
bool clear_of_itself(Organ& organ, const ShellBody& before, const VecX& x) {
  const VecX going = organ.body->as_shell()->coordinates_in(before, organ.state.x) - x;
  return organ.search.own.safe_share(before, x, going, contact_keep, 1.0) == 1.0;
}

std::vector<int> united(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> out;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

/// The same part of a motion with other details; whether it can be.
bool motion_in(const ShellBody& next, const ShellBody& before, MotionPart& motion) {
  if (motion.duration == 0) return true;
  const auto there = [&](const VecX& x) { return before.coordinates_in(next, x); };
  Result<MotionPart> part = motion_part(
      next, {there(motion.begin.x), there(motion.begin.velocity), motion.begin.centroid}, motion.duration);
  if (part) motion = std::move(part).value();
  return static_cast<bool>(part);
}

/// The extensions that the organ needs with the tools where they stand: one for each part of a tool that is near
/// or holds on, two for a part that lies along the organ. Those that still serve stay as they are.
std::vector<Extension> wanted_extensions(const Field& field, const Organ& organ, const ShellBody& body,
                                         const ContactLoads& loads) {
  constexpr int most_along_a_part = 2;
  std::vector<Extension> out;
  if (field.viewed && &field.organ(field.viewed->organ) == &organ)
    out.push_back({-1, field.viewed->skin_point});
  const int first_ground = FieldShape::of_ground(0).index(field.tools.size());
  for (int shape = 0; shape < first_ground; ++shape) {
    std::vector<NearPoint> points = points_near(shape, field, organ, loads);
    for (int k = 0; k < most_along_a_part && !points.empty(); ++k) {
      const NearPoint lead =
          *std::min_element(points.begin(), points.end(),
                            [](const NearPoint& a, const NearPoint& b) { return a.distance < b.distance; });
      const double edge = coarse_edge(body, lead.skin_point);
      Extension next{shape, middle_of(body, points, lead, 0.5 * edge)};
      const double drift = 0.25 * std::ldexp(edge, -body.levels().levels());
      for (const Extension& present : organ.extensions)
        if (present.shape == shape &&
            (body.skin_rest()[present.centre] - body.skin_rest()[next.centre]).norm() < drift)
          next = present;
      out.push_back(next);
      // Another one only where the part touches too far away to be served.
      std::erase_if(points, [&](const NearPoint& p) {
        return p.distance > field.barrier.range ||
               (body.skin_rest()[p.skin_point] - body.skin_rest()[next.centre]).norm() < 1.5 * edge;
      });
    }
  }
  return out;
}

/// What an organ's details are chosen by: where it lies, what holds it, how far its details have faded, and the tools'
/// poses.
ContactPlace contact_place(const Organ& organ, const ShellBody& shell,
                           const std::vector<InstrumentPose>& poses) {
  return {organ.state.x,      poses,           organ.grips,          organ.extensions,
          organ.state.shares, shell.details(), organ.refused_details};
}

/// Refines the organ's shell by `details` instead of its own and brings the group to rest; `wanted`: those of them that
/// do not fade. Where that cannot be, the organ keeps its own, and `details` are refused until others are wanted.
void change_details(Field& field, Organ& organ, std::vector<int> details, const std::vector<int>& wanted,
                    const ContactLoads& now, const std::vector<InstrumentPose>& poses,
                    SolveStatistics& statistics) {
  const BodyPointer present = organ.body;
  const ShellBody& shell = *organ.body->as_shell();
  organ.refused_details = details;
  const Timed timed(statistics.extension_s);
  Result<ShellBody> next = shell.with_details(std::move(details));
  if (!next) {
    ++statistics.extensions_refused;
    return;
  }
  const GroupSnapshot before = snapshot(field);
  const bool was_balanced = statistics.balanced;
  const double residual = statistics.residual;
  const BodyState was = organ.state;
  if (!motion_in(next.value(), shell, organ.state.motion)) {
    ++statistics.extensions_refused;
    return;
  }
  organ.state.x = shell.coordinates_in(next.value(), was.x);
  organ.state.shares = shares_of(next->details(), wanted, shell, was.shares);
  organ.state.fading_load = made_good(shell, was, next.value(), organ.state.x);
  organ.body = std::make_shared<const ShellBody>(std::move(next).value());
  field.group.forget_bodies();
  ++statistics.extensions_changed;
  if (clear_of_tools(organ, now) && clear_of_itself(organ, shell, was.x)) {
    const NewtonResult settled =
        settle_group(field, poses, present_places(field), NewtonSettings{}.max_iterations, statistics);
    if (settled.converged() || was_cut_short(field, settled)) {
      organ.refused_details.reset();
      return;
    }
  }
  restore(field, before);
  statistics.balanced = was_balanced;
  statistics.residual = residual;
  --statistics.extensions_changed;
  ++statistics.extensions_refused;
}

}  // namespace

std::vector<int> details_around(const ShellBody& body, const std::vector<Extension>& extensions) {
  std::vector<int> out;
  std::vector<std::pair<double, int>> by_distance;
  for (const Extension& extension : extensions) {
    const Vec3& centre = body.skin_rest()[extension.centre];
    for (int level = 1; level <= body.levels().levels(); ++level) {
      by_distance.clear();
      for (int node = body.levels().nodes(level - 1); node < body.levels().nodes(level); ++node)
        by_distance.emplace_back((body.node_rest()[node] - centre).squaredNorm(), node);
      const auto end =
          by_distance.begin() + std::min<std::ptrdiff_t>(details_per_level, std::ssize(by_distance));
      std::partial_sort(by_distance.begin(), end, by_distance.end());
      for (auto it = by_distance.begin(); it != end; ++it) out.push_back(it->second);
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void follow_contacts(Field& field, Organ& organ, SolveStatistics& statistics) {
  const ShellBody* shell = organ.body->as_shell();
  if (shell == nullptr || shell->most_levels() == 0) return;
  const std::vector<InstrumentPose> poses = present_poses(field);
  const auto place = [&] { return contact_place(organ, *shell, poses); };
  if (organ.looked_at == place()) return;
  const ContactLoads now = contact_loads(field, organ, poses);
  std::vector<int> wanted, details;
  {
    const Timed timed(statistics.contact_s);
    organ.extensions = wanted_extensions(field, organ, *shell, now);
    wanted = details_around(*shell, organ.extensions);
    details = united(wanted, lasting_details(*shell, organ.state, wanted));
  }
  if (details == organ.refused_details) {
    organ.looked_at = place();
    return;
  }
  const std::vector<int>& active = shell->details();
  // What has faded goes with the next change or with the last that fades: a change costs as much as many details.
  if (details == active ||
      (details != wanted && std::includes(active.begin(), active.end(), wanted.begin(), wanted.end()))) {
    organ.state.shares = shares_of(active, wanted, *shell, organ.state.shares);
    organ.looked_at = place();
    return;
  }
  change_details(field, organ, std::move(details), wanted, now, poses, statistics);
}

}  // namespace calot

#include "joins/skin_join.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "fem/links.h"
#include "group/body_problem.h"
#include "group/self_contact.h"

namespace calot {

SkinJoin::Side SkinJoin::side_of(const Body& body, std::span<const JoinedPlace> joined) const {
  Side side;
  side.radius = body.thickest();
  const std::vector<Vec3>& rest = body.skin_rest();
  const auto left_out = [&](int point) {
    return std::any_of(joined.begin(), joined.end(), [&](const JoinedPlace& joint) {
      return (rest[point] - joint.place).norm() <= joint.within;
    });
  };
  side.met = met_skin(body);
  const std::vector<Triangle>& triangles = side.met.triangles;
  for (std::size_t p = 0; p < rest.size(); ++p)
    side.areas.push_back(left_out(static_cast<int>(p)) ? 0.0 : 0.5 * side.met.areas[p]);
  for (const Triangle& t : triangles) side.counts.push_back(std::none_of(t.begin(), t.end(), left_out));
  side.around.assign(rest.size(), -1);
  for (std::size_t t = triangles.size(); t-- > 0;)
    for (int corner : triangles[t]) side.around[corner] = static_cast<int>(t);
  side.at.assign(rest.size(), Vec3::Zero());
  side.way.assign(rest.size(), Vec3::Zero());
  side.looked.assign(rest.size(), 0);
  return side;
}

SkinJoin::SkinJoin(const Body& one, const Body& other, std::array<int, 2> bodies,
                   std::span<const JoinedPlace> joined)
    : bodies_(bodies), sides_{side_of(one, joined), side_of(other, joined)} {}

void SkinJoin::begin(std::span<const GroupPlace> bodies) const {
  const bool present = std::max(bodies_[0], bodies_[1]) < static_cast<int>(bodies.size());
  workers_ = present ? bodies[bodies_[0]].workers : nullptr;
  for (int k = 0; k < 2; ++k) {
    Side& side = sides_[k];
    if (!present) {
      side.body = nullptr;
      continue;
    }
    const GroupPlace& place = bodies[bodies_[k]];
    const Eigen::Index first = Eigen::Index{3} * place.first_node;
    if (side.body == nullptr || side.first != first || side.details != place.body->details()) {
      patches_known_ = pairs_known_ = edges_known_ = false;
      found_ = {};
      at_x_ = {};
    }
    side.body = place.body;
    side.first = first;
    side.details = place.body->details();
  }
}

SkinJoin::Parts SkinJoin::parts_of(const VecX& x) const {
  Parts out;
  for (int k = 0; k < 2; ++k) out[k] = x.segment(sides_[k].first, sides_[k].body->rest().size());
  return out;
}

bool SkinJoin::idle(std::span<const SkinBounds> bodies) const {
  const SkinBounds &one = bodies[bodies_[0]], &other = bodies[bodies_[1]];
  // What safe_share() would look at.
  const double far = approach_of(one.motion, other.motion) / (1.0 - contact_keep);
  const double gap = one.box.exteriorDistance(other.box) - sides_[0].radius - sides_[1].radius;
  if (!(gap >= std::max(far, uncouple_above))) return false;
  lacking_ = false;
  return true;
}

const SkinJoin::Touching& SkinJoin::found_at(const VecX& x) const {
  static const Touching none;
  if (!active()) return none;
  Parts parts = parts_of(x);
  if (!parts[0].allFinite() || !parts[1].allFinite()) return none;
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const Parts& known = found_[k].x;
    if (known[0].size() == 0 || known[0] != parts[0] || known[1] != parts[1]) continue;
    newest_ = k;
    return found_[k];
  }
  newest_ = 1 - newest_;
  Touching& found = found_[newest_];
  found.touches.clear();
  found.crossings.clear();
  const std::vector<SkinPair>& pairs = pairs_below(parts, self_barrier.range);
  if (!pairs.empty()) found.touches = skin_touches(placed(false), pairs, self_barrier.range);
  for (const EdgesNear& pair : edges_below(parts, self_edge_barrier.range)) {
    const std::array<PlacedEdges, 2> at = placed_edges(false);
    if (const std::optional<EdgeTouch> touch = edge_touch(at[0], at[1], pair, self_edge_barrier))
      found.crossings.push_back(*touch);
  }
  found.x = std::move(parts);
  return found;
}

double SkinJoin::gap(const VecX& x) const {
  double least = close_reach;
  if (!active()) return least;
  const Parts parts = parts_of(x);
  for (const SkinPair& pair : pairs_below(parts, close_reach)) least = std::min(least, gap_of(pair));
  for (const EdgesNear& pair : edges_below(parts, close_reach)) least = std::min(least, edge_distance(pair));
  return least;
}

double SkinJoin::value(const VecX& x) const {
  double sum = 0;
  for (const SkinTouch& touch : touching(x)) {
    // Parts that count negatively must not hide that skins are in each other.
    const double energy = self_barrier.sample(touch.gap).energy;
    if (!std::isfinite(energy)) return energy;
    sum += touch.area * energy;
  }
  for (const EdgeTouch& touch : crossing(x)) sum += touch.area * touch.sample.energy;
  return sum;
}

StencilPoint SkinJoin::stencil_point(int skin, int row) const {
  const Side& side = sides_[skin];
  return {&side.body->skin().stencils, row, static_cast<int>(side.first / 3)};
}

std::array<StencilPoint, 4> SkinJoin::points_of(const SkinTouch& touch) const {
  std::array<StencilPoint, 4> out{stencil_point(touch.skin, touch.point)};
  for (int k = 0; k < touch.part.corners; ++k) out[k + 1] = stencil_point(touch.other, touch.part.corner[k]);
  return out;
}

std::array<StencilPoint, 4> SkinJoin::points_of(const EdgeTouch& touch) const {
  std::array<StencilPoint, 4> out;
  for (int k = 0; k < 4; ++k) out[k] = stencil_point(k / 2, touch.ends[k]);
  return out;
}

namespace {

void spread(const StencilPoint& point, const Vec3& force, VecX& gradient) {
  const StencilTable& table = *point.table;
  for (int e = table.begin[point.row]; e < table.begin[point.row + 1]; ++e)
    gradient.segment<3>(Eigen::Index{3} * (point.first_node + table.node[e])) += table.value[e] * force;
}

}  // namespace

void SkinJoin::add_gradient(const VecX& x, VecX& gradient) const {
  for (const SkinTouch& touch : touching(x)) {
    const Eigen::Matrix<double, 12, 1> slope = touch_gradient(touch, self_barrier.sample(touch.gap));
    const std::array<StencilPoint, 4> points = points_of(touch);
    for (int k = 0; k <= touch.part.corners; ++k) spread(points[k], slope.segment<3>(3 * k), gradient);
  }
  for (const EdgeTouch& touch : crossing(x)) {
    const std::array<StencilPoint, 4> points = points_of(touch);
    for (int k = 0; k < 4; ++k)
      spread(points[k], touch.area * touch.sample.gradient.segment<3>(3 * k), gradient);
  }
}

namespace {

/// N, on the first of the two edges.
Vec3 on_first(const EdgeTouch& touch) {
  return -touch.area * (touch.sample.gradient.head<3>() + touch.sample.gradient.segment<3>(3));
}

}  // namespace

Vec3 SkinJoin::force(const VecX& x) const {
  Vec3 sum = Vec3::Zero();
  for (const SkinTouch& touch : touching(x)) {
    const Vec3 on_point = -touch_gradient(touch, self_barrier.sample(touch.gap)).head<3>();
    sum += touch.skin == 0 ? Vec3(-on_point) : on_point;
  }
  for (const EdgeTouch& touch : crossing(x)) sum -= on_first(touch);
  return sum;
}

/// Of the pair that is nearest, where its points were looked up last.
RubbingPlace SkinJoin::rubbing_place(const SkinPair& pair) const {
  const Side &one = sides_[pair.skin], &other = sides_[pair.other];
  const auto of_one = [&](int row) { return BodyPoint{bodies_[pair.skin], row}; };
  const auto of_other = [&](int row) { return BodyPoint{bodies_[pair.other], row}; };
  const std::span<const int> corners = other.skin->corners(pair.simplex);
  if (other.skin->is_triangle(pair.simplex))
    return {{of_one(pair.point), of_other(corners[0]), of_other(corners[1]), of_other(corners[2])}, false};
  const Triangle& t = one.met.triangles[one.around[pair.point]];
  if (t[1] == t[2]) {  // a line, too
    const int beside = t[0] == pair.point ? t[1] : t[0];
    return {{of_one(pair.point), of_other(corners[0]), of_other(corners[1]), of_one(beside)}, true};
  }
  const Vec3& point = one.at[pair.point];
  const bool first = (other.at[corners[0]] - point).norm() <= (other.at[corners[1]] - point).norm();
  return {{of_other(corners[first ? 0 : 1]), of_one(t[0]), of_one(t[1]), of_one(t[2])}, false};
}

std::vector<SkinPress> SkinJoin::pressing(const VecX& x) const {
  std::vector<SkinPress> out = points_pressing(x);
  for (const EdgeTouch& touch : crossing(x)) {
    const Parts parts = parts_of(x);
    EdgePair at;
    for (int k = 0; k < 4; ++k) at[k] = sides_[k / 2].body->skin_point(touch.ends[k], parts[k / 2]);
    const bool first = nearest_of_edges(at).weight[0] >= 0.5;
    const auto end = [&](int k) { return BodyPoint{bodies_[k / 2], touch.ends[k]}; };
    const RubbingPair pair{end(first ? 0 : 1), bodies_[1]};
    const auto found =
        std::lower_bound(out.begin(), out.end(), pair.point.row, [&](const SkinPress& press, int row) {
          return press.pair.point.body == bodies_[0] && press.pair.point.row < row;
        });
    if (found != out.end() && found->pair == pair)
      found->force += on_first(touch);
    else
      out.insert(found, {pair,
                         {{end(first ? 0 : 1), end(2), end(3), end(first ? 1 : 0)}, true},
                         on_first(touch),
                         touch.area});
  }
  return out;
}

std::vector<SkinPress> SkinJoin::points_pressing(const VecX& x) const {
  const std::vector<SkinTouch> touches = touching(x);
  std::vector<SkinPress> out;
  if (touches.empty()) return out;
  const std::vector<SkinPair>& pairs = pairs_below(parts_of(x), self_barrier.range);
  std::size_t at = 0;
  const auto nearest = [&](const SkinTouch& touch) {  // both are ordered by skin and point
    const auto before = [&](const SkinPair& pair) {
      return std::tie(pair.skin, pair.point) < std::tie(touch.skin, touch.point);
    };
    while (before(pairs[at])) ++at;
    const SkinPair* best = &pairs[at];
    double least = gap_of(*best);
    for (; at < pairs.size() && pairs[at].skin == touch.skin && pairs[at].point == touch.point; ++at)
      if (const double gap = gap_of(pairs[at]); gap < least) least = gap, best = &pairs[at];
    return *best;
  };
  for (std::size_t k = 0; k < touches.size();) {
    const SkinTouch& touch = touches[k];
    SkinPress press{{{bodies_[touch.skin], touch.point}, bodies_[touch.other]},
                    {},
                    Vec3::Zero(),
                    sides_[touch.skin].areas[touch.point]};
    for (; k < touches.size() && touches[k].skin == touch.skin && touches[k].point == touch.point; ++k)
      press.force -= touch_gradient(touches[k], self_barrier.sample(touches[k].gap)).head<3>();
    press.place = rubbing_place(nearest(touch));
    out.push_back(press);
  }
  return out;
}

Eigen::Matrix<double, 12, 12> SkinJoin::touch_matrix(const SkinTouch& touch, const Parts& x,
                                                     const BarrierSample& at_gap) const {
  const Side& other = sides_[touch.other];
  std::array<Vec3, 3> corners;
  for (int k = 0; k < touch.part.corners; ++k)
    corners[k] = other.body->skin_point(touch.part.corner[k], x[touch.other]);
  return touch_hessian(touch, {corners.data(), static_cast<std::size_t>(touch.part.corners)}, at_gap);
}

void SkinJoin::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  std::vector<PointsStiffness> all;
  for (const EdgeTouch& touch : crossing(x))
    all.push_back({points_of(touch), touch.area * touch.sample.hessian});
  const std::vector<SkinTouch>& touches = touching(x);
  if (!touches.empty()) {
    const Parts parts = parts_of(x);
    for (const SkinTouch& touch : touches)
      all.push_back({points_of(touch), touch_matrix(touch, parts, self_barrier.sample(touch.gap))});
  }
  lacking_ = !add_all(all, workers_, matrix);
}

// How the gap curves times the pressure, that is; edges' own curvature stays.
bool SkinJoin::add_convexity(const VecX& x, BlockMatrix& matrix) const {
  const std::vector<SkinTouch>& touches = touching(x);
  if (touches.empty()) return false;
  const Parts parts = parts_of(x);
  std::vector<PointsStiffness> all;
  for (const SkinTouch& touch : touches) {
    BarrierSample flat = self_barrier.sample(touch.gap);
    flat.second = 0;
    all.push_back({points_of(touch), -touch_matrix(touch, parts, flat)});
  }
  add_all(all, workers_, matrix);
  return true;
}

void SkinJoin::add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const {
  if (!active()) return;
  const double below = close ? couple_below : uncouple_above;
  std::set<std::array<int, 2>> patches;  // of the first body and of the other
  const Parts parts = parts_of(x);
  for (const SkinPair& pair : pairs_below(parts, below)) {
    if (gap_of(pair) >= below) continue;
    const Side &one = sides_[pair.skin], &other = sides_[pair.other];
    std::array<int, 2> both{one.body->skin().at[pair.point].face,
                            other.triangles[pair.simplex] / other.met.each};
    if (pair.skin == 1) std::swap(both[0], both[1]);
    patches.insert(both);
  }
  for (const EdgesNear& pair : edges_below(parts, edges_couple(below))) {
    if (edge_distance(pair) >= edges_couple(below)) continue;
    const auto patch = [&](const Side& side, int edge) { return side.edges->triangle[edge] / side.met.each; };
    patches.insert({patch(sides_[0], pair.edge), patch(sides_[1], pair.other)});
  }
  for (const std::array<int, 2>& both : patches) {
    std::vector<int> clique;
    for (int k = 0; k < 2; ++k)
      for (int node : sides_[k].body->face_nodes()[both[k]])
        clique.push_back(static_cast<int>(sides_[k].first / 3) + node);
    std::sort(clique.begin(), clique.end());
    cliques.push_back(std::move(clique));
  }
}

}  // namespace calot

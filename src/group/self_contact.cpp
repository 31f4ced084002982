#include "group/self_contact.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/workers.h"
#include "geometry/turn.h"
#include "group/join.h"

namespace calot {
namespace {

/// How far groups of points are remembered, m. Only points in near groups are looked at when pairs are
/// gathered, and only how these move against each other ages the pairs: a fold that is pulled along keeps its own.
/// More reach means fewer searches and more to look at between them: these were the fastest of nine in a grasp.
constexpr double group_reach = 3e-3;
/// Of edges.
constexpr double least_edges_reach = 0.35e-3;
/// Bound on how much any two skin points that hang on `nodes` move against each other when the nodes move by `dx`, m:
/// what the coarse nodes' motions differ by, and the details' of each level.
double relative_motion(const Body& body, const VecX& dx, const std::vector<int>& nodes) {
  Eigen::AlignedBox3d coarse;
  const int coarse_nodes = body.coarse_nodes();
  std::vector<double> of_level(body.levels_used() + 1, 0.0);
  for (int node : nodes) {
    const Vec3 move = dx.segment<3>(Eigen::Index{3} * node);
    if (node < coarse_nodes) {
      coarse.extend(move);
    } else {
      double& largest = of_level[body.level_of_detail(node - coarse_nodes)];
      largest = std::max(largest, move.norm());
    }
  }
  double sum = coarse.isEmpty() ? 0.0 : coarse.sizes().norm();
  for (double largest : of_level) sum += 2 * largest;
  return sum;
}

std::vector<int> all_nodes(const Body& body) {
  std::vector<int> all(body.nodes());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

Eigen::Map<const Eigen::Matrix3Xd> coarse_places(const Body& body, const VecX& x) {
  return {x.data(), 3, body.coarse_nodes()};
}

/// Bound on how much any two skin points have come nearer between two states, m: what their motions differ by but for
/// a turn of the whole, which changes no distance.
double approach_between(const Body& body, const VecX& before, const VecX& now) {
  const Mat3 turn = best_turn(coarse_places(body, before), coarse_places(body, now));
  VecX moved = now;
  for (int i = 0; i < body.nodes(); ++i) moved.segment<3>(3 * i) -= turn * before.segment<3>(3 * i);
  return relative_motion(body, moved, all_nodes(body));
}

/// A step from x without its turn about one axis, w x place with w the same everywhere. On a straight way such a turn
/// brings no two points nearer: |d + w x d| >= |d|. So what points lose of their distances the rest takes from them.
VecX unturned(const Body& body, const VecX& x, const VecX& step) {
  const Vec3 spin = best_spin(coarse_places(body, x), coarse_places(body, step));
  VecX out = step;
  for (int i = 0; i < body.nodes(); ++i) out.segment<3>(3 * i) -= spin.cross(x.segment<3>(3 * i));
  return out;
}

/// What the pair leaves of a share of the motion. Few of those that are looked at could meet at all.
double cut_by(const SkinNet& net, const SelfPair& pair, const std::vector<Vec3>& at,
              const std::vector<Vec3>& motion, double keep, double share) {
  const Triangle& t = net.triangles[pair.triangle];
  const Vec3 p = at[pair.skin_point], q = at[t[0]];
  const double triangle = std::max((at[t[1]] - q).norm(), (at[t[2]] - q).norm());
  std::array<Vec3, 3> motions = corners_of(t, motion);
  double longest = 0;
  for (Vec3& m : motions) longest = std::max(longest, (m - motion[pair.skin_point]).squaredNorm());
  if (share * std::sqrt(longest) < (1.0 - keep) * ((p - q).norm() - triangle)) return share;
  for (Vec3& m : motions) m *= share;
  return share * calot::safe_share(at[pair.skin_point], share * motion[pair.skin_point], corners_of(t, at),
                                   motions, keep);
}

/// The least that any of the items leaves of a share: cut(item, share) says what one does.
template <class Item, class Cut>
double least_left(const std::vector<Item>& items, Workers* workers, double share, const Cut& cut) {
  constexpr int few = 128;  // not worth another chunk
  const int size = static_cast<int>(items.size()), chunks = std::clamp(size / few, 1, 8);
  return least_safe(workers, static_cast<std::size_t>(chunks), share, [&](std::size_t k) {
    const Chunk chunk = chunk_of(size, chunks, static_cast<int>(k));
    double left = share;
    for (int i = chunk.begin; i < chunk.end; ++i) left = cut(items[static_cast<std::size_t>(i)], left);
    return left;
  });
}

}  // namespace

const SkinNet& SelfContact::net(const Body& body) {
  if (!net_) net_.emplace(body);
  return *net_;
}

double SelfContact::since_groups(const Body& body, const VecX& x) {
  if (aged_x_.size() != x.size() || aged_x_ != x) {
    aged_x_ = x;
    aged_ = approach_between(body, groups_x_, x);
  }
  return aged_;
}

void SelfContact::refresh_groups(const Body& body, const VecX& x, double need) {
  // A group is near by its triangles' corners: these come nearer by what moves, and edges lengthen by that.
  constexpr double by_motion = 1.6;
  if (groups_known_ && groups_x_.size() == x.size() && groups_details_ == body.details() &&
      need + by_motion * since_groups(body, x) <= group_reach)
    return;
  groups_x_ = x;
  aged_x_.resize(0);
  groups_details_ = body.details();
  const std::vector<Vec3> points = body.skin_positions(x);
  groups_ = near_groups(net(body), {points, nullptr, group_reach}, workers);
  std::vector<char> used(points.size(), 0), on_face(body.face_nodes().size(), 0), hangs(body.nodes(), 0);
  for (const auto& [a, b] : groups_)
    for (int group : {a, b})
      for (int k = net_->nodes[group].first; k < net_->nodes[group].last; ++k) {
        const int point = net_->order[k];
        for (int t = net_->begin[point]; t < net_->begin[point + 1]; ++t)
          for (int corner : net_->triangles[net_->around[t]]) used[corner] = 1;
      }
  rows_.clear();
  nodes_.clear();
  for (std::size_t row = 0; row < used.size(); ++row) {
    if (!used[row]) continue;
    rows_.push_back(static_cast<int>(row));
    on_face[body.skin().at[row].face] = 1;
  }
  for (std::size_t f = 0; f < on_face.size(); ++f)
    if (on_face[f])
      for (int node : body.face_nodes()[f]) hangs[node] = 1;
  for (int node = 0; node < body.nodes(); ++node)
    if (hangs[node]) nodes_.push_back(node);
  groups_known_ = true;
  pairs_known_ = false;
}

double SelfContact::refresh(const Body& body, const VecX& x, double need, double need_edges) {
  if (!active || !x.allFinite()) {
    forget_pairs();
    groups_known_ = pairs_known_ = false;
    return 0;
  }
  const double beside = beside_edges(body);
  refresh_groups(body, x, std::max(need, std::hypot(need_edges, beside)));
  if (groups_.empty()) {
    forget_pairs();
    return 0;
  }
  if (pairs_known_) {
    const double approach = relative_motion(body, x - pairs_x_, nodes_);
    if (need + approach <= pairs_reach_ && need_edges + approach <= edges_reach_) return approach;
  }
  edges_reach_ = std::max(need_edges, least_edges_reach);
  pairs_reach_ = std::max(close_reach, need);
  refresh_groups(body, x, std::max(pairs_reach_, std::hypot(edges_reach_, beside)));
  pairs_known_ = true;
  pairs_x_ = x;
  nearest_ = pairs_reach_;
  nearest_edges_ = edges_reach_;
  look_up(body, x, at_);
  const SkinMotion still{at_, nullptr, pairs_reach_, edges_reach_};
  near_ = near_pairs(*net_, still, groups_, workers);
  edges_near_ = edges_at(*net_, near_, still, workers);
  for (const SelfPair& pair : near_) nearest_ = std::min(nearest_, pair.distance);
  for (const EdgesNear& pair : edges_near_) nearest_edges_ = std::min(nearest_edges_, pair.distance);
  return 0;
}

void SelfContact::look_up(const Body& body, const VecX& x, std::vector<Vec3>& points) const {
  look_up(body, x, rows_, points);
}

void SelfContact::look_up(const Body& body, const VecX& x, std::span<const int> rows,
                          std::vector<Vec3>& points) {
  points.resize(body.skin_rest().size());
  for (int row : rows) points[row] = body.skin_point(row, x);
}

std::vector<int> SelfContact::rows_of(std::span<const SelfPair> pairs,
                                      std::span<const EdgesNear> crossing) const {
  std::vector<char> used(net_->rest.size(), 0);
  for (const SelfPair& pair : pairs) {
    used[pair.skin_point] = 1;
    for (int corner : net_->triangles[pair.triangle]) used[corner] = 1;
  }
  for (const EdgesNear& pair : crossing)
    for (int end : ends_of(net_->edges, net_->edges, pair)) used[end] = 1;
  std::vector<int> out;
  for (std::size_t row = 0; row < used.size(); ++row)
    if (used[row]) out.push_back(static_cast<int>(row));
  return out;
}

const SelfContact::Touching& SelfContact::found_at(const Body& body, const VecX& x) {
  for (std::size_t k = 0; active && k < found_.size(); ++k) {
    const Touching& known = found_[k];
    if (known.x.size() != x.size() || known.x != x || known.details != body.details()) continue;
    newest_ = k;
    return known;
  }
  newest_ = 1 - newest_;
  found_[newest_] = {active ? x : VecX(), body.details(), find_touching(body, x), find_crossing(body, x)};
  return found_[newest_];
}

std::vector<SelfTouch> SelfContact::find_touching(const Body& body, const VecX& x) {
  const double near = self_barrier.range + refresh(body, x, self_barrier.range, self_edge_barrier.range);
  std::vector<SelfTouch> out;
  if (near_.empty() || nearest_ >= near) return out;
  look_up(body, x, at_);
  std::vector<Triangle> faces;
  for (std::size_t first = 0, last = 0; first < near_.size(); first = last) {
    const int row = near_[first].skin_point;
    faces.clear();
    for (; last < near_.size() && near_[last].skin_point == row; ++last) {
      if (near_[last].distance >= near) continue;
      const Triangle& t = net_->triangles[near_[last].triangle];
      if (nearest_point(at_[row], corners_of(t, at_)).distance < self_barrier.range) faces.push_back(t);
    }
    if (faces.empty()) continue;
    for (const SurfacePart& part : surface_parts(at_[row], faces, at_, self_barrier.range)) {
      std::array<Vec3, 3> corners;
      for (int k = 0; k < part.corners; ++k) corners[k] = at_[part.corner[k]];
      const FlatSample sample =
          sample_flat(at_[row], {corners.data(), static_cast<std::size_t>(part.corners)});
      out.push_back({row, part, sample, 0.5 * part.times * body.skin_areas()[row]});
    }
  }
  return out;
}

std::vector<EdgeTouch> SelfContact::find_crossing(const Body& body, const VecX& x) {
  constexpr double range = self_edge_barrier.range;
  const double near = range + refresh(body, x, self_barrier.range, range);
  std::vector<EdgeTouch> out;
  if (edges_near_.empty() || nearest_edges_ >= near) return out;
  look_up(body, x, at_);
  const PlacedEdges edges{&net_->edges, &at_};
  for (const EdgesNear& pair : edges_near_) {
    if (pair.distance >= near) continue;
    if (const std::optional<EdgeTouch> touch = edge_touch(edges, edges, pair, self_edge_barrier))
      out.push_back(*touch);
  }
  return out;
}

double SelfContact::value(const Body& body, const VecX& x) {
  double sum = 0;
  for (const SelfTouch& touch : touching(body, x))
    sum += touch.area * self_barrier.sample(touch.sample.distance).energy;
  for (const EdgeTouch& touch : crossing(body, x)) sum += touch.area * touch.sample.energy;
  return sum;
}

void SelfContact::add_gradient(const Body& body, const VecX& x, VecX& gradient) {
  const StencilTable& skin = body.skin().stencils;
  for (const SelfTouch& touch : touching(body, x)) {
    const Vec3 force =
        touch.area * self_barrier.sample(touch.sample.distance).derivative * touch.sample.normal;
    spread(skin, touch.skin_point, force, gradient);
    for (int k = 0; k < touch.part.corners; ++k)
      spread(skin, touch.part.corner[k], touch.sample.weight[k + 1] * force, gradient);
  }
  for (const EdgeTouch& touch : crossing(body, x))
    for (int k = 0; k < 4; ++k)
      spread(skin, touch.ends[k], touch.area * touch.sample.gradient.segment<3>(3 * k), gradient);
}

template <class Answer>
std::vector<PointsStiffness> SelfContact::touches_stiffness(const Body& body, const VecX& x,
                                                            const Answer& answer) {
  std::vector<PointsStiffness> out;
  for (const SelfTouch& touch : touching(body, x)) {
    const BarrierSample b = answer(touch.sample.distance);
    std::array<Vec3, 3> corners;
    std::array<int, 4> rows{touch.skin_point, -1, -1, -1};
    Eigen::Matrix<double, 12, 1> slope;
    for (int k = 0; k < 4; ++k) slope.segment<3>(3 * k) = touch.sample.weight[k] * touch.sample.normal;
    for (int k = 0; k < touch.part.corners; ++k) {
      rows[k + 1] = touch.part.corner[k];
      corners[k] = body.skin_point(touch.part.corner[k], x);
    }
    const std::span<const Vec3> used(corners.data(), touch.part.corners);
    const Eigen::Matrix<double, 12, 12> bend = flat_hessian(used, touch.sample);
    out.push_back({points_of(body.skin().stencils, rows),
                   touch.area * (b.second * slope * slope.transpose() + b.derivative * bend)});
  }
  return out;
}

void SelfContact::add_hessian(const Body& body, const VecX& x, BlockMatrix& matrix) {
  std::vector<PointsStiffness> all =
      touches_stiffness(body, x, [](double distance) { return self_barrier.sample(distance); });
  for (const EdgeTouch& touch : crossing(body, x))
    all.push_back({points_of(body.skin().stencils, touch.ends), touch.area * touch.sample.hessian});
  lacking_ = !add_all(all, workers, matrix);
}

bool SelfContact::add_convexity(const Body& body, const VecX& x, BlockMatrix& matrix) {
  if (touching(body, x).empty()) return false;
  const auto against = [](double distance) {
    return BarrierSample{0, -self_barrier.sample(distance).derivative, 0};
  };
  add_all(touches_stiffness(body, x, against), workers, matrix);
  return true;
}

double SelfContact::safe_share(const Body& body, const VecX& x, const VecX& step, double keep, double share) {
  if (!active || !step.allFinite() || !x.allFinite() || step.isZero(0)) return share;
  // A pair that loses more than 1 - keep of its distance was no further apart than this. What could meet on a longer
  // way would be everything: that is gone in parts.
  const double far = share * relative_motion(body, unturned(body, x, step), all_nodes(body)) / (1.0 - keep);
  // So many parts that most steps of a crumpled organ are looked through at once.
  constexpr int most_at_once = 3;
  const int parts = 1 + static_cast<int>(far / (0.5 * group_reach));
  const double part = share / parts;
  for (int k = 0; k < parts; k += most_at_once) {
    const int some = std::min(most_at_once, parts - k);
    const VecX from = x + k * part * step, way = some * part * step;
    const double safe =
        some == 1 ? safe_part(body, from, way, keep) : safe_in_parts(body, from, way, keep, some);
    if (safe < 1.0) return (k + some * safe) * part;
  }
  return share;
}

double SelfContact::safe_in_parts(const Body& body, const VecX& x, const VecX& step, double keep, int parts) {
  at_ = body.skin_positions(x);
  way_ = body.skin_positions(step);
  // A pair that loses more than 1 - keep of its distance in a part has lost no more in those before than its points move
  // against each other there: at first it was no further apart than these parts of the whole say.
  const double lost = parts / (parts - 1 + 1 / (1.0 - keep));
  const SkinMotion moving{at_, &way_, 0, 0, lost};
  const std::vector<GroupPair> groups = near_groups(net(body), moving, workers);
  const std::vector<SelfPair> pairs = near_pairs(*net_, moving, groups, workers);
  if (pairs.empty()) return 1;
  const std::vector<EdgesNear> crossing = edges_at(*net_, pairs, moving, workers);
  const std::vector<int> rows = rows_of(pairs, crossing);
  const VecX part = step / parts;
  look_up(body, part, rows, way_);
  for (int k = 0; k < parts; ++k) {
    if (k > 0) look_up(body, x + k * part, rows, at_);
    const double safe = least_share(pairs, crossing, keep);
    if (safe < 1.0) return (k + safe) / parts;
  }
  return 1;
}

double SelfContact::safe_part(const Body& body, const VecX& x, const VecX& step, double keep) {
  const double lost = 1.0 - keep, beside = beside_edges(body);
  const VecX nearing = unturned(body, x, step);
  const double anywhere = relative_motion(body, nearing, all_nodes(body)) / lost;
  refresh_groups(body, x, std::hypot(anywhere, beside));
  if (groups_.empty()) return 1.0;
  const double far = relative_motion(body, nearing, nodes_) / lost;
  if (far <= close_reach) {
    const double near = far + refresh(body, x, far, far);
    if ((near_.empty() || nearest_ >= near) && (edges_near_.empty() || nearest_edges_ >= near)) return 1.0;
    look_up(body, x, at_);
    look_up(body, step, way_);
    const PlacedEdges edges{&net_->edges, &at_, &way_};
    double share = 1.0;
    for (const SelfPair& pair : near_)
      if (pair.distance < near) share = cut_by(*net_, pair, at_, way_, keep, share);
    for (const EdgesNear& pair : edges_near_)
      if (pair.distance < near) share = calot::safe_share(edges, edges, pair, keep, share);
    return share;
  }
  look_up(body, x, at_);
  look_up(body, step, way_);
  look_up(body, nearing, nearing_);
  const SkinMotion moving{at_, &nearing_, 0, 0, lost};
  const std::vector<SelfPair> pairs = near_pairs(*net_, moving, groups_, workers);
  return least_share(pairs, edges_at(*net_, pairs, moving, workers), keep);
}

double SelfContact::least_share(const std::vector<SelfPair>& pairs, const std::vector<EdgesNear>& crossing,
                                double keep) const {
  const PlacedEdges edges{&net_->edges, &at_, &way_};
  const double beside_points = least_left(pairs, workers, 1.0, [&](const SelfPair& pair, double left) {
    return cut_by(*net_, pair, at_, way_, keep, left);
  });
  return least_left(crossing, workers, beside_points, [&](const EdgesNear& pair, double left) {
    return calot::safe_share(edges, edges, pair, keep, left);
  });
}

bool SelfContact::any_nearer(const Body& body, const VecX& x, double distance) {
  const double edges = edges_couple(distance), aged = refresh(body, x, distance, edges);
  const double near = distance + aged, near_edges = edges + aged;
  const bool points = !near_.empty() && nearest_ < near,
             at_edges = !edges_near_.empty() && nearest_edges_ < near_edges;
  if (!points && !at_edges) return false;
  look_up(body, x, at_);
  const PlacedEdges placed{&net_->edges, &at_};
  return std::any_of(near_.begin(), near_.end(),
                     [&](const SelfPair& pair) {
                       return pair.distance < near &&
                              nearest_point(at_[pair.skin_point],
                                            corners_of(net_->triangles[pair.triangle], at_))
                                      .distance < distance;
                     }) ||
         std::any_of(edges_near_.begin(), edges_near_.end(), [&](const EdgesNear& pair) {
           return pair.distance < near_edges &&
                  nearest_of_edges(places_of(placed, placed, pair)).distance < edges;
         });
}

std::optional<BlockMatrix> SelfContact::new_pattern(const Body& body, const VecX& x,
                                                    const BlockMatrix& present) {
  const BlockMatrix& own = body.pattern();
  const bool widened = present.entries().size() != own.entries().size();
  if (!any_nearer(body, x, widened ? uncouple_above : couple_below))
    return widened ? std::optional(own) : std::nullopt;
  // Of all pairs this near, however many more are remembered: the pattern must not depend on where else the skin was
  // looked at.
  const double edges = edges_couple(uncouple_above), aged = refresh(body, x, uncouple_above, edges);
  const double near = uncouple_above + aged;
  look_up(body, x, at_);
  std::vector<std::array<int, 4>> groups;  // faces of a point and of a triangle's corners, or of edges' ends
  const auto face_of = [&](int row) { return body.skin().at[row].face; };
  for (const SelfPair& pair : near_) {
    const Triangle& t = net_->triangles[pair.triangle];
    if (pair.distance >= near ||
        nearest_point(at_[pair.skin_point], corners_of(t, at_)).distance >= uncouple_above)
      continue;
    groups.push_back({face_of(pair.skin_point), face_of(t[0]), face_of(t[1]), face_of(t[2])});
  }
  const PlacedEdges placed{&net_->edges, &at_};
  for (const EdgesNear& pair : edges_near_) {
    if (pair.distance >= edges + aged || nearest_of_edges(places_of(placed, placed, pair)).distance >= edges)
      continue;
    const std::array<int, 4> ends = ends_of(net_->edges, net_->edges, pair);
    groups.push_back({face_of(ends[0]), face_of(ends[1]), face_of(ends[2]), face_of(ends[3])});
  }
  std::sort(groups.begin(), groups.end());
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  std::vector<std::vector<int>> cliques;
  bool missing = false;
  for (const std::array<int, 4>& group : groups) {
    std::vector<int> clique;
    for (int face : group)
      clique.insert(clique.end(), body.face_nodes()[face].begin(), body.face_nodes()[face].end());
    std::sort(clique.begin(), clique.end());
    clique.erase(std::unique(clique.begin(), clique.end()), clique.end());
    for (int j : clique)
      for (int i : clique) missing |= i > j && present.slot(i, j) < 0;
    cliques.push_back(std::move(clique));
  }
  return missing ? std::optional(own.widened(cliques)) : std::nullopt;
}

}  // namespace calot

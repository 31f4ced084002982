#include "sim/tool_touch.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/body_problem.h"

namespace calot {
namespace {

/// Brings Hessians by a blend of skin points and a tool's unknowns to the nodes, those of one triangle at once where they
/// follow each other.
class JointStiffness {
 public:
  JointStiffness(const StencilTable& table, const ToolTouch::FirstNodes& first, BlockMatrix& matrix)
      : table_(table), first_(first), matrix_(matrix) {}

  void add(const Triangle& rows, const Vec3& w, const PointAndToolMatrix& h) {
    if (rows != rows_) finish();
    rows_ = rows;
    for (int b = 0; b < 3; ++b) {
      for (int a = b; a < 3; ++a) sum_.block<3, 3>(3 * a, 3 * b) += w[a] * w[b] * h.topLeftCorner<3, 3>();
      sum_.block<6, 3>(9, 3 * b) += w[b] * h.bottomLeftCorner<6, 3>();
    }
    sum_.bottomRightCorner<6, 6>() += h.bottomRightCorner<6, 6>();
  }
  /// Whether the pattern held all couplings so far.
  bool finish() {
    if (rows_[0] >= 0) spread();
    rows_ = {-1, -1, -1};
    sum_.setZero();
    return complete_;
  }

 private:
  /// A node by what it weighs in the three corners and the tool's two nodes.
  struct Node {
    int node;
    Eigen::Matrix<double, 5, 1> weight = Eigen::Matrix<double, 5, 1>::Zero();
  };
  using Whole = Eigen::Matrix<double, 15, 15>;

  std::vector<Node> nodes() const {
    std::vector<Node> out;
    const auto at = [&](int node) -> Node& {
      const auto place = std::lower_bound(out.begin(), out.end(), node,
                                          [](const Node& n, int wanted) { return n.node < wanted; });
      return place != out.end() && place->node == node ? *place : *out.insert(place, {node});
    };
    for (int k = 0; k < 3; ++k) {
      if (k > 0 && rows_[k] == rows_[0]) continue;
      for (int e = table_.begin[rows_[k]]; e < table_.begin[rows_[k] + 1]; ++e)
        at(first_.body + table_.node[e]).weight[k] = table_.value[e];
    }
    for (int k = 0; k < tool_nodes; ++k) at(first_.tool + k).weight[3 + k] = 1;
    return out;
  }

  void spread() {
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < b; ++a)
        sum_.block<3, 3>(3 * a, 3 * b) = sum_.block<3, 3>(3 * b, 3 * a).transpose().eval();
    sum_.topRightCorner<9, 6>() = sum_.bottomLeftCorner<6, 9>().transpose().eval();
    const std::vector<Node> all = nodes();
    for (std::size_t j = 0; j < all.size(); ++j) {
      Eigen::Matrix<double, 15, 3> column = Eigen::Matrix<double, 15, 3>::Zero();
      for (int k = 0; k < 5; ++k)
        if (all[j].weight[k] != 0) column += all[j].weight[k] * sum_.middleCols<3>(3 * k);
      for (std::size_t i = j; i < all.size(); ++i) {
        Mat3 block = Mat3::Zero();
        for (int k = 0; k < 5; ++k)
          if (all[i].weight[k] != 0) block += all[i].weight[k] * column.middleRows<3>(3 * k);
        if (matrix_.slot(all[i].node, all[j].node) < 0)
          complete_ = false;
        else
          matrix_.add(all[i].node, all[j].node, block);
      }
    }
  }

  const StencilTable& table_;
  ToolTouch::FirstNodes first_;
  BlockMatrix& matrix_;
  Triangle rows_{-1, -1, -1};
  Whole sum_ = Whole::Zero();
  bool complete_ = true;
};

}  // namespace

ToolTouch::ToolTouch(const std::array<int, 2>& bodies, const Tool& tool, const ToolHolds& holds,
                     const Barrier& barrier)
    : bodies_(bodies), tool_(tool), holds_(holds), barrier_(barrier) {}

void ToolTouch::begin(std::span<const GroupPlace> bodies) const {
  body_ = bodies[bodies_[0]].body;
  first_ = {bodies[bodies_[0]].first_node, bodies[bodies_[1]].first_node};
}

ContactLoads ToolTouch::shapes_at(const InstrumentPose& pose) const {
  ContactLoads out;
  out.barrier = barrier_;
  for (const Shape& shape : instrument_shapes(tool_.trocar, pose, tool_.geometry))
    out.shapes.push_back(contact_shape(shape));
  return out;
}

template <class Use>
void ToolTouch::for_loads(const VecX& x, bool hessians, const Use& use) const {
  const VecX own = of_body(x);
  const InstrumentPose pose = pose_at(of_tool(x));
  const ContactLoads loads = shapes_at(pose);
  std::vector<PosedPart> parts;
  for (int part = 0; part < shapes_per_tool; ++part) parts.emplace_back(tool_, pose, part);

  for (const Touch& touch : search_.touching(*body_, own, loads)) {
    const DistanceSlope& d = touch.slope;
    const BarrierSample& b = touch.answer;
    const double area = body_->contact_area(touch.point);
    Load load{ForceOnTool::By::contact,
              touch.shape,
              touch.point,
              body_->skin().triangles[touch.point / contacts_each],
              contact_weights(touch.point),
              touch.at,
              area * b.energy,
              area * b.derivative * d.gradient,
              Mat3::Zero()};
    if (hessians) {
      const Shape& shape = loads.shapes[touch.shape];
      // The touch's distance is of the surface around the skin; the shape bends about the point itself.
      load.hessian =
          area * (b.second * d.gradient * d.gradient.transpose() +
                  b.derivative * distance_hessian(shape, touch.at, distance_slope(shape, touch.at)));
    }
    use(load, parts[touch.shape]);
  }
  for (const PadHold& hold : holds_.pads) {
    const PosedPart& part = parts[hold.part];
    const Vec3 at = body_->skin_point(hold.skin_point, own), across = part.frame().linear().col(0);
    const Vec3 off = at - part.frame() * hold.local, along = off - across * across.dot(off);
    use({ForceOnTool::By::hold,
         hold.part,
         hold.skin_point,
         {hold.skin_point, hold.skin_point, hold.skin_point},
         Vec3::UnitX(),
         at,
         0.5 * hold.stiffness * along.squaredNorm(),
         hold.stiffness * along,
         hold.stiffness * (Mat3::Identity() - across * across.transpose())},
        part);
  }
  ContactPlaces places(body_->skin(), own);
  for (const ToolRub& rub : holds_.rubs) {
    const PosedPart& part = parts[rub.part];
    const Vec3 at = places.at(rub.point);
    const FrictionSample sample = rub.hold.carried(part.frame()).sample(at);
    use({ForceOnTool::By::rub, rub.part, rub.point, body_->skin().triangles[rub.point / contacts_each],
         contact_weights(rub.point), at, sample.energy, sample.gradient, sample.hessian},
        part);
  }
}

double ToolTouch::value(const VecX& x) const {
  double sum = 0;
  for_loads(x, false, [&](const Load& load, const PosedPart&) { sum += load.energy; });
  return sum;
}

void ToolTouch::add_gradient(const VecX& x, VecX& gradient) const {
  VecX on_body = VecX::Zero(body_->rest().size());
  ToolVector on_tool = ToolVector::Zero();
  for_loads(x, false, [&](const Load& load, const PosedPart& part) {
    for (int k = 0; k < 3; ++k)
      if (load.weights[k] != 0)
        spread(body_->skin().stencils, load.rows[k], load.weights[k] * load.gradient, on_body);
    on_tool -= part.slopes(load.at).transpose() * load.gradient;
  });
  gradient.segment(Eigen::Index{3} * first_.body, on_body.size()) += on_body;
  gradient.segment<6>(Eigen::Index{3} * first_.tool) += on_tool;
}

void ToolTouch::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  JointStiffness stiffness(body_->skin().stencils, first_, matrix);
  for_loads(x, true, [&](const Load& load, const PosedPart& part) {
    stiffness.add(load.rows, load.weights, part.carried_hessian(load.at, load.gradient, load.hessian));
  });
  lacking_ = !stiffness.finish();
}

void ToolTouch::add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const {
  const auto add = [&](const auto& nodes) {
    std::vector<int> clique{first_.tool, first_.tool + 1};
    for (int node : nodes) clique.push_back(first_.body + node);
    std::sort(clique.begin(), clique.end());
    cliques.push_back(std::move(clique));
  };
  std::vector<char> near(body_->face_nodes().size(), 0);
  const ContactLoads loads = shapes_at(pose_at(of_tool(x)));
  // Beyond contact's own margin, so that a matrix serves for some mm of motion.
  constexpr double lasting = 3e-3;  // m
  for (const ContactPair& pair : search_.pairs(*body_, of_body(x), loads, close ? 0.0 : lasting))
    near[pair.triangle / body_->triangles_each()] = 1;
  for (const ToolRub& rub : holds_.rubs) near[rub.point / contacts_each / body_->triangles_each()] = 1;
  for (std::size_t patch = 0; patch < near.size(); ++patch)
    if (near[patch]) add(body_->face_nodes()[patch]);
  const StencilTable& table = body_->skin().stencils;
  for (const PadHold& hold : holds_.pads)
    add(std::vector<int>(table.node.begin() + table.begin[hold.skin_point],
                         table.node.begin() + table.begin[hold.skin_point + 1]));
}

double ToolTouch::safe_share(const VecX& x, const VecX& step, double share) const {
  const VecX own = of_body(x), dx = of_body(step);
  const InstrumentPose from = pose_at(of_tool(x)), to = pose_at(of_tool(x) + of_tool(step));
  const double longest = body_->largest_motion(dx), depth = body_->core_depth();
  const double reach =
      (share * longest + travel_bound(tool_, from, interpolate(from, to, share))) / (1.0 - contact_keep) -
      depth;
  if (!(reach > 0)) return share;
  const ContactLoads loads = shapes_at(from);
  ContactPlaces places(body_->skin(), own, body_->core_radii()), moves(body_->skin(), dx);
  for (int part = 0; part < shapes_per_tool; ++part) {
    const Shape core = core_of(loads.shapes[part]);
    std::vector<ContactPair> pairs;
    search_.pairs_with(part, *body_, own, loads, reach, pairs);
    double path_share = share;
    std::optional<PartPath> path(std::in_place, tool_, part, from, interpolate(from, to, share));
    for (const ContactPair& pair : pairs) {
      if (path_share != share) path.emplace(tool_, part, from, interpolate(from, to, share));
      path_share = share;
      const Nearness near = places.nearness(pair.triangle, core);
      double way = 0;  // of the triangle's corners
      for (int c = 0; c < 3; ++c)
        way = std::max(way, path->way(places.corners(pair.triangle).col(c),
                                      share * moves.corners(pair.triangle).col(c)));
      if (way < (1.0 - contact_keep) * near.of_all()) continue;
      for (int local : body_->contact_points(false)) {
        const int point = pair.triangle * contacts_each + local;
        if (way < (1.0 - contact_keep) * near.of(point)) continue;
        if (path_share != share) path.emplace(tool_, part, from, interpolate(from, to, share));
        path_share = share;
        const double radius = places.radius(point);
        share *= path->share_apart(radius > 0 ? offset(core, radius) : core, places.at(point),
                                   share * moves.at(point), contact_keep);
      }
    }
  }
  return share;
}

std::vector<ForceOnTool> ToolTouch::forces(const VecX& x) const {
  std::vector<ForceOnTool> out;
  for_loads(x, false, [&](const Load& load, const PosedPart&) {
    out.push_back({load.by, load.part, load.point, load.at, load.gradient});
  });
  return out;
}

}  // namespace calot

#include "body/rod_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/units.h"
#include "fem/centreline.h"
#include "fem/point_mass.h"
#include "numerics/parts.h"

namespace calot {
namespace {

using std::numbers::pi;

constexpr double rod_spacing = 1.0e-3;  // m, of the points that are touched: less than half a duct's radius
constexpr int rod_sectors = 20;         // of the tube that is drawn

RodSection section_of(double young, double radius, double wall) {
  return wall < radius ? tube_section(young, radius - 0.5 * wall, wall) : solid_section(young, radius);
}

/// Of the way along points, for each.
std::vector<double> shares_of_way(const std::vector<Vec3>& points) {
  std::vector<double> out{0};
  for (std::size_t k = 1; k < points.size(); ++k)
    out.push_back(out.back() + (points[k] - points[k - 1]).norm());
  const double whole = out.back();
  for (double& share : out) share /= whole;
  return out;
}

}  // namespace

double RodBody::radius_along(double share) const {
  if (!setup_.radii.empty()) {
    const auto behind = std::upper_bound(radius_shares_.begin() + 1, radius_shares_.end() - 1, share);
    const auto k = static_cast<std::size_t>(behind - radius_shares_.begin());
    const double part = (share - radius_shares_[k - 1]) / (radius_shares_[k] - radius_shares_[k - 1]);
    return setup_.radii[k - 1] + part * (setup_.radii[k] - setup_.radii[k - 1]);
  }
  const double end = setup_.end_radius > 0 ? setup_.end_radius : setup_.radius;
  return setup_.radius + share * (end - setup_.radius);
}

Result<RodBody> RodBody::create(const Setup& setup) {
  Result<Centreline> line = Centreline::create(setup.nodes);
  if (!line) return line.failure();
  if (!setup.radii.empty() && setup.radii.size() != setup.points.size())
    return fail(
        FailureKind::scenario,
        fmt::format("{} radii at {} points of '{}'", setup.radii.size(), setup.points.size(), setup.name),
        "give one at each of its points");
  RodBody body(setup, std::move(line).value());
  Result<VecX> rest = body.line_.along(setup.points);
  if (!rest) return rest.failure();
  body.rest_ = std::move(rest).value();
  body.radius_shares_ = shares_of_way(setup.points);
  std::vector<double> middles;
  for (const HeldPart& held : setup.held) middles.push_back(held.share * body.line_.spans());
  const StencilTable table = body.line_.stencils(middles);
  body.held_at_ = blend_all(table, table.value, body.rest_);
  if (Result<bool> built = body.build(); !built) return built.failure();
  return body;
}

RodBody RodBody::without_held(std::size_t which) const {
  RodBody out = *this;
  out.setup_.held.erase(out.setup_.held.begin() + static_cast<std::ptrdiff_t>(which));
  out.held_at_.erase(out.held_at_.begin() + static_cast<std::ptrdiff_t>(which));
  out.constant_ = constant_.blank();
  out.bed_ = {};
  out.lay_bed();
  return out;
}

RodBody RodBody::pinched(const std::vector<Pinch>& pinches) const {
  RodBody out = *this;
  out.pinches_.clear();
  out.lay_sections();
  for (const Pinch& pinch : pinches) out.hold_flat(pinch);
  return out;
}

void RodBody::hold_flat(const Pinch& pinch) {
  pinches_.push_back(pinch);
  const int last = static_cast<int>(radii_.size()) - 1, before = static_cast<int>(pinch.at);
  const double height = flat_half_height(pinch.at, pinch.opening);
  for (int row : {before, std::min(before + 1, last)})
    radii_[row] = core_radii_[row] = std::min(radii_[row], height);
  for (int k = std::max(before - 1, 0); k <= std::min(before + 1, last - 1); ++k)
    rings_[k] = {0, 0, 0.5 * (radii_[k] + radii_[k + 1])};
}

FlatRing RodBody::ring_of(double radius) const {
  return setup_.wall < radius
             ? FlatRing::of_tube(4 * setup_.shear_modulus, radius - 0.5 * setup_.wall, setup_.wall)
             : FlatRing{0, 0, radius};
}

namespace {

/// What lies between two of the values that stand one at each skin point.
template <class Value>
Value between_points(const std::vector<Value>& values, double at) {
  const auto before = std::min(static_cast<std::size_t>(at), values.size() - 2);
  const double share = at - static_cast<double>(before);
  return (1 - share) * values[before] + share * values[before + 1];
}

}  // namespace

double RodBody::outer_radius(double at) const { return radius_along(between_points(skin_shares_, at)); }
FlatRing RodBody::ring_at(double at) const { return ring_of(outer_radius(at)); }
Vec3 RodBody::place_at(double at, const VecX& x) const { return between_points(skin_positions(x), at); }

double RodBody::share_at(double at) const {
  const int point = std::min(static_cast<int>(at), static_cast<int>(skin_rest_.size()) - 2);
  const double before = share_of_length(point), after = share_of_length(point + 1);
  return before + (at - point) * (after - before);
}

double RodBody::at_share(double share) const {
  int before = 0;
  while (before + 2 < static_cast<int>(skin_rest_.size()) && share_of_length(before + 1) < share) ++before;
  const double low = share_of_length(before), high = share_of_length(before + 1);
  return before + (share - low) / (high - low);
}

std::map<std::string, int> RodBody::landmarks() const {
  std::map<std::string, int> out;
  for (const auto& [name, share] : setup_.landmarks)
    out[name] = static_cast<int>(std::lround(share * last_point()));
  return out;
}

double RodBody::way_to(double at) const {
  double way = 0;
  for (std::size_t p = 0; p + 1 < skin_rest_.size() && static_cast<double>(p) < at; ++p)
    way += std::min(1.0, at - static_cast<double>(p)) * (skin_rest_[p + 1] - skin_rest_[p]).norm();
  return way;
}

Mat3 RodBody::frame_at(double at, const VecX& x) const {
  const std::vector<Vec3> line = skin_positions(x);
  const auto before = std::min(static_cast<std::size_t>(at), line.size() - 2);
  Mat3 out;
  out.col(0) = (line[before + 1] - line[before]).normalized();
  const Vec3 normal = between_points(skin_normals(x), at);
  out.col(1) = (normal - out.col(0) * out.col(0).dot(normal)).normalized();
  out.col(2) = out.col(0).cross(out.col(1));
  return out;
}

double RodBody::share_of_length(int point) const {
  double before = 0, all = 0;
  for (std::size_t k = 1; k < skin_rest_.size(); ++k) {
    all += (skin_rest_[k] - skin_rest_[k - 1]).norm();
    if (static_cast<int>(k) == point) before = all;
  }
  return before / all;
}

Result<bool> RodBody::build() {
  if (Result<bool> laid = lay_rod(); !laid) return laid;
  if (skin_shares_.empty()) choose_skin_points();
  lay_skin();
  Result<TubeMesh> tube = TubeMesh::create(skin_rest_, rod_sectors);
  if (!tube) return tube.failure();
  tube_ = std::move(tube).value();
  drawn_rest_ = drawn(rest_).positions;
  Eigen::AlignedBox3d box;
  for (const Vec3& p : drawn_rest_) box.extend(p);
  size_ = box.diagonal().norm();
  for (int i = 0; i < nodes(); ++i) {
    double shortest = size_;
    for (int other : {i - 1, i + 1})
      if (other >= 0 && other < nodes())
        shortest =
            std::min(shortest, (rest_.segment<3>(3 * i) - rest_.segment<3>(Eigen::Index{3} * other)).norm());
    edge_lengths_.push_back(std::max(shortest, least_edge_));
  }
  std::vector<std::vector<int>> cliques = rod_.cliques();
  cliques.insert(cliques.end(), face_nodes_.begin(), face_nodes_.end());
  constant_ = BlockMatrix(nodes(), cliques);
  lay_bed();
  weigh();
  return true;
}

Result<bool> RodBody::lay_rod() {
  RodQuadrature quadrature = line_.quadrature();
  std::vector<RodSection> sections;
  double axial = std::numeric_limits<double>::infinity();
  for (double share : quadrature.shares) {
    shares_.push_back(part_[0] + share * (part_[1] - part_[0]));
    sections.push_back(section_of(3 * setup_.shear_modulus, radius_along(shares_.back()), setup_.wall));
    axial = std::min(axial, sections.back().axial);
  }
  Result<Rod> rod = Rod::create(std::move(quadrature), rest_, std::move(sections));
  if (!rod) return rod.failure();
  // Where nothing loads it, forces are but rounding: a strain of 1e-4 is what they are judged beside then.
  least_force_ = 1e-4 * axial;
  rod_ = std::move(rod).value();
  for (double length : rod_.point_lengths()) length_ += length;
  return true;
}

void RodBody::choose_skin_points() {
  // An even number of segments, so that the middle is a point.
  const int segments = std::max(4, 2 * static_cast<int>(std::ceil(0.5 * length_ / rod_spacing)));
  for (int k = 0; k <= segments; ++k) {
    skin_parameters_.push_back(static_cast<double>(line_.spans()) * k / segments);
    skin_shares_.push_back(static_cast<double>(k) / segments);
  }
}

/// Each segment between two points is two triangles flat as lines, one from either end, so that their contact points lie
/// evenly on it.
void RodBody::lay_skin() {
  const int segments = static_cast<int>(skin_shares_.size()) - 1;
  skin_.stencils = line_.stencils(skin_parameters_);
  skin_rest_ = blend_all(skin_.stencils, skin_.stencils.value, rest_);
  skin_areas_.assign(skin_rest_.size(), 0.0);
  lay_sections();
  for (int k = 0; k <= segments; ++k) skin_.at.push_back({std::min(k, segments - 1), 0, 0});
  for (int k = 0; k < segments; ++k) {
    const double radius = 0.5 * (radii_[k] + radii_[k + 1]);
    skin_.triangles.push_back({k, k + 1, k + 1});
    skin_.triangles.push_back({k + 1, k, k});
    segment_areas_.push_back(radius * (skin_rest_[k + 1] - skin_rest_[k]).norm());
    for (int end : {k, k + 1}) skin_areas_[end] += 0.5 * segment_areas_.back();
    std::vector<int>& nodes = face_nodes_.emplace_back();
    for (int row : {k, k + 1})
      nodes.insert(nodes.end(), skin_.stencils.node.begin() + skin_.stencils.begin[row],
                   skin_.stencils.node.begin() + skin_.stencils.begin[row + 1]);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
}

/// As nothing pinches it.
void RodBody::lay_sections() {
  radii_.clear();
  core_radii_.clear();
  rings_.clear();
  for (double share : skin_shares_) {
    const double radius = radius_along(share);
    radii_.push_back(radius);
    const bool solid = setup_.wall >= radius;
    // A trial may flatten a tube but for a hundredth of its lumen, where the section's law ends.
    const double folded = solid ? radius - contact_guard : setup_.wall + 0.01 * (radius - setup_.wall);
    core_radii_.push_back(folded + contact_guard);
  }
  for (std::size_t k = 0; k + 1 < radii_.size(); ++k)
    rings_.push_back(ring_of(0.5 * (radii_[k] + radii_[k + 1])));
}

void RodBody::lay_bed() {
  const StencilTable& table = rod_.stencils();
  for (int row = 0; row < table.rows(); ++row) {
    const Vec3 at = blend(table, table.value, row, rest_);
    const double around = 2 * pi * radius_along(shares_[row]) * rod_.point_lengths()[row];
    double stiffness = 0;
    for (std::size_t k = 0; k < setup_.held.size(); ++k)
      if ((at - held_at_[k]).norm() < setup_.held[k].radius) stiffness += setup_.held[k].stiffness * around;
    if (stiffness <= 0) continue;
    bed_.row.push_back(row);
    bed_.target.push_back(at);
    bed_.stiffness.push_back(stiffness);
  }
  bed_.add_hessian(table, constant_);
}

void RodBody::weigh() {
  weight_ = VecX::Zero(rest_.size());
  const StencilTable& table = rod_.stencils();
  for (int row = 0; row < table.rows(); ++row)
    spread(table, row, -units::standard_gravity * row_mass(row) * setup_.up, weight_);
  PointMass mass;
  for (int row = 0; row < table.rows(); ++row) mass.mass.push_back(row_mass(row));
  if (!(mass.total() > 0)) return;
  mass_ = constant_.blank();
  mass.add_hessian(table, 1, *mass_);
}

double RodBody::row_mass(int row) const {
  const double outer = radius_along(shares_[row]), inner = std::max(0.0, outer - setup_.wall);
  const double lumen = pi * inner * inner, wall = pi * outer * outer - lumen;
  return rod_.point_lengths()[row] * (setup_.density * wall + setup_.liquid_density * lumen);
}

double RodBody::value(const VecX& x) const {
  return rod_.value(x, setup_.pressure) + bed_.value(rod_.stencils(), x);
}

void RodBody::add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const {
  rod_.add_gradient(x, setup_.pressure, gradient);
  largest_internal = std::max({largest_node(gradient), largest_node(weight_), least_force_});
  bed_.add_gradient(rod_.stencils(), x, gradient);
}

void RodBody::add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* /*assembly*/) const {
  rod_.add_hessian(x, setup_.pressure, matrix);
}

double RodBody::max_stretch(const VecX& x) const {
  double largest = 0;
  for (const Rod::Sample& sample : rod_.samples(x, setup_.pressure))
    largest = std::max(largest, sample.stretch);
  return largest;
}

double RodBody::contact_area(int point) const {
  return 0.5 * segment_areas_[point / (2 * contacts_each)] / felt_points.size();
}

BarrierSample RodBody::contact_sample(int point, double distance, const Barrier& barrier) const {
  const FlatRing& ring = rings_[point / (2 * contacts_each)];
  const double width = ring.outer;  // as contact_area() counts it
  const SectionSample s =
      RodContactLaw<Barrier>{ring, barrier, width}.sample(distance + ring.outer, setup_.pressure).section;
  return {s.energy / width, s.slope / width, s.bend / width};
}

std::vector<Vec3> RodBody::skin_normals(const VecX& x) const {
  std::vector<Vec3> normals;
  const StencilTable& table = skin_.stencils;
  for (int row = 0; row < table.rows(); ++row) {
    const Vec3 along = blend(table, table.du, row, x).normalized();
    const Vec3 across = setup_.up - along * along.dot(setup_.up);
    normals.push_back(across.norm() > 1e-6 ? across.normalized() : along.unitOrthogonal());
  }
  return normals;
}

DrawnSurface RodBody::drawn(const VecX& x) const {
  std::vector<TubeSection> sections;
  for (std::size_t row = 0; row < radii_.size(); ++row) {
    const double radius = outer_radius(static_cast<double>(row));
    sections.push_back({radius, radius, Vec3::Zero()});
    constexpr double held = 0.6, reach = 3;  // skin points to either side, held flat and drawn in
    for (const Pinch& pinch : pinches_) {
      const double away =
          std::clamp((std::abs(static_cast<double>(row) - pinch.at) - held) / (reach - held), 0.0, 1.0);
      const double flat = 1 - away * away * (3 - 2 * away);
      const FlatRing ring = ring_of(radius);
      const double closing = flat * (1 - pinch.opening) * ring.lumen;
      if (ring.half_height(closing) >= sections.back().flattened) continue;
      sections.back() = {ring.half_width(closing), ring.half_height(closing),
                         frame_at(pinch.at, x) * pinch.pressed};
    }
  }
  TubeMesh::Surface surface;
  std::array<TubeEnd, 2> ends;  // a part's are cut
  for (int k = 0; k < 2; ++k) {
    const double at = k == 0 ? 0.0 : last_point();
    ends[k] = {part_[k] != static_cast<double>(k), lumen_radius(at) / outer_radius(at)};
  }
  tube_->place(skin_positions(x), sections, surface, ends);
  return {std::move(surface.positions), std::move(surface.normals)};
}

}  // namespace calot

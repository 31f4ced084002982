// A kind of body that the program does not know, one class and one row here, is to all others a body like any.

#include <gtest/gtest.h>

#include "body/body_cut.h"
#include "field/change_bodies.h"
#include "field/divide_body.h"
#include "field_rig.h"
#include "motion/settle_field.h"
#include "numerics/parts.h"

namespace calot {
namespace {

/// A strap on an elastic bed: three points across, and springs between those that are next to each other. Nodes are its
/// skin's points, straight across the strap and then along it.
class Strap : public Body {
 public:
  static constexpr int across = 3;
  static constexpr double spacing = 4e-3, bed = 4, spring = 10;  // m, N/m

  Strap(std::string name, std::vector<Vec3> points) : name_(std::move(name)), points_(std::move(points)) {
    const int nodes = static_cast<int>(points_.size()), rows = nodes / across;
    for (int row = 0; row + 1 < rows; ++row)
      for (int k = across * row; k + 1 < across * (row + 1); ++k) {
        skin_.triangles.push_back({k, k + across, k + 1});
        skin_.triangles.push_back({k + 1, k + across, k + across + 1});
      }
    Eigen::AlignedBox3d box;
    for (int k = 0; k < nodes; ++k) {
      skin_.at.push_back({});
      skin_.stencils.node.push_back(k);
      skin_.stencils.value.push_back(1);
      skin_.stencils.begin.push_back(k + 1);
      box.extend(points_[k]);
    }
    for (const Triangle& t : skin_.triangles) patches_.push_back({t[0], t[1], t[2]});
    for (std::vector<int>& patch : patches_) std::sort(patch.begin(), patch.end());
    rest_ = to_coordinates(points_);
    size_ = box.diagonal().norm();
    edges_.assign(points_.size(), spacing);
    areas_.assign(points_.size(), spacing * spacing);
    stiffness_ = BlockMatrix(nodes, patches_);
    for (int k = 0; k < nodes; ++k) {
      stiffness_.add(k, k, bed * Mat3::Identity());
      if (k % across + 1 < across) tie(k, k + 1);
      if (k + across < nodes) tie(k, k + across);
    }
  }
  /// Level, from `from` along x.
  static Strap level(const std::string& name, const Vec3& from, int rows) {
    std::vector<Vec3> points;
    for (int row = 0; row < rows; ++row)
      for (int k = 0; k < across; ++k) points.push_back(from + spacing * Vec3(row, k - 1, 0));
    return {name, std::move(points)};
  }

  const std::string& name() const override { return name_; }
  const VecX& rest() const override { return rest_; }
  double size() const override { return size_; }
  const std::vector<double>& edge_lengths() const override { return edges_; }
  const BlockMatrix& pattern() const override { return stiffness_; }
  double value(const VecX& x) const override { return 0.5 * (x - rest_).dot(stiffness_.multiply(x - rest_)); }
  void add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const override {
    gradient += stiffness_.multiply(x - rest_);
    largest_internal = std::max(largest_node(gradient), 1e-3);
  }
  void add_hessian(const VecX&, BlockMatrix&, Assembly*) const override {}
  double strain_energy(const VecX& x) const override { return value(x); }
  double max_stretch(const VecX&) const override { return 1; }
  const Tessellation& skin() const override { return skin_; }
  const std::vector<double>& skin_areas() const override { return areas_; }
  double contact_area(int) const override { return 0.5 * spacing * spacing / contacts_each; }
  const std::vector<Vec3>& skin_rest() const override { return points_; }
  const std::vector<std::vector<int>>& face_nodes() const override { return patches_; }
  std::vector<Vec3> skin_normals(const VecX&) const override {
    return std::vector<Vec3>(points_.size(), Vec3::UnitZ());
  }

  std::map<std::string, int> landmarks() const override {
    return {{"first", across / 2}, {"last", nodes() - 1 - across / 2}};
  }
  Result<std::optional<BodyCut>> divide(double share) const override {
    const int last = nodes() / across - 1, cut = static_cast<int>(std::lround(share * last));
    if (cut < 1 || cut >= last) return fail(FailureKind::scenario, "a strap is divided between its ends");
    const double at = static_cast<double>(cut) / last;
    return std::optional(BodyCut{across * cut + across / 2, at, false, {piece(0, cut), piece(cut, last)}});
  }

 private:
  void tie(int one, int other) {
    stiffness_.add(one, one, spring * Mat3::Identity());
    stiffness_.add(other, other, spring * Mat3::Identity());
    stiffness_.add(other, one, -spring * Mat3::Identity());
  }
  BodyPiece piece(int first, int last) const {
    const int begin = across * first, end = across * (last + 1), segment = 2 * (across - 1);
    BodyPiece out;
    out.body = std::make_shared<const Strap>(
        name_, std::vector<Vec3>(points_.begin() + begin, points_.begin() + end));
    for (int k = 0; k < nodes(); ++k) out.points.push_back(k >= begin && k < end ? k - begin : -1);
    for (int t = 0; t < static_cast<int>(skin_.triangles.size()); ++t) {
      const bool there = t >= segment * first && t < segment * last;
      out.triangles.push_back(there ? t - segment * first : -1);
    }
    out.nodes = [begin, end](const VecX& x) { return VecX(x.segment(3 * begin, 3 * (end - begin))); };
    out.begins = first * spacing;
    out.share = static_cast<double>(last - first) / (nodes() / across - 1);
    return out;
  }

  std::string name_;
  std::vector<Vec3> points_;
  VecX rest_;
  double size_ = 0;
  std::vector<double> edges_, areas_;
  Tessellation skin_;
  std::vector<std::vector<int>> patches_;
  BlockMatrix stiffness_{0, {}};
};

constexpr int rows = 11;

const BodyKind strap_kind{
    "strap", [](const OrganDefinition& definition, const OrganSetting& setting) -> Result<RestedOrgan> {
      return organ_as_drawn<Strap>(definition, Strap::level(definition.name, Vec3::Zero(), rows), setting);
    }};

/// A strap along x from the origin, and above it one grasper's tip.
Field strap_field() {
  OrganDefinition definition;
  definition.name = "strap";
  definition.shape = RigidShape{};  // of which it is not asked anything
  Field field;
  field.tolerance = 1e-9;
  field.add(make_organ(strap_kind, definition, {ContactLoads{}, Vec3::UnitZ(), 1e-9}).value());
  test::add_grasper(field, Vec3(20e-3, 0, 150e-3));
  keep_members(field);
  return field;
}

/// The middle of the strap, pressed down to this height, m.
std::string press(Field& field, double height) { return test::move_tip(field, Vec3(20e-3, 0, height), 0, 8); }

Vec3 on_bed(const Organ& strap) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < strap.state.x.size(); i += 3)
    sum += Strap::bed * (strap.state.x - strap.body->rest()).segment<3>(i);
  return sum;
}

TEST(NewKind, GivesWayToAToolAndPressesBackByWhatItsBedBears) {
  Field field = strap_field();
  const Organ& strap = field.organs[0];
  ASSERT_EQ(press(field, 5e-3), "");
  ASSERT_EQ(strap.state.x, strap.body->rest()) << "not touched yet";
  ASSERT_EQ(press(field, -4e-3), "");
  const int middle = Strap::across * (rows / 2) + Strap::across / 2;
  EXPECT_LT(strap.body->skin_point(middle, strap.state.x).z(), -3.9e-3);
  EXPECT_GT(test::tool_force(field).z(), 5e-3);
  EXPECT_LT((test::tool_force(field) + on_bed(strap)).norm(), 1e-8);
  ASSERT_EQ(press(field, 5e-3), "");
  EXPECT_LT((strap.state.x - strap.body->rest()).lpNorm<Eigen::Infinity>(), 1e-8);
}

TEST(NewKind, HasItsLandmarks) {
  const Field field = strap_field();
  const std::optional<OrganPoint> last = find_landmark(field.organs, "strap.last");
  ASSERT_TRUE(last);
  EXPECT_EQ(field.organ(last->organ).body->skin_rest()[last->skin_point],
            Vec3((rows - 1) * Strap::spacing, 0, 0));
  EXPECT_FALSE(find_landmark(field.organs, "strap.middle"));
}

TEST(NewKind, IsDividedIntoPiecesThatLieAsItDidWithTheirHoldsAndLandmarks) {
  Field field = strap_field();
  ASSERT_EQ(press(field, -4e-3), "");
  field.organs[0].grips.push_back({ToolIndex(0), 1, 4, Vec3(1e-3, 0, 0), 10});
  field.organs[0].grips.push_back({ToolIndex(0), 0, 28, Vec3(2e-3, 0, 0), 10});
  const Organ whole = field.organs[0];
  ASSERT_FALSE(can_be_divided(whole, 0));
  ASSERT_TRUE(can_be_divided(whole, 0.3));
  const Result<Division> done = divide_body(field, OrganIndex(0), 0.3, 1.0);
  ASSERT_TRUE(done) << to_text(done.failure());
  EXPECT_EQ(done->share, 0.3);
  ASSERT_EQ(field.organs.size(), 2u);
  // Nothing says which is the patient's: the piece at its end.
  const Organ &end = field.organs[0], &start = field.organs[1];
  EXPECT_EQ(end.definition.name, "strap.patient");
  EXPECT_EQ(start.definition.name, "strap.specimen");
  const std::vector<Vec3> before = whole.body->skin_positions(whole.state.x),
                          at_start = start.body->skin_positions(start.state.x),
                          at_end = end.body->skin_positions(end.state.x);
  constexpr int cut = 3;  // row
  ASSERT_EQ(at_start.size(), static_cast<std::size_t>(Strap::across * (cut + 1)));
  for (std::size_t k = 0; k < at_start.size(); ++k) EXPECT_EQ(at_start[k], before[k]);
  for (std::size_t k = 0; k < at_end.size(); ++k) EXPECT_EQ(at_end[k], before[Strap::across * cut + k]);
  ASSERT_EQ(start.grips.size(), 1u);
  EXPECT_EQ(start.grips[0].skin_point, 4);
  ASSERT_EQ(end.grips.size(), 1u);
  EXPECT_EQ(end.grips[0].skin_point, 28 - Strap::across * cut);
  EXPECT_EQ(end.landmarks.at("first"), 1);
  EXPECT_TRUE(start.openings.empty()) << "it carries nothing";
  // Once apart, the piece that nothing presses lies as it was drawn.
  for (Organ& piece : field.organs) piece.grips.clear();
  SolveStatistics statistics;
  const Result<bool> rested = settle_field(field, "once divided", statistics);
  ASSERT_TRUE(rested) << to_text(rested.failure());
  EXPECT_LT((start.state.x - start.body->rest()).lpNorm<Eigen::Infinity>(), 1e-8);
  EXPECT_LT((test::tool_force(field) + on_bed(end)).norm(), 1e-8);
}

}  // namespace
}  // namespace calot

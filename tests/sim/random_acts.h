#pragma once
// Acts of all instruments of a world at random: what must hold in each step of whatever they do.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "base/rng.h"
#include "field/field.h"
#include "field/field_state.h"
#include "organs/tissue.h"
#include "support/random.h"
#include "tools/tool.h"
#include "world/world.h"

namespace calot::test {

/// One after the other acts from where the last one left the field; `again()` begins anew.
class RandomActs {
 public:
  static constexpr double hardest = 4;  ///< N, with which it presses on
  RandomActs(World world, std::uint64_t seed) : world_(std::move(world)), rng_(seed), start_(world_.state()) {
    again();
  }

  void again() {
    EXPECT_TRUE(world_.restore(start_));
    bile_ = bile_in_organs();
    carried_ = carried_clips() + clips_on_organs();
    dropped_ = 0;
    here_.clear();
    in_.clear();
    for (const InstrumentState& tool : world_.report().instruments) here_.push_back(tool.pose);
    report_ = world_.report();
  }

  /// A random instrument goes to a random place, slowly or fast, does what it is for, pulls, and may let go and leave.
  void act() {
    ++acts;
    tool_ = below(here_.size());
    if (!make_way()) return;
    const Vec3 place = random_place() + random_vector(rng_, 2e-3);
    const double opening = rng_.uniform(0, 0.95) * geometry().jaw_opening, roll = rng_.uniform(-1.5, 1.5);
    const Vec3 back = (trocar() - place).normalized();
    const double speed = std::array{30e-3, 100e-3, 200e-3}[below(3)];
    if (!move(at(place + 8e-3 * back, roll, opening), quick) || !move(at(place, roll, opening), speed))
      return;
    const InstrumentAction action = main_action(definition().type);
    if (has_jaws(definition().type) && rng_.uniform() < 0.7 && !close(0, std::array{3, 10}[below(2)])) return;
    if (action != InstrumentAction::none && rng_.uniform() < 0.8 && !trigger(action)) return;
    if (rng_.uniform() < 0.7 && !move(moved(random_vector(rng_, 5e-3)), speed,
                                      rng_.uniform() < 0.5 ? action : InstrumentAction::none))
      return;
    if (rng_.uniform() < 0.5) return;
    leave();
  }

  std::uint64_t hash() const { return world_.state_hash(); }

  int acts = 0, steps = 0, iterations = 0;
  std::map<std::string, int> events = {}, failures = {};  ///< how often, by kind and by reason

 private:
  static constexpr double quick = 2;  ///< m/s, through the air

  std::size_t below(std::size_t count) { return rng_.next() % count; }
  const InstrumentDefinition& definition() const { return world_.scene().instruments[tool_]; }
  InstrumentGeometry geometry() const { return instrument_geometry(definition().type); }
  Vec3 trocar() const { return world_.port_position(definition().port); }

  /// There are two hands: of the other tools the one that came first leaves.
  bool make_way() {
    const std::size_t acting = tool_;
    std::erase(in_, acting);
    if (in_.size() == 2) {
      tool_ = in_[0];
      if (!leave()) return false;
      tool_ = acting;
    }
    in_.push_back(acting);
    return true;
  }
  bool leave() {
    std::erase(in_, tool_);
    const double opening = 0.7 * geometry().jaw_opening;
    if (has_jaws(definition().type) && here_[tool_].jaw < opening && !close(opening, 5)) return false;
    InstrumentPose out = here_[tool_];
    out.insertion = 30e-3;
    return move(out, quick, InstrumentAction::none, true);
  }

  /// Of an organ's skin, on the side that the tool comes from, or of a strand.
  Vec3 random_place() {
    const Field& field = world_.field();
    const std::size_t body = below(field.organs.size() + field.tissues.size());
    if (body < field.organs.size()) {
      const std::vector<Vec3> skin = world_.skin_positions(OrganIndex(body));
      const std::vector<Vec3> normals = world_.skin_normals(OrganIndex(body));
      for (int tries = 0; tries < 50; ++tries) {
        const std::size_t point = below(skin.size());
        if (normals[point].dot((trocar() - skin[point]).normalized()) > 0.3) return skin[point];
      }
      return skin[0];
    }
    const std::vector<StrandLine> lines =
        strand_lines(field.tissues[body - field.organs.size()], field.organs);
    return lines[below(lines.size())].by;
  }

  InstrumentPose at(const Vec3& tip, double roll, double jaw) const {
    InstrumentPose pose = pose_reaching(trocar(), tip, roll, jaw, geometry());
    pose.insertion = std::clamp(pose.insertion, 0.0, geometry().max_insertion);
    return pose;
  }
  InstrumentPose moved(const Vec3& way) const {
    const InstrumentPose& from = here_[tool_];
    return at(tip_position(trocar(), from, geometry()) + way, from.roll, from.jaw);
  }
  bool move(const InstrumentPose& to, double speed, InstrumentAction action = InstrumentAction::none,
            bool leaves = false) {
    const InstrumentPose from = here_[tool_];
    const double way =
        (tip_position(trocar(), to, geometry()) - tip_position(trocar(), from, geometry())).norm();
    const double turn = std::abs(to.roll - from.roll) + std::abs(to.jaw - from.jaw);
    const double seconds = std::max(way / speed, turn / 25);  // rad/s
    const int parts = std::max(1, static_cast<int>(std::ceil(seconds * world_.scene().solver.rate)));
    for (int k = 1; k <= parts && (leaves || !presses_hard()); ++k)
      if (!step(interpolate(from, to, static_cast<double>(k) / parts), action)) return false;
    return true;
  }
  /// A hand goes no further.
  bool presses_hard() const { return report_.instruments[tool_].force.norm() > hardest; }
  bool close(double jaw, int parts) {
    const InstrumentPose from = here_[tool_];
    InstrumentPose to = from;
    to.jaw = jaw;
    for (int k = 1; k <= parts; ++k)
      if (!step(interpolate(from, to, static_cast<double>(k) / parts), InstrumentAction::none)) return false;
    return true;
  }
  bool trigger(InstrumentAction action) {
    for (int k = 0; k < 3; ++k)
      if (!step(here_[tool_], action)) return false;
    return step(here_[tool_], InstrumentAction::none);
  }

  bool step(const InstrumentPose& pose, InstrumentAction action) {
    StepInput input{here_};
    input.instruments[tool_] = pose;
    input.actions.assign(here_.size(), InstrumentAction::none);
    input.actions[tool_] = action;
    const std::uint64_t hash = world_.state_hash();
    Result<StepReport> done = world_.step(input);
    ++steps;
    iterations += world_.report().statistics.newton_iterations;
    if (!done) {
      judge_failure(done.failure(), hash);
      return false;
    }
    judge(done.value());
    report_ = std::move(done).value();
    here_ = input.instruments;
    return !testing::Test::HasFailure();
  }

  /// It says what, when and what to change, and the field is as it was.
  void judge_failure(const Failure& failure, std::uint64_t hash) {
    const std::string text = to_text(failure);
    ++failures[failure.problems[0].message];
    EXPECT_EQ(failure.kind, FailureKind::simulation) << text;
    EXPECT_NE(failure.problems[0].message.find(
                  fmt::format("{:.3f} s", world_.report().time + 1 / world_.scene().solver.rate)),
              std::string::npos)
        << "when? " << text;
    EXPECT_FALSE(failure.problems[0].hint.empty()) << "what to change? " << text;
    EXPECT_EQ(world_.state_hash(), hash) << text;
    again();
  }

  void judge(const StepReport& now) {
    const std::string when = fmt::format("act {}, step {}, {}", acts, steps, definition().name);
    for (const Organ& organ : world_.field().organs)
      EXPECT_TRUE(organ.state.x.allFinite() && std::isfinite(organ.state.datum_pressure)) << when;
    for (const Tissue& tissue : world_.field().tissues) EXPECT_TRUE(tissue.now.state.x.allFinite()) << when;
    for (const InstrumentState& tool : now.instruments)
      EXPECT_TRUE(tool.force.allFinite() && tool.handle_force.allFinite()) << when;
    const Spill& spill = world_.field().spill;
    std::array<double, liquids> lost{}, hanging{};
    for (const LostState& one : now.lost) lost[0] += one.bile, lost[1] += one.blood;
    for (const Organ& organ : world_.field().organs) {
      const auto* tube = std::get_if<TubeShape>(&organ.definition.shape);
      const Carries liquid = tube ? tube->carries : Carries::bile;
      for (const Opening& opening : organ.openings) hanging[static_cast<std::size_t>(liquid)] += opening.drop;
    }
    double aspirated = 0;
    for (const InstrumentState& tool : now.instruments) aspirated += tool.aspirated;
    EXPECT_NEAR(bile_in_organs() + lost[0] + aspirated - spill.given[0] - spill.drained[0], bile_,
                1e-9 * bile_)
        << when;
    EXPECT_NEAR(lost[1], spill.given[1] + spill.drained[1], 1e-9 * lost[1]) << when;
    for (std::size_t l = 0; l < liquids; ++l)
      EXPECT_NEAR(spill.lying(static_cast<Carries>(l)) + spill.out_of_sight[l] + hanging[l], lost[l],
                  1e-9 * lost[l])
          << when;
    int cuts = 0;
    for (const WorldEvent& event : now.events) {
      const EventRow& row = event_row(event.kind);
      ++events[row.name];
      cuts += event.kind == EventKind::cut && has_organ(report_, event.organ);
      dropped_ += event.kind == EventKind::clip_dropped;
      EXPECT_EQ(event.time, now.time) << row.name << ", " << when;
      EXPECT_TRUE(std::isfinite(event.value)) << row.name << ", " << when;
    }
    EXPECT_EQ(now.organs.size(), report_.organs.size() + static_cast<std::size_t>(cuts)) << when;
    EXPECT_EQ(carried_clips() + clips_on_organs() + dropped_, carried_) << when;
    for (const TissueState& tissue : now.tissues)
      for (const TissueState& before : report_.tissues) {
        if (tissue.name != before.name) continue;
        EXPECT_GE(tissue.torn, before.torn) << tissue.name << ", " << when;
        EXPECT_LE(tissue.strands, before.strands) << tissue.name << ", " << when;
      }
  }
  static bool has_organ(const StepReport& report, const std::string& name) {
    return std::any_of(report.organs.begin(), report.organs.end(),
                       [&](const OrganState& organ) { return organ.name == name; });
  }
  double bile_in_organs() const {
    double sum = 0;
    // What is booked: where a step was cut short its shape holds that to a millionth only.
    for (const Organ& organ : world_.field().organs)
      if (organ.body->liquid() != nullptr) sum += organ.state.volume;
    return sum;
  }
  int carried_clips() const {
    int sum = 0;
    for (const InstrumentState& tool : world_.report().instruments) sum += tool.clips;
    return sum;
  }
  int clips_on_organs() const {
    std::size_t sum = 0;
    for (const OrganState& organ : world_.report().organs) sum += organ.clips.size();
    return static_cast<int>(sum);
  }

  World world_;
  Rng rng_;
  FieldState start_;
  std::vector<InstrumentPose> here_;
  StepReport report_;  ///< of the step before
  std::size_t tool_ = 0;
  std::vector<std::size_t> in_;  ///< tools in the field, the first that came first
  double bile_ = 0;              ///< m^3, in organs at the start
  int carried_ = 0, dropped_ = 0;
};

/// `most` of them may not be followed: a tenth in steps of 40 ms and longer, in which tools go further.
inline void perform(const SceneDefinition& scene, std::uint64_t seed, int acts, double most = 0.05) {
  Result<World> world = World::create(scene);
  ASSERT_TRUE(world) << to_text(world.failure());
  RandomActs hands(std::move(world).value(), seed);
  for (int k = 0; k < acts && !testing::Test::HasFailure(); ++k) {
    if (k % 25 == 0 && k > 0) hands.again();
    hands.act();
  }
  fmt::print("{} acts in {} steps and {} Newton iterations:", hands.acts, hands.steps, hands.iterations);
  for (const auto& [kind, count] : hands.events) fmt::print(" {} {},", count, kind);
  int failed = 0;
  for (const auto& [why, count] : hands.failures) {
    fmt::print("\n  {} x {}", count, why);
    failed += count;
  }
  fmt::print("\n");
  EXPECT_LE(failed, most * acts) << "acts that could not be followed";
}

}  // namespace calot::test

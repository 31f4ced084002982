#include "acts/hands.h"

#include <fmt/format.h>

#include <algorithm>

#include "group/equilibrium.h"
#include "motion/tool_loads.h"
#include "tools/ground_meeting.h"
#include "tools/tool_body.h"
#include "tools/tool_meeting.h"

namespace calot {
namespace {

using Poses = std::vector<InstrumentPose>;

/// N/m, where a force above the strength came without a way of the tip's that shows how it grows: between an organ that is
/// pushed about and one that is squeezed.
constexpr double unknown_stiffness = 2e3;
/// m, that a hand gives way in a step by such a force: what is hard leaves it after less.
constexpr double farthest_unknown = 2e-3;
/// m, that a hand gives way in a step at most, by whatever force, and rad about the shaft: a force that a step out of
/// balance left may be any.
constexpr double farthest = 10e-3, farthest_turn = 0.35;
/// N/m: less is felt where a force falls for another reason than the tip's way.
constexpr double least_stiffness = 100;
/// m: a shorter way tells nothing of how a force grows.
constexpr double shortest_way = 1e-6;
/// The same about the shaft: such forces on pads 5 mm wide, N m/rad, and ways at their edges, rad.
constexpr double unknown_roll_stiffness = 12e-3, least_roll_stiffness = 0.6e-3, shortest_turn = 4e-4;
/// rad: turns of the jaws and about the shaft that are no more than a solver's rounding; 1 um at the pads' ends.
constexpr double turn_slack = 1e-4;

/// Share of a tip's way across the force on it. Tissue that holds the tip pulls it back aside, too; as the force turns
/// by that, a hand that is far from its command would swing about more with every step. By a force that grows alike in
/// all directions the way is that to the place nearest to the command which the strength reaches.
double share_across(const Tool& tool, const Vec3& force, const Vec3& way) {
  const double strength = tool.definition.hand_force, stiffness = tool.stiffness_across;
  const double wanted = (stiffness * way - force).norm();
  return wanted <= strength ? 1.0 : strength / wanted;
}

/// The torque that a hand holds about the shaft, N m.
double roll_strength(const Tool& tool) { return tool.definition.hand_force * HandStrength().roll_arm; }

/// How far a hand turns its tool about the shaft, rad, against the tissue's torque.
double roll_within_strength(const Tool& tool, const InstrumentState& last, double command) {
  const double strength = roll_strength(tool), torque = std::abs(last.roll_torque);
  if (torque == 0 || (!(tool.roll_stiffness > 0) && torque <= strength)) return command;
  const double away = last.roll_torque > 0 ? 1.0 : -1.0, into = -away * (command - tool.pose.roll);
  const double stiffness = tool.roll_stiffness > 0 ? tool.roll_stiffness : unknown_roll_stiffness;
  const double allowed = std::max((strength - torque) / stiffness, -farthest_turn);
  return into <= allowed ? command : tool.pose.roll - away * allowed;
}

/// Where a hand takes its tool against what the tissue does.
InstrumentPose within_strength(const Tool& tool, const InstrumentState& last, InstrumentPose command) {
  command.roll = roll_within_strength(tool, last, command.roll);
  const double strength = tool.definition.hand_force, force = last.at_tip.norm();
  if (force == 0 || (!(tool.tissue_stiffness > 0) && force <= strength)) return command;
  // Jaws that rest on a fold close no further, and the tip of open jaws is nearer to the hinge.
  InstrumentPose reached = command;
  if (tool.jaws_rest()) reached.jaw = std::max(command.jaw, tool.pose.jaw);
  const Vec3 away = last.at_tip / force;
  const Vec3 way = tip_position(tool.trocar, reached, tool.geometry) - last.tip;
  const double into = -way.dot(away);
  const bool known = tool.tissue_stiffness > 0;
  const double stiffness = known ? tool.tissue_stiffness : unknown_stiffness;
  const double allowed = std::max((strength - force) / stiffness, known ? -farthest : -farthest_unknown);
  if (into <= allowed) return command;
  const Vec3 across = share_across(tool, last.at_tip, way) * (way + into * away);
  InstrumentPose out = pose_reaching(tool.trocar, last.tip + across - allowed * away, command.roll,
                                     reached.jaw, tool.geometry);
  out.jaw = command.jaw;
  return out;
}

/// A pair of tools that may meet on their ways.
using Pair = std::array<std::size_t, 2>;

/// m, between two tools where they are, at most `most`.
double gap_between(const Tool& one, const Tool& other, double most) {
  VecX x(12);
  x << tool_coordinates(one.pose), tool_coordinates(other.pose);
  return ToolMeeting({&one, 0}, {&other, tool_nodes}).gap(x, most);
}

std::vector<Pair> near_pairs(const Field& field, const Poses& to) {
  std::vector<Pair> out;
  const auto travel = [&](std::size_t k) { return travel_bound(field.tools[k], field.tools[k].pose, to[k]); };
  for (std::size_t a = 0; a < field.tools.size(); ++a)
    for (std::size_t b = a + 1; b < field.tools.size(); ++b) {
      const Tool &one = field.tools[a], &other = field.tools[b];
      if (one.waits || other.waits) continue;
      const double reach = travel(a) + travel(b) + field.barrier.range;
      if (gap_between(one, other, reach) < reach) out.push_back({a, b});
    }
  return out;
}

/// A tool and what ground it may meet on its way.
struct Grounded {
  std::size_t tool = 0;
  std::vector<const Ground*> ground;
};

std::vector<Shape> shapes_of(const std::vector<const Ground*>& ground) {
  std::vector<Shape> out;
  for (const Ground* one : ground) out.push_back(one->shape);
  return out;
}

/// Whether a shape may come nearer than `reach` m to what lies in a box: quick, and false only where it does not.
bool may_meet(const Shape& shape, const Eigen::AlignedBox3d& box, double reach) {
  const auto* plane = std::get_if<Plane>(&shape);
  if (plane == nullptr) return box.intersects(box_around(shape, reach));
  const Vec3 half = 0.5 * box.sizes();
  return signed_distance(shape, box.center()) - plane->normal.cwiseAbs().dot(half) < reach;
}

std::vector<Grounded> near_ground(const Field& field, const Poses& to) {
  std::vector<Grounded> out;
  for (std::size_t k = 0; k < field.tools.size(); ++k) {
    const Tool& tool = field.tools[k];
    if (tool.waits) continue;
    const double reach = travel_bound(tool, tool.pose, to[k]) + field.barrier.range;
    const VecX here = tool_coordinates(tool.pose);
    const std::vector<Shape> parts = instrument_shapes(tool.trocar, tool.pose, tool.geometry);
    Grounded found{k, {}};
    for (const Ground& ground : field.ground) {
      const bool near = std::any_of(parts.begin(), parts.end(), [&](const Shape& part) {
        return may_meet(ground.shape, box_around(part, 0), reach);
      });
      if (near && GroundMeeting(tool, 0, {ground.shape}).gap(here, reach) < reach)
        found.ground.push_back(&ground);
    }
    if (!found.ground.empty()) out.push_back(std::move(found));
  }
  return out;
}

/// N at the tip that have the moment of what presses on a tool's unknowns.
Vec3 force_at_tip_of(const Tool& tool, const InstrumentPose& pose, const ToolVector& pressed) {
  const Mat3 tip_by_unknowns =
      PosedPart(tool, pose, 0).slopes(tip_position(tool.trocar, pose, tool.geometry)).leftCols<3>();
  return tip_by_unknowns.transpose().fullPivLu().solve(pressed.head<3>());
}

/// What each ground presses a tool's jaws with, or what its shaft ends in.
std::vector<GroundTouch> ground_touches(const Tool& tool, const Grounded& grounded,
                                        const std::vector<GroundMeeting::Press>& presses) {
  std::vector<GroundTouch> out;
  for (const GroundMeeting::Press& press : presses) {
    if (press.part == 0) continue;
    const std::string& name = grounded.ground[press.ground]->name;
    if (out.empty() || out.back().ground != name) out.push_back({name});  // one ground's follow each other
    GroundTouch& touch = out.back();
    touch.force += press.force;
    touch.conducts |= conducts(tool.geometry, press.part);
    if (press.force.norm() <= touch.largest) continue;
    touch.largest = press.force.norm();
    touch.at = press.at;
  }
  return out;
}

/// What ground presses a tool's parts with, at a pose.
PartLoads ground_parts(const Tool& tool, const InstrumentPose& pose, const Grounded& grounded,
                       const std::vector<GroundMeeting::Press>& presses) {
  PartLoads out;
  const Vec3 tip = tip_position(tool.trocar, pose, tool.geometry);
  for (const GroundMeeting::Press& press : presses)
    add_load(tool, tip, press.part == 0, press.at, press.force, true, grounded.ground[press.ground]->name,
             out);
  return out;
}

/// Tools between their hands, each other and ground.
class MetTools {
 public:
  MetTools(const Field& field, const std::vector<Pair>& pairs, const std::vector<Grounded>& grounded,
           const Poses& commands)
      : field_(field), grounded_(grounded), commands_(commands) {
    for (const Pair& pair : pairs) tools_.insert(tools_.end(), pair.begin(), pair.end());
    for (const Grounded& one : grounded) tools_.push_back(one.tool);
    std::sort(tools_.begin(), tools_.end());
    tools_.erase(std::unique(tools_.begin(), tools_.end()), tools_.end());
    for (std::size_t tool : tools_) {
      const Tool& one = field.tools[tool];
      bodies_.emplace_back(one, commands[tool], hand_of(one));
      states_.push_back(ToolBody::at(one.pose));
    }
    for (const Pair& pair : pairs) {
      meetings_.push_back(std::make_shared<const ToolMeeting>(side(pair[0]), side(pair[1]), field.barrier));
      joins_.push_back(meetings_.back());
      pairs_.push_back(pair);
    }
    for (const Grounded& one : grounded) {
      const ToolMeeting::Side here = side(one.tool);
      grounds_.push_back(std::make_shared<const GroundMeeting>(*here.tool, here.first_node,
                                                               shapes_of(one.ground), field.barrier));
      joins_.push_back(grounds_.back());
    }
  }

  /// A balance that takes more is not worth looking for: a shorter way may have one.
  static constexpr int most_iterations = 200;

  NewtonResult balance() {
    std::vector<ContactSearch> searches(bodies_.size());
    std::vector<Member> members;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      searches[k].own.active = false;
      members.push_back({bodies_[k], no_loads_, searches[k], states_[k]});
    }
    NewtonWorkspace work{BlockMatrix(0, {})};
    GroupPatterns patterns;
    NewtonSettings settings;
    settings.stop = [left = most_iterations]() mutable { return left-- <= 0; };
    return settle(members, joins_, patterns, settings, work);
  }

  /// Writes where the tools are, and what they press on others and on ground with.
  void keep(std::vector<Tool>& tools, Poses& poses) const {
    for (std::size_t tool : tools_) poses[tool] = commands_[tool];
    VecX x(6 * static_cast<Eigen::Index>(tools_.size()));
    for (std::size_t k = 0; k < tools_.size(); ++k)
      x.segment<6>(6 * static_cast<Eigen::Index>(k)) = states_[k].x;
    VecX by_tools = VecX::Zero(x.size()), by_ground = by_tools;
    for (const auto& meeting : meetings_) meeting->add_gradient(x, by_tools);
    for (const auto& ground : grounds_) ground->add_gradient(x, by_ground);
    for (std::size_t k = 0; k < tools_.size(); ++k) {
      const ToolVector tools_press = -by_tools.segment<6>(6 * static_cast<Eigen::Index>(k)),
                       ground_presses = -by_ground.segment<6>(6 * static_cast<Eigen::Index>(k));
      if (tools_press.isZero(0) && ground_presses.isZero(0)) continue;
      Tool& tool = tools[tools_[k]];
      poses[tools_[k]] = without_rounding(tool.pose, poses[tools_[k]], pose_at(states_[k].x));
      tool.meeting.force = force_at_tip_of(tool, poses[tools_[k]], tools_press);
      tool.ground.force = force_at_tip_of(tool, poses[tools_[k]], ground_presses);
    }
    for (std::size_t k = 0; k < grounds_.size(); ++k) {
      Tool& tool = tools[grounded_[k].tool];
      const std::vector<GroundMeeting::Press> presses = grounds_[k]->presses(x);
      tool.ground.parts = ground_parts(tool, poses[grounded_[k].tool], grounded_[k], presses);
      tool.ground.touched = ground_touches(tool, grounded_[k], presses);
    }
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (meetings_[k]->force(x).isZero(0)) continue;
      for (int side : {0, 1}) {
        std::string& with = tools[pairs_[k][static_cast<std::size_t>(side)]].meeting.with;
        if (with.empty()) with = tools[pairs_[k][static_cast<std::size_t>(1 - side)]].definition.name;
      }
    }
  }

 private:
  ToolMeeting::Side side(std::size_t tool) const {
    const auto place = std::lower_bound(tools_.begin(), tools_.end(), tool) - tools_.begin();
    return {&field_.tools[tool], tool_nodes * static_cast<int>(place)};
  }
  /// Jaws that other tools do not move close, stand and open as they are asked to, to the bit.
  static InstrumentPose without_rounding(const InstrumentPose& was, const InstrumentPose& commanded,
                                         InstrumentPose pose) {
    if (std::abs(pose.roll - commanded.roll) < turn_slack) pose.roll = commanded.roll;
    if (std::abs(pose.jaw - commanded.jaw) < turn_slack)
      pose.jaw = commanded.jaw;
    else if (std::abs(pose.jaw - was.jaw) < turn_slack)
      pose.jaw = was.jaw;
    return pose;
  }

  const Field& field_;
  const std::vector<Grounded>& grounded_;
  Poses commands_;
  std::vector<std::size_t> tools_;  ///< increasing
  std::vector<Pair> pairs_;
  std::vector<ToolBody> bodies_;
  std::vector<BodyState> states_;
  std::vector<std::shared_ptr<const ToolMeeting>> meetings_;
  std::vector<std::shared_ptr<const GroundMeeting>> grounds_;  ///< as grounded_
  std::vector<JoinPointer> joins_;
  ContactLoads no_loads_;
};

}  // namespace

Vec3 force_at_tip(const Tool& tool, const Vec3& force, const Vec3& moment) {
  // What touches the shaft has a shorter lever.
  const Vec3 arm = tip_position(tool.trocar, tool.pose, tool.geometry) - tool.trocar, axis = arm.normalized();
  if (!(arm.norm() > 0)) return force;
  return axis * axis.dot(force) + moment.cross(axis) / arm.norm();
}

namespace {

/// Lets tools that meet come as far on their ways `to` as they find a balance: all the way, or a half, a quarter, an eighth
/// of it; else they stay where they are, which is free of the others and of ground. Others go all the way.
void bring_met_tools(Field& field, const std::vector<Pair>& pairs, const std::vector<Grounded>& grounded,
                     Poses& to) {
  const Poses from = present_poses(field);
  constexpr double least_share = 0.125;
  for (double share = 1; share >= least_share; share *= 0.5) {
    MetTools met(field, pairs, grounded, interpolate(from, to, share));
    if (met.balance().converged()) return met.keep(field.tools, to);
  }
  MetTools(field, pairs, grounded, from).keep(field.tools, to);
}

}  // namespace

Poses bring_tools(Field& field, const Poses& commands, const std::vector<InstrumentState>& last) {
  Poses to;
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    tool.closes = !tool.waits && commands[i].jaw < tool.command.jaw - turn_slack;
    tool.command = tool.waits ? tool.pose : commands[i];
    tool.meeting = {};
    tool.ground = {};
    to.push_back(tool.waits ? tool.pose : within_strength(tool, last[i], commands[i]));
  }
  const std::vector<Pair> pairs = near_pairs(field, to);
  const std::vector<Grounded> grounded = near_ground(field, to);
  if (!pairs.empty() || !grounded.empty()) bring_met_tools(field, pairs, grounded, to);
  return to;
}

namespace {

void feel_roll_stiffness(Tool& tool, const InstrumentState& before, const InstrumentState& now) {
  if (std::abs(now.roll_torque) < 0.5 * roll_strength(tool)) {
    tool.roll_stiffness = 0;
    return;
  }
  const double back = before.pose.roll - now.pose.roll, more = now.roll_torque - before.roll_torque;
  if (std::abs(back) >= shortest_turn) tool.roll_stiffness = std::max(least_roll_stiffness, more / back);
}

void feel_stiffness(Tool& tool, const InstrumentState& before, const InstrumentState& now) {
  feel_roll_stiffness(tool, before, now);
  const double force = now.at_tip.norm();
  // No single step makes twice as much of a force that the hand has to give way to.
  if (force < 0.5 * tool.definition.hand_force) {
    tool.tissue_stiffness = tool.stiffness_across = 0;
    return;
  }
  const Vec3 away = now.at_tip / force;
  const Vec3 back = before.tip - now.tip, more = now.at_tip - before.at_tip;
  const double into = back.dot(away);
  if (const Vec3 across = back - into * away; across.norm() >= shortest_way)
    tool.stiffness_across = std::max(0.0, more.dot(across) / across.squaredNorm());
  if (std::abs(into) < shortest_way) return;
  tool.tissue_stiffness = std::max(least_stiffness, more.dot(away) / into);
}

/// N at the hand, of the port's seal on a shaft that was pushed in by `way` (m; negative: drawn out) in `duration` s:
/// against the way, the whole friction from 5 mm/s on, and in proportion below.
Vec3 port_drag(const Tool& tool, double way, double duration) {
  constexpr double full_speed = 5e-3;  // m/s
  const double share = std::clamp(way / duration / full_speed, -1.0, 1.0);
  // The hinge frame's z points along the shaft, inwards.
  return -share * tool.definition.port_friction *
         hinge_frame(tool.trocar, tool.pose, tool.geometry).linear().col(2);
}

}  // namespace

void feel_ports(std::vector<Tool>& tools, const std::vector<InstrumentState>& before, double duration) {
  for (std::size_t i = 0; i < tools.size(); ++i) {
    Tool& tool = tools[i];
    const bool slid = i < before.size() && !tool.waits && !before[i].waits;
    tool.drag =
        slid ? port_drag(tool, tool.pose.insertion - before[i].pose.insertion, duration) : Vec3(Vec3::Zero());
  }
}

void feel_stiffness(std::vector<Tool>& tools, const std::vector<InstrumentState>& before,
                    const std::vector<InstrumentState>& now) {
  for (std::size_t i = 0; i < before.size(); ++i) feel_stiffness(tools[i], before[i], now[i]);
}

std::string tool_met(const Field& field, ToolIndex instrument) {
  const Tool& tool = field.tool(instrument);
  for (const Tool& other : field.tools) {
    if (&other == &tool || other.waits) continue;
    if (gap_between(tool, other, field.barrier.range) < field.barrier.range) return other.definition.name;
  }
  return {};
}

namespace {

/// The ground that a tool is in; empty: none.
std::string ground_around(const Field& field, const Tool& tool) {
  for (const Ground& ground : field.ground)
    if (GroundMeeting(tool, 0, {ground.shape}).gap(tool_coordinates(tool.pose), 0) < 0) return ground.name;
  return {};
}

}  // namespace

Result<bool> check_apart(const Field& field) {
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    const Tool& tool = field.tools[i];
    if (tool.waits) continue;
    const std::string& name = tool.definition.name;
    if (const std::string in = ground_around(field, tool); !in.empty())
      return fail(FailureKind::scenario,
                  fmt::format("instrument '{}' that waits in its trocar, 30 mm deep, is in the ground '{}'",
                              name, in),
                  "put the port or the ground elsewhere",
                  {"", 0, fmt::format("scene.instruments.{}.port", name)});
    const std::string met = tool_met(field, ToolIndex(i));
    if (met.empty()) continue;
    return fail(
        FailureKind::scenario,
        fmt::format("instrument '{}' meets '{}' where both wait in their trocars, 30 mm deep", name, met),
        "put their ports further apart, or have both name one port and one of them wait outside",
        {"", 0, fmt::format("scene.instruments.{}.port", name)});
  }
  return true;
}

}  // namespace calot

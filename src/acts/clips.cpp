#include "acts/clips.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "acts/ground_injury.h"
#include "acts/injury.h"
#include "body/rod_body.h"
#include "field/between_jaws.h"
#include "field/change_bodies.h"
#include "field/divide_body.h"
#include "field/grip.h"
#include "liquid/drops.h"

namespace calot {
namespace {

/// Share of a flat tube's width that is not between the legs.
double left_open(const Tool& tool, const TubeBetween& tube, const RodBody& rod, double leg) {
  const double slant = std::max(0.2, std::abs(tube.along.y()) / std::hypot(tube.along.y(), tube.along.z()));
  const double half = 0.5 * rod.flat_width(tube.at) / slant;
  const double tip = tool.geometry.jaw_length * std::cos(0.5 * tool.pose.jaw), crown = tip - leg;
  const double held = std::min(tube.place.z() + half, tip) - std::max(tube.place.z() - half, crown);
  return open_share(1 - std::clamp(held / (2 * half), 0.0, 1.0));
}

/// m along a tube from one of its skin points to the next, in the mean.
double spacing(const RodBody& rod) { return rod.length() / rod.last_point(); }

/// Holds a tube flat where its clips are now, once they have moved or gone, and nowhere else.
void keep_to_clips(Field& field, OrganIndex index) {
  Organ& organ = field.organ(index);
  std::vector<RodBody::Pinch> pinches;
  for (const Clip& clip : organ.clips) pinches.push_back({clip.at, clip.opening, clip.pressed});
  organ.body = std::make_shared<const RodBody>(organ.body->as_tube()->pinched(pinches));
  finish_change(field);
}

}  // namespace

void set_clip(Field& field, OrganIndex index, const Clip& clip) {
  std::vector<Clip>& clips = field.organ(index).clips;
  const auto behind =
      std::find_if(clips.begin(), clips.end(), [&](const Clip& other) { return other.at > clip.at; });
  clips.insert(behind, clip);
  keep_to_clips(field, index);
}

Result<bool> free_of_clips(const Organ& organ, double share, double width, const std::string& done) {
  const RodBody* rod = organ.body->as_tube();
  if (rod == nullptr) return true;
  for (const Clip& clip : organ.clips) {
    const double apart = std::abs(clip.at - rod->at_share(share)) * spacing(*rod);
    const double least = 0.5 * (width + clip_row(clip.size).wire);
    if (apart < least)
      return fail(FailureKind::scenario,
                  fmt::format("'{}' cannot be {} at {:g} of its length: a clip lies there",
                              organ.definition.name, done, share),
                  fmt::format("stay {:.1f} mm away from its middle, {:.2f} of the length", 1e3 * least,
                              least / rod->length()));
  }
  return true;
}

Result<bool> clip_body(Field& field, OrganIndex index, double share, ClipSize size) {
  const Organ& organ = field.organ(index);
  const RodBody* rod = organ.body->as_tube();
  if (rod == nullptr) return no_tube(organ.definition, "clip", "clipped");
  if (!(share >= 0 && share <= 1))
    return fail(FailureKind::scenario,
                fmt::format("'{}' cannot be clipped at {:g} of its length", organ.definition.name, share),
                "give a share of it from its start, 0, to its end, 1");
  if (Result<bool> clear = free_of_clips(organ, share, clip_row(size).wire, "clipped"); !clear) return clear;
  const double at = rod->at_share(share);
  // As far past the tube as legs reach that a careful hand sets.
  constexpr double past = 1e-3;
  const double reach = std::min(0.5 * rod->flat_width(at) + past, clip_row(size).leg);
  set_clip(field, index, {size, at, 0, Vec3::UnitZ(), Vec3::UnitY(), reach});
  return true;
}

namespace {

void fire(Field& field, ToolIndex instrument, std::vector<WorldEvent>& events) {
  Tool& tool = field.tool(instrument);
  if (tool.clips == 0) return;
  --tool.clips;
  const ClipRow& row = clip_row(tool.definition.clip);
  const Mat3 hinge = hinge_frame(tool.trocar, tool.pose, tool.geometry).linear();
  const double tip = tool.geometry.jaw_length * std::cos(0.5 * tool.pose.jaw);
  bool holds = false;
  for (const TubeBetween& tube : tubes_between(field, instrument)) {
    const Organ& organ = field.organ(tube.organ);
    const RodBody& rod = *organ.body->as_tube();
    // Where a clip lies its legs find metal.
    if (!free_of_clips(organ, rod.share_at(tube.at), row.wire, "clipped")) continue;
    const double open = left_open(tool, tube, rod, row.leg);
    const Mat3 to_tube = rod.frame_at(tube.at, organ.state.x).transpose() * hinge;
    Clip clip{row.size, tube.at, open, to_tube.col(2), to_tube.col(0), tip - tube.place.z()};
    const Vec3 at = rod.place_at(tube.at, organ.state.x);
    const std::string name = organ.definition.name;
    const InjuryDefinition& injury = organ.definition.injury;
    const std::string called = clip.shut() ? injury_at(field, organ, injury.closed, tube.at) : injury.partly;
    set_clip(field, tube.organ, clip);
    events.push_back({EventKind::clip, 0, tool.definition.name, name, open, at});
    if (!called.empty())
      events.push_back({EventKind::injury, 0, tool.definition.name, name, 0, at, EventCause::clip, called});
    holds = true;
  }
  if (holds) return;
  hurt_by_clip(field, instrument, events);
  const Vec3 middle =
      hinge_frame(tool.trocar, tool.pose, tool.geometry).translation() + (tip - 0.5 * row.leg) * hinge.col(2);
  drop_clip(field, row.size, middle, hinge.col(2));
  events.push_back({EventKind::clip_dropped, 0, tool.definition.name, {}, 0});
}

/// Whether a tube ends openly at a skin point: where it does not, it goes on or is tied.
bool is_open_at(const Organ& organ, double end) {
  return std::any_of(organ.openings.begin(), organ.openings.end(),
                     [&](const Opening& opening) { return opening.point == static_cast<int>(end); });
}

/// How near to each other two clips may come, middle to middle, in skin points.
double least_apart(const Organ& organ, const Clip& one, const Clip& other) {
  return 0.5 * (clip_row(one.size).wire + clip_row(other.size).wire) / spacing(*organ.body->as_tube());
}

/// The clip of a tube that is next to one on the side of `towards`, in skin points; -1: there is none.
int next_clip(const Organ& organ, int clip, double towards) {
  const int next = clip + (towards > 0 ? 1 : -1);
  const bool there = next >= 0 && next < static_cast<int>(organ.clips.size());
  return there && organ.body->as_tube()->has(organ.clips[next].at) ? next : -1;
}

/// Moves a clip along its tube by so many skin points, and before it those in its way, as far as there is room: what a
/// tube goes on as behind an end that is not open, or is tied to, stops the first. Clips that were set nearer to each
/// other than they are thick stay as near.
void move_clip(Organ& organ, int index, double by) {
  Clip& clip = organ.clips[index];
  const double side = by > 0 ? 1 : -1;
  if (const int next = next_clip(organ, index, by); next >= 0) {
    const Clip& other = organ.clips[next];
    const double apart = side * (other.at - clip.at),
                 least = std::min(apart, least_apart(organ, clip, other));
    const double pushed = side * by - (apart - least);
    if (pushed > 0) move_clip(organ, next, side * pushed);
    if (organ.body->as_tube()->has(other.at)) {
      clip.at = side * std::min(side * (clip.at + by), side * other.at - least);
      return;
    }
  }
  clip.at += by;
  constexpr double stop = 0.5;
  const double last = organ.body->as_tube()->last_point();
  if (!is_open_at(organ, 0)) clip.at = std::max(clip.at, stop);
  if (!is_open_at(organ, last)) clip.at = std::min(clip.at, last - stop);
}

/// A clip between a tool's pads, and by how many skin points it moves as its tube slides along them.
struct Drawn {
  int clip = 0;
  double by = 0;
};

/// Of those between a tool's pads, as a tube slides along by `way`, m. The foremost come first.
std::vector<Drawn> drawn_by(const Field& field, ToolIndex instrument, const Organ& organ, const Vec3& way) {
  const RodBody& rod = *organ.body->as_tube();
  std::vector<Drawn> out;
  for (const ClipBetween& between : clips_between(field, instrument, organ)) {
    const Vec3 along =
        rod.skin_point(between.points[1], organ.state.x) - rod.skin_point(between.points[0], organ.state.x);
    out.push_back({between.clip, -way.dot(along) / along.squaredNorm()});
  }
  std::stable_sort(out.begin(), out.end(), [](const Drawn& a, const Drawn& b) {
    return (a.by > 0) != (b.by > 0) ? a.by > 0 : a.by > 0 ? a.clip > b.clip : a.clip < b.clip;
  });
  return out;
}

/// N, on a tool, of the springs of its grip on an organ.
Vec3 grip_pull(const Field& field, ToolIndex instrument, const Organ& organ) {
  const GripSprings grip = grip_springs(organ, field.tools, present_poses(field));
  Vec3 pull = Vec3::Zero();
  for (std::size_t g = 0; g < organ.grips.size(); ++g)
    if (organ.grips[g].instrument == instrument)
      pull += grip.sample(g, organ.body->skin_point(grip.row[g], organ.state.x)).gradient;
  return pull;
}

/// How many clips of a tube that it grips a tool would have to draw along: those between its pads, and those that touch
/// them before them, on the side to which they are pulled.
int clips_to_draw(const Field& field, ToolIndex instrument, const Organ& organ) {
  constexpr double touching = 1e-3;  // of their thickness: they have been pushed to just there
  std::vector<int> drawn;
  for (const Drawn& one : drawn_by(field, instrument, organ, grip_pull(field, instrument, organ)))
    for (int clip = one.clip; clip >= 0;) {
      drawn.push_back(clip);
      const int next = one.by == 0 ? -1 : next_clip(organ, clip, one.by);
      if (next < 0) break;
      const Clip &of = organ.clips[clip], &before = organ.clips[next];
      if (std::abs(before.at - of.at) > (1 + touching) * least_apart(organ, of, before)) break;
      clip = next;
    }
  std::sort(drawn.begin(), drawn.end());
  return static_cast<int>(std::unique(drawn.begin(), drawn.end()) - drawn.begin());
}

}  // namespace

double hold_of_clips(const Field& field, ToolIndex instrument) {
  int clips = 0;
  for (const Organ& organ : field.organs)
    if (grip_count(organ, instrument) > 0 && !organ.clips.empty())
      clips += clips_to_draw(field, instrument, organ);
  return clips > 0 ? clips * clip_hold : std::numeric_limits<double>::infinity();
}

void draw_clips(Field& field, ToolIndex instrument, const Vec3& way) {
  for (Organ& organ : field.organs)
    if (grip_count(organ, instrument) > 0 && !organ.clips.empty())
      for (const Drawn& one : drawn_by(field, instrument, organ, way)) move_clip(organ, one.clip, one.by);
}

void let_clips_fall(Field& field, ToolIndex instrument, std::vector<WorldEvent>& events) {
  const std::string& name = field.tool(instrument).definition.name;
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    Organ& organ = field.organs[k];
    const RodBody* rod = organ.body->as_tube();
    if (rod == nullptr) continue;
    const auto stays = [](const Clip& clip, const RodBody::Pinch& pinch) { return clip.at == pinch.at; };
    if (std::equal(organ.clips.begin(), organ.clips.end(), rod->pinches().begin(), rod->pinches().end(),
                   stays))
      continue;
    for (const Clip& clip : organ.clips) {
      if (rod->has(clip.at)) continue;
      const double end = clip.at < 0 ? 0 : rod->last_point();
      const Vec3 from = rod->place_at(end, organ.state.x);
      drop_clip(field, clip.size, from, rod->frame_at(end, organ.state.x) * clip.legs);
      events.push_back(
          {EventKind::clip_dropped, 0, name, organ.definition.name, 0, from, EventCause::slipping});
    }
    std::erase_if(organ.clips, [&](const Clip& clip) { return !rod->has(clip.at); });
    std::sort(organ.clips.begin(), organ.clips.end(),
              [](const Clip& a, const Clip& b) { return a.at < b.at; });
    keep_to_clips(field, OrganIndex(k));
  }
}

void fire_clips(Field& field, const std::vector<InstrumentAction>& actions, std::vector<WorldEvent>& events) {
  for (std::size_t i = 0; i < actions.size(); ++i)
    if (actions[i] == InstrumentAction::fire && field.tools[i].action != InstrumentAction::fire)
      fire(field, ToolIndex(i), events);
}

}  // namespace calot

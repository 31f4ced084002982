#include "field/moving_bodies.h"

#include <algorithm>
#include <cmath>

#include "group/pressed_laws.h"

namespace calot {

std::size_t moving_bodies(const Field& field) { return field.organs.size() + field.tissues.size(); }

BodyState& state_of(Field& field, std::size_t k) {
  const std::size_t organs = field.organs.size();
  return k < organs ? field.organs[k].state : field.tissues[k - organs].now.state;
}

const BodyState& state_of(const Field& field, std::size_t k) {
  const std::size_t organs = field.organs.size();
  return k < organs ? field.organs[k].state : field.tissues[k - organs].now.state;
}

const Body& body_of(const Field& field, std::size_t k) {
  const std::size_t organs = field.organs.size();
  if (k < organs) return *field.organs[k].body;
  return *field.tissues[k - organs].body;
}

bool fit(const std::vector<SharpTangent>& tangents, const Field& field) {
  return std::all_of(tangents.begin(), tangents.end(), [&](const SharpTangent& tangent) {
    const auto part = static_cast<std::size_t>(tangent.part);
    return part < moving_bodies(field) && fits(tangent, body_of(field, part));
  });
}

Result<std::vector<MotionPart>> next_parts(const Field& field) {
  std::vector<std::optional<Result<MotionPart>>> parts(field.step_time > 0 ? moving_bodies(field) : 0);
  for_each_chunk(field.workers(), static_cast<int>(parts.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk);
    const Body& body = body_of(field, k);
    parts[k].emplace(motion_part(body, present_motion(body, state_of(field, k)), 0));
  });
  std::vector<MotionPart> out;
  for (std::optional<Result<MotionPart>>& part : parts) {
    if (!*part) return part->failure();
    out.push_back(std::move(*part).value());
  }
  return out;
}

void begin_parts(const std::vector<MotionPart>& parts, double duration, Field& field) {
  constexpr double alike = 0.1;  // another share than this of the time, and the factor is of another matrix
  for (std::size_t k = 0; k < parts.size(); ++k) {
    MotionPart& part = state_of(field, k).motion;
    if (!(std::abs(duration - part.duration) < alike * part.duration)) field.group.work.factored = false;
    part = parts[k];
    part.duration = duration;
  }
}

bool all_stand_still(const Field& field) {
  // What is dragged may be slow and far from rest.
  for (const Organ& organ : field.organs)
    if (organ.state.motion.duration > 0 && !organ.leaving.empty()) return false;
  for (std::size_t k = 0; k < moving_bodies(field); ++k) {
    const MotionPart& motion = state_of(field, k).motion;
    if (motion.duration > 0 && !stands_still(motion.begin)) return false;
  }
  return true;
}

}  // namespace calot

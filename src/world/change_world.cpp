#include <fmt/format.h>

#include "acts/clips.h"
#include "field/change_bodies.h"
#include "field/divide_body.h"
#include "field/field_state.h"
#include "liquid/perforate.h"
#include "motion/settle_field.h"
#include "world/report_states.h"
#include "world/world_impl.h"

namespace calot {

/// Where masses count the next step brings what changed into motion. Else all must come to rest first.
Result<bool> World::Impl::settle_change(const std::string& what) {
  if (field.step_time > 0) return true;
  return settle_field(field, what, report.statistics);
}

template <class Change>
auto World::Impl::change(const std::string& what, const Change& change) -> decltype(change()) {
  if (failed) return failure;
  const FieldState before = field_state(field);
  auto done = change();
  if (!done) return done;
  if (Result<bool> settled = settle_change(what); !settled) {
    calot::restore(field, before);
    return settled.failure();
  }
  // What hands felt was of what has changed.
  for (Tool& tool : field.tools) tool.tissue_stiffness = tool.stiffness_across = tool.roll_stiffness = 0;
  report_states(field, report);
  keep_hash();
  still.reset();
  return done;
}

Result<Division> World::divide(const std::string& name, double share) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  const Result<bool> clear = free_of_clips(impl_->field.organ(organ.value()), share, 0, "divided");
  if (!clear) return clear.failure();
  return impl_->change(fmt::format("after '{}' was divided", name),
                       [&] { return divide_body(impl_->field, organ.value(), share, impl_->time()); });
}

Result<bool> World::clip(const std::string& name, double share, ClipSize size) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  return impl_->change(fmt::format("after '{}' was clipped", name),
                       [&] { return clip_body(impl_->field, organ.value(), share, size); });
}

Result<bool> World::remove(const std::string& name, const std::string& why) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  return impl_->change(fmt::format("after '{}' was removed", name),
                       [&] { return remove_body(impl_->field, organ.value(), why, impl_->time()); });
}

namespace {

/// Paths of what was added begin with what it is.
Failure of_added(Failure failure, const char* what) {
  for (Problem& problem : failure.problems)
    if (problem.place.path.starts_with('.')) problem.place.path.insert(0, what);
  return failure;
}

}  // namespace

Result<OrganIndex> World::add(const OrganDefinition& definition) {
  if (std::vector<Problem> problems = validate(definition); !problems.empty())
    return Failure{FailureKind::scenario, std::move(problems)};
  const auto make = [&](const OrganDefinition& one) { return impl_->make_later(one); };
  Result<OrganIndex> added = impl_->change(fmt::format("after '{}' came", definition.name),
                                           [&] { return add_body(impl_->field, definition, make); });
  return added ? added : of_added(added.failure(), "organ");
}

Result<bool> World::release(const std::string& name, const std::string& held) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  return impl_->change(fmt::format("after '{}' was let go", name),
                       [&] { return release_body(impl_->field, organ.value(), held); });
}

Result<bool> World::add_tissue(const TissueDefinition& definition) {
  std::vector<std::string> organs;
  for (const Organ& organ : impl_->field.organs) organs.push_back(organ.definition.name);
  if (std::vector<Problem> problems = validate(definition, organs); !problems.empty())
    return Failure{FailureKind::scenario, std::move(problems)};
  Result<bool> added = impl_->change(fmt::format("after '{}' came", definition.name),
                                     [&] { return calot::add_tissue(impl_->field, definition); });
  return added ? added : of_added(added.failure(), "tissue");
}

Result<bool> World::remove_tissue(const std::string& name) {
  return impl_->change(fmt::format("after '{}' was removed", name),
                       [&] { return calot::remove_tissue(impl_->field, name, impl_->time()); });
}

Result<double> World::open_tube(const std::string& name, double share, double width) {
  const Result<OrganIndex> organ = this->organ(name);
  if (!organ) return organ.failure();
  const Result<bool> clear = free_of_clips(impl_->field.organ(organ.value()), share, 0, "opened");
  if (!clear) return clear.failure();
  return impl_->change(fmt::format("after '{}' was opened", name),
                       [&] { return calot::open_tube(impl_->field.organ(organ.value()), share, width); });
}

Result<bool> World::tie(const JointDefinition& joint) {
  for (const std::string& name : {joint.from, joint.to})
    if (Result<Vec3> there = place(name); !there) return there.failure();
  if (joint.from.substr(0, joint.from.rfind('.')) == joint.to.substr(0, joint.to.rfind('.')))
    return fail(FailureKind::scenario, "an organ is tied to itself", "name a place on another organ");
  return impl_->change(fmt::format("after '{}' was tied to '{}'", joint.from, joint.to),
                       [&] { return tie_bodies(impl_->field, joint); });
}

Result<bool> World::untie(const std::string& one, const std::string& other) {
  const Result<OrganIndex> first = organ(one), second = organ(other);
  if (!first) return first.failure();
  if (!second) return second.failure();
  return impl_->change(fmt::format("after '{}' and '{}' were untied", one, other),
                       [&] { return untie_bodies(impl_->field, first.value(), second.value()); });
}

}  // namespace calot

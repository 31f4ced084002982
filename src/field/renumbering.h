#pragma once
// What is left of what names two bodies where some go and others stand elsewhere in the field.

#include <array>
#include <vector>

#include "field/field.h"

namespace calot {

/// Leaves out, or gives new numbers to, the bodies of what names two.
class Renumbering {
 public:
  /// One a body; -1: it is gone.
  explicit Renumbering(std::vector<int> now) : now_(std::move(now)) {}
  /// False where one of them is gone.
  bool apply(std::array<int, 2>& bodies) const {
    for (int& body : bodies) body = now_[body];
    return std::min(bodies[0], bodies[1]) >= 0;
  }
  void apply(Field& field) const {
    std::vector<FieldJoint> joints;
    for (const FieldJoint& joint : field.membership.joints) {
      JointLinks links = joint.joint->links();
      if (apply(links.bodies)) joints.push_back({std::make_shared<const Joint>(std::move(links))});
    }
    field.membership.joints = std::move(joints);
    std::vector<TiedPlace> tied;
    for (TiedPlace place : field.membership.tied)
      if (apply(place.bodies)) tied.push_back(place);
    field.membership.tied = std::move(tied);
    std::vector<Tissue> tissues;
    for (const Tissue& tissue : field.tissues) {
      std::array<int, 2> bodies = tissue.strands->bodies();
      if (apply(bodies)) tissues.push_back(tissue.between(bodies));
    }
    field.tissues = std::move(tissues);
    if (!field.viewed) return;
    const int viewed = now_[field.viewed->organ.value];
    field.viewed->organ = OrganIndex(viewed);
    if (viewed < 0) field.viewed.reset();
  }

 private:
  std::vector<int> now_;
};

}  // namespace calot

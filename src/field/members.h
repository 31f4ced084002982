#pragma once
// Who is in a field, and who was. Bodies join it, leave it and are divided while it runs (change_bodies.h); between two
// such changes nothing here changes, so that all states of that time share one copy.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "body/body_handle.h"
#include "joins/joint.h"
#include "joins/skin_join.h"
#include "organs/organ.h"
#include "organs/tissue.h"

namespace calot {

struct SkinPlace {
  Vec3 at = Vec3::Zero();      ///< m
  Vec3 normal = Vec3::Zero();  ///< unit, outward
};
void visit_members(auto&& visit, MembersOf<SkinPlace> auto& place) {
  auto& [at, normal] = place;
  visit(at, normal);
}

/// When and why a body went.
struct Departure {
  double time = 0;                       ///< s
  std::string how;                       ///< "was divided", "was removed: taken out"
  std::vector<std::string> pieces = {};  ///< the patient's and the specimen's, of one that was divided
  std::map<std::string, SkinPlace> landmarks = {};  ///< where they were last
};
void visit_members(auto&& visit, MembersOf<Departure> auto& departure) {
  auto& [time, how, pieces, landmarks] = departure;
  visit(time, how, pieces, landmarks);
}

/// A body that is or was in the field, or a tissue that was taken out of it.
struct BodyRecord {
  std::string name;
  std::uint64_t life = 0;
  std::optional<Departure> gone;
};
void visit_members(auto&& visit, MembersOf<BodyRecord> auto& record) {
  auto& [name, life, gone] = record;  // lives are of one world in one process
  visit(name, gone);
}

/// Nothing of two bodies presses on each other there.
struct TiedPlace {
  std::array<int, 2> bodies{};  ///< increasing
  JoinedPlace place;
};
void visit_members(auto&& visit, MembersOf<TiedPlace> auto& tied) {
  auto& [bodies, place] = tied;
  visit(bodies, place);
}

struct FieldJoint {
  std::shared_ptr<const Joint> joint;
};

/// Beside the bodies themselves.
struct Membership {
  std::vector<FieldJoint> joints;
  std::vector<TiedPlace> tied;
  std::vector<BodyRecord> roll;  ///< in the order in which they came; the scene's first
};

/// All of it at one time.
struct FieldMembers {
  std::vector<Organ> organs;    ///< as they were when it began
  std::vector<Tissue> tissues;  ///< likewise
  std::vector<JoinPointer> joins;
  std::optional<OrganPoint> viewed;
  Membership membership;
  std::shared_ptr<const int> world;  ///< whose it is
  std::uint64_t hash = 0;            ///< of who they are (members_note.h)
};

}  // namespace calot

#pragma once
// The tissues of a field as members of its group: behind organs.

#include "sim/field.h"

namespace calot {

/// The nodes of all tissues as members of a group, in the part of a motion that they are in.
class TissueMembers {
 public:
  explicit TissueMembers(Field& field);
  /// Adds them behind organs.
  void add_to(std::vector<Member>& members);

 private:
  Field& field_;
  std::vector<ContactLoads> loads_;
};

/// Adds the strands of all tissues, with their past and in the part of a motion that they are in; `first`: the place of
/// the first tissue's nodes in the group.
void add_strands(const Field& field, int first, std::vector<JoinPointer>& joins);

/// Strands that are stretched further than ever, beyond their strength, are so from now on. To be called between solves.
void grow_damage(Field& field);

/// A tissue of the scene's anatomy, from where its organs are. Failures have paths of the scene.
Result<bool> add_tissues(const AnatomyDefinition& anatomy, const Vec3& up, Field& field);

}  // namespace calot

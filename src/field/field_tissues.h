#pragma once
// The tissues of a field as members of its group: behind organs.

#include "field/field.h"

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

/// Adds the strands of all tissues, with their past and in the part of a motion that they are in, and what they touch when
/// the tools stand at `poses`.
void add_strands(const Field& field, const std::vector<InstrumentPose>& poses,
                 std::vector<JoinPointer>& joins);

/// Tells the strands where their bodies are. Returns where all nodes of the group are, m.
VecX place_strands(const Field& field);
/// The same, and what they touch when the tools stand where they do: for who asks them outside of a solve.
VecX place_strands_and_tools(const Field& field);

/// Strands that are stretched further than ever, beyond their strength, are so from now on. To be called between solves.
void grow_damage(Field& field);

/// A tissue of the scene's anatomy, from where its organs are. Failures have paths of the scene.
Result<bool> add_tissues(const AnatomyDefinition& anatomy, const Vec3& up, Field& field);

}  // namespace calot

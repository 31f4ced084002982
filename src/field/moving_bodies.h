#pragma once
// What moves of a field, as one list of bodies: its organs, then the nodes of its tissues.

#include "body/inertia.h"
#include "field/field.h"

namespace calot {

std::size_t moving_bodies(const Field& field);
BodyState& state_of(Field& field, std::size_t body);
const BodyState& state_of(const Field& field, std::size_t body);
const Body& body_of(const Field& field, std::size_t body);

/// Whether these are all of places that its bodies have.
bool fit(const std::vector<SharpTangent>& tangents, const Field& field);

/// The next part of each body's motion, from where it is as it moves there; none where the field is static. Fails
/// (simulation) where its liquid's motion cannot be found.
Result<std::vector<MotionPart>> next_parts(const Field& field);
/// Has bodies begin these, which take `duration`, s.
void begin_parts(const std::vector<MotionPart>& parts, double duration, Field& field);

/// Whether none begins its part with a velocity.
bool all_stand_still(const Field& field);

/// What of dx is a body's: organs, then tissues.
class BodyParts {
 public:
  explicit BodyParts(const Field& field) {
    for (std::size_t k = 0; k < moving_bodies(field); ++k) {
      first_.push_back(total_);
      sizes_.push_back(state_of(field, k).x.size());
      total_ += sizes_.back();
    }
  }
  Eigen::Index total() const { return total_; }
  auto of(std::size_t body, VecX& dx) const { return dx.segment(first_[body], sizes_[body]); }
  auto of(std::size_t body, const VecX& dx) const { return dx.segment(first_[body], sizes_[body]); }
  /// Where all nodes are, m.
  VecX present(const Field& field) const {
    VecX out(total_);
    for (std::size_t k = 0; k < sizes_.size(); ++k) of(k, out) = state_of(field, k).x;
    return out;
  }

 private:
  std::vector<Eigen::Index> first_, sizes_;
  Eigen::Index total_ = 0;
};

}  // namespace calot

#include "field/field_hash.h"

#include "base/hash.h"
#include "field/moving_state.h"

namespace calot {

std::uint64_t hash_of(const Field& field) {
  WordHash hash;
  MemberWriter put{hash};
  put(field.members->hash, details_of(field));
  visit_moving(put, field);
  return hash.value();
}

std::vector<std::vector<int>> details_of(const Field& field) {
  std::vector<std::vector<int>> out;
  for (const Organ& organ : field.organs) out.push_back(organ.body->details());
  return out;
}

}  // namespace calot

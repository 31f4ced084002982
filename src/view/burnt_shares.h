#pragma once
// What an organ's surface shows of what was done on it: marks of current, and the bed of a loose plane.

#include <vector>

#include "field/field.h"

namespace calot {

/// How far it is burnt at each of its drawn points, 0 to 1 (SceneMesh::burnt), or at each of `points` (null: all); none
/// where nothing is. Where an areolar tissue hangs on an organ that is no tube, it is a little whitish, and charred where the
/// tissue was divided.
std::vector<double> burnt_shares(const Field& field, OrganIndex organ, const std::vector<int>* points);

}  // namespace calot

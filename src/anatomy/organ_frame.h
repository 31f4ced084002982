#pragma once
// The frame in which an organ is made, and in which its texture and what lies around it are laid out.

#include "anatomy/definitions.h"

namespace calot {

/// Origin at the neck, +z towards the fundus, +x towards the liver (made orthogonal), +y completes it.
Pose organ_frame(const OrganDefinition& organ);

/// Half the organ's width and its length (m), for what is laid around it; a mesh file counts as the default
/// pear.
struct OrganExtent {
  double radius, length;
};
OrganExtent organ_extent(const OrganDefinition& organ);

}  // namespace calot

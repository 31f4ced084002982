#pragma once
// What lies around the gallbladder, so that no picture shows a void: shapes laid out from the organ's
// definition (d), for looks only; nothing here is simulated.

#include <vector>

#include "anatomy/definitions.h"
#include "render/scene.h"

namespace calot {

/// The liver: its visceral surface holds the gallbladder a little embedded, its round margin leaves the
/// fundus free, and its front rises behind the margin.
SceneMesh liver_mesh(const OrganDefinition& organ);

/// Omentum and bowel below and behind the gallbladder, and the wall of the abdomen around all.
std::vector<SceneMesh> abdomen_meshes(const OrganDefinition& organ);

/// A supporting plane as a moist drape of tissue, and a dark wall far around it.
std::vector<SceneMesh> support_meshes(const SupportDefinition& support, const Vec3& about);

}  // namespace calot

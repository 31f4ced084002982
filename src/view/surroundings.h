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

/// A plane that carries organs around the foot of a place on it: a moist drape of tissue, or a flat board.
SceneMesh plane_mesh(const Vec3& point, const Vec3& normal, const Vec3& about, Material material);
/// A capsule as bowel, between whose folds it is up to a tenth of its radius thinner than what is touched.
SceneMesh bowel_mesh(const GroundDefinition& capsule);
/// What stays and is touched: planes as drapes, the rest as it is, of a material.
SceneMesh ground_mesh(const GroundDefinition& ground, const Vec3& about, Material material);
/// A wall far around a place.
SceneMesh cavity_wall(const Vec3& centre, Material material);

}  // namespace calot

#pragma once
// Small builders of drawn surfaces.

#include <functional>

#include "render/scene.h"

namespace calot {

/// The surface place(u, v) over [0, 1] squared as columns x rows quads, each two triangles; normals point
/// along d/du x d/dv. Rest positions are the places themselves.
SceneMesh sheet(Material material, int columns, int rows,
                const std::function<Vec3(double u, double v)>& place);

/// Unit, one a point: of the triangles around it, by their areas.
std::vector<Vec3> mean_normals(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles);

/// For closed surfaces: turns the triangles outward where they face inward. Normals from the triangles,
/// averaged over triangles that meet at less than `crease` (rad); points are split where they do not. Rest
/// positions move along.
void give_creased_normals(SceneMesh& mesh, double crease);

/// The mesh moved by `motion`; rest positions stay.
void move(SceneMesh& mesh, const Pose& motion);

/// `more` appended to `mesh` (same material).
void append(SceneMesh& mesh, const SceneMesh& more);

}  // namespace calot

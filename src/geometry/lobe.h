#pragma once
// A lobe of the liver as a bent box: thick at its back, thin at its edge, with a bed in its underside for a
// gallbladder that lies along +z from the origin.

#include "geometry/box_surface.h"
#include "geometry/shapes.h"

namespace calot {

/// Lengths in m. x goes through the lobe from its underside up, y across, z from its back to its edge.
struct LobeForm {
  double width = 140e-3, depth = 90e-3;   ///< across; from its back to the middle of its edge
  double thickness = 45e-3, edge = 9e-3;  ///< at the back, about; at the edge
  double edge_angle = 0.7;                ///< rad, between underside and upper side at the edge
  double edge_at = 64e-3;                 ///< z of the middle of its edge
  double underside = 11e-3;               ///< x of its underside
  double bed_width = 35e-3;  ///< of what lies in it, which is round about the z axis; 0: nothing does
  std::function<double(double z)> bed_radius = {};  ///< of that
};

/// Where the box' corners of cells are, `at` in [0, 1]^3: across, from the back to the edge, from the underside up.
Vec3 lobe_place(const LobeForm& form, const Vec3& at);

/// The cells and the shares of the way, in [0, 1], at which they are parted: narrow beside the bed and at the edge.
struct LobeCells {
  BoxSurface surface;
  std::vector<double> across, along;
};
LobeCells lobe_cells(const LobeForm& form);

/// The corners of the cells, on the lobe, by their numbers on the surface.
TriMesh lobe_mesh(const LobeForm& form, const LobeCells& cells);

/// Radius of a closed profile at heights, 0 beyond its ends.
std::function<double(double z)> radius_by_height(const Profile& profile);

}  // namespace calot

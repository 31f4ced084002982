#pragma once
// Drops and clips that fall: freely from where they are let go until they meet the skin of an organ or the ground (tubes
// let them pass: they would run off those). There a drop becomes film (films.h), and a clip stays.

#include <optional>
#include <vector>

#include "field/field.h"

namespace calot {

/// The skins that a drop may fall on, as they stand now: those of all organs but tubes. The field's organs must outlive it.
class FallenOn {
 public:
  explicit FallenOn(const Field& field);
  struct Met {
    OrganIndex organ;
    int point = 0;
  };
  /// Organ and nearest skin point that are met first from outside on the way between two places, m; none: no skin is.
  std::optional<Met> meets(const Vec3& from, const Vec3& to) const;

 private:
  struct Skin {
    OrganIndex organ;
    std::vector<Vec3> at;
    const std::vector<Triangle>* triangles;
    std::size_t each;
    std::vector<Eigen::AlignedBox3d> patches = {};  ///< around `each` triangles that follow each other
  };
  std::vector<Skin> skins_;
};

/// Moves a drop on by `part` s. Returns whether it is gone: into the film where it met something, or out of sight.
bool fall(Field& field, const FallenOn& skins, Drop& drop, double part);

/// Where an opening is, m, and which way out (unit): a tube's end along it, a hole from the middle of its wall upwards.
struct Mouth {
  Vec3 at, out;
};
Mouth mouth_of(const Organ& organ, const Opening& opening);

/// Makes drops of what hangs on openings and is heavy enough or was let out fast, each with the way that it has made
/// since, in a step of `duration` s. `skins` is made where there is a drop.
void let_fall(Field& field, double duration, std::optional<FallenOn>& skins);

/// Lets a clip fall from there straight down onto what a drop would meet; what meets nothing is not seen again. It falls
/// in no time: 50 mm take a tenth of a second. `legs`: m, along its legs.
void drop_clip(Field& field, ClipSize size, const Vec3& from, const Vec3& legs);

}  // namespace calot

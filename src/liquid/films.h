#pragma once
// Films of liquid on skins and on the ground, which run down and gather in the lowest places (spill.h has the law).

#include <array>
#include <utility>
#include <vector>

#include "field/field.h"

namespace calot {

/// A place where liquid can lie: a point of the wet mesh of a surface.
struct Landing {
  int on = 0;  ///< the organ's place on the roll; -1 - k: ground k
  int point = 0;
};

/// Adds a drop to the film on what it landed on, spread over as many points as it covers.
void spread_drop(Spill& spill, const Drop& drop, const Landing& landing);

/// Where a drop meets the skin of an organ at a point, or ground (numbered in the field) next to a place, m. The meshes
/// that films are on are made when they are first met.
Landing land_on_skin(Field& field, const Organ& organ, int point);
Landing land_on_ground(Field& field, int ground, const Vec3& place);

/// What lies on organs that are gone is out of sight.
void forget_films_of_gone(Field& field);

/// Whether a film lies as it did when nothing of it moved: then `part` s more move nothing, and are not worth a look.
bool lies_still(const Field& field, const Film& film, double part);
/// What a film lies on at present, of which a part of `part` s moved nothing.
FilmRest rest_of(const Field& field, const Film& film, double part);

/// The film on one surface that moves; what it knows of each point is of the present part of a step.
class FilmFlow {
 public:
  FilmFlow(WetSurface surface, const Vec3& up);
  /// Moves it on by `part` s; what drips or drops off becomes drops. Returns whether anything moved.
  bool run(Film& film, double part, std::vector<Drop>& drops);

 private:
  /// Of its surface, m; of an underside the skin's, so that what hangs draws no more to it.
  double height(int point) const;
  double loose(const WetPoint& wet) const;
  /// A sheet's flow to each neighbour that stands lower, until both stand alike. Returns whether there is any.
  bool flow_from(const WetPoint& wet, double part);
  void move(Film& film);
  /// A share of what is there leaves it, into what has left around it.
  static void take(WetPoint& wet, double share, std::array<double, liquids>& taken);
  void make_drops(const WetPoint& below, const std::array<double, liquids>& taken,
                  std::vector<Drop>& drops) const;
  /// Of an underside, where a film is too thick to hang. Returns whether it drips.
  bool drip(WetPoint& wet, std::vector<Drop>& drops) const;
  /// What hangs at a lowest place of an underside. Returns whether it drops.
  bool drop_off(Film& film, WetPoint& wet, std::vector<Drop>& drops) const;

  WetSurface surface_;
  const Vec3& up_;
  std::vector<double> thickness_;  ///< m, total; 0: dry
  std::vector<std::array<double, liquids>> moved_;
  std::vector<char> touched_;
  std::vector<int> fresh_;  ///< dry until now
  std::vector<std::pair<int, double>> flows_;
};

/// The surface of a film that is `on` there; its mesh is null where the organ is gone.
WetSurface wet_surface(const Field& field, int on);

}  // namespace calot

#pragma once
// The shape of the jaws on what they hold (the paper, section 5.3): where pads grip a fold, the skin that is DRAWN is
// moved onto their surface, and out into the window of a fenestrated jaw, by a free-form deformation in the frame of
// the jaws. It changes pictures only: no force, no contact and no state hash knows of it, and it moves skin by less
// than the pads' reach (plus the bulge in a window). The pads' teeth, 1 mm apart, are finer than the skin's points
// and leave no mark.

#include <optional>
#include <vector>

#include "field/field.h"
#include "skin/free_form.h"
#include "world/world.h"

namespace calot {

/// Height of the wall that a pad moulds, m: the x in the jaw's frame (tools/instrument.h) of the skin before the place
/// (y, z) of its pad. Just clear of a solid pad; in a window up to window_bulge beyond it.
double moulded_height(const InstrumentGeometry& geometry, double y, double z);

inline constexpr double pad_clearance =
    0.03e-3;  ///< m, drawn between pad and wall so that neither shows through
inline constexpr double window_bulge = 0.3e-3;  ///< m (d)
inline constexpr double mould_ease = 0.2;       ///< s in which a mould comes and goes

/// Instruments as they are made (jaws with their windows) and the ground: what is drawn must keep out of them.
class Solids {
 public:
  explicit Solids(const Field& field);
  /// From x to the nearest, m, negative inside; in a window at most the true distance.
  double distance(const Vec3& x) const;
  /// The place nearest to x (nearly, for deep ones) from which they are at least `least` away; none found: none.
  std::optional<Vec3> pushed_out(Vec3 x, double least) const;

 private:
  struct Part {
    Shape shape;
    std::optional<JawWindow> window;
    Pose to_jaw;
  };
  std::vector<Part> parts_;
};

struct DrawnSkin {
  std::vector<Vec3> positions, normals;  ///< m; unit, outward
};

/// The mould of one tool. Each held point has its way to go; after the tool has let go it keeps a share of it that
/// fades, and the lattice stays where the jaws were. A tool that takes hold again within mould_ease jumps to the new fold's.
class JawMould {
 public:
  /// Looks at the tool after a step of dt, s.
  void follow(const Field& field, ToolIndex instrument, double dt);
  bool active() const { return weight_ > 0; }

  /// Moves an organ's drawn skin, or of it these points (null: all), and its normals where there are some. A point that would
  /// come nearer to a solid than the pad's clearance, or than it already is, slides along it.
  void apply(const Field& field, ToolIndex instrument, OrganIndex organ, const std::vector<int>* points,
             DrawnSkin& skin) const;

 private:
  struct Held {
    int record = 0, skin_point = 0;  ///< the organ's
    Vec3 way = Vec3::Zero();         ///< m, patient's frame: from where it is held to where the mould has it
  };
  bool holds(const Organ& organ) const;
  /// The lattice that takes what is held of an organ to where its mould has it, and leaves the skin around as it is.
  std::optional<FreeForm> fitted(const InstrumentGeometry& geometry, const Organ& organ,
                                 const std::vector<int>* points, const std::vector<Vec3>& positions) const;
  std::vector<Held> held_;
  Pose hinge_ = Pose::Identity();  ///< of the tool while it held
  double jaw_ = 0;                 ///< rad, then
  double weight_ = 0;              ///< 0 to 1, linear in time
};

/// The moulds of a world's tools.
class JawMoulds {
 public:
  explicit JawMoulds(const World& world);
  /// To be told of every step, drawn or not: moulds come and go in time. Twice after one step is once.
  void follow(const World& world);
  /// An organ's skin as it is drawn. Some milliseconds a holding tool.
  DrawnSkin skin(const World& world, OrganIndex organ) const;
  /// The same of some of its points alone, whose triangles are these: a quarter of the time for a quarter of the points. For
  /// organs whose skin is what is drawn.
  DrawnSkin skin(const World& world, OrganIndex organ, const std::vector<int>& points,
                 const std::vector<Triangle>& triangles) const;

 private:
  std::vector<JawMould> moulds_;  ///< one a tool
  double time_;                   ///< s, of the last step that was followed
};

}  // namespace calot

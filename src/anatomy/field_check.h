#pragma once
// Collects what is wrong with a definition's fields, each with its path, its value in SI and a hint that
// tries the units an author may have left out.

#include <string>
#include <vector>

#include "base/status.h"
#include "geometry/types.h"

namespace calot {

/// A Lua multiplier, calot.units.<name>.
struct UnitName {
  std::string name;
  double factor = 1;
};

/// What a number measures: its SI unit ("" for none) and the multipliers to suggest, the first of them for
/// limits.
struct Quantity {
  std::string unit;
  std::vector<UnitName> multipliers;
};

namespace quantity {
extern const Quantity length, angle, pressure, volume, density, force, foundation, rate, time, number;
}

class FieldCheck {
 public:
  void problem(const std::string& path, std::string message, std::string hint);

  /// Finite and in [low, high] (SI). `what` completes "70 m is not ...": "a gallbladder's length". True when
  /// it is.
  bool in_range(const std::string& path, double value, const Quantity& quantity, double low, double high,
                const std::string& what);
  /// Finite and each coordinate within `reach` of the origin (m). True when it is.
  bool place_within(const std::string& path, const Vec3& position, double reach, const std::string& what);
  /// The same of three angles, each of up to `most` (rad).
  bool turn_within(const std::string& path, const Vec3& turn, double most, const std::string& what);
  bool unit_direction(const std::string& path, const Vec3& direction, const std::string& what);
  /// Non-empty, starting with a letter or underscore, then letters, digits and underscores: fit for a.b
  /// paths.
  bool identifier(const std::string& path, const std::string& name, const std::string& what);
  bool known(const std::string& path, const std::string& name, const std::vector<std::string>& names,
             const std::string& what);

  /// Whether nothing was said about this very field.
  bool is_fine(const std::string& path) const;

  std::vector<Problem> take() { return std::move(problems_); }

 private:
  /// Each of three figures within `most` of 0. `hint`: what to give else.
  bool vector_within(const std::string& path, const Vec3& vector, double most, const Quantity& quantity,
                     const std::string& what, std::string hint);

  std::vector<Problem> problems_;
};

}  // namespace calot

#include "anatomy/field_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/suggest.h"
#include "base/units.h"

namespace calot {

namespace quantity {
const Quantity length{"m", {{"mm", units::mm}, {"cm", units::cm}}};
const Quantity angle{"rad", {{"deg", units::deg}}};
const Quantity pressure{"Pa", {{"kPa", units::kPa}, {"mmHg", units::mmHg}, {"MPa", units::MPa}}};
const Quantity volume{"m^3", {{"mL", units::mL}, {"L", units::L}}};
const Quantity density{"kg/m^3", {}};
const Quantity force{"N", {{"N", units::N}, {"mN", units::mN}}};
const Quantity foundation{"N/m^3", {}};
const Quantity rate{"steps a second", {}};
const Quantity time{"s", {{"s", units::s}, {"ms", units::ms}}};
const Quantity number{"", {}};
}  // namespace quantity

namespace {

std::string with_unit(double value, const std::string& unit) {
  return unit.empty() ? fmt::format("{:g}", value) : fmt::format("{:g} {}", value, unit);
}

std::string range_text(const Quantity& quantity, double low, double high) {
  const UnitName shown =
      quantity.multipliers.empty() ? UnitName{quantity.unit, 1} : quantity.multipliers.front();
  return fmt::format("give {:g} to {}", low / shown.factor, with_unit(high / shown.factor, shown.name));
}

std::string text_of(const Vec3& v) { return fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z()); }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

void FieldCheck::problem(const std::string& path, std::string message, std::string hint) {
  problems_.push_back({{"", 0, path}, std::move(message), std::move(hint)});
}

bool FieldCheck::is_fine(const std::string& path) const {
  return std::none_of(problems_.begin(), problems_.end(),
                      [&](const Problem& problem) { return problem.place.path == path; });
}

bool FieldCheck::in_range(const std::string& path, double value, const Quantity& quantity, double low,
                          double high, const std::string& what) {
  if (value >= low && value <= high) return true;
  std::string hint = range_text(quantity, low, high);
  for (const UnitName& unit : quantity.multipliers) {
    const double scaled = value * unit.factor;
    if (!(scaled >= low && scaled <= high)) continue;
    hint = fmt::format("did you mean {:g} * {}? {}", value, unit.name, hint);
    break;
  }
  problem(path, fmt::format("{} is not {}", with_unit(value, quantity.unit), what), hint);
  return false;
}

bool FieldCheck::place_within(const std::string& path, const Vec3& position, double reach,
                              const std::string& what) {
  return vector_within(
      path, position, reach, quantity::length, what,
      fmt::format("give three coordinates within {:g} mm of the umbilicus", reach / units::mm));
}

bool FieldCheck::turn_within(const std::string& path, const Vec3& turn, double most,
                             const std::string& what) {
  return vector_within(path, turn, most, quantity::angle, what,
                       fmt::format("give three angles of up to {:g} degrees", most / units::deg));
}

bool FieldCheck::vector_within(const std::string& path, const Vec3& vector, double most,
                               const Quantity& quantity, const std::string& what, std::string hint) {
  const double largest = vector.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  if (largest <= most) return true;
  const UnitName& usual = quantity.multipliers.front();
  if (largest * usual.factor <= most)
    hint = fmt::format("did you mean {} * {}? {}", text_of(vector), usual.name, hint);
  problem(path, fmt::format("{} {} is not {}", text_of(vector), quantity.unit, what), std::move(hint));
  return false;
}

bool FieldCheck::unit_direction(const std::string& path, const Vec3& direction, const std::string& what) {
  const double length = direction.norm();
  if (std::abs(length - 1.0) <= 1e-6) return true;
  const bool usable = std::isfinite(length) && length > 0;
  problem(path, fmt::format("{} is not {}: its length must be 1", text_of(direction), what),
          usable ? "give " + text_of(direction / length) : "give a direction such as (0, 0, 1)");
  return false;
}

bool FieldCheck::identifier(const std::string& path, const std::string& name, const std::string& what) {
  bool good = !name.empty() && !is_digit(name.front());
  for (const char c : name) good = good && (is_letter(c) || is_digit(c));
  if (good) return true;
  problem(path, name.empty() ? what + " has no name" : fmt::format("\"{}\" is not a name for {}", name, what),
          "use letters, digits and underscores, not starting with a digit");
  return false;
}

bool FieldCheck::known(const std::string& path, const std::string& name,
                       const std::vector<std::string>& names, const std::string& what) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return true;
  problem(path, fmt::format("unknown {} \"{}\"", what, name), suggestion(name, names));
  return false;
}

}  // namespace calot

#pragma once
// How a field lies at rest, as plain data that can be kept: all that the search for it leaves behind and later steps
// depend on. What else that remembers (contacts' searches) is no part of any result.

#include <optional>
#include <string>
#include <string_view>

#include "field/field.h"

namespace calot {

struct RestState {
  std::vector<VecX> places;       ///< m, 3 a node, of each organ, then of each tissue
  std::vector<double> pressures;  ///< Pa, at the datum, one an organ
  /// Of each member: what its matrix couples where walls have met; empty: what its body's pattern does. Of no member: the
  /// search began at rest, and all that follows is empty.
  std::vector<std::vector<std::vector<int>>> own;
  std::vector<std::vector<int>> joined;  ///< what the group's matrix was made to couple
  bool factored = false;  ///< else its matrix has no factor, and what follows but `shifted` is empty
  bool shifted = false;
  /// The last matrix that was factorised, as BlockMatrix::entries(): its factor serves the first steps, and from the same
  /// bits the same is made again in a few ms.
  std::vector<double> matrix;
  Eigen::MatrixXd constraints;      ///< Border::gradients
  VecX compliances;                 ///< Border::compliances
  std::vector<SharpTangent> sharp;  ///< NewtonWorkspace::sharp

  bool searched() const { return !own.empty(); }
};

/// Of a field of two members or more that has just come to rest. (What is alone has another kind of matrix, and rests
/// soon.)
RestState rest_state(const Field& field);
/// Brings a field that was built of the same definition to rest so. False, with the field as it was, where it is another's.
bool take_rest_state(const RestState& state, Field& field);

/// Every number by its bits.
std::string to_bytes(const RestState& state);
/// None where they are no state's.
std::optional<RestState> rest_state_of(std::string_view bytes);

}  // namespace calot

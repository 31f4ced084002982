#pragma once
// Which of a field's shapes touches a body. Bodies know shapes by their places in ContactLoads::shapes: those of the tools,
// shapes_per_tool of each in the tools' order, then the ground. Strands know the tools' alone, at the same places.

#include <cstddef>

#include "tools/tool_index.h"

namespace calot {

/// A part of a tool, or a piece of ground.
struct FieldShape {
  ToolIndex tool{-1};  ///< -1: it is ground
  int part = 0;        ///< of the tool: 0 its shaft, 1 and 2 its jaws, or what a rod ends in
  int ground = -1;     ///< place among the field's pieces of ground; -1: it is a tool's

  static FieldShape of_tool(ToolIndex tool, int part) { return {tool, part, -1}; }
  /// `jaw`: 0 or 1.
  static FieldShape of_jaw(ToolIndex tool, int jaw) { return {tool, jaw + 1, -1}; }
  static FieldShape of_ground(int ground) { return {ToolIndex(-1), 0, ground}; }
  /// What has this place among the shapes of a field with so many tools.
  static FieldShape at(int index, std::size_t tools);
  /// Its place there.
  int index(std::size_t tools) const;

  bool is_ground() const { return ground >= 0; }
  bool is_shaft() const { return !is_ground() && part == 0; }
  /// A jaw, or what a rod ends in: which of the two, 0 or 1. Of no other part.
  int jaw() const { return part - 1; }
  bool operator==(const FieldShape&) const = default;
};

}  // namespace calot

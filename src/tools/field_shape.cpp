#include "tools/field_shape.h"

#include "tools/instrument.h"

namespace calot {

FieldShape FieldShape::at(int index, std::size_t tools) {
  const int of_tools = shapes_per_tool * static_cast<int>(tools);
  if (index >= of_tools) return of_ground(index - of_tools);
  return of_tool(ToolIndex(index / shapes_per_tool), index % shapes_per_tool);
}

int FieldShape::index(std::size_t tools) const {
  if (is_ground()) return shapes_per_tool * static_cast<int>(tools) + ground;
  return shapes_per_tool * tool.value + part;
}

}  // namespace calot

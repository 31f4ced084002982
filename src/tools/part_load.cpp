#include "tools/part_load.h"

namespace calot {

const std::vector<std::string>& tool_part_names() {
  static const std::vector<std::string> names = {"tip", "jaws", "shaft"};
  return names;
}

const std::vector<std::string>& grip_state_names() {
  static const std::vector<std::string> names = {"holding", "open", "empty", "beside", "slipped"};
  return names;
}

}  // namespace calot

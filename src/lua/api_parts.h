#pragma once
// The parts that api_table.h's tables are made of; nobody else needs them.

#include <vector>

#include "lua/api_table.h"

namespace calot {

std::vector<KeyTable> exercise_tables();
std::vector<ApiFunction> all_functions();

}  // namespace calot

#pragma once
// The parts that api_table.h's tables are made of; nobody else needs them.

#include <vector>

#include "lua/api_table.h"

namespace calot {

std::vector<ApiTable> exercise_tables();
std::vector<ApiTable> scene_tables();
std::vector<ApiFunction> all_functions();

// Makers of keys: the shorter a table reads, the fewer its mistakes.
ApiKey number(std::string name, const Quantity& quantity, double low, double high, std::string fallback,
              std::string doc);
ApiKey point(std::string name, const Quantity& quantity, double reach, std::string fallback, std::string doc);
ApiKey text(std::string name, std::string fallback, std::string doc);
ApiKey flag(std::string name, std::string fallback, std::string doc);
ApiKey choice(std::string name, std::vector<std::string> choices, std::string fallback, std::string doc);
ApiKey table(std::string name, std::string of, std::string doc);
ApiKey list(std::string name, std::string of, std::string doc);
ApiKey map(std::string name, std::string of, std::string doc);
ApiKey function(std::string name, std::string signature, std::string doc);
ApiKey required(ApiKey key);
/// A number as an author writes it in the quantity's first unit: "80 * mm".
std::string written(double value, const Quantity& quantity);

}  // namespace calot

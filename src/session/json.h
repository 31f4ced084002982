#pragma once
// JSON as it is read, and as it is written: members in the order they were put in.

#include <nlohmann/json.hpp>
#include <string>

#include "base/status.h"

namespace calot {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

/// Indented, without a newline at the end. Bytes that are not UTF-8 are replaced: a scenario's texts and files' names may hold any.
std::string json_text(const OrderedJson& json);

/// A list of {"file", "line", "path", "message", "hint"}.
OrderedJson problems_json(const Failure& failure);

}  // namespace calot

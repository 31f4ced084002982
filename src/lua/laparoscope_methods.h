#pragma once
// The functions behind t.laparoscope: where it is, what its picture shows, and how demos move it.

#include <vector>

#include "lua/method_targets.h"

namespace calot {

/// Of the classes Laparoscope and DemoLaparoscope.
const std::vector<Method>& laparoscope_methods();

}  // namespace calot

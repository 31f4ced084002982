#pragma once
// A CSV table of forces, pressures and volumes, one row a step (RFC 4180; the first row is the rest state).

#include <fstream>
#include <string>

#include "base/status.h"
#include "sim/world.h"

namespace calot {

class StepTable {
 public:
  /// Fails (usage) where the file cannot be written.
  static Result<StepTable> create(const std::string& path, const SceneDefinition& scene);
  bool write(const StepReport& report);

 private:
  std::ofstream out_;
};

}  // namespace calot

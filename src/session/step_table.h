#pragma once
// A CSV table of forces, pressures and volumes, one row a step (RFC 4180; the first row is the rest state). An organ that
// is not there yet, or no more, has empty fields; the columns of one that comes are added behind all others, in earlier
// rows too.

#include <fstream>
#include <string>
#include <vector>

#include "base/status.h"
#include "world/world.h"

namespace calot {

class StepTable {
 public:
  /// Fails (usage) where the file cannot be written.
  static Result<StepTable> create(const std::string& path, const SceneDefinition& scene);
  bool write(const StepReport& report);

 private:
  /// Writes the table anew with the columns of these organs too.
  bool widen(const std::vector<std::string>& organs);

  std::string path_;
  std::vector<std::string> organs_;  ///< that the scene has, and came later
  std::size_t of_scene_ = 0;
  std::ofstream out_;
};

}  // namespace calot

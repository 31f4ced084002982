#pragma once
// Which scenarios and frames a golden command's names mean.

#include <filesystem>
#include <string>
#include <vector>

#include "base/status.h"

namespace calot {

/// A scenario with the frames that were asked for; no frames: all of them.
struct SelectedGolden {
  std::filesystem::path file;
  std::string name;  ///< scenario_name(file)
  std::vector<std::string> frames;
  bool wants(const std::string& frame) const;
};

/// The scenarios that names select, all for no names. A name is a scenario ("paper/figure_4") or one of its frames
/// ("paper/figure_4/t001.00s"); its folders may be left out where only one scenario is then meant. Fails (usage)
/// naming all names that mean nothing or more than one scenario.
Result<std::vector<SelectedGolden>> select_goldens(const std::vector<std::string>& names);

}  // namespace calot

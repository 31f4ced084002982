#pragma once
// Results that take long to find, kept as bytes from one start of the program to the next.

#include <optional>
#include <string>

namespace calot {

class KeptResults {
 public:
  virtual ~KeptResults() = default;
  /// What was kept under this name by the same program; none: nothing, or nothing whole.
  virtual std::optional<std::string> find(const std::string& key) = 0;
  /// `key`: a digest of all that the result is a function of, beside the program. What cannot be kept is not.
  virtual void keep(const std::string& key, const std::string& bytes) = 0;
};

}  // namespace calot

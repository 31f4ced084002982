#pragma once
// From a field's path ("scene.anatomy.organs[1].wall.thickness") to the line on which a scenario's author
// wrote it, found by the nesting of tables and functions in the text.

#include <map>
#include <string>
#include <string_view>

namespace calot {

class SourceMap {
 public:
  SourceMap() = default;
  explicit SourceMap(std::string_view source);

  /// The line of the key; of the nearest enclosing one when it is not written in plain sight (built by a
  /// loop, a module, or left out), at last of the chunk's `return`; 0 when not even that is known.
  int line_of(const std::string& path) const;

 private:
  class Builder;
  int exact_line(const std::string& path, int depth) const;

  std::map<std::string, int> lines_;  ///< paths below a local variable or function start with "$name"
  std::map<std::string, std::string> aliases_;  ///< path -> "$name": the value is that variable or its call
};

}  // namespace calot

#pragma once
// Reads the members of a JSON object that others wrote: every member is checked, what is wrong is said in words, all
// at once, and nothing throws.

#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "session/json.h"

namespace calot {

/// A text as JSON. Where it is none, `problem` says why and at which byte (from 1), and the value is null.
Json parse_json(std::string_view text, std::string& problem);

bool is_utf8(const std::string& text);

class JsonFields {
 public:
  /// `json` and `problems` outlive this. Of anything but an object, every member is missing.
  JsonFields(const Json& json, std::vector<std::string>& problems, std::string prefix = {})
      : json_(json), problems_(problems), prefix_(std::move(prefix)) {}

  bool has(const std::string& key) const { return json_.is_object() && json_.contains(key); }
  // Each takes one member; where that is missing or unfit it says so and gives an empty value.
  std::string text(const std::string& key);  ///< of up to 4096 bytes
  double number(const std::string& key, double least = std::numeric_limits<double>::lowest(),
                double most = std::numeric_limits<double>::max());
  int integer(const std::string& key, int least, int most);
  std::uint64_t count(const std::string& key);
  std::uint64_t hash(const std::string& key);  ///< sixteen lower-case hexadecimal digits
  std::vector<std::string> texts(const std::string& key);
  std::map<std::string, std::string> text_map(const std::string& key);
  const Json& any(const std::string& key);  ///< null where it is missing
  void wrong(const std::string& key, const std::string& why);
  /// Says which members nobody took.
  void expect_no_others();

 private:
  const Json* take(const std::string& key);

  const Json& json_;
  std::vector<std::string>& problems_;
  std::string prefix_;
  std::set<std::string> taken_;
};

}  // namespace calot

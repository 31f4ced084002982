#pragma once
// Who operated a session, when, where and by what means. Nothing here decides a bit of a state, and no person's name stands
// here: a trainee is known by a pseudonym, and a register that stays at home tells whose it is (grading/name_register.h).

#include <optional>
#include <string>
#include <vector>

#include "base/status.h"
#include "session/json_fields.h"

namespace calot {

/// What is not known is empty, or 0.
struct Attempt {
  std::string session;  ///< 32 lower-case hexadecimal digits, random; a copy and a replay keep them
  std::string source;   ///< of the inputs: one of input_source_names()
  std::string mode;     ///< "practice" or "exam" of a session that somebody operated
  std::string trainee;  ///< a pseudonym
  int number = 0;       ///< of the attempt within its sitting, from 1
  std::string began;    ///< UTC: "2026-11-25T20:13:27Z"
  std::string machine;  ///< its name in its network
  bool operator==(const Attempt&) const = default;
};

/// "demo" of the scenario, "window" (mouse, keyboard, gamepad), "lines", "openigtlink", "import".
const std::vector<std::string>& input_source_names();

/// Gives it a new session number, the present time and this machine's name.
Attempt begin_attempt(Attempt attempt);

/// Fails (usage) where a text is no pseudonym: 1 to 40 letters, digits, full stops, hyphens and underscores.
std::optional<Failure> check_pseudonym(const std::string& text);

/// The members that write_attempt may add, in their order.
const std::vector<std::string>& attempt_keys();
/// Adds what is known.
void write_attempt(const Attempt& attempt, OrderedJson& json);
/// Takes what is there; what does not fit is added to the reader's problems.
Attempt read_attempt(JsonFields& fields);
/// The mode alone, likewise.
std::string read_mode(JsonFields& fields);

}  // namespace calot

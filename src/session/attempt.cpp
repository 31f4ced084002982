#include "session/attempt.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <random>

#include "base/suggest.h"
#include "session/live.h"

namespace calot {
namespace {

constexpr std::size_t longest_pseudonym = 40;
constexpr std::size_t session_digits = 32;
constexpr int most_attempts = 1'000'000;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hexadecimal(char c) { return is_digit(c) || (c >= 'a' && c <= 'f'); }
bool is_for_pseudonyms(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '-' || c == '_';
}

std::string random_session() {
  std::random_device device;
  std::string digits;
  while (digits.size() < session_digits) digits += fmt::format("{:08x}", device());
  return digits;
}

std::string time_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  std::array<char, 64> text{};
  gmtime_r(&now, &parts);
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

std::string machine_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

bool is_session(const std::string& text) {
  return text.size() == session_digits && std::all_of(text.begin(), text.end(), is_hexadecimal);
}

bool is_time(const std::string& text) {
  constexpr std::string_view pattern = "0000-00-00T00:00:00Z";
  const auto fits = [](char found, char wanted) { return wanted == '0' ? is_digit(found) : found == wanted; };
  return text.size() == pattern.size() && std::equal(text.begin(), text.end(), pattern.begin(), fits);
}

std::string read_choice(JsonFields& fields, const char* key, const std::vector<std::string>& known) {
  if (!fields.has(key)) return {};
  const std::string text = fields.text(key);
  if (std::find(known.begin(), known.end(), text) == known.end())
    fields.wrong(key, fmt::format("is \"{}\"; {}", shortened(text, 40), suggestion(text, known)));
  return text;
}

}  // namespace

const std::vector<std::string>& input_source_names() {
  static const std::vector<std::string> names = {"demo", "window", "lines", "openigtlink", "import"};
  return names;
}

Attempt begin_attempt(Attempt attempt) {
  attempt.session = random_session();
  attempt.began = time_now();
  attempt.machine = machine_name();
  return attempt;
}

std::optional<Failure> check_pseudonym(const std::string& text) {
  if (!text.empty() && text.size() <= longest_pseudonym &&
      std::all_of(text.begin(), text.end(), is_for_pseudonyms))
    return std::nullopt;
  return fail(FailureKind::usage, fmt::format("\"{}\" is no pseudonym", shortened(text, 60)),
              "give 1 to 40 letters, digits, full stops, hyphens and underscores, such as T-07; names of "
              "people stand "
              "in a register: calot score --names FILE");
}

std::string read_mode(JsonFields& fields) { return read_choice(fields, "mode", live_mode_names()); }

const std::vector<std::string>& attempt_keys() {
  static const std::vector<std::string> keys = {"session", "source", "mode",   "trainee",
                                                "attempt", "began",  "machine"};
  return keys;
}

void write_attempt(const Attempt& attempt, OrderedJson& json) {
  const auto add = [&](const char* key, const std::string& text) {
    if (!text.empty()) json[key] = text;
  };
  add("session", attempt.session);
  add("source", attempt.source);
  add("mode", attempt.mode);
  add("trainee", attempt.trainee);
  if (attempt.number > 0) json["attempt"] = attempt.number;
  add("began", attempt.began);
  add("machine", attempt.machine);
}

Attempt read_attempt(JsonFields& fields) {
  Attempt attempt;
  if (fields.has("session")) attempt.session = fields.text("session");
  if (!attempt.session.empty() && !is_session(attempt.session))
    fields.wrong("session", "must be 32 lower-case hexadecimal digits");
  attempt.source = read_choice(fields, "source", input_source_names());
  attempt.mode = read_mode(fields);
  if (fields.has("trainee")) attempt.trainee = fields.text("trainee");
  if (!attempt.trainee.empty() && check_pseudonym(attempt.trainee))
    fields.wrong("trainee", "is no pseudonym: 1 to 40 letters, digits, full stops, hyphens and underscores");
  if (fields.has("attempt")) attempt.number = fields.integer("attempt", 1, most_attempts);
  if (fields.has("began")) attempt.began = fields.text("began");
  if (!attempt.began.empty() && !is_time(attempt.began))
    fields.wrong("began", "must be a time such as 2026-11-25T20:13:27Z");
  if (fields.has("machine")) attempt.machine = fields.text("machine");
  return attempt;
}

}  // namespace calot

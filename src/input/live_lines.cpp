#include "input/live_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/suggest.h"

namespace calot {
namespace {

constexpr std::array pose_fields = {"pitch", "yaw", "insertion", "roll", "jaw"};
constexpr std::array tip_fields = {"x", "y", "z", "roll", "jaw"};
constexpr std::size_t words_before = 3;  // the kind, time and name
constexpr std::size_t words_of_input = words_before + pose_fields.size();

/// What a message may show of bytes from anywhere.
std::string shown(std::string_view text) {
  std::string clean;
  for (const char c : text.substr(0, 40)) clean += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > 40 ? clean + "..." : clean;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  const char* const blanks = " \t\r";
  for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(blanks, end);
  }
  return words;
}

}  // namespace

LiveLines::LiveLines(std::vector<LiveInstrument> instruments, std::string source)
    : instruments_(std::move(instruments)), source_(std::move(source)) {}

void LiveLines::add(std::string_view bytes, std::vector<LiveEvent>& events) {
  for (const char c : bytes) {
    if (c == '\n')
      end_line(events);
    else if (line_.size() == longest)
      too_long_ = true;
    else
      line_ += c;
  }
}

void LiveLines::finish(std::vector<LiveEvent>& events) {
  if (line_.empty()) return;
  ++number_;
  events.emplace_back(LiveRefusal{
      wrong("this last line has no end: it may be half of one", "end it with a line feed").problems[0]});
  line_.clear();
}

void LiveLines::end_line(std::vector<LiveEvent>& events) {
  ++number_;
  Result<std::optional<LiveEvent>> event =
      too_long_ ? wrong(fmt::format("this line has more than {} bytes", longest), "send one input a line")
                : read(line_);
  line_.clear();
  too_long_ = false;
  if (!event)
    events.emplace_back(LiveRefusal{event.failure().problems[0]});
  else if (event.value())
    events.push_back(std::move(*event.value()));
}

Failure LiveLines::wrong(const std::string& message, const std::string& hint) const {
  return fail(FailureKind::usage, message, hint, {source_, number_, {}});
}

Result<std::optional<LiveEvent>> LiveLines::read(std::string_view line) {
  const std::vector<std::string_view> words = split(line);
  if (words.empty() || words[0].starts_with('#')) return std::optional<LiveEvent>();
  if (words[0] == "pose" || words[0] == "tip") {
    const Result<LiveInput> input = read_input(words);
    if (!input) return input.failure();
    return std::optional<LiveEvent>(input.value());
  }
  if (is_session_act(words[0])) {
    const std::string_view said = words.size() > 1
                                      ? line.substr(static_cast<std::size_t>(words[1].data() - line.data()))
                                      : std::string_view();
    const std::size_t end = said.find_last_not_of(" \t\r");
    Result<SessionAct> act =
        read_session_act(std::string(words[0]), std::string(said.substr(0, end == said.npos ? 0 : end + 1)));
    if (!act) return wrong(act.failure().problems[0].message, act.failure().problems[0].hint);
    return std::optional<LiveEvent>(std::move(act).value());
  }
  const std::vector<std::string>& commands = live_command_names();
  const auto found = std::find(commands.begin(), commands.end(), words[0]);
  if (found == commands.end()) {
    std::vector<std::string> known = {"pose", "tip"};
    known.insert(known.end(), commands.begin(), commands.end());
    known.insert(known.end(), session_act_names().begin(), session_act_names().end());
    return wrong(fmt::format("\"{}\" begins no line", shown(words[0])), suggestion(shown(words[0]), known));
  }
  if (words.size() > 1) return wrong(fmt::format("`{}` stands alone on its line", *found), "");
  const auto command = static_cast<LiveCommand>(found - commands.begin());
  ended_ = command == LiveCommand::end || command == LiveCommand::abandon;
  if (command == LiveCommand::restart) time_ = 0;
  return std::optional<LiveEvent>(command);
}

Result<double> LiveLines::number(std::string_view word, const char* name) const {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    return wrong(fmt::format("{} is \"{}\"", name, shown(word)), "give a finite number, such as 0.125");
  return value;
}

Result<double> LiveLines::read_time(std::string_view word) const {
  const Result<double> time = number(word, "time");
  if (!time) return time.failure();
  if (time.value() < 0)
    return wrong(fmt::format("time {} is before 0", time.value()), "count from the session's start, in s");
  if (time.value() < time_)
    return wrong(fmt::format("time {} is before the {} of line {}", time.value(), time_, time_line_),
                 "send inputs in the order of their times");
  return time;
}

Result<int> LiveLines::read_instrument(std::string_view word) const {
  std::vector<std::string> names;
  for (const LiveInstrument& instrument : instruments_) names.push_back(instrument.definition.name);
  const auto named = std::find(names.begin(), names.end(), word);
  if (named == names.end())
    return wrong(fmt::format("there is no instrument \"{}\"", shown(word)), suggestion(shown(word), names));
  return static_cast<int>(named - names.begin());
}

Result<InstrumentPose> LiveLines::read_pose(const std::vector<std::string_view>& words,
                                            const LiveInstrument& instrument) const {
  const bool is_tip = words[0] == "tip";
  const auto& fields = is_tip ? tip_fields : pose_fields;
  std::array<double, pose_fields.size()> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Result<double> value = number(words[words_before + i], fields[i]);
    if (!value) return value.failure();
    v[i] = value.value();
  }
  InstrumentPose pose =
      is_tip ? pose_reaching(instrument.trocar, {v[0], v[1], v[2]}, v[3], 0, instrument.geometry)
             : InstrumentPose{v[0], v[1], v[2], v[3], 0};
  pose.jaw = v[4];
  return pose;
}

Result<LiveInput> LiveLines::read_input(const std::vector<std::string_view>& words) {
  if (words.size() != words_of_input && words.size() != words_of_input + 1)
    return wrong(fmt::format("`{}` with {} values", words[0], words.size() - 1),
                 words[0] == "tip" ? "write: tip T NAME x y z roll jaw [ACTION]"
                                   : "write: pose T NAME pitch yaw insertion roll jaw [ACTION]");
  const Result<double> time = read_time(words[1]);
  if (!time) return time.failure();
  const Result<int> named = read_instrument(words[2]);
  if (!named) return named.failure();
  const LiveInstrument& instrument = instruments_[static_cast<std::size_t>(named.value())];
  const Result<InstrumentPose> pose = read_pose(words, instrument);
  if (!pose) return pose.failure();
  LiveInput input;
  input.time = time.value();
  input.instrument = named.value();
  input.pose = pose.value();
  std::optional<Failure> refused = check_pose(instrument.definition.name, instrument.geometry, input.pose);
  if (words.size() > words_of_input && !refused) {
    const std::string word = shown(words.back());
    const std::optional<InstrumentAction> action = instrument_action_called(word);
    if (!action)
      return wrong(fmt::format("\"{}\" is no action", word), suggestion(word, instrument_action_names()));
    input.action = *action;
    refused = check_action(instrument.definition, input.action);
  }
  if (refused) return wrong(refused->problems[0].message, refused->problems[0].hint);
  time_ = time.value();
  time_line_ = number_;
  return input;
}

}  // namespace calot

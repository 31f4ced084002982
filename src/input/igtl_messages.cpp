#include "input/igtl_messages.h"

#include <fmt/format.h>
#include <openigtlink/igtl_header.h>
#include <openigtlink/igtl_position.h>
#include <openigtlink/igtl_sensor.h>
#include <openigtlink/igtl_string.h>
#include <openigtlink/igtl_tdata.h>
#include <openigtlink/igtl_transform.h>
#include <openigtlink/igtl_util.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/suggest.h"

namespace calot {
namespace {

constexpr std::uint64_t longest_kept = 1 << 16;     // bytes of a body that is read
constexpr std::uint64_t longest_body = 1ULL << 32;  // more is no message: a volume has less
constexpr int newest_version = 3;
constexpr std::size_t most_left_out = 100;
constexpr const char* session_device = "session";
constexpr std::array types_read = {"TRANSFORM", "POSITION", "TDATA", "SENSOR", "STRING"};

/// Of the content that protocol versions 2 and 3 put around it, big-endian.
constexpr std::size_t extended_header_size = 12;

bool is_read(const std::string& type) {
  return std::find(types_read.begin(), types_read.end(), type) != types_read.end();
}

/// A name of at most so many bytes, of which a message may show all.
std::string name_of(const char* bytes, std::size_t most) {
  std::string name(bytes, strnlen(bytes, most));
  for (char& c : name)
    if (c < ' ' || c > '~') c = '?';
  return name;
}

std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char c : bytes) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

/// What a body of versions 2 and 3 holds between an extended header and metadata; none where their sizes cannot be.
std::optional<std::string_view> content_of(std::string_view body, int version) {
  if (version < 2) return body;
  if (body.size() < extended_header_size) return std::nullopt;
  const std::uint64_t before = big_endian(body.substr(0, 2));
  const std::uint64_t after = big_endian(body.substr(2, 2)) + big_endian(body.substr(4, 4));
  if (before < extended_header_size || before + after > body.size()) return std::nullopt;
  return body.substr(before, body.size() - before - after);
}

/// From the quaternion x, y, z, w.
std::optional<Mat3> rotation_of(const igtl_float32 (&q)[4]) {
  const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
  if (!(std::abs(turn.norm() - 1) < 1e-2)) return std::nullopt;
  return turn.normalized().toRotationMatrix();
}

}  // namespace

IgtlMessages::IgtlMessages(std::vector<LiveInstrument> instruments,
                           std::shared_ptr<const Registration> registration, std::string source)
    : instruments_(std::move(instruments)),
      registration_(std::move(registration)),
      source_(std::move(source)) {
  for (const ForeignInstrument& tool : registration_->instruments) {
    const auto named = std::find_if(instruments_.begin(), instruments_.end(), [&](const LiveInstrument& one) {
      return one.definition.name == tool.name;
    });
    tools_.push_back({&tool,
                      static_cast<int>(named - instruments_.begin()),
                      tool.jaw.empty() ? tool.source + "/jaw" : tool.jaw,
                      tool.source + "/action",
                      RegisteredTool(*registration_, tool, *tool.port, *named),
                      {},
                      {}});
  }
}

void IgtlMessages::add(std::string_view bytes, std::vector<LiveEvent>& events) {
  while (!broken_ && (!bytes.empty() || (in_body_ && left_ == 0))) {
    if (!in_body_) {
      const std::size_t part = std::min(bytes.size(), sizeof(igtl_header) - bytes_.size());
      bytes_.append(bytes.substr(0, part));
      bytes.remove_prefix(part);
      if (bytes_.size() == sizeof(igtl_header)) read_header(events);
      continue;
    }
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), left_));
    if (is_read(header_.type) && header_.body <= longest_kept) bytes_.append(bytes.substr(0, part));
    bytes.remove_prefix(part);
    left_ -= part;
    if (left_ > 0) continue;
    read_message(events);
    in_body_ = false;
    bytes_.clear();
  }
}

void IgtlMessages::finish(std::vector<LiveEvent>& events) {
  if (!in_body_ && bytes_.empty()) return;
  if (!in_body_) ++number_;
  refuse("this last message is not whole", "", events);
}

void IgtlMessages::read_header(std::vector<LiveEvent>& events) {
  igtl_header raw;
  std::memcpy(&raw, bytes_.data(), sizeof raw);
  bytes_.clear();
  igtl_header_convert_byte_order(&raw);
  ++number_;
  header_ = {raw.version, name_of(raw.name, sizeof raw.name),
             name_of(raw.device_name, sizeof raw.device_name), raw.body_size, raw.crc};
  left_ = header_.body;
  in_body_ = true;
  broken_ = header_.version < 1 || header_.version > newest_version || header_.body > longest_body;
  if (broken_)
    refuse(
        fmt::format("this is no header of OpenIGTLink: version {}, {} bytes", header_.version, header_.body),
        "send messages of version 1 to 3", events);
}

void IgtlMessages::read_message(std::vector<LiveEvent>& events) {
  if (!is_read(header_.type))
    return leave_out("messages of type " + header_.type,
                     fmt::format("what is read: {}", fmt::join(types_read, ", ")), events);
  if (header_.body > longest_kept)
    return refuse(fmt::format("a {} of {} bytes", header_.type, header_.body), "", events);
  auto* const raw = reinterpret_cast<unsigned char*>(bytes_.data());
  if (crc64(raw, bytes_.size(), 0) != header_.checksum)
    return refuse(fmt::format("the checksum of this {} is wrong", header_.type),
                  "it was damaged on its way, or cut", events);
  const std::optional<std::string_view> content = content_of(bytes_, header_.version);
  if (!content)
    return refuse(fmt::format("the parts of this {} have no room in it", header_.type), "", events);
  read_content(*content, events);
}

void IgtlMessages::read_content(std::string_view content, std::vector<LiveEvent>& events) {
  if (header_.type == "TRANSFORM") return read_frame(header_.device, content, events);
  if (header_.type == "POSITION") return read_position(content, events);
  if (header_.type == "TDATA") return read_tracking(content, events);
  if (header_.type == "SENSOR") return read_sensor(content, events);
  read_string(content, events);
}

/// Twelve numbers: three axes, then the origin in mm.
void IgtlMessages::read_frame(const std::string& name, std::string_view numbers,
                              std::vector<LiveEvent>& events) {
  igtl_float32 v[12];
  if (numbers.size() != sizeof v) return refuse("a transform has 12 numbers", "", events);
  std::memcpy(v, numbers.data(), sizeof v);
  igtl_transform_convert_byte_order(v);
  Tool* const tool = tool_called(name);
  if (tool == nullptr) return leave_out("the device " + name, "", events);
  Mat3 axes;
  axes << v[0], v[3], v[6], v[1], v[4], v[7], v[2], v[5], v[8];
  if (!std::all_of(std::begin(v), std::end(v), [](float one) { return std::isfinite(one); }))
    return refuse(name + ": a value is not finite", "", events);
  if (!is_rotation(axes)) return refuse(name + ": its axes are not of length 1 and upright", "", events);
  place(*tool, axes, Vec3(v[9], v[10], v[11]), events);
}

void IgtlMessages::read_position(std::string_view content, std::vector<LiveEvent>& events) {
  igtl_position raw = {};
  const std::size_t size = content.size();
  std::memcpy(&raw, content.data(), std::min(size, sizeof raw));
  if (size == IGTL_POSITION_MESSAGE_DEFAULT_SIZE)
    igtl_position_convert_byte_order(&raw);
  else if (size == IGTL_POSITION_MESSAGE_POSITON_ONLY_SIZE)
    igtl_position_convert_byte_order_position_only(&raw);
  else
    return refuse("a position has 3 or 7 numbers", "", events);
  Tool* const tool = tool_called(header_.device);
  if (tool == nullptr) return leave_out("the device " + header_.device, "", events);
  const Vec3 origin(raw.position[0], raw.position[1], raw.position[2]);
  if (!origin.allFinite()) return refuse(header_.device + ": a value is not finite", "", events);
  if (size == sizeof raw) {
    igtl_float32 turn[4];
    std::memcpy(turn, &raw.quaternion, sizeof turn);
    const std::optional<Mat3> axes = rotation_of(turn);
    if (!axes) return refuse(header_.device + ": its quaternion is not of length 1", "", events);
    return place(*tool, *axes, origin, events);
  }
  if (tool->foreign->tip != Vec3::Zero())
    return refuse(header_.device + ": where its tip is takes its orientation", "send TRANSFORM", events);
  tool->last.emplace();
  tool->last->tip = origin;
  send(*tool, events);
}

void IgtlMessages::read_tracking(std::string_view content, std::vector<LiveEvent>& events) {
  if (content.size() % sizeof(igtl_tdata_element) != 0)
    return refuse("tracking data has 70 bytes for each tool", "", events);
  for (; !content.empty(); content.remove_prefix(sizeof(igtl_tdata_element))) {
    igtl_tdata_element element;
    std::memcpy(&element, content.data(), sizeof element);
    read_frame(name_of(element.name, sizeof element.name),
               content.substr(offsetof(igtl_tdata_element, transform), sizeof element.transform), events);
  }
}

void IgtlMessages::read_sensor(std::string_view content, std::vector<LiveEvent>& events) {
  const auto tool = std::find_if(tools_.begin(), tools_.end(),
                                 [&](const Tool& one) { return one.jaw_device == header_.device; });
  if (tool == tools_.end()) return leave_out("the device " + header_.device, "", events);
  igtl_sensor_header raw;
  igtl_float64 value = 0;
  if (content.size() != sizeof raw + sizeof value)
    return refuse(header_.device + ": how far jaws are open is one number", "", events);
  std::memcpy(&raw, content.data(), sizeof raw);
  std::memcpy(&value, content.data() + sizeof raw, sizeof value);
  if (raw.larray != 1) return refuse(header_.device + ": how far jaws are open is one number", "", events);
  igtl_sensor_convert_byte_order(&raw, &value);
  if (!std::isfinite(value)) return refuse(header_.device + ": the value is not finite", "", events);
  tool->jaw = value;
  if (tool->last) send(*tool, events);
}

void IgtlMessages::read_string(std::string_view content, std::vector<LiveEvent>& events) {
  igtl_string_header raw;
  if (content.size() < sizeof raw) return refuse("a string has a header", "", events);
  std::memcpy(&raw, content.data(), sizeof raw);
  igtl_string_convert_byte_order(&raw);
  if (content.size() - sizeof raw != raw.length)
    return refuse("this string is not as long as it says", "", events);
  const std::string text = name_of(content.data() + sizeof raw, raw.length);
  if (header_.device == session_device) return read_command(text, events);
  const auto tool = std::find_if(tools_.begin(), tools_.end(),
                                 [&](const Tool& one) { return one.action_device == header_.device; });
  if (tool == tools_.end()) return leave_out("the device " + header_.device, "", events);
  const std::optional<InstrumentAction> action = instrument_action_called(text);
  if (!action)
    return refuse(fmt::format("\"{}\" is no action", shortened(text, 40)),
                  suggestion(text, instrument_action_names()), events);
  const auto& definition = instruments_[static_cast<std::size_t>(tool->instrument)].definition;
  if (const std::optional<Failure> failure = check_action(definition, *action))
    return refuse(failure->problems[0].message, failure->problems[0].hint, events);
  tool->action = *action;
  if (tool->last) send(*tool, events);
}

void IgtlMessages::read_command(const std::string& text, std::vector<LiveEvent>& events) {
  const std::size_t blank = text.find(' ');
  if (const std::string name = text.substr(0, blank); is_session_act(name)) {
    Result<SessionAct> act =
        read_session_act(name, blank == std::string::npos ? std::string() : text.substr(blank + 1));
    if (!act) return refuse(act.failure().problems[0].message, act.failure().problems[0].hint, events);
    events.emplace_back(std::move(act).value());
    return;
  }
  const std::vector<std::string>& commands = live_command_names();
  const auto found = std::find(commands.begin(), commands.end(), text);
  if (found == commands.end())
    return refuse(fmt::format("\"{}\" is no command", shortened(text, 40)), suggestion(text, commands),
                  events);
  const auto command = static_cast<LiveCommand>(found - commands.begin());
  ended_ = command == LiveCommand::end || command == LiveCommand::abandon;
  events.emplace_back(command);
}

void IgtlMessages::place(Tool& tool, const Mat3& axes, const Vec3& origin, std::vector<LiveEvent>& events) {
  set_frame(tool.last.emplace(), *tool.foreign, axes, origin);
  send(tool, events);
}

void IgtlMessages::send(Tool& tool, std::vector<LiveEvent>& events) {
  tool.last->jaw = tool.jaw;
  LiveInput input;
  input.instrument = tool.instrument;
  input.pose = tool.registered.pose(*tool.last);
  input.action = tool.action;
  const LiveInstrument& instrument = instruments_[static_cast<std::size_t>(tool.instrument)];
  if (const std::optional<Failure> failure =
          check_pose(instrument.definition.name, instrument.geometry, input.pose))
    return refuse(failure->problems[0].message, failure->problems[0].hint, events);
  if (tool.registered.held_jaws() > 0 && !std::exchange(tool.said_held, true))
    events.emplace_back(LiveRemark{
        fmt::format("{}: its jaws were said to be beyond closed or fully open, and are taken as that",
                    instrument.definition.name)});
  events.emplace_back(input);
}

IgtlMessages::Tool* IgtlMessages::tool_called(const std::string& source) {
  const auto tool = std::find_if(tools_.begin(), tools_.end(),
                                 [&](const Tool& one) { return one.foreign->source == source; });
  return tool == tools_.end() ? nullptr : &*tool;
}

void IgtlMessages::refuse(const std::string& message, const std::string& hint,
                          std::vector<LiveEvent>& events) const {
  events.emplace_back(LiveRefusal{{{source_, 0, {}}, fmt::format("message {}: {}", number_, message), hint}});
}

void IgtlMessages::leave_out(const std::string& what, const std::string& hint,
                             std::vector<LiveEvent>& events) {
  if (left_out_.size() >= most_left_out || !left_out_.insert(what).second) return;
  std::vector<std::string> sources;
  for (const Tool& tool : tools_) sources.push_back(tool.foreign->source);
  refuse("left out from here on: " + what,
         hint.empty() ? fmt::format("devices that do: {}", fmt::join(sources, ", ")) : hint, events);
}

}  // namespace calot

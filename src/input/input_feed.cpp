#include "input/input_feed.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace calot {
namespace {

constexpr const char* path_prefix = "unix:";
constexpr const char* network_prefix = "tcp:";
constexpr int again_after = 1000;  // ms, between two tries to connect

std::string reason() { return std::strerror(errno); }

/// Whether there is anything among them that can be used.
bool say_something(const std::vector<LiveEvent>& events) {
  return std::any_of(events.begin(), events.end(), [](const LiveEvent& event) {
    return std::holds_alternative<LiveInput>(event) || std::holds_alternative<LiveCommand>(event) ||
           std::holds_alternative<SessionAct>(event);
  });
}

}  // namespace

InputFeed::InputFeed(std::string name, DecoderMaker maker, LiveMailbox& mailbox)
    : name_(std::move(name)), maker_(std::move(maker)), mailbox_(mailbox) {}

Result<std::unique_ptr<InputFeed>> InputFeed::open(const std::string& input, DecoderMaker maker,
                                                   LiveMailbox& mailbox) {
  std::unique_ptr<InputFeed> feed(
      new InputFeed(input == "-" ? "standard input" : input, std::move(maker), mailbox));
  std::array<int, 2> ends = {-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    return fail(FailureKind::resource, "no pipe can be made: " + reason());
  feed->wake_ = Descriptor(ends[0]);
  feed->waker_ = Descriptor(ends[1]);
  if (std::optional<Failure> wrong = feed->open_source(input)) return *wrong;
  struct stat status = {};
  const int file = feed->is_standard_ ? STDIN_FILENO : feed->file_.get();
  feed->is_file_ = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  feed->thread_ = std::thread([raw = feed.get()] { raw->run(); });
  return feed;
}

std::optional<Failure> InputFeed::open_source(const std::string& input) {
  is_standard_ = input == "-";
  if (is_standard_) return std::nullopt;
  if (input.starts_with(network_prefix)) return open_network(input.substr(std::strlen(network_prefix)));
  if (!input.starts_with(path_prefix)) return open_file(input);
  const std::string path = input.substr(std::strlen(path_prefix));
  Result<Descriptor> listener = listen_at_path(path);
  if (!listener) return listener.failure();
  listener_ = std::move(listener).value();
  socket_path_ = path;
  return std::nullopt;
}

std::optional<Failure> InputFeed::open_file(const std::string& path) {
  // A pipe that nobody writes to yet is waited for by the thread.
  file_ = Descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  const std::string why = reason();
  struct stat status = {};
  const bool known = stat(path.c_str(), &status) == 0;
  if (known && S_ISSOCK(status.st_mode))
    return fail(FailureKind::usage, fmt::format("{} is a socket", path),
                "Calot makes its own: --input unix:PATH, and the sender connects to it");
  if (!file_)
    return fail(FailureKind::usage, fmt::format("cannot read {}: {}", path, why),
                "give a file or pipe of input lines, - for standard input, or unix:PATH for a socket");
  if (S_ISDIR(status.st_mode))
    return fail(FailureKind::usage, fmt::format("{} is a folder", path), "give a file of input lines");
  return std::nullopt;
}

std::optional<Failure> InputFeed::open_network(const std::string& text) {
  const Result<NetworkPlace> place = read_network_place(text);
  if (!place) return place.failure();
  if (!place->is_here) server_ = place.value();
  Result<Descriptor> file =
      place->is_here ? listen_at(place.value(), heard_at_) : connect_to(place.value(), wake_.get());
  if (!file) return file.failure();
  (place->is_here ? listener_ : file_) = std::move(file).value();
  return std::nullopt;
}

InputFeed::~InputFeed() {
  mailbox_.close();
  if (thread_.joinable()) {
    while (write(waker_.get(), "", 1) < 0 && errno == EINTR) {
    }
    thread_.join();
  }
  if (!socket_path_.empty()) unlink(socket_path_.c_str());
}

/// Until there is something to read, or so long; false once the feed is to end.
bool InputFeed::wait_for(int file, int most_ms) const {
  std::array<pollfd, 2> watched = {{{file, POLLIN, 0}, {wake_.get(), POLLIN, 0}}};
  while (poll(watched.data(), watched.size(), most_ms) < 0)
    if (errno != EINTR) return false;
  return watched[1].revents == 0;
}

void InputFeed::run() {
  if (listener_) return accept_all();
  if (server_) return stay_connected();
  serve(is_standard_ ? STDIN_FILENO : file_.get(), false);
}

void InputFeed::accept_all() {
  while (wait_for(listener_.get()))
    if (const Descriptor sender = accept_from(listener_.get())) serve(sender.get(), true);
}

void InputFeed::stay_connected() {
  serve(file_.get(), true);
  while (wait_for(-1, again_after)) {
    const Result<Descriptor> again = connect_to(*server_, wake_.get());
    if (again) serve(again->get(), true);
  }
}

void InputFeed::serve(int file, bool may_return) {
  const std::unique_ptr<LiveDecoder> decoder = maker_(name_);
  std::array<char, 1 << 14> bytes;
  std::vector<LiveEvent> events;
  std::string end = "has ended without saying `end`";
  bool spoke = false;
  for (bool goes_on = true; goes_on && wait_for(file);) {
    const ssize_t size = read(file, bytes.data(), bytes.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size < 0) end = "cannot be read: " + reason();
    if (size <= 0) decoder->finish(events);
    if (size > 0) decoder->add({bytes.data(), static_cast<std::size_t>(size)}, events);
    if (decoder->broken()) end = "sends what cannot be read, and is left";
    goes_on = size > 0 && !decoder->broken();
    spoke = spoke || say_something(events);
    // Who has sent nothing that can be used, as a port scan, is nobody whose leaving counts.
    if (!goes_on && may_return && !spoke) {
      if (!std::exchange(told_, true))
        events.emplace_back(
            LiveRemark{name_ + " " + end + ", and sent nothing that can be used: it does not count."});
    } else if (!goes_on && !decoder->ended()) {
      events.emplace_back(LiveLoss{name_ + " " + end, may_return});
    }
    for (LiveEvent& event : events)
      if (!mailbox_.put(std::move(event))) return;
    events.clear();
  }
}

}  // namespace calot

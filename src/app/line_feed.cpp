#include "app/line_feed.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace calot {
namespace {

constexpr const char* socket_prefix = "unix:";

std::string why() { return std::strerror(errno); }

Result<sockaddr_un> socket_address(const std::string& path) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    return fail(FailureKind::usage, fmt::format("\"{}\" is no place for a socket", path),
                fmt::format("give unix:PATH, of up to {} bytes", sizeof address.sun_path - 1));
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

/// A socket that a program left which is gone is in nobody's way.
std::optional<Failure> make_room(const std::string& path, const sockaddr_un& address) {
  struct stat status = {};
  if (lstat(path.c_str(), &status) != 0) return std::nullopt;
  if (!S_ISSOCK(status.st_mode))
    return fail(FailureKind::usage, fmt::format("{} is there already, and is no socket", path),
                "give another path");
  const int probe = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const bool answered = ::connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const bool nobody = !answered && errno == ECONNREFUSED;
  close(probe);
  if (nobody && unlink(path.c_str()) == 0) return std::nullopt;
  return fail(FailureKind::usage, fmt::format("{} is another program's socket", path), "give another path");
}

}  // namespace

LineFeed::LineFeed(std::string name, std::vector<LiveInstrument> instruments, LiveMailbox& mailbox)
    : name_(std::move(name)), instruments_(std::move(instruments)), mailbox_(mailbox) {}

Result<std::unique_ptr<LineFeed>> LineFeed::open(const std::string& input,
                                                 std::vector<LiveInstrument> instruments,
                                                 LiveMailbox& mailbox) {
  const bool is_standard = input == "-";
  std::unique_ptr<LineFeed> feed(
      new LineFeed(is_standard ? "standard input" : input, std::move(instruments), mailbox));
  std::optional<Failure> wrong;
  if (is_standard)
    feed->file_ = STDIN_FILENO;
  else if (input.starts_with(socket_prefix))
    wrong = feed->listen_at(input.substr(std::strlen(socket_prefix)));
  else
    wrong = feed->open_file(input);
  if (!wrong && pipe2(feed->wake_, O_CLOEXEC) != 0)
    wrong = fail(FailureKind::resource, "no pipe can be made: " + why());
  if (wrong) return *wrong;
  struct stat status = {};
  feed->is_file_ = feed->file_ >= 0 && fstat(feed->file_, &status) == 0 && S_ISREG(status.st_mode);
  feed->thread_ = std::thread([raw = feed.get()] { raw->run(); });
  return feed;
}

std::optional<Failure> LineFeed::open_file(const std::string& path) {
  // A pipe that nobody writes to yet is waited for by the thread.
  file_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  owns_file_ = file_ >= 0;
  struct stat status = {};
  const bool is_socket = stat(path.c_str(), &status) == 0 && S_ISSOCK(status.st_mode);
  if (is_socket)
    return fail(FailureKind::usage, fmt::format("{} is a socket", path),
                "Calot makes its own: --input unix:PATH, and the sender connects to it");
  if (file_ < 0)
    return fail(FailureKind::usage, fmt::format("cannot read {}: {}", path, why()),
                "give a file or pipe of input lines, - for standard input, or unix:PATH for a socket");
  if (S_ISDIR(status.st_mode))
    return fail(FailureKind::usage, fmt::format("{} is a folder", path), "give a file of input lines");
  return std::nullopt;
}

std::optional<Failure> LineFeed::listen_at(const std::string& path) {
  const Result<sockaddr_un> address = socket_address(path);
  if (!address) return address.failure();
  if (std::optional<Failure> taken = make_room(path, address.value())) return taken;
  listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const mode_t others = umask(0077);  // whoever may move the instruments is whoever may read the user's files
  const bool bound = listener_ >= 0 && ::bind(listener_, reinterpret_cast<const sockaddr*>(&address.value()),
                                              sizeof(sockaddr_un)) == 0;
  umask(others);
  if (bound) socket_path_ = path;
  if (!bound || ::listen(listener_, 1) != 0)
    return fail(FailureKind::usage, fmt::format("cannot make a socket at {}: {}", path, why()),
                "give a path in a folder that can be written to");
  return std::nullopt;
}

LineFeed::~LineFeed() {
  mailbox_.close();
  if (thread_.joinable()) {
    while (write(wake_[1], "", 1) < 0 && errno == EINTR) {
    }
    thread_.join();
  }
  for (const int file : {owns_file_ ? file_ : -1, listener_, wake_[0], wake_[1]})
    if (file >= 0) close(file);
  if (!socket_path_.empty()) unlink(socket_path_.c_str());
}

/// Until there is something to read; false once the feed is to end.
bool LineFeed::wait_for(int file) const {
  std::array<pollfd, 2> watched = {{{file, POLLIN, 0}, {wake_[0], POLLIN, 0}}};
  while (poll(watched.data(), watched.size(), -1) < 0)
    if (errno != EINTR) return false;
  return watched[1].revents == 0;
}

void LineFeed::run() {
  if (listener_ < 0) return serve(file_, false);
  while (wait_for(listener_)) {
    const int sender = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (sender < 0) continue;
    serve(sender, true);
    close(sender);
  }
}

void LineFeed::serve(int file, bool may_return) {
  LiveLines lines(instruments_, name_);
  std::array<char, 1 << 14> bytes;
  std::vector<LiveEvent> events;
  std::string end = "has ended without saying `end`";
  while (wait_for(file)) {
    const ssize_t size = read(file, bytes.data(), bytes.size());
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size < 0) end = "cannot be read: " + why();
    if (size <= 0) lines.finish(events);
    if (size > 0) lines.add({bytes.data(), static_cast<std::size_t>(size)}, events);
    if (size <= 0 && !lines.ended()) events.emplace_back(LiveLoss{name_ + " " + end, may_return});
    for (LiveEvent& event : events)
      if (!mailbox_.put(std::move(event))) return;
    events.clear();
    if (size <= 0) return;
  }
}

}  // namespace calot

#include "input/sockets.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>


namespace calot {
namespace {

constexpr int connect_within = 3000;  // ms
constexpr const char* here = "127.0.0.1";

std::string why() { return std::strerror(errno); }

Result<sockaddr_un> path_address(const std::string& path) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    return fail(FailureKind::usage, fmt::format("\"{}\" is no place for a socket", path),
                fmt::format("give unix:PATH, of up to {} bytes", sizeof address.sun_path - 1));
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

const sockaddr* plain(const sockaddr_un& address) { return reinterpret_cast<const sockaddr*>(&address); }

std::optional<Failure> make_room(const std::string& path, const sockaddr_un& address) {
  struct stat status = {};
  if (lstat(path.c_str(), &status) != 0) return std::nullopt;
  if (!S_ISSOCK(status.st_mode))
    return fail(FailureKind::usage, fmt::format("{} is there already, and is no socket", path),
                "give another path");
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const bool answered = ::connect(probe.get(), plain(address), sizeof address) == 0;
  const bool nobody = !answered && errno == ECONNREFUSED;
  if (nobody && unlink(path.c_str()) == 0) return std::nullopt;
  return fail(FailureKind::usage, fmt::format("{} is another program's socket", path), "give another path");
}

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

/// Of a host and port; the system's own text where there are none.
Result<Addresses> addresses_of(const NetworkPlace& place) {
  addrinfo wanted = {};
  wanted.ai_socktype = SOCK_STREAM;
  wanted.ai_flags = AI_NUMERICSERV | (place.host == "*" ? AI_PASSIVE : 0);
  if (place.is_here) wanted.ai_family = AF_INET;
  addrinfo* found = nullptr;
  const char* const host = place.host == "*" ? nullptr : place.host.c_str();
  const int error = getaddrinfo(host, place.port.c_str(), &wanted, &found);
  if (error == 0) return Addresses(found, &freeaddrinfo);
  return fail(FailureKind::usage, fmt::format("{}: {}", place.host, gai_strerror(error)),
              "give HOST:PORT of who sends");
}

/// Whether a connection that was begun is there in time.
bool is_connected(int file, int wake) {
  std::array<pollfd, 2> watched = {{{file, POLLOUT, 0}, {wake, POLLIN, 0}}};
  if (poll(watched.data(), watched.size(), connect_within) <= 0 || watched[0].revents == 0) {
    errno = ETIMEDOUT;
    return false;
  }
  int error = 0;
  socklen_t size = sizeof error;
  if (getsockopt(file, SOL_SOCKET, SO_ERROR, &error, &size) != 0) return false;
  errno = error;
  return error == 0;
}

}  // namespace

Descriptor::~Descriptor() {
  if (file_ >= 0) close(file_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  const Descriptor former(std::exchange(file_, std::exchange(other.file_, -1)));
  return *this;
}

Result<Descriptor> listen_at_path(const std::string& path) {
  const Result<sockaddr_un> address = path_address(path);
  if (!address) return address.failure();
  if (std::optional<Failure> taken = make_room(path, address.value())) return *taken;
  Descriptor listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const mode_t others = umask(0077);  // whoever may move the instruments is whoever may read the user's files
  const bool bound = listener && ::bind(listener.get(), plain(address.value()), sizeof(sockaddr_un)) == 0;
  umask(others);
  if (bound && ::listen(listener.get(), 1) == 0) return listener;
  return fail(FailureKind::usage, fmt::format("cannot make a socket at {}: {}", path, why()),
              "give a path in a folder that can be written to");
}

Result<NetworkPlace> read_network_place(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  NetworkPlace place;
  place.port = text.substr(colon == std::string::npos ? 0 : colon + 1);
  place.host = colon == std::string::npos ? here : text.substr(0, colon);
  place.is_here = colon == std::string::npos || place.host == "*";
  unsigned port = 0;
  const char* const end = place.port.data() + place.port.size();
  const auto [stop, error] = std::from_chars(place.port.data(), end, port);
  if (error == std::errc() && stop == end && port <= 65535 && !place.host.empty()) return place;
  return fail(FailureKind::usage, fmt::format("\"{}\" is no port, nor HOST:PORT", text),
              "give 18944 to be connected to from this machine, *:18944 from others too, or tracker:18944");
}

Result<Descriptor> listen_at(const NetworkPlace& place, std::string& heard_at) {
  const Result<Addresses> addresses = addresses_of(place);
  if (!addresses) return addresses.failure();
  const addrinfo& address = *addresses->get();
  Descriptor listener(::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int yes = 1;
  setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_storage got = {};
  socklen_t size = sizeof got;
  std::array<char, 64> host = {}, port = {};
  if (!listener || ::bind(listener.get(), address.ai_addr, address.ai_addrlen) != 0 ||
      ::listen(listener.get(), 1) != 0 ||
      getsockname(listener.get(), reinterpret_cast<sockaddr*>(&got), &size) != 0)
    return fail(FailureKind::usage, fmt::format("cannot listen at port {}: {}", place.port, why()),
                "give a port that no other program has");
  getnameinfo(reinterpret_cast<const sockaddr*>(&got), size, host.data(), host.size(), port.data(),
              port.size(), NI_NUMERICHOST | NI_NUMERICSERV);
  heard_at = fmt::format("{}:{}", host.data(), port.data());
  return listener;
}

Result<Descriptor> connect_to(const NetworkPlace& place, int wake) {
  const Result<Addresses> addresses = addresses_of(place);
  if (!addresses) return addresses.failure();
  for (const addrinfo* address = addresses->get(); address != nullptr; address = address->ai_next) {
    Descriptor file(::socket(address->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (!file) continue;
    if (::connect(file.get(), address->ai_addr, address->ai_addrlen) == 0) return file;
    if (errno == EINPROGRESS && is_connected(file.get(), wake)) return file;
  }
  return fail(FailureKind::usage, fmt::format("cannot connect to {}:{}: {}", place.host, place.port, why()),
              "is the sender there, and does it listen at that port?");
}

Descriptor accept_from(int listener) { return Descriptor(accept4(listener, nullptr, nullptr, SOCK_CLOEXEC)); }

}  // namespace calot

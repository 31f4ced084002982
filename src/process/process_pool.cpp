#include "process/process_pool.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstring>

#include "process/exit_code.h"

namespace calot {
namespace {

/// False where the other end is gone.
bool send_all(int socket, const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = send(socket, bytes, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
  char* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = recv(socket, bytes, size, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

[[noreturn]] void serve(int socket, pid_t parent, const std::function<std::string(int)>& work) {
  // A terminal's interrupt reaches the whole group: the parent decides what becomes of its children.
  signal(SIGINT, SIG_IGN);
  signal(SIGTERM, SIG_DFL);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  ExitCode code = ExitCode::ok;
  try {  // nothing may unwind what the child has of its parent's
    for (int task = 0; getppid() == parent && receive_all(socket, &task, sizeof task);) {
      const std::string answer = work(task);
      const std::uint64_t size = answer.size();
      if (!send_all(socket, &size, sizeof size) || !send_all(socket, answer.data(), size)) break;
    }
  } catch (const std::bad_alloc&) {
    std::fputs("out of memory\n", stderr);
    code = ExitCode::resource;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = ExitCode::internal;
  }
  std::fflush(nullptr);
  _exit(static_cast<int>(code));
}

Failure death(int status) {
  if (WIFSIGNALED(status))
    return fail(FailureKind::internal,
                fmt::format("the process at work on it was ended by signal {} ({})", WTERMSIG(status),
                            strsignal(WTERMSIG(status))),
                WTERMSIG(status) == SIGKILL ? "memory may have run out: fewer at once with -j" : "");
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  const bool limit = code == static_cast<int>(ExitCode::resource);
  return fail(limit ? FailureKind::resource : FailureKind::internal,
              fmt::format("the process at work on it ended with exit code {}", code),
              limit ? "what it printed above says why" : "");
}

class Pool {
 public:
  Pool(int count, const PoolOptions& options, const std::function<std::string(int)>& work,
       const std::function<void(int, Result<std::string>)>& on_answer)
      : count_(count), options_(options), work_(work), on_answer_(on_answer) {}
  ~Pool() {
    for (const Child& child : children_) {
      kill(child.pid, SIGKILL);
      bury(child);
    }
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  Result<int> run() {
    while (!stopped() && (next_ < count_ || !children_.empty())) {
      while (next_ < count_ && static_cast<int>(children_.size()) < options_.processes && start()) {
      }
      if (children_.empty())
        return fail(FailureKind::resource, fmt::format("no process can be started: {}", std::strerror(errno)),
                    "end other programs, or raise the limit of processes (ulimit -u)");
      listen();
    }
    return done_;
  }

 private:
  struct Child {
    pid_t pid = -1;
    int socket = -1;
    int task = -1;
  };

  bool stopped() const { return options_.stop != nullptr && *options_.stop; }

  /// A child and its first task.
  bool start() {
    int sockets[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) return false;
    std::fflush(nullptr);  // what is buffered is printed once
    const pid_t parent = getpid(), pid = fork();
    if (pid < 0) {
      close(sockets[0]);
      close(sockets[1]);
      return false;
    }
    if (pid == 0) {
      close(sockets[0]);
      for (const Child& other : children_) close(other.socket);
      serve(sockets[1], parent, work_);
    }
    close(sockets[1]);
    children_.push_back({pid, sockets[0], -1});
    give_task(children_.back());
    return true;
  }

  /// The next task, or the end of its socket, which ends it.
  void give_task(Child& child) {
    child.task = next_ < count_ ? next_++ : -1;
    // A child that has died is noticed by its socket's end.
    if (child.task >= 0)
      send_all(child.socket, &child.task, sizeof child.task);
    else
      shutdown(child.socket, SHUT_WR);
  }

  void listen() {
    std::vector<pollfd> sockets;
    for (const Child& child : children_) sockets.push_back({child.socket, POLLIN, 0});
    if (poll(sockets.data(), sockets.size(), -1) < 0) return;  // a signal
    for (std::size_t i = sockets.size(); i-- > 0;)
      if (sockets[i].revents != 0) hear(i);
  }

  void hear(std::size_t index) {
    Child& child = children_[index];
    std::uint64_t size = 0;
    if (receive_all(child.socket, &size, sizeof size)) {
      std::string answer(size, '\0');
      if (receive_all(child.socket, answer.data(), size)) {
        const int task = child.task;
        give_task(child);  // it works while its answer is looked at
        return answered(task, std::move(answer));
      }
    }
    const int task = child.task, status = bury(child);
    children_.erase(children_.begin() + static_cast<std::ptrdiff_t>(index));
    if (task >= 0) answered(task, death(status));
  }

  void answered(int task, Result<std::string> answer) {
    ++done_;
    on_answer_(task, std::move(answer));
  }

  /// Its wait status, when its socket has ended: it has, or is about to.
  static int bury(const Child& child) {
    int status = 0;
    close(child.socket);
    waitpid(child.pid, &status, 0);
    return status;
  }

  int count_, next_ = 0, done_ = 0;
  const PoolOptions& options_;
  const std::function<std::string(int)>& work_;
  const std::function<void(int, Result<std::string>)>& on_answer_;
  std::vector<Child> children_;
};

}  // namespace

Result<int> work_in_processes(int count, const PoolOptions& options,
                              const std::function<std::string(int)>& work,
                              const std::function<void(int, Result<std::string>)>& on_answer) {
  return Pool(count, options, work, on_answer).run();
}

}  // namespace calot

#pragma once
// A browser without a window, spoken to over pipes in its DevTools protocol: what it says of a page.

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace calot::test {

/// What happened while a page was opened.
struct Opened {
  bool loaded = false;
  std::vector<std::string> requests;  ///< addresses asked for, but for the page itself and data in it
  std::vector<std::string> said;      ///< on the console, errors among them
  nlohmann::json found;               ///< the value of the expression
};

class Browser {
 public:
  /// `home` is a folder for what it keeps.
  explicit Browser(const std::filesystem::path& home) {
    int in[2] = {-1, -1}, out[2] = {-1, -1};
    if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0) return;
    process_ = fork();
    if (process_ == 0) run(home, in[0], out[1]);
    close(in[0]);
    close(out[1]);
    to_ = in[1];
    from_ = out[0];
    const nlohmann::json target = call("Target.createTarget", {{"url", "about:blank"}});
    if (!target.contains("targetId")) return;
    const nlohmann::json attached =
        call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}});
    if (attached.contains("sessionId")) session_ = attached["sessionId"];
    for (const char* domain : {"Page.enable", "Network.enable", "Log.enable", "Runtime.enable"})
      call(domain, {});
  }
  ~Browser() {
    if (process_ > 0) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
    close(to_);
    close(from_);
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  bool is_there() const { return !session_.empty(); }

  Opened open(const std::filesystem::path& page, const std::string& expression) {
    opened_ = {};
    page_ = "file://" + page.string();
    call("Page.navigate", {{"url", page_}});
    while (!opened_.loaded && !take().is_null()) {
    }
    const nlohmann::json answer = call(
        "Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
    if (answer.contains("result") && answer["result"].contains("value"))
      opened_.found = answer["result"]["value"];
    return opened_;
  }

 private:
  static constexpr int patience = 60'000;  // ms, for an answer

  [[noreturn]] static void run(const std::filesystem::path& home, int in, int out) {
    // It reads from 3 and writes to 4. The copies are out of the way of both.
    const int from = fcntl(in, F_DUPFD, 10), to = fcntl(out, F_DUPFD, 10);
    dup2(from, 3);
    dup2(to, 4);
    const int nothing = ::open("/dev/null", O_RDWR);
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
    const std::string folder = "--user-data-dir=" + home.string();
    execlp("chromium", "chromium", "--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe",
           "--no-first-run", "--disable-background-networking", folder.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }

  /// Its answer to one command; what happens meanwhile is noted.
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters) {
    nlohmann::json message = {{"id", ++calls_}, {"method", method}};
    message["params"] = parameters.is_null() ? nlohmann::json::object() : parameters;
    if (!session_.empty()) message["sessionId"] = session_;
    const std::string text = message.dump() + '\0';
    if (write(to_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) return {};
    for (;;) {
      const nlohmann::json answer = take();
      if (answer.is_null()) return {};
      if (answer.value("id", 0) == calls_) return answer.value("result", nlohmann::json::object());
    }
  }

  /// The next message; null where none comes.
  nlohmann::json take() {
    std::size_t end = 0;
    while ((end = held_.find('\0')) == std::string::npos) {
      pollfd watched{from_, POLLIN, 0};
      char part[1 << 14];
      if (poll(&watched, 1, patience) <= 0) return {};
      const ssize_t size = read(from_, part, sizeof part);
      if (size <= 0) return {};
      held_.append(part, static_cast<std::size_t>(size));
    }
    const nlohmann::json message = nlohmann::json::parse(held_.substr(0, end));
    held_.erase(0, end + 1);
    note(message.value("method", ""), message.value("params", nlohmann::json::object()));
    return message;
  }

  void note(const std::string& method, const nlohmann::json& parameters) {
    if (method == "Page.loadEventFired") opened_.loaded = true;
    if (method == "Network.requestWillBeSent") {
      const std::string address = parameters["request"]["url"];
      if (address != page_ && !address.starts_with("data:")) opened_.requests.push_back(address);
    }
    if (method == "Log.entryAdded" || method == "Runtime.exceptionThrown" ||
        method == "Runtime.consoleAPICalled")
      opened_.said.push_back(parameters.dump());
  }

  pid_t process_ = -1;
  int to_ = -1, from_ = -1, calls_ = 0;
  std::string session_, held_, page_;
  Opened opened_;
};

}  // namespace calot::test

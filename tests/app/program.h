#pragma once
// Runs the program as a user would: in a folder of its own, with its output caught.

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "base/hash.h"
#include "support/paths.h"
#include "support/text_files.h"

namespace calot::test {

namespace fs = std::filesystem;

inline std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

inline void spill(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

struct Outcome {
  int code = -1;  ///< exit code; 128 + signal where one ended the process
  std::string out, err;
};

/// A scenario on a small sphere that takes 0.6 s of simulated time. `steps` and `demo` are bodies in Lua.
inline std::string small_scenario(const std::string& steps = "t:step('move', 'Move about'); t:wait(0.6 * s)",
                                  const std::string& demo = "t.left:move_by({ 0, 0, -10 * mm })") {
  return R"(local calot = require "calot"
local mm, s = calot.units.mm, calot.units.s
return calot.exercise {
  api = 1, id = "small", title = "A small exercise", time_limit = 30 * s,
  params = { height = { type = "number", default = 10 } },
  scene = function()
    return {
      anatomy = { organs = { { name = "ball", shape = { type = "sphere" }, nodes = 61, held = { { landmark = "bed" } } } } },
      laparoscope = { port = "umbilical", look_at = "ball.fundus" },
      instruments = { left = { port = "right_subcostal" } },
    }
  end,
  steps = function(t) )" +
         steps + R"( end,
  demo = function(t) )" +
         demo + R"( end,
  score = calot.score.weighted {
    { calot.score.benchmark { metric = "left.path_length_mm", novice = 20, expert = 0 }, weight = 1 },
  },
  golden = { at = { 0, 0.4 * s } },
}
)";
}

/// The same, moving to and fro for longer than any test waits.
inline std::string endless_scenario() {
  std::string text =
      small_scenario("t:step('wait', 'Wait'); t:wait(2999 * s)",
                     "while true do t.left:move_by({ 0, 0, -5 * mm }); t.left:move_by({ 0, 0, 5 * mm }) end");
  text.replace(text.find("time_limit = 30 "), 16, "time_limit = 3000 ");
  return text;
}

class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override { spill(folder_ / "small.lua", small_scenario()); }

  /// Runs `calot` with these arguments in folder_; `meanwhile` sees the running process.
  Outcome calot(const std::vector<std::string>& arguments,
                const std::function<void(pid_t)>& meanwhile = {}) const {
    const fs::path out = folder_ / ".stdout", err = folder_ / ".stderr";
    const pid_t pid = fork();
    if (pid == 0) run_child(arguments, out, err);
    if (meanwhile) meanwhile(pid);
    int status = 0;
    waitpid(pid, &status, 0);
    Outcome outcome;
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = slurp(out);
    outcome.err = slurp(err);
    return outcome;
  }

  /// The recording with the checksum of what it now is.
  static std::string sealed(const std::string& text) {
    const std::size_t last = text.rfind('\n', text.size() - 2) + 1,
                      at = text.find("checksum\":\"", last) + 11;
    Hash hash;
    hash.add(std::string_view(text).substr(0, last));
    return text.substr(0, at) + hex(hash.value()) + text.substr(at + 16);
  }
  /// The same as if another session had been recorded; of a whole recording still with its checksum.
  static std::string of_session(std::string text, int number) {
    const std::string key = "\"session\":\"";
    const std::size_t at = text.find(key) + key.size();
    text.replace(at, 32, fmt::format("{:032x}", number));
    return text.find("\"checksum\":") == std::string::npos ? text : sealed(text);
  }
  /// Waits until a file has so many lines; false after 30 s.
  static bool wait_for_lines(const fs::path& file, std::ptrdiff_t lines) {
    for (int i = 0; i < 3000; ++i) {
      const std::string text = slurp(file);
      if (std::count(text.begin(), text.end(), '\n') >= lines) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  const Folder home_;
  fs::path folder_ = home_.path();

 private:
  [[noreturn]] void run_child(const std::vector<std::string>& arguments, const fs::path& out,
                              const fs::path& err) const {
    if (chdir(folder_.c_str()) != 0) _exit(125);
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), flags, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), flags, 0600), STDERR_FILENO);
    std::vector<std::string> words{program_path()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execv(program_path().c_str(), argv.data());
    _exit(126);
  }
};

/// Runs a line of shell in the test's folder; `$calot` is the program.
inline int shell(const fs::path& folder, const std::string& line) {
  const std::string words =
      "cd '" + folder.string() + "' && calot='" + program_path() + "' && { " + line + " ; } 2>.stderr";
  const int status = std::system(words.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// What every failure ends with.
inline void expect_next_command(const Outcome& outcome) {
  const std::size_t line = outcome.err.rfind("Next: ");
  ASSERT_NE(line, std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find('\n', line), outcome.err.size() - 1) << "something follows the next command:\n"
                                                                  << outcome.err;
}

}  // namespace calot::test

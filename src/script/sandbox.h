#pragma once
// A Lua state that a hostile script cannot get out of, hang or exhaust: capped memory, a budget of
// instructions that no pcall survives, text chunks only, a library without files, clocks and addresses, and a
// watchdog.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "base/status.h"
#include "script/limits.h"
#include "script/watchdog.h"

struct lua_State;
struct lua_Debug;

namespace calot {

/// Texts of script and modules by their paths, as they were read.
using ScriptTexts = std::map<std::filesystem::path, std::string>;

struct SandboxOptions {
  std::filesystem::path script;   ///< the scenario; its folder is the first that `require` looks into
  std::filesystem::path modules;  ///< the second; may be empty
  std::uint64_t seed = 1;         ///< of math.random
  ScriptLimits limits;
  ScriptTexts texts;  ///< taken from here, whatever has become of their files since; others are read
};

/// Which line of the author's is to mend what went wrong, and how the script came there: lines of text, each begins
/// with a new line.
struct Blame {
  Place place;  ///< nearest frame outside the project's modules; where there is none, the nearest frame
  std::string inside;   ///< the modules' lines that it has called, innermost first
  std::string callers;  ///< the lines that led to it, nearest first
};

class Sandbox {
 public:
  static Result<std::unique_ptr<Sandbox>> create(const SandboxOptions& options);
  ~Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;

  /// The sandbox that a running function belongs to.
  static Sandbox& of(lua_State* L);
  lua_State* state() const { return L_; }
  const SandboxOptions& options() const { return options_; }

  /// While one lives, the simulator is inside the script: a fresh budget per call, the watchdog armed. They
  /// nest.
  class Call {
   public:
    explicit Call(Sandbox& sandbox);
    ~Call();
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    Sandbox& sandbox_;
  };

  /// Runs `body` in protected mode inside a Call; the stack is left as it was.
  std::optional<Failure> protect(const std::function<void(lua_State*)>& body);

  /// A coroutine owned by the simulator: scripts cannot resume it. The function is a registry reference; what
  /// `push_arguments` pushes are the arguments of its first resume. The thread lives as long as the sandbox.
  Result<lua_State*> start_thread(int function, const std::function<void(lua_State*)>& push_arguments);
  /// The same for a thread made while L runs; empty: push its function.
  lua_State* adopt_thread(lua_State* L);
  /// Runs it to its next yield (false) or its end (true), with the top `arguments` values of its stack.
  Result<bool> resume(lua_State* thread, int arguments);
  bool owns(lua_State* thread) const;

  /// The text of a script, without a byte order mark. Failures: usage (it cannot be read), scenario (it is
  /// longer than 1 MiB, which names the line where it gets so, or no text).
  static Result<std::string> read_text(const std::filesystem::path& path);
  /// Pushes the compiled text of `path`, a text chunk. Raises a Lua error for what is wrong; call it
  /// protected.
  void push_chunk(lua_State* L, const std::filesystem::path& path);
  void push_chunk(lua_State* L, const std::filesystem::path& path, const std::string& text);
  /// All the text loaded so far, and its hash in the order of loading.
  const ScriptTexts& texts() const { return texts_; }
  std::uint64_t source_hash() const { return source_hash_.value(); }

  /// Takes instructions off the budget for work done in C++; raises the budget's error when it is used up.
  void charge(lua_State* L, std::int64_t instructions);
  /// Raises the memory limit's error unless so much more would fit below it: before C++ copies a script's values.
  void need_memory(lua_State* L, std::size_t bytes);
  /// The simulated time (s) that the coming calls belong to: each second has a budget of its own.
  void set_time(double time);
  /// For pcall and resume, of the error on top of the stack: raises it again when no script may survive it,
  /// else charges for it, because raising costs far more than an instruction.
  void survive_error(lua_State* L, int status);
  /// Notes that a script raises an error of its own making (error, assert), and tells, once, whether the last
  /// failure was one.
  void note_raise() { raised_ = true; }
  bool take_raised() { return std::exchange(raised_, false); }
  /// Where the script is now, should the watchdog have to say so.
  void note_place(lua_State* L);
  /// One line for `print`, up to a number of lines and bytes per run.
  void print(const std::string& line);
  /// While quiet, print says nothing.
  void set_quiet(bool quiet) { quiet_ = quiet; }
  Watchdog& watchdog() { return watchdog_; }

  /// The file that a function was written in, by its debug information ("S"); null: none of the script's.
  const std::string* file_of(const lua_Debug& info) const;
  /// A failure of a function, a registry reference, that was called: where only modules' lines are known, because it
  /// went on to them by a last call, it is where the function was written.
  Failure laid_at(Failure failure, int function) const;
  /// The author's line that runs in L. Callers are told only of a line in a module of the author's.
  Blame blame(lua_State* L) const;

 private:
  enum class Trip { none, call, second, run, memory };
  explicit Sandbox(const SandboxOptions& options);
  static void* allocate(void* sandbox, void* block, std::size_t old_size, std::size_t new_size);
  static void on_count(lua_State* L, lua_Debug*);
  static int collect_trace(lua_State* L);
  static int call_body(lua_State* L);

  void spend(std::int64_t instructions);
  [[noreturn]] void raise_trip(lua_State* L);
  std::string trip_text() const;
  std::vector<Place> trace_of(lua_State* L) const;
  /// Whether it lies in a module of the project's, which its users are not to mend.
  bool is_shared(const Place& place) const;
  Blame blame(std::span<const Place> trace) const;
  /// From the error on top of L's stack and trace_.
  Failure failure_of(lua_State* L, int status) const;
  bool split_place(std::string& message, Place& place) const;

  SandboxOptions options_;
  lua_State* L_ = nullptr;
  std::size_t memory_ = 0;
  std::int64_t used_in_call_ = 0, used_in_second_ = 0, used_in_run_ = 0;
  double second_ = 0;  ///< s, whole: the simulated second that is running
  int calls_ = 0;      ///< depth of nested Calls
  int printed_ = 0;
  std::size_t printed_bytes_ = 0;
  bool raised_ = false;
  bool quiet_ = false;
  Trip trip_ = Trip::none;
  std::vector<Place> trace_;                  ///< of the last error, innermost first
  std::map<std::string, std::string> files_;  ///< Lua's short names of chunks to paths
  std::vector<lua_State*> threads_;
  ScriptTexts texts_;
  Hash source_hash_;
  Watchdog watchdog_;
};

}  // namespace calot

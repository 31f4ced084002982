#include "script/sandbox.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <span>
#include <stdexcept>

#include "base/log.h"
#include "base/suggest.h"
#include "script/lua_headers.h"
#include "script/safe_path.h"
#include "script/sandbox_library.h"

namespace calot {
namespace {

constexpr int hook_interval = 1000;       // instructions between two looks at the budget
constexpr int error_cost = 1000;          // instructions that raising and catching an error counts for
constexpr int longest_trace = 8;          // frames
constexpr int most_printed_lines = 1000;  // of a run
constexpr std::size_t most_printed_bytes = 1 << 18;  // of a run
constexpr std::size_t longest_file = 1 << 20;        // bytes of one file
constexpr std::size_t longest_message = 2000;        // bytes of an error's text

std::string text_at_top(lua_State* L) {
  const int type = lua_type(L, -1);
  if (type == LUA_TNUMBER) return fmt::format("{:g}", lua_tonumber(L, -1));
  if (type == LUA_TSTRING) {
    std::size_t length = 0;
    const char* text = lua_tolstring(L, -1, &length);
    return shortened({text, length}, longest_message);
  }
  return fmt::format("an error that is no text was raised (a {} value)", lua_typename(L, type));
}

/// The lines of a trace, a line of text each, which begins with a new line and with what they are to the place.
std::string lines_of(std::span<const Place> trace, std::string_view what) {
  std::string text;
  for (const Place& place : trace) text += fmt::format("\n    {} {}:{}", what, place.file, place.line);
  return text;
}

}  // namespace

Sandbox::Sandbox(const SandboxOptions& options)
    : options_(options),
      watchdog_(options.script.string(), options.limits.call_seconds, options.limits.exit_code) {}

Sandbox::~Sandbox() {
  if (L_ != nullptr) lua_close(L_);
}

Result<std::unique_ptr<Sandbox>> Sandbox::create(const SandboxOptions& options) {
  std::unique_ptr<Sandbox> sandbox(new Sandbox(options));
  sandbox->L_ = lua_newstate(allocate, sandbox.get());
  if (sandbox->L_ == nullptr) {
    return fail(FailureKind::resource, "no memory for a Lua state",
                fmt::format("a memory limit of {} bytes is too small", options.limits.memory));
  }
  Sandbox* self = sandbox.get();
  *static_cast<Sandbox**>(lua_getextraspace(self->L_)) = self;  // threads made from it get a copy
  lua_sethook(self->L_, on_count, LUA_MASKCOUNT, hook_interval);
  std::optional<Failure> failure = self->protect([&](lua_State* L) { open_library(L, options.seed); });
  if (failure) return *failure;
  return sandbox;
}

Sandbox& Sandbox::of(lua_State* L) { return **static_cast<Sandbox**>(lua_getextraspace(L)); }

void* Sandbox::allocate(void* sandbox, void* block, std::size_t old_size, std::size_t new_size) {
  Sandbox& self = *static_cast<Sandbox*>(sandbox);
  const std::size_t before = block != nullptr ? old_size : 0;  // without a block Lua passes a type here
  if (new_size == 0) {
    std::free(block);
    self.memory_ -= before;
    return nullptr;
  }
  if (new_size > before && self.memory_ - before + new_size > self.options_.limits.memory) return nullptr;
  void* const fresh = std::realloc(block, new_size);
  if (fresh != nullptr) self.memory_ = self.memory_ - before + new_size;
  return fresh;
}

// ---- budget

Sandbox::Call::Call(Sandbox& sandbox) : sandbox_(sandbox) {
  if (sandbox_.calls_++ > 0) return;
  sandbox_.used_in_call_ = 0;
  sandbox_.watchdog_.arm();
}

Sandbox::Call::~Call() {
  if (--sandbox_.calls_ == 0) sandbox_.watchdog_.disarm();
}

void Sandbox::spend(std::int64_t instructions) {
  used_in_call_ += instructions;
  used_in_second_ += instructions;
  used_in_run_ += instructions;
  if (trip_ != Trip::none) return;
  if (used_in_run_ > options_.limits.instructions_per_run) trip_ = Trip::run;
  if (used_in_second_ > options_.limits.instructions_per_second) trip_ = Trip::second;
  if (used_in_call_ > options_.limits.instructions_per_call) trip_ = Trip::call;
}

std::string Sandbox::trip_text() const {
  switch (trip_) {
    case Trip::none:
      return {};
    case Trip::call:
      return fmt::format(
          "the script ran for more than {} instructions without waiting: a loop that does not end?",
          options_.limits.instructions_per_call);
    case Trip::second:
      return fmt::format("the script ran for more than {} instructions in one simulated second",
                         options_.limits.instructions_per_second);
    case Trip::run:
      return fmt::format("the script ran for more than {} instructions in all",
                         options_.limits.instructions_per_run);
    case Trip::memory:
      return fmt::format("the script needs more than {:.1f} MiB of memory",
                         static_cast<double>(options_.limits.memory) / (1 << 20));
  }
  return {};
}

/// Sticky: from now on each instruction of any thread that gets to run raises it again.
void Sandbox::raise_trip(lua_State* L) {
  lua_sethook(L, on_count, LUA_MASKCOUNT, 1);
  luaL_where(L, 0);  // level 1 has no position at top level
  lua_pushstring(L, trip_text().c_str());
  lua_concat(L, 2);
  lua_error(L);
  std::abort();  // lua_error does not return
}

void Sandbox::on_count(lua_State* L, lua_Debug*) {
  Sandbox& self = of(L);
  self.note_place(L);
  self.spend(lua_gethookcount(L));
  if (self.trip_ != Trip::none) self.raise_trip(L);
}

void Sandbox::charge(lua_State* L, std::int64_t instructions) {
  spend(instructions);
  if (trip_ != Trip::none) raise_trip(L);
}

void Sandbox::need_memory(lua_State* L, std::size_t bytes) {
  const std::size_t limit = options_.limits.memory;
  if (bytes <= limit && memory_ <= limit - bytes) return;
  if (trip_ == Trip::none) trip_ = Trip::memory;
  raise_trip(L);
}

void Sandbox::set_time(double time) {
  if (std::floor(time) == second_) return;
  second_ = std::floor(time);
  used_in_second_ = 0;
  watchdog_.refill();
}

void Sandbox::survive_error(lua_State* L, int status) {
  if (status == LUA_ERRMEM) trip_ = Trip::memory;
  raised_ = false;
  if (trip_ == Trip::none) return charge(L, error_cost);
  lua_sethook(L, on_count, LUA_MASKCOUNT, 1);
  lua_error(L);
}

// ---- calls

int Sandbox::call_body(lua_State* L) {
  const auto* body = static_cast<const std::function<void(lua_State*)>*>(lua_touserdata(L, 1));
  lua_settop(L, 0);
  try {
    (*body)(L);
    return 0;
  } catch (const std::exception& error) {
    lua_pushstring(L, error.what());
  }
  return lua_error(L);
}

int Sandbox::collect_trace(lua_State* L) {
  Sandbox& self = of(L);
  try {
    self.trace_ = self.trace_of(L);
  } catch (const std::exception&) {
    self.trace_.clear();  // no memory left for it: the error itself still gets through
  }
  return 1;
}

std::optional<Failure> Sandbox::protect(const std::function<void(lua_State*)>& body) {
  const Call call(*this);
  trace_.clear();
  raised_ = false;
  const int top = lua_gettop(L_);
  lua_pushcfunction(L_, collect_trace);
  lua_pushcfunction(L_, call_body);
  lua_pushlightuserdata(L_, const_cast<std::function<void(lua_State*)>*>(&body));
  const int status = lua_pcall(L_, 1, 0, top + 1);
  std::optional<Failure> failure;
  if (status != LUA_OK) failure = failure_of(L_, status);
  lua_settop(L_, top);
  return failure;
}

Result<lua_State*> Sandbox::start_thread(int function,
                                         const std::function<void(lua_State*)>& push_arguments) {
  lua_State* thread = nullptr;
  std::optional<Failure> failure = protect([&](lua_State* L) {
    thread = adopt_thread(L);
    lua_rawgeti(L, LUA_REGISTRYINDEX, function);
    push_arguments(L);
    lua_xmove(L, thread, lua_gettop(L));
  });
  if (failure) return *failure;
  return thread;
}

lua_State* Sandbox::adopt_thread(lua_State* L) {
  lua_State* thread = lua_newthread(L);
  luaL_ref(L, LUA_REGISTRYINDEX);
  threads_.push_back(thread);
  return thread;
}

Result<bool> Sandbox::resume(lua_State* thread, int arguments) {
  const Call call(*this);
  trace_.clear();
  raised_ = false;
  int results = 0;
  const int status = lua_resume(thread, L_, arguments, &results);
  if (status == LUA_OK || status == LUA_YIELD) {
    lua_pop(thread, results);
    return status == LUA_OK;
  }
  trace_ = trace_of(thread);
  return failure_of(thread, status);
}

bool Sandbox::owns(lua_State* thread) const {
  return std::find(threads_.begin(), threads_.end(), thread) != threads_.end();
}

// ---- text

Result<std::string> Sandbox::read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(longest_file + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  const Place place{path.string(), 0, {}};
  if (file.bad() || (!file.eof() && file.fail()))
    return fail(FailureKind::usage, "the file cannot be read", "check who may read it", place);
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > longest_file) {
    const auto lines = std::count(text.begin(), text.end() - 1, '\n');
    return fail(FailureKind::scenario, "a script has at most 1 MiB, and this one has more from this line on",
                "move what is large into modules", {path.string(), static_cast<int>(lines) + 1, {}});
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // a byte order mark: some editors write one
  if (!text.empty() && text.front() == LUA_SIGNATURE[0])
    return fail(FailureKind::scenario, "this is compiled Lua (bytecode); scripts are text", "give the source",
                {path.string(), 1, {}});
  return text;
}

void Sandbox::push_chunk(lua_State* L, const std::filesystem::path& path) {
  if (const auto known = options_.texts.find(path); known != options_.texts.end())
    return push_chunk(L, path, known->second);
  const Result<std::string> text = read_text(path);
  if (!text) throw std::runtime_error(to_text(text.failure()));
  push_chunk(L, path, text.value());
}

void Sandbox::push_chunk(lua_State* L, const std::filesystem::path& path, const std::string& text) {
  texts_[path] = text;
  source_hash_.add(std::uint64_t{text.size()});
  source_hash_.add(std::string_view(text));
  const std::string name = fmt::format("@{}", path.string());
  // Lua shortens long names in its messages; remember what each short name stands for. An empty chunk has it
  // too.
  if (luaL_loadbufferx(L, "", 0, name.c_str(), "t") != LUA_OK) lua_error(L);
  lua_Debug info;
  lua_getinfo(L, ">S", &info);
  const std::string& file = files_.emplace(info.short_src, path.string()).first->second;
  watchdog_.note_place(file, 1);  // of a chunk that compiles for ever Lua tells no line
  if (luaL_loadbufferx(L, text.data(), text.size(), name.c_str(), "t") != LUA_OK) lua_error(L);
}

void Sandbox::print(const std::string& line) {
  if (quiet_ || printed_ < 0) return;
  ++printed_;
  printed_bytes_ += line.size();
  if (printed_ <= most_printed_lines && printed_bytes_ <= most_printed_bytes) return log_info(line);
  printed_ = -1;
  log_info(fmt::format("the script has printed {} lines or {} KiB; the rest is dropped", most_printed_lines,
                       most_printed_bytes >> 10));
}

// ---- errors

const std::string* Sandbox::file_of(const lua_Debug& info) const {
  const auto file = files_.find(info.short_src);
  return file != files_.end() ? &file->second : nullptr;  // none of C++ and the library's own Lua
}

std::vector<Place> Sandbox::trace_of(lua_State* L) const {
  std::vector<Place> trace;
  lua_Debug info;
  for (int level = 0; lua_getstack(L, level, &info) != 0; ++level) {
    lua_getinfo(L, "Sl", &info);
    const std::string* file = file_of(info);
    if (file == nullptr) continue;
    if (static_cast<int>(trace.size()) == longest_trace) break;
    trace.push_back({*file, info.currentline, {}});
  }
  return trace;
}

bool Sandbox::is_shared(const Place& place) const {
  return !options_.modules.empty() && place.file != options_.script.string() &&
         is_inside(place.file, options_.modules);
}

Blame Sandbox::blame(std::span<const Place> trace) const {
  if (trace.empty()) return {{options_.script.string(), 0, {}}, {}, {}};
  auto author =
      std::find_if(trace.begin(), trace.end(), [&](const Place& place) { return !is_shared(place); });
  if (author == trace.end()) author = trace.begin();
  return {*author, lines_of({trace.begin(), author}, "inside"),
          lines_of({author + 1, trace.end()}, "called from")};
}

Failure Sandbox::laid_at(Failure failure, int function) const {
  lua_Debug info;
  lua_rawgeti(L_, LUA_REGISTRYINDEX, function);
  lua_getinfo(L_, ">S", &info);
  const std::string* file = file_of(info);
  if (file == nullptr || is_shared({*file, 0, {}})) return failure;
  for (Problem& problem : failure.problems) {
    if (!is_shared(problem.place)) continue;
    problem.message += lines_of({&problem.place, 1}, "inside");
    problem.place = {*file, std::max(0, info.linedefined), {}};
  }
  return failure;
}

Blame Sandbox::blame(lua_State* L) const {
  Blame found = blame(trace_of(L));
  if (found.place.file == options_.script.string()) found.callers.clear();
  return found;
}

void Sandbox::note_place(lua_State* L) {
  lua_Debug info;
  for (int level = 0; lua_getstack(L, level, &info) != 0; ++level) {
    lua_getinfo(L, "Sl", &info);
    if (const std::string* file = file_of(info)) return watchdog_.note_place(*file, info.currentline);
  }
}

/// Cuts "file:line: " off the message, once or more often (nested errors), and keeps the innermost.
bool Sandbox::split_place(std::string& message, Place& place) const {
  bool found = false;
  for (bool again = true; again;) {
    again = false;
    for (const auto& [name, path] : files_) {
      if (!message.starts_with(name + ":")) continue;
      const std::size_t start = name.size() + 1, colon = message.find(':', start);
      if (colon == std::string::npos || colon == start) continue;
      if (message.find_first_not_of("0123456789", start) != colon) continue;
      place = {path, std::atoi(message.c_str() + start), {}};
      message.erase(0, std::min(message.size(), colon + 2));
      again = found = true;
      break;
    }
  }
  return found;
}

Failure Sandbox::failure_of(lua_State* L, int status) const {
  std::string message = text_at_top(L);
  const std::string prelude = fmt::format("{}:", prelude_name);
  if (message.starts_with(prelude)) message.erase(0, message.find(' ') + 1);
  Place place;
  if (!split_place(message, place) && !trace_.empty()) place = trace_.front();
  if (place.file.empty()) place.file = options_.script.string();
  FailureKind kind = FailureKind::scenario;
  std::string hint;
  if (trip_ != Trip::none) {
    kind = FailureKind::resource;
    message = trip_text();
    hint = trip_ == Trip::memory ? "keep less data" : "let loops end or call t:wait inside them";
  } else if (status == LUA_ERRMEM) {
    kind = FailureKind::resource;
    message = fmt::format("the script needs more than {:.1f} MiB of memory",
                          static_cast<double>(options_.limits.memory) / (1 << 20));
    hint = "keep less data";
  } else if (status == LUA_ERRERR || message.find("stack overflow") != std::string::npos) {
    kind = FailureKind::resource;
    message = "calls are nested too deep (stack overflow)";
    hint = "let the recursion end, or use a loop";
  }
  // What lies within the place's own call has put the blame on its caller.
  auto own = std::find_if(trace_.begin(), trace_.end(), [&](const Place& called) {
    return called.file == place.file && called.line == place.line;
  });
  if (own == trace_.end() && is_shared(place)) own = trace_.begin();
  const Blame blamed = blame({own, trace_.end()});
  if (own == trace_.end()) return fail(kind, std::move(message), std::move(hint), std::move(place));
  message += blamed.inside;
  if (kind == FailureKind::scenario) message += blamed.callers;
  return fail(kind, std::move(message), std::move(hint), blamed.place);
}

}  // namespace calot

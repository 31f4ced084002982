// Hostile scripts end with a clear error of the right kind, wherever they hide their loop.

#include "script/sandbox.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "base/log.h"
#include "script/lua_headers.h"
#include "script/sandbox_library.h"
#include "support/text_files.h"

namespace calot {
namespace {

using test::Folder;

struct Attack {
  const char* name;
  const char* script;
};

/// A script alone in its sandbox.
class Script {
 public:
  explicit Script(const std::string& text, SandboxOptions options = {},
                  const std::string& name = "attack.lua")
      : file_(folder_.write(name, text)) {
    options.script = file_;
    sandbox_ = Sandbox::create(options).value();
  }

  Sandbox& sandbox() { return *sandbox_; }
  /// Runs a file as a chunk of its own.
  std::optional<Failure> call(const std::filesystem::path& file) {
    return sandbox_->protect([&](lua_State* L) {
      sandbox_->push_chunk(L, file);
      lua_call(L, 0, 0);
    });
  }
  std::optional<Failure> call() { return call(file_); }
  std::filesystem::path add_file(const std::string& name, const std::string& text) {
    return folder_.write(name, text);
  }
  const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  Folder folder_;
  std::filesystem::path file_;
  std::unique_ptr<Sandbox> sandbox_;
};

std::optional<Failure> run(const std::string& text, const ScriptLimits& limits = {}) {
  SandboxOptions options;
  options.limits = limits;
  return Script(text, options).call();
}

constexpr const char* counting_loop = "for i = 1, 100000 do end";  // a bit over 100,000 instructions

class EndlessLoops : public ::testing::TestWithParam<Attack> {};

TEST_P(EndlessLoops, EndAsResourceFailuresThatNameTheScript) {
  const std::optional<Failure> failure = run(GetParam().script);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, FailureKind::resource) << to_text(*failure);
  EXPECT_NE(to_text(*failure).find("attack.lua"), std::string::npos) << to_text(*failure);
  EXPECT_NE(to_text(*failure).find("instructions"), std::string::npos) << to_text(*failure);
}

INSTANTIATE_TEST_SUITE_P(
    Sandbox, EndlessLoops,
    ::testing::Values(
        Attack{"Plain", "while true do end"},
        Attack{"InPcall", "while true do pcall(function() while true do end end) end"},
        Attack{"InNestedPcalls", "local function f() pcall(f) while true do pcall(f) end end f()"},
        Attack{"InXpcallHandler", "xpcall(error, function() while true do end end)"},
        Attack{"InXpcall",
               "while true do xpcall(function() while true do end end, function() return 1 end) end"},
        Attack{"InSortComparator",
               "local t = {} for i = 1, 100 do t[i] = i end\n"
               "table.sort(t, function(a, b) while true do end end)"},
        Attack{"InMetamethod",
               "local t = setmetatable({}, { __add = function() while true do end end }) local _ = t + t"},
        Attack{"InTostring", "print(setmetatable({}, { __tostring = function() while true do end end }))"},
        Attack{"InPairs", "pairs(setmetatable({}, { __pairs = function() while true do end end }))"},
        Attack{"InManyCoroutines",
               "while true do local c = coroutine.wrap(function() for i = 1, 500 do end end) c() end"},
        Attack{"InCoroutineThatIsResumed",
               "local c = coroutine.create(function() while true do coroutine.yield() end end)\n"
               "while true do coroutine.resume(c) end"},
        Attack{"InCoroutineWithinPcall",
               "while true do pcall(coroutine.wrap(function() while true do end end)) end"},
        Attack{"InRepOfNothing", "local _ = string.rep('', 1e18)"},
        Attack{"InRepOfNothingAgain", "for _ = 1, 1e9 do local _ = (''):rep(1e6) end"},
        Attack{"InMove", "table.move({}, 1, 1e15, 2)"},
        Attack{"InMoveOverAllIntegers", "table.move({}, -1, math.maxinteger - 1, 0)"},
        Attack{"InInsert",
               "local t = setmetatable({}, { __len = function() return 1e15 end }) table.insert(t, 1, 1)"},
        Attack{"InRemove",
               "local t = setmetatable({}, { __len = function() return 1e15 end }) table.remove(t, 1)"},
        Attack{"InGsubCallback", "string.gsub('x', '.', function() while true do end end)"}),
    [](const auto& attack) { return std::string(attack.param.name); });

TEST(Sandbox, ALongListIsBuiltAndMovedWithinTheBudget) {
  const std::optional<Failure> failure = run(R"(
    local list = {}
    for i = 1, 20000 do table.insert(list, i / 2) end
    for i = 1, 100 do table.insert(list, 1, i) table.remove(list, 1) end
    list = table.move(list, 1, #list, 1, {})
    assert(#list == 20000 and #string.rep("x", 1000000) == 1000000))");
  EXPECT_FALSE(failure) << to_text(*failure);
}

TEST(Sandbox, WhatLoopsStillNamesItsFunctionWhereItIsMisused) {
  for (const char* misuse : {"string.rep({}, 2)", "table.move(1, 1, 2, 3)", "table.insert({}, 5, 1)"}) {
    const std::optional<Failure> failure = run(misuse);
    ASSERT_TRUE(failure) << misuse;
    const std::string name = std::string(misuse).substr(std::string(misuse).find('.') + 1);
    EXPECT_NE(to_text(*failure).find("'" + name.substr(0, name.find('(')) + "'"), std::string::npos)
        << to_text(*failure);
  }
}

TEST(Sandbox, RefusesFinalisersClosersAndWeakTables) {
  for (const char* key : {"__gc", "__close", "__mode"}) {
    const std::optional<Failure> failure =
        run("setmetatable({}, { " + std::string(key) + " = function() while true do end end })");
    ASSERT_TRUE(failure) << key;
    EXPECT_EQ(failure->kind, FailureKind::scenario);
    EXPECT_NE(to_text(*failure).find(key), std::string::npos) << to_text(*failure);
  }
}

TEST(Sandbox, NoMetamethodGivenLateShowsWhenMemoryIsCollected) {
  // Each way in which a metatable in use can be written to; then enough garbage for several collections.
  for (const char* late :
       {"mt.__mode = 'k' mt.__gc = closer mt.__close = closer",
        "rawset(mt, '__mode', 'k') rawset(mt, '__gc', closer) rawset(mt, '__close', closer)",
        "getmetatable(keep).__mode = 'k' getmetatable(keep).__close = closer",
        "table.move({ 'k' }, 1, 1, 1, mt) mt['__' .. 'mode'] = 'k' mt['__clo' .. 'se'] = closer"}) {
    const std::optional<Failure> failure =
        run("local closed = false local function closer() closed = true end\n"
            "local mt = {} local keep = setmetatable({}, mt)\n"
            "keep[{}] = 1\n" +
            std::string(late) +
            R"(
      setmetatable({}, mt == 0 and mt or {})
      for i = 1, 200000 do local _ = { i } end
      local function entries(t) local n = 0 for _ in pairs(t) do n = n + 1 end return n end
      local counted, why = pcall(entries, keep)
      assert(not counted and why:find("no fixed order"), "the table has lost its entry")
      local done, message = pcall(function() local x <close> = keep end)
      assert(not done and message:find("non%-closable"), message)
      done = pcall(function() for _ in function() end, nil, nil, keep do end end)
      assert(not done and not closed)
      done, message = pcall(setmetatable, {}, mt)
      assert(not done and message:find("not available"), message))");
    EXPECT_FALSE(failure) << late << "\n" << to_text(*failure);
  }
}

TEST(Sandbox, ClassesWorkAsTheyDoInLua) {
  const char* code = R"(
    local Base = {} Base.__index = Base
    function Base.new(class, n) return setmetatable({ n = n }, class) end
    local Class = setmetatable({}, { __index = Base, __call = function(class, n) return class:new(n) end })
    Class.__index = Class
    local a = Class(1)
    function Class:twice() return 2 * self.n end        -- methods and metamethods may come late
    Class.__add = function(x, y) return Class(x.n + y.n) end
    Class.__eq = function(x, y) return x.n == y.n end
    Class.__lt = function(x, y) return x.n < y.n end
    Class.__le = function(x, y) return x.n <= y.n end
    Class.__concat = function(x, y) return tostring(x) .. tostring(y) end
    Class.__tostring = function(x) return "<" .. x.n .. ">" end
    Class.__unm = function(x) return Class(-x.n) end
    Class.__len = function() return 7 end
    Class.__shl = function(x, by) return Class(x.n << by) end
    Class.__pairs = function(x) return function(_, k) if not k then return 1, x.n end end, x, nil end
    local b = Class(2)
    assert(a:twice() == 2 and (a + b).n == 3 and a ~= b and a == Class(1) and a < b and a <= b and b > a)
    assert(a .. b == "<1><2>" and "x" .. a == "x<1>" and (-a).n == -1 and #a == 7 and (b << 2).n == 8)
    assert(string.format("%s", b) == "<2>")
    for k, v in pairs(b) do assert(k == 1 and v == 2) end
    assert(getmetatable(a) == Class and getmetatable(Class).__index == Base and getmetatable({}) == nil)
    -- absent metamethods are as absent as in Lua
    local plain = setmetatable({ 1, 2, 3 }, {})
    assert(#plain == 3 and plain.x == nil and plain ~= setmetatable({}, getmetatable(plain)))
    plain.x = 1 assert(rawget(plain, "x") == 1)
    for _, wrong in ipairs({ function() return plain + 1 end, function() return plain() end,
                             function() return plain < plain end, function() return plain .. "" end,
                             function() return ~plain end }) do
      local done, why = pcall(wrong)
      assert(not done and why:find("table value"), why)
    end
    -- a writer, and one that is a table; callers with any number of values; waits inside
    local log = {}
    local watched = setmetatable({}, { __newindex = function(t, k, v) log[#log + 1] = k rawset(t, k, v) end })
    watched.a = 1 watched.a = 2 watched.b = 3
    assert(table.concat(log) == "ab" and watched.a == 2)
    local behind = {} local front = setmetatable({}, { __newindex = behind, __index = behind })
    front.z = 5 assert(rawget(front, "z") == nil and behind.z == 5 and front.z == 5)
    local callable = setmetatable({}, { __call = function(_, ...) return select("#", ...), ... end })
    assert(select("#", callable(1, nil, 3)) == 4)
    local lazy = setmetatable({}, { __index = function(_, k) return coroutine.yield(k) end })
    local c = coroutine.wrap(function() return lazy.key end)
    assert(c() == "key" and c(9) == 9)
    -- protection
    local locked = setmetatable({}, { __metatable = "locked" })
    assert(getmetatable(locked) == "locked" and not pcall(setmetatable, locked, {}))
    assert(getmetatable(setmetatable(setmetatable({}, {}), nil)) == nil))";
  const std::optional<Failure> failure = run(code);
  EXPECT_FALSE(failure) << to_text(*failure);
}

TEST(Sandbox, PrintsAreBoundedByLinesBytesAndWidth) {
  std::size_t lines = 0, bytes = 0;
  LogSink before = set_log_sink([&](LogLevel, const std::string& text) {
    ++lines;
    bytes += text.size();
    EXPECT_LE(text.size(), 4100u);
  });
  const std::optional<Failure> failure =
      run("local wide = string.rep('x', 1000000) print(wide, wide, wide)\n"
          "for i = 1, 5000 do print(string.rep('y', 3000)) end");
  set_log_sink(std::move(before));
  EXPECT_FALSE(failure) << to_text(*failure);
  EXPECT_LT(lines, 1002u);
  EXPECT_LT(bytes, 300'000u);
}

TEST(Sandbox, ErrorsOfAnySizeAreToldInShort) {
  const std::optional<Failure> failure = run("error(string.rep('x', 10000000))");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->problems[0].place.line, 1);
  EXPECT_LT(to_text(*failure).size(), 3000u);
}

TEST(Sandbox, LibraryCallsOverLongTextsCountAsInstructions) {
  const std::optional<Failure> failure =
      run("local long = string.rep('x', 1 << 20)\nwhile true do string.find(long, 'y', 1, true) end");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, FailureKind::resource);
  EXPECT_EQ(failure->problems[0].place.line, 2) << to_text(*failure);
}

TEST(Sandbox, BudgetIsPerSimulatedSecond) {
  SandboxOptions options;
  options.limits.instructions_per_second = 450'000;  // four runs
  Script script(counting_loop, options);
  std::optional<Failure> failure;
  const auto call = [&](double time) {
    script.sandbox().set_time(time);
    failure = script.call();
  };
  for (int i = 0; i < 30; ++i) {
    call(0.25 * i);
    ASSERT_FALSE(failure) << i << ": " << to_text(*failure);
  }
  for (int i = 0; i < 5 && !failure; ++i) call(100);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, FailureKind::resource);
  EXPECT_NE(to_text(*failure).find("one simulated second"), std::string::npos) << to_text(*failure);
}

TEST(Sandbox, SkipsAByteOrderMark) {
  EXPECT_FALSE(run("\xEF\xBB\xBFlocal x = 1"));
  const std::optional<Failure> failure = run("\xEF\xBB\xBF\nerror('here')");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->problems[0].place.line, 2);
}

class MemoryBombs : public ::testing::TestWithParam<Attack> {};

TEST_P(MemoryBombs, EndAsResourceFailures) {
  ScriptLimits limits;
  limits.memory = std::size_t{32} << 20;  // smaller than the default, so that the test is quick
  const std::optional<Failure> failure = run(GetParam().script, limits);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, FailureKind::resource) << to_text(*failure);
}

INSTANTIATE_TEST_SUITE_P(
    Sandbox, MemoryBombs,
    ::testing::Values(
        Attack{"Doubling", "local s = 'x' while true do s = s .. s end"},
        Attack{"Repetition", "local s = string.rep('x', 1 << 30)"},
        Attack{"WithinPcall", "while true do pcall(string.rep, 'x', 1 << 30) end"},
        Attack{"Tables", "local t = {} for i = 1, 1e9 do t[i] = { i } end"},
        Attack{"Concatenation",
               "local t = {} for i = 1, 1000 do t[i] = string.rep('x', 60000) end table.concat(t)"},
        Attack{"Coroutines",
               "local t = {} for i = 1, 1e9 do t[i] = coroutine.create(function() end) "
               "coroutine.resume(t[i]) end"},
        Attack{"Recursion", "local function f() return 1 + f() end f()"},
        Attack{"WidePairs", "local t = {} for i = 1, 1000000 do t[i] = true end pairs(t)"},
        Attack{
            "RecursionThroughMetamethods",
            "local t = setmetatable({}, {}) getmetatable(t).__index = function(s, k) return s[k .. 'x'] end\n"
            "local _ = t.x"},
        Attack{"NestedCoroutines", "local function f() coroutine.wrap(f)() end f()"},
        Attack{"NestedPcalls",
               "local function f() local ok, e = pcall(f) if not ok then error(e, 0) end end f()"}),
    [](const auto& attack) { return std::string(attack.param.name); });

TEST(Sandbox, RefusesBytecode) {
  const std::optional<Failure> failure = run(std::string("\x1bLua", 4) + "T");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, FailureKind::scenario);
  EXPECT_NE(to_text(*failure).find("bytecode"), std::string::npos) << to_text(*failure);
}

TEST(Sandbox, HidesWhatReachesOutside) {
  for (const char* name : {"os", "io", "debug", "package", "load", "loadstring", "loadfile", "dofile",
                           "collectgarbage", "next", "_G"}) {
    const std::optional<Failure> failure = run("\nlocal x = " + std::string(name));
    ASSERT_TRUE(failure) << name;
    EXPECT_EQ(failure->kind, FailureKind::scenario);
    EXPECT_EQ(failure->problems[0].place.line, 2) << to_text(*failure);
    EXPECT_NE(to_text(*failure).find("not available"), std::string::npos) << to_text(*failure);
  }
  for (const char* code :
       {"assert(string.dump == nil)", "assert(('').dump == nil)", "assert(coroutine.close == nil)",
        "assert(math.randomseed == nil)", "assert(getmetatable('') == false)",
        "assert(rawget(_ENV, 'os') == nil)", "assert(not pcall(string.format, '%p', {}))"}) {
    const std::optional<Failure> failure = run(code);
    EXPECT_FALSE(failure) << code << ": " << to_text(*failure);
  }
}

TEST(Sandbox, HoldsExactlyTheLibraryItLists) {
  std::string code = "local listed = {";
  for (const std::string& name : library_names()) code += "['" + name + "'] = true,";
  code +=
      "}\nlocal count = 0\n"
      "for k, v in pairs(_ENV) do\n"
      "  assert(listed[k], k) count = count + 1\n"
      "  if type(v) == 'table' then for m in pairs(v) do assert(listed[k .. '.' .. m], k .. '.' .. m) count "
      "= count + 1 end end\n"
      "end\n"
      "local wanted = 0 for _ in pairs(listed) do wanted = wanted + 1 end\n"
      "assert(count == wanted, count .. ' of ' .. wanted)";
  const std::optional<Failure> failure = run(code);
  EXPECT_FALSE(failure) << to_text(*failure);
}

TEST(Sandbox, KeepsLuaAsItIsOtherwise) {
  const char* code = R"(
    local ok, message = pcall(error, { 1 })
    assert(not ok and message[1] == 1)
    assert(select(2, xpcall(function() error("e", 0) end, function(m) return m .. "!" end)) == "e!")
    assert(select("#", xpcall(function(...) return ... end, print, 1, 2)) == 3)
    local t = { 3, 1, 2 }
    table.sort(t) assert(table.concat(t, ",") == "1,2,3")
    table.sort(t, function(a, b) return a > b end) assert(table.concat(t, ",") == "3,2,1")
    local pairs_of = { { 1, "a" }, { 0, "b" }, { 1, "c" }, { 0, "d" } }
    table.sort(pairs_of, function(a, b) return a[1] < b[1] end)
    assert(pairs_of[1][2] .. pairs_of[2][2] .. pairs_of[3][2] .. pairs_of[4][2] == "bdac")
    local c = coroutine.wrap(function(a) local b = coroutine.yield(a + 1) return b * 2 end)
    assert(c(1) == 2 and c(21) == 42)
    local d = coroutine.create(function() error("inside") end)
    local done, why = coroutine.resume(d)
    assert(not done and why:find("inside") and coroutine.status(d) == "dead")
    assert(not coroutine.resume(d))
    -- yields pass through pcall
    local e = coroutine.wrap(function() return pcall(function() coroutine.yield(1) return 2 end) end)
    assert(e() == 1) local fine, two = e() assert(fine and two == 2)
    assert(string.format("%s %5.1f %d %%", {}, 1.25, 3) == "table   1.2 3 %")
    assert(tostring(print) == "function" and tostring(1) == "1" and tostring(nil) == "nil")
    local seen = {}
    for k in pairs({ b = 1, a = 1, [2] = 1, [1] = 1, [1.5] = 1, [true] = 1, [false] = 1 }) do seen[#seen + 1] = tostring(k) end
    assert(table.concat(seen, " ") == "1 1.5 2 a b false true")
    local keys = {} for k in pairs({ a = 1, b = 2 }) do keys[#keys + 1] = k end
    local gone = { a = 1, b = 2, c = 3 } for k in pairs(gone) do gone.c = nil keys[#keys + 1] = k end
    assert(table.concat(keys) == "abab"))";
  const std::optional<Failure> failure = run(code);
  EXPECT_FALSE(failure) << to_text(*failure);
}

TEST(Sandbox, RefusesKeysWithoutAnOrderInPairs) {
  const std::optional<Failure> failure = run("local t = { [{}] = 1 }\nfor k in pairs(t) do end");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->problems[0].place.line, 2);
}

TEST(Sandbox, GivesNoAddresses) {
  std::string printed;
  LogSink before = set_log_sink([&](LogLevel, const std::string& text) { printed += text; });
  const std::optional<Failure> failure =
      run("print({}, print, coroutine.create(print), string.format('%s', {}))");
  set_log_sink(std::move(before));
  EXPECT_FALSE(failure);
  EXPECT_EQ(printed.find("0x"), std::string::npos) << printed;
}

TEST(Sandbox, RaisesErrorsThatAreNoTextAsText) {
  const std::optional<Failure> failure = run("error({})");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, FailureKind::scenario);
  EXPECT_EQ(to_text(*failure).find("0x"), std::string::npos);
}

TEST(Sandbox, TracesErrorsToTheScriptsOwnLines) {
  const std::optional<Failure> failure =
      run("local function f() error('bad') end\nlocal function g() f() return 1 end\nxpcall(print, "
          "print)\ng()\n");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->problems[0].place.line, 1);
  const std::string text = to_text(*failure);
  EXPECT_NE(text.find("attack.lua:2"), std::string::npos) << text;
  EXPECT_NE(text.find("attack.lua:4"), std::string::npos) << text;
  EXPECT_EQ(text.find(prelude_name), std::string::npos) << text;
}

TEST(Sandbox, PlacesErrorsOfItsOwnLuaAtTheScriptsLine) {
  const std::optional<Failure> failure = run("\ntable.sort({ 1, 'x' })");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->problems[0].place.line, 2) << to_text(*failure);
  EXPECT_EQ(to_text(*failure).find(prelude_name), std::string::npos) << to_text(*failure);
}

TEST(Sandbox, BudgetIsPerCallAndPerRun) {
  SandboxOptions options;
  options.limits.instructions_per_run = 450'000;  // four runs
  Script script(counting_loop, options);
  int runs = 0;
  std::optional<Failure> failure;
  while (!failure && runs < 10) {
    failure = script.call();
    ++runs;
  }
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->kind, FailureKind::resource);
  EXPECT_EQ(runs, 5);
}

TEST(Sandbox, StaysDeadOnceItsBudgetIsUsedUp) {
  Script script("while true do end");
  const std::filesystem::path harmless = script.add_file("b.lua", "return 1 + 1");
  for (const std::optional<Failure>& failure : {script.call(), script.call(harmless)}) {
    ASSERT_TRUE(failure);
    EXPECT_EQ(failure->kind, FailureKind::resource);
  }
}

// ---- the watchdog

using SandboxDeathTest = ::testing::Test;

void hang(const std::string& code) {
  SandboxOptions options;
  options.limits.call_seconds = 0.2;
  Script script(code, options, "hang.lua");
  // The process ends there: no destructor removes the folder.
  script.sandbox().watchdog().set_flush([&] {
    std::fputs("flushed\n", stderr);
    std::filesystem::remove_all(script.folder());
  });
  (void)script.call();
  std::fputs("it came back\n", stderr);
}

TEST(SandboxDeathTest, WatchdogEndsACatastrophicPatternAfterFlushing) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(hang("string.find(string.rep('a', 5000), string.rep('.-', 20) .. 'b')"),
              ::testing::ExitedWithCode(7), "hang.lua:1: the script has been running[^\n]*\nflushed");
}

TEST(SandboxDeathTest, WatchdogEndsATextThatCompilesForEver) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  std::string chain = "if x then\n";
  for (int i = 0; i < 70'000; ++i) chain += "elseif x then\n";  // Lua's compiler takes the square of that
  EXPECT_EXIT(hang(chain + "end"), ::testing::ExitedWithCode(7), "hang.lua:1: .* elseif");
}

TEST(SandboxDeathTest, WatchdogEndsCallsThatAreTooLongTogether) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      hang("local n = 0 while true do string.find(string.rep('a', 300), string.rep('a-', 3) .. 'b') end"),
      ::testing::ExitedWithCode(7), "hang.lua");
}

TEST(Sandbox, WatchdogSleepsWhileNoScriptRuns) {
  SandboxOptions options;
  options.limits.call_seconds = 0.05;
  Script script("return 1", options);
  EXPECT_FALSE(script.call());
  ::usleep(200'000);  // a long solve: the process must still be there after it
}

// ---- the same in every process

TEST(Sandbox, DISABLED_PrintsOrderAndRandomNumbers) {
  LogSink before =
      set_log_sink([](LogLevel, const std::string& text) { std::printf("law: %s\n", text.c_str()); });
  const std::optional<Failure> failure = run(R"(
    local t = {} for i = 1, 50 do t["key" .. math.random(1000)] = i t[i / 4] = i end
    local keys = {} for k, v in pairs(t) do keys[#keys + 1] = k .. "=" .. v end
    print(table.concat(keys, " "), math.random(), {}, print)
    local many = {} for i = 1, 2000 do many[i] = { i % 7, i } end
    table.sort(many, function(a, b) return a[1] < b[1] end)
    for i = 1, #many do many[i] = many[i][2] end print(table.concat(many, " ")))");
  set_log_sink(std::move(before));
  EXPECT_FALSE(failure);
}

std::string output_of_fresh_process() {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command =
      self + " --gtest_also_run_disabled_tests --gtest_filter=Sandbox.DISABLED_PrintsOrder*";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  std::string laws;
  std::array<char, 65536> line;
  while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr)
    if (std::string(line.data()).starts_with("law: ")) laws += line.data();
  ::pclose(pipe);
  return laws;
}

TEST(Sandbox, OrderAndRandomNumbersAreTheSameInFreshProcesses) {
  const std::string first = output_of_fresh_process();
  EXPECT_GT(first.size(), 1000u);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(output_of_fresh_process(), first);
}

TEST(Sandbox, RandomNumbersFollowTheSeed) {
  const auto numbers = [](std::uint64_t seed) {
    SandboxOptions options;
    options.seed = seed;
    Script script("print(math.random(), math.random(1000))", options);
    std::string printed;
    LogSink before = set_log_sink([&](LogLevel, const std::string& text) { printed += text; });
    EXPECT_FALSE(script.call());
    set_log_sink(std::move(before));
    return printed;
  };
  EXPECT_EQ(numbers(7), numbers(7));
  EXPECT_NE(numbers(7), numbers(8));
}

}  // namespace
}  // namespace calot

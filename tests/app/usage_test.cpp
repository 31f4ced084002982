// How the program meets someone who has never used it.

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "app/program.h"
#include "support/paths.h"

namespace calot::test {
namespace {

class Usage : public ProgramTest {};

std::vector<std::vector<std::string>> all_commands() {
  return {{"run"},
          {"operate"},
          {"replay"},
          {"score"},
          {"page"},
          {"import"},
          {"check"},
          {"list"},
          {"new"},
          {"golden"},
          {"golden", "test"},
          {"golden", "accept"},
          {"golden", "report"},
          {"bench"},
          {"doctor"}};
}

std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_F(Usage, WithoutArgumentsItPrintsItsHelp) {
  const Outcome outcome = calot({});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* command : {"run", "operate", "replay", "score", "page", "import", "check", "list", "new",
                              "golden", "bench", "doctor"}) {
    EXPECT_NE(outcome.out.find(command), std::string::npos) << command;
  }
}

TEST_F(Usage, EveryCommandHasHelp) {
  for (const std::vector<std::string>& words : all_commands()) {
    const Outcome outcome = calot(joined(words, {"--help"}));
    EXPECT_EQ(outcome.code, 0) << words.back();
    EXPECT_NE(outcome.out.find("Usage"), std::string::npos) << words.back();
  }
}

TEST_F(Usage, AMisspeltOptionIsAUsageErrorEvenBesideHelp) {
  for (const std::vector<std::string>& words : all_commands()) {
    SCOPED_TRACE(words.back());
    const Outcome outcome = calot(joined(words, {"--exma=3", "--help"}));
    EXPECT_EQ(outcome.code, 4);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find("--exma"), std::string::npos) << outcome.err;
    expect_next_command(outcome);
  }
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"operate", "--help", "--exma"},
                                             {"--exma", "operate", "--help"},
                                             {"golden", "--exma", "test", "--help"},
                                             {"--exma", "--help"},
                                             {"--version", "--exma"},
                                             {"--exma", "--version"}})
    EXPECT_EQ(calot(arguments).code, 4) << arguments.front();
  EXPECT_NE(calot({"operate", "--exma", "--help"}).err.find("did you mean \"--exam\"?"), std::string::npos);
}

TEST_F(Usage, HelpBesideRightOptionsIsHelp) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--help"},
                                             {"run", "small.lua", "--seed", "7", "--help"},
                                             {"run", "--help", "-o", "-x"},  // -x is a folder here
                                             {"operate", "--exam", "--help"},
                                             {"golden", "test", "--json", "--help"}})
    EXPECT_EQ(calot(arguments).code, 0) << arguments.front();
  const Outcome outcome = calot({"--version"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_TRUE(outcome.out.starts_with("calot ")) << outcome.out;
}

TEST_F(Usage, WrongArgumentsAreUsageErrorsWithTheNextCommand) {
  const std::vector<std::vector<std::string>> wrong{
      {"rnu", "small.lua"},
      {"run"},
      {"operate"},
      {"operate", "small.lua", "--exam", "--practice"},
      {"run", "small.lua", "--frames"},
      {"run", "small.lua", "extra.lua"},
      {"run", "small.lua", "--size", "960"},
      {"run", "small.lua", "--size", "0x540"},
      {"run", "small.lua", "--size", "-960x540"},
      {"run", "small.lua", "--param", "height"},
      {"run", "small.lua", "--param", "hieght=3"},
      {"run", "small.lua", "--param", "height=tall"},
      {"run", "small.lua", "--seed", "one"},
      {"run", "small.lua", "--seed=-1"},
      {"run", "small.lua", "--threads", "0"},
      {"golden", "test", "--threads", "two"},
      {"run", "small.lua", "--seed=1.5"},
      {"run", "small.lua", "--seed=18446744073709551616"},
      {"run", "small.lua", "--fail-below", "nan"},
      {"run", "small.lua", "--fail-below", "-1"},
      {"run", "bad\xff.lua"},
      {"run", "small.lua", "--param", "height=\xc3("},
      {"run", "small.lua", "--no-render", "-o", "bad\xff"},
      {"check", "bad\xff.lua"},
      {"replay", "bad\xff.jsonl"},
      {"golden", "test", "bad\xff"},
      {"new", "bad\xff"},
      {"run", "/proc/self/mem"},
      {"check", "/proc/self/mem"},
      {"run", "small.lua", "--fail-below", "120"},
      {"run", "."},
      {"run", "none.lua"},
      {"run", "small.lua", "--at", "soon"},
      {"run", "small.lua", "--at", "-1"},
      {"list", "none.lua"},
      {"check"},
      {"check", "none.lua"},
      {"replay", "none.jsonl"},
      {"replay", "small.lua"},
      {"golden"},
      {"golden", "frobnicate"},
      {"golden", "accept"},
      {"bench", "fast"},
      {"bench", "--json", "--output"},
      {"doctor", "--fix"},
  };
  for (const std::vector<std::string>& arguments : wrong) {
    const Outcome outcome = calot(arguments);
    std::string words;
    for (const std::string& word : arguments) words += word + " ";
    SCOPED_TRACE(words);
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    expect_next_command(outcome);
  }
}

TEST_F(Usage, WhatIsNotUtf8IsShownEscaped) {
  const Outcome outcome = calot({"run", "bad\xff.lua", "--json"});
  EXPECT_NE(outcome.err.find("argument 2 is not UTF-8: bad\\xff.lua"), std::string::npos) << outcome.err;
}

TEST_F(Usage, AMissingScenarioHasNoLinesToMend) {
  EXPECT_EQ(calot({"check", "none.lua"}).err.find("mend"), std::string::npos);
  spill(folder_ / "broken.lua", "return {\n");
  EXPECT_NE(calot({"check", "broken.lua"}).err.find("mend the lines named above"), std::string::npos);
}

TEST_F(Usage, AMistypedCommandGetsTheNearestOne) {
  EXPECT_NE(calot({"chek", "small.lua"}).err.find("did you mean \"check\"?"), std::string::npos);
}

TEST_F(Usage, AMistypedPathGetsTheNearestScenario) {
  spill(folder_ / "scenarios" / "grasp.lua", small_scenario());
  fs::create_directories(folder_ / "scripts" / "lua");
  EXPECT_NE(calot({"run", "scenarios/gasp.lua"}).err.find("scenarios/grasp.lua"), std::string::npos);
}

TEST_F(Usage, NothingIsColouredOrOverwrittenWhereThereIsNoTerminal) {
  const Outcome outcome = calot({"run", "small.lua", "--no-render"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find('\033'), std::string::npos);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Usage, AnOutputFolderThatCannotBeIsAUsageErrorBeforeAnythingIsPlayed) {
  spill(folder_ / "taken", "a file\n");
  for (const char* folder : {"taken", "taken/below", "/proc/calot"}) {
    const Outcome outcome = calot({"run", "small.lua", "--no-render", "-o", folder});
    EXPECT_EQ(outcome.code, 4) << folder << ": " << outcome.err;
    EXPECT_NE(outcome.err.find("-o DIR"), std::string::npos) << outcome.err;
    expect_next_command(outcome);
  }
  EXPECT_EQ(slurp(folder_ / "taken"), "a file\n");
}

TEST_F(Usage, WhatCannotBePrintedIsAnError) {
  for (const char* command : {"--help", "check small.lua", "run small.lua --no-render --json"})
    EXPECT_EQ(shell(folder_, std::string("$calot ") + command + " >/dev/full"), 4) << command;
  EXPECT_NE(slurp(folder_ / ".stderr").find("free space"), std::string::npos);
}

TEST_F(Usage, AFileThatDoesNotFitLeavesWhatWasThere) {
  // Files may have 512 bytes here, as on a disk that is full.
  const std::string little = "trap '' XFSZ; ulimit -f 1; ";
  EXPECT_EQ(shell(folder_, little + "$calot new mine"), 4);
  EXPECT_NE(slurp(folder_ / ".stderr").find("cannot write mine.lua"), std::string::npos);
  std::set<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
    files.insert(entry.path().filename());
  EXPECT_EQ(files, (std::set<std::string>{".stderr", "small.lua"}));
  fs::create_directories(folder_ / "scenarios");
  fs::create_directories(folder_ / "scripts" / "lua");
  fs::rename(folder_ / "small.lua", folder_ / "scenarios" / "small.lua");
  spill(folder_ / "out" / "page.html", "the last one\n");
  EXPECT_EQ(shell(folder_, little + "$calot golden report -o out/page.html >/dev/null"), 4);
  EXPECT_EQ(slurp(folder_ / "out" / "page.html"), "the last one\n");
}

TEST_F(Usage, DoctorSeesThatNothingCanBeWritten) {
  // Through a pipe: what it finds may be longer than a file can be here.
  const std::string doctor = "(trap '' XFSZ; ulimit -f 1; $calot doctor; echo \"code $?\") | cat >found";
  ASSERT_EQ(shell(folder_, doctor), 0);
  const std::string found = slurp(folder_ / "found");
  EXPECT_NE(found.find("\ncode 1\n"), std::string::npos) << found;
  EXPECT_NE(found.find("FAILED  output folder: cannot write"), std::string::npos) << found;
}

TEST_F(Usage, DoctorFindsNothingWrongHere) {
  const Outcome outcome = calot({"doctor"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.out.find("FAILED"), std::string::npos) << outcome.out;
}

TEST_F(Usage, NewWritesAnExerciseThatRunsAndPassesItsOwnScore) {
  const Outcome written = calot({"new", "hold_tight"});
  ASSERT_EQ(written.code, 0) << written.err;
  EXPECT_EQ(calot({"check", "hold_tight.lua"}).code, 0);
  const Outcome played = calot({"run", "hold_tight.lua", "--no-render", "--json"});
  EXPECT_EQ(played.code, 0) << played.err;
  const auto report = nlohmann::json::parse(played.out);
  EXPECT_EQ(report["scenario"], "hold-tight");
  EXPECT_TRUE(report["score"]["passed"].get<bool>()) << played.out;
}

TEST_F(Usage, NewNeverOverwritesAndRefusesOddNames) {
  spill(folder_ / "mine.lua", "-- mine\n");
  const Outcome outcome = calot({"new", "mine"});
  EXPECT_EQ(outcome.code, 4);
  expect_next_command(outcome);
  EXPECT_EQ(slurp(folder_ / "mine.lua"), "-- mine\n");
  for (const char* name : {"", "7up", "a b", "naïve"}) EXPECT_EQ(calot({"new", name}).code, 4) << name;
}

}  // namespace
}  // namespace calot::test

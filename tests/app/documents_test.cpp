// What the documents say: links lead somewhere, commands are those of the program, Lua is read, and paragraphs are short.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "app/markdown.h"
#include "app/program.h"
#include "lua/read_benchmarks.h"
#include "lua/read_registration.h"
#include "support/paths.h"

namespace calot::test {
namespace {

/// Every Markdown file of the source, sorted, without what is built or hidden.
std::vector<Markdown> all_documents() {
  std::vector<Markdown> documents;
  for (fs::recursive_directory_iterator entry(source_dir()), end; entry != end; ++entry) {
    const std::string name = entry->path().filename().string();
    const bool skipped = name.starts_with('.') || (entry.depth() == 0 && (name == "build" || name == "out"));
    if (entry->is_directory() && skipped) entry.disable_recursion_pending();
    if (entry->is_regular_file() && entry->path().extension() == ".md")
      documents.push_back(read_markdown(entry->path()));
  }
  std::sort(documents.begin(), documents.end(),
            [](const Markdown& a, const Markdown& b) { return a.file < b.file; });
  return documents;
}

/// "scenarios/README.md:7".
std::string place_of(const Markdown& document, int line) {
  return document.file.lexically_relative(source_dir()).string() + ":" + std::to_string(line);
}

bool is_exercise(const FencedBlock& block) {
  return block.language == "lua" && block.text.find("return calot.exercise") != std::string::npos;
}

bool is_table(const FencedBlock& block) {
  return block.language == "lua" && ("\n" + block.text).find("\nreturn {") != std::string::npos;
}

/// The commands of a block's line, a pipe's one by one, without its comment.
std::vector<std::vector<std::string>> commands_of(const std::string& line) {
  std::vector<std::vector<std::string>> commands;
  std::istringstream parts(line.substr(0, line.find(" #")));
  for (std::string part; std::getline(parts, part, '|');) commands.push_back(words_of(part));
  std::erase_if(commands,
                [](const std::vector<std::string>& words) { return words.empty() || words[0][0] == '#'; });
  return commands;
}

/// A project such as a reader has who did what the documents say before.
class Documents : public ProgramTest {
 protected:
  void make_project() {
    const fs::path source = source_dir();
    for (const char* written : {"scenarios", "golden"})
      fs::copy(source / written, folder_ / written, fs::copy_options::recursive);
    for (const char* part : {"scripts", "assets"})
      fs::create_directory_symlink(source / part, folder_ / part);
    record();
    for (const Markdown& document : all_documents())
      for (const FencedBlock& block : document.blocks) lay_down(block);
  }

  /// A recording of the exercise that the documents use, which an interruption keeps short.
  void record() {
    const fs::path recording = folder_ / "out" / "grasp-and-traction" / "recording.jsonl";
    const Outcome outcome = calot({"run", "scenarios/grasp_and_traction.lua", "--no-render"}, [&](pid_t pid) {
      EXPECT_TRUE(wait_for_lines(recording, 5));
      kill(pid, SIGINT);
    });
    ASSERT_EQ(outcome.code, 2) << outcome.err;
    fs::create_directories(folder_ / "recordings" / "T-07-1");
    fs::copy_file(recording, folder_ / "recordings" / "T-07-1" / "recording.jsonl");
  }

  /// A file that the document shows as a whole after naming it.
  void lay_down(const FencedBlock& block) const {
    static const std::regex file(R"(`((scenarios/)?\w+\.(lua|csv))`)");
    if (block.language != "text" && !is_table(block) && !is_exercise(block)) return;
    std::smatch named;
    if (std::regex_search(block.introduced, named, file)) spill(folder_ / named[1].str(), block.text);
  }

  /// Tries each command of each block; `real`: not dry.
  void try_blocks(const char* language, bool real) const {
    for (const Markdown& document : all_documents())
      for (const FencedBlock& block : document.blocks) {
        if (block.language != language) continue;
        std::istringstream lines(block.text);
        int number = block.line;
        for (std::string line; std::getline(lines, line);) {
          SCOPED_TRACE(place_of(document, ++number) + ": " + line);
          for (const std::vector<std::string>& words : commands_of(line)) try_command(words, real);
        }
      }
  }

  void try_command(std::vector<std::string> words, bool real) const {
    const std::string program = words.front();
    words.erase(words.begin());
    if (program.starts_with("scripts/")) return try_script(program, words);
    ASSERT_EQ(program, "build/release/calot") << "no program that a document may name";
    ASSERT_FALSE(words.empty());
    if (words[0] == "new") {
      // In earnest: the next command reads the file, and another document may say it again.
      fs::remove(folder_ / "scenarios" / (words.at(1) + ".lua"));
      real = true;
    }
    if (!real) words.emplace_back("--dry-run");
    const Outcome outcome = calot(words);
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.out.empty(), !real);
  }

  /// A script's first lines say which options it has; those of `run` are the program's.
  void try_script(const std::string& script, std::vector<std::string> options) const {
    const fs::path file = fs::path(source_dir()) / script;
    ASSERT_TRUE(fs::is_regular_file(file));
    EXPECT_EQ(access(file.c_str(), X_OK), 0) << "is not executable";
    if (script == "scripts/run") {
      if (options.empty() || options[0].starts_with('-'))
        options.insert(options.begin(), "scenarios/critical_view.lua");
      options.insert(options.begin(), "run");
      options.insert(options.begin(), "build/release/calot");
      return try_command(options, false);
    }
    const std::string text = slurp(file);
    const std::string usage = text.substr(0, text.find("\n#\n"));
    ASSERT_NE(usage.find("# usage: " + script), std::string::npos);
    static const std::regex option_names("--[a-z]+");
    const std::set<std::string> known(std::sregex_token_iterator(usage.begin(), usage.end(), option_names),
                                      {});
    for (const std::string& option : options) {
      const bool measures =
          option.starts_with("--benchmark_") && usage.find("Google Benchmark") != std::string::npos;
      EXPECT_TRUE(measures || known.contains(option)) << option << " is no option of " << script;
    }
  }

  /// Tries commands in the text that name a scenario: their other words are then files, too.
  void try_spans() const {
    for (const Markdown& document : all_documents())
      for (const MarkdownLine& span : code_spans_of(document)) {
        std::vector<std::string> words = words_of(span.text);
        if (words.size() < 3 || words[0] != "calot" || !words[2].starts_with("scenarios/")) continue;
        SCOPED_TRACE(place_of(document, span.number) + ": " + span.text);
        words[0] = "build/release/calot";
        try_command(words, false);
      }
  }
};

TEST_F(Documents, EveryLinkLeadsSomewhere) {
  int links = 0;
  for (const Markdown& document : all_documents())
    for (const MarkdownLine& link : links_of(document)) {
      if (link.text.find("://") != std::string::npos) continue;
      SCOPED_TRACE(place_of(document, link.number) + ": " + link.text);
      ++links;
      const std::size_t hash = link.text.find('#');
      const std::string path = link.text.substr(0, hash);
      const fs::path target = path.empty() ? document.file : document.file.parent_path() / path;
      EXPECT_TRUE(fs::exists(target)) << "leads nowhere";
      if (hash == std::string::npos) continue;
      EXPECT_TRUE(anchors_of(read_markdown(target)).contains(link.text.substr(hash + 1)))
          << "no such heading";
    }
  EXPECT_GT(links, 50);
}

TEST_F(Documents, EveryCommandIsOneOfTheProgram) {
  make_project();
  try_spans();
  try_blocks("sh", false);
  try_blocks("sh run", false);
}

TEST_F(Documents, WhatABlockSaysIsRunRuns) {
  make_project();
  try_blocks("sh run", true);
}

/// Places of arguments, such as FILE..., are no files; --help, which looks at no file, refuses options that are none.
TEST_F(Documents, EveryCommandInTheTextHasOnlyOptionsThatExist) {
  std::set<std::string> tried;
  for (const Markdown& document : all_documents())
    for (const MarkdownLine& span : code_spans_of(document)) {
      std::vector<std::string> words = words_of(span.text);
      if (words[0] != "calot" && words[0] != "build/release/calot") continue;
      if (!tried.insert(span.text).second) continue;
      SCOPED_TRACE(place_of(document, span.number) + ": " + span.text);
      words.erase(words.begin());
      words.emplace_back("--help");
      const Outcome outcome = calot(words);
      EXPECT_EQ(outcome.code, 0) << outcome.err;
    }
  EXPECT_GT(tried.size(), 15u);
}

TEST_F(Documents, EveryWholePieceOfLuaIsRead) {
  const fs::path modules = fs::path(source_dir()) / "scripts" / "lua";
  int pieces = 0;
  for (const Markdown& document : all_documents())
    for (const FencedBlock& block : document.blocks) {
      SCOPED_TRACE(place_of(document, block.line));
      const fs::path file = folder_ / "piece.lua";
      spill(file, block.text);
      pieces += is_exercise(block) || is_table(block) ? 1 : 0;
      if (is_exercise(block)) {
        const Outcome outcome = calot({"check", "piece.lua"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
      } else if (is_table(block) && block.text.find("format =") != std::string::npos) {
        const auto registration = read_registration(file, modules);
        EXPECT_TRUE(registration) << to_text(registration.failure());
      } else if (is_table(block)) {
        const auto benchmarks = read_benchmarks(file, modules);
        EXPECT_TRUE(benchmarks) << to_text(benchmarks.failure());
      } else {
        EXPECT_NE(block.language, "lua") << "a piece that is not whole is a `lua fragment`";
      }
    }
  EXPECT_GE(pieces, 4);
}

TEST_F(Documents, EveryFragmentOfLuaIsLua) {
  // Statements or fields of a table, in a function that is never called: what they name need not be there.
  const std::string never = "return { never = function(t)\n", end = "\nend }\n";
  std::vector<std::string> places;
  for (const Markdown& document : all_documents())
    for (const FencedBlock& block : document.blocks) {
      if (block.language != "lua fragment") continue;
      const fs::path folder = folder_ / "fragments" / fmt::format("{:03}", places.size());
      spill(folder / "statements.lua", never + block.text + end);
      spill(folder / "table.lua", never + "return {\n" + block.text + "}" + end);
      places.push_back(place_of(document, block.line));
    }
  const Outcome outcome = calot({"check", "fragments", "--json"});
  const auto checked = nlohmann::json::parse(outcome.out)["scenarios"];
  ASSERT_EQ(checked.size(), 2 * places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool read = checked[2 * i]["ok"].get<bool>() || checked[2 * i + 1]["ok"].get<bool>();
    EXPECT_TRUE(read) << places[i] << ": as statements " << checked[2 * i]["problems"] << "\nas fields "
                      << checked[2 * i + 1]["problems"];
  }
}

/// What is called otherwise would be tried by none of these tests.
TEST_F(Documents, EveryBlockIsOfAKindThatIsTested) {
  const std::set<std::string> kinds{"", "text", "sh", "sh run", "lua", "lua fragment"};
  for (const Markdown& document : all_documents())
    for (const FencedBlock& block : document.blocks) {
      EXPECT_TRUE(kinds.contains(block.language)) << place_of(document, block.line) << ": " << block.language;
      const bool hidden =
          block.language.empty() && block.text.find("build/release/calot") != std::string::npos;
      EXPECT_FALSE(hidden) << place_of(document, block.line) << ": commands stand in blocks of `sh`";
    }
}

TEST_F(Documents, TheWorkedExampleIsWhatTheProgramScoresAndAddsUp) {
  make_project();
  const Outcome run =
      calot({"run", "scenarios/clip_and_divide.lua", "--param", "demo=clumsy", "--no-render", "--json"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json scored = Json::parse(run.out)["score"];
  const std::regex row(R"(^\| `([\w.]+)` \|.*\| ([\d.]+) x ([\d.]+) x ([\d.]+) \| ([\d.]+) \|$)");
  std::size_t part = 0;
  double sum = 0, printed_sum = -1;
  for (const MarkdownLine& line : read_markdown(fs::path(source_dir()) / "scenarios" / "SCORING.md").prose) {
    std::smatch found;
    if (line.text.starts_with("| **sum**"))
      printed_sum = std::stod(line.text.substr(line.text.rfind("**", line.text.size() - 5) + 2));
    if (!std::regex_match(line.text, found, row)) continue;
    ASSERT_LT(part, scored["parts"].size());
    const Json& of_program = scored["parts"][part++];
    const double points = std::stod(found[5]);
    EXPECT_EQ(of_program["name"], found[1].str());
    EXPECT_EQ(of_program["weight"], std::stod(found[2]));
    EXPECT_EQ(of_program["share_of_steps_done"], std::stod(found[4]));
    EXPECT_NEAR(100 * std::stod(found[2]) * std::stod(found[3]) * std::stod(found[4]), points, 0.01)
        << line.text;
    EXPECT_NEAR(of_program["points"].get<double>(), points, 0.01) << line.text;
    sum += points;
  }
  EXPECT_EQ(part, scored["parts"].size());
  EXPECT_NEAR(printed_sum, sum, 1e-9);
  EXPECT_NEAR(scored["total"].get<double>(), sum, 0.01);
  EXPECT_EQ(scored["outcome"], "unsafe");
}

TEST_F(Documents, TheFirstPageIsShort) {
  const std::string text = slurp(fs::path(source_dir()) / "README.md");
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 150);
  EXPECT_LE(words_of(text).size(), 1300u);
}

TEST_F(Documents, NoParagraphHasMoreThanAHundredWords) {
  for (const Markdown& document : all_documents()) {
    if (document.file.lexically_relative(source_dir()) == "scripts/lua/README.md") continue;  // generated
    for (const MarkdownLine& paragraph : paragraphs_of(document))
      EXPECT_LE(words_of(paragraph.text).size(), 100u)
          << place_of(document, paragraph.number) << ": " << paragraph.text.substr(0, 60);
  }
}

}  // namespace
}  // namespace calot::test

// Two thousand scenarios that went wrong by chance: each loads, or is refused with file and line.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "base/log.h"
#include "base/rng.h"
#include "lua/scenario_files.h"

namespace calot {
namespace {

namespace fs = std::filesystem;
using test::Folder;

std::vector<std::string> shipped_scenarios() {
  const fs::path root(source_dir());
  std::vector<fs::path> files = {root / "assets/starter_exercise.lua"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "scenarios"))
    if (entry.path().extension() == ".lua") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return texts;
}

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : rng_(seed) {}

  std::string mutate(const std::string& text) {
    std::string mutated = text;
    const std::size_t edits = 1 + below(3);
    for (std::size_t i = 0; i < edits && !mutated.empty(); ++i) edit(mutated);
    return mutated;
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(rng_.next() % count); }

 private:
  struct Piece {
    std::size_t at, length;
  };

  /// Words (names, keywords, numbers) or, without `words`, any token.
  Piece pick(const std::string& text, bool words, bool number = false) {
    std::vector<Piece> pieces;
    const auto in_word = [&](std::size_t i) {
      return std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_' || text[i] == '.';
    };
    for (std::size_t i = 0; i < text.size();) {
      std::size_t end = i + 1;
      while (in_word(i) && end < text.size() && in_word(end)) ++end;
      const bool digit = std::isdigit(static_cast<unsigned char>(text[i])) != 0;
      if (std::isspace(static_cast<unsigned char>(text[i])) == 0 && (!words || in_word(i)) &&
          (!number || digit))
        pieces.push_back({i, end - i});
      i = end;
    }
    return pieces.empty() ? Piece{0, 0} : pieces[below(pieces.size())];
  }

  void edit(std::string& text) {
    static const std::vector<std::string> numbers = {
        "0", "-1", "1e308", "(0/0)", "math.huge", "1 << 62", "1e-300", "9007199254740993", "'7'", "nil"};
    switch (below(9)) {
      case 0:  // a bit turned
        text[below(text.size())] ^= static_cast<char>(1 << below(8));
        return;
      case 1: {  // a token left out
        const Piece piece = pick(text, false);
        text.erase(piece.at, piece.length);
        return;
      }
      case 2: {  // a token twice
        const Piece piece = pick(text, false);
        text.insert(piece.at, text.substr(piece.at, piece.length) + " ");
        return;
      }
      case 3: {  // two tokens exchanged
        Piece a = pick(text, false), b = pick(text, false);
        if (a.at > b.at) std::swap(a, b);
        if (a.at + a.length > b.at) return;
        const std::string first = text.substr(a.at, a.length), second = text.substr(b.at, b.length);
        text.replace(b.at, b.length, first);
        text.replace(a.at, a.length, second);
        return;
      }
      case 4:
      case 5: {  // another number
        const Piece piece = pick(text, true, true);
        text.replace(piece.at, piece.length, numbers[below(numbers.size())]);
        return;
      }
      case 6: {  // a slip in a name
        const Piece piece = pick(text, true);
        if (piece.length > 1) text.erase(piece.at + below(piece.length), 1);
        return;
      }
      case 7: {  // a text that grows
        const std::size_t quote = text.find('"', below(text.size()));
        if (quote != std::string::npos) text.insert(quote + 1, std::string(std::size_t{1} << below(18), 'x'));
        return;
      }
      default:  // cut off
        text.resize(below(text.size()));
    }
  }

  Rng rng_;
};

TEST(Mutations, OfTheShippedScenariosLoadOrAreRefusedWithFileAndLine) {
  LogSink before = set_log_sink([](LogLevel, const std::string&) {});  // what they print
  const std::vector<std::string> texts = shipped_scenarios();
  const Folder folder;
  LoadOptions options;
  options.modules = fs::path(source_dir()) / "scripts/lua";
  options.assets = fs::path(source_dir()) / "assets";
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    Mutator mutator(seed);
    const std::string text = mutator.mutate(texts[mutator.below(texts.size())]);
    const Result<std::unique_ptr<ExerciseScript>> loaded = test::load_text(folder, text, options);
    if (loaded) continue;
    ++refused;
    const Failure& failure = loaded.failure();
    EXPECT_TRUE(failure.kind == FailureKind::scenario || failure.kind == FailureKind::resource)
        << "seed " << seed << ": " << to_text(failure);
    ASSERT_FALSE(failure.problems.empty()) << "seed " << seed;
    for (const Problem& problem : failure.problems) {
      EXPECT_FALSE(problem.message.empty()) << "seed " << seed;
      // A module that is given what it cannot use is named with its line, and who called it in the message.
      const std::string& file = problem.place.file;
      EXPECT_TRUE((file.ends_with("test.lua") || file.starts_with(options.modules.string())) &&
                  problem.place.line > 0)
          << "seed " << seed << ": " << to_text(problem);
      EXPECT_LT(to_text(problem).size(), 10'000u) << "seed " << seed;
    }
  }
  set_log_sink(std::move(before));
  EXPECT_GT(refused, 1000);  // the edits do break things
  EXPECT_LT(refused, 2000);  // and not everything
}

}  // namespace
}  // namespace calot

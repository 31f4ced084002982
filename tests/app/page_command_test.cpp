// calot page: what is on it is what was scored and replayed; what is cut, bad or hostile.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <turbojpeg.h>

#include "app/browser.h"
#include "app/program.h"
#include "grading/page_moments.h"
#include "session/json.h"
#include "session/recording.h"
#include "support/long_run.h"

namespace calot::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class PageOfSmall : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::string text = small_scenario(
        "t:step('move', '<script>alert(1)</script>', { hint = 'Gently' }); t:note('seen', 3); t:wait(0.2 * "
        "s)");
    text.replace(text.find("left.path_length_mm"), 19, "note.seen");
    text.replace(text.find("A small exercise"), 16, "<script>alert(2)</script>");
    spill(folder_ / "small.lua", text);
    static std::string recording;  // played once for all tests
    if (recording.empty()) {
      const Outcome played = calot({"run", "small.lua", "--no-render", "-o", "out"});
      ASSERT_EQ(played.code, 0) << played.err;
      recording = slurp(folder_ / "out" / "recording.jsonl");
    }
    text_ = recording;
    spill(folder_ / "out" / "recording.jsonl", text_);
  }

  /// Without the line that says what to run next.
  static std::string said(const Outcome& outcome) {
    return outcome.err.substr(0, outcome.err.rfind("Next: "));
  }

  std::string text_;  ///< of a whole recording
};

TEST_F(PageOfSmall, HasItsScoreAndPicturesWhereStepsBeginAndEndAndNoForeignMarkup) {
  const Outcome made = calot({"page", "out/recording.jsonl"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.out, "Written to out/recording.html\n");
  EXPECT_EQ(made.err, "");
  const std::string html = slurp(folder_ / "out" / "recording.html");
  const Json score =
      Json::parse(calot({"score", "small.lua", "out/recording.jsonl", "--json"}).out)["recordings"][0];
  EXPECT_THAT(html,
              HasSubstr(fmt::format("<b>{:.1f}</b> of 100 points", score["score"]["total"].get<double>())));
  EXPECT_THAT(html, HasSubstr("uncalibrated"));
  EXPECT_THAT(html, HasSubstr("id=\"picture-2\"><img src=\"data:image/jpeg;base64,/9j/"));
  EXPECT_THAT(html, HasSubstr("85.0 of 100.0"))
      << "what was noted in the step, from 20 to 0, counts as the step's";
  EXPECT_THAT(html, HasSubstr("Gently")) << "points were lost";
  EXPECT_THAT(html, Not(HasSubstr("id=\"picture-3\""))) << "one where the step begins, one where it ends";
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(1)"));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(2)"));
}

TEST_F(PageOfSmall, GoesToTheCutAndListsWhatIsBadAsScoreDoes) {
  const std::string half = of_session(text_.substr(0, text_.find("\"time_s\":0.1,")), 2);
  spill(folder_ / "cut.jsonl", half);
  spill(folder_ / "foreign.jsonl", std::string(half).replace(half.find("\"small\""), 7, "\"other\""));
  const std::vector<std::string> files{"out/recording.jsonl", "cut.jsonl", "missing.jsonl", "foreign.jsonl"};
  std::vector<std::string> page{"page", "--no-pictures", "-o", "p.html", "-j", "1"},
      score{"score", "small.lua"};
  page.insert(page.end(), files.begin(), files.end());
  score.insert(score.end(), files.begin(), files.end());
  const Outcome made = calot(page), scored = calot(score);
  EXPECT_EQ(made.code, 4);
  EXPECT_EQ(made.code, scored.code);
  EXPECT_THAT(said(scored), EndsWith(said(made))) << "but for how many were simulated";
  EXPECT_THAT(said(made), HasSubstr("cut.jsonl: it did not come to its end (cut)"));
  expect_next_command(made);
  const std::string html = slurp(folder_ / "p.html");
  EXPECT_THAT(html, HasSubstr("The session did not come to its end (cut)"));
  EXPECT_THAT(html, HasSubstr("1 unfinished"));
  EXPECT_THAT(html, HasSubstr("cannot read missing.jsonl"));
  EXPECT_THAT(html, HasSubstr("the recording is of other"));
  EXPECT_THAT(html, HasSubstr("id=\"r2-recording\""));
  EXPECT_THAT(html, Not(HasSubstr("id=\"r3-recording\"")));
  EXPECT_THAT(html, Not(HasSubstr("<img")));
}

TEST_F(PageOfSmall, IsNotWrittenWhereNothingIsScoredNorOverARecording) {
  const Outcome missing = calot({"page", "missing.jsonl"});
  EXPECT_EQ(missing.code, 4);
  expect_next_command(missing);
  EXPECT_FALSE(fs::exists(folder_ / "missing.html"));
  const Outcome over = calot({"page", "out/recording.jsonl", "-o", "out/recording.jsonl"});
  EXPECT_EQ(over.code, 4);
  EXPECT_EQ(slurp(folder_ / "out" / "recording.jsonl"), text_);
  fs::create_directories(folder_ / "empty");
  EXPECT_EQ(calot({"page", "empty"}).code, 5);
}

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned held = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    held = held << 6 | static_cast<unsigned>(digits.find(c));
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 0xff);
  }
  return bytes;
}

TEST_F(PageOfSmall, ItsPicturesAreWholeAndAsLargeAsItSays) {
  ASSERT_EQ(calot({"page", "out/recording.jsonl"}).code, 0);
  const std::string html = slurp(folder_ / "out" / "recording.html"), start = "src=\"data:image/jpeg;base64,";
  const std::unique_ptr<void, decltype(&tjDestroy)> decoder(tjInitDecompress(), &tjDestroy);
  int pictures = 0;
  for (std::size_t at = html.find(start); at != std::string::npos;
       at = html.find(start, at + 1), ++pictures) {
    const std::size_t begin = at + start.size();
    std::string bytes = from_base64(html.substr(begin, html.find('"', begin) - begin));
    std::vector<unsigned char> rgb(640 * 360 * 3);
    EXPECT_EQ(tjDecompress2(decoder.get(), reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(),
                            rgb.data(), 640, 0, 360, TJPF_RGB, TJFLAG_STOPONWARNING),
              0)
        << tjGetErrorStr2(decoder.get());
  }
  EXPECT_EQ(pictures, 2);
}

TEST_F(PageOfSmall, ABrowserFindsNothingBrokenAndAsksForNothingElse) {
  if (!long_run()) GTEST_SKIP() << "left to scripts/test --long: it takes a browser of 300 MB";
  Browser browser(folder_ / "browser");
  ASSERT_TRUE(browser.is_there()) << "no chromium, which scripts/test --long installs";
  spill(folder_ / "cut.jsonl", of_session(text_.substr(0, text_.find("\"time_s\":0.1,")), 2));
  EXPECT_EQ(calot({"page", "out/recording.jsonl", "cut.jsonl", "-o", "p.html"}).code, 1);
  const std::string html = slurp(folder_ / "p.html");
  const char* look = R"((() => {
    const broken = [...document.images].filter(i => !(i.complete && i.naturalWidth === 640)).length;
    const links = [...document.querySelectorAll('a')].map(a => a.getAttribute('href'));
    const lost = links.filter(l => !l.startsWith('#') || !document.getElementById(l.slice(1)));
    const wide = document.documentElement.scrollWidth > window.innerWidth;
    return { images: document.images.length, links: links.length, broken, lost, wide };
  })())";
  const Opened whole = browser.open(folder_ / "p.html", look);
  ASSERT_TRUE(whole.loaded);
  EXPECT_THAT(whole.requests, testing::IsEmpty());
  EXPECT_THAT(whole.said, testing::IsEmpty());
  EXPECT_GE(whole.found["images"], 3) << whole.found;
  EXPECT_GE(whole.found["links"], 10);
  EXPECT_EQ(whole.found["broken"], 0);
  EXPECT_EQ(whole.found["lost"], Json::array());
  EXPECT_EQ(whole.found["wide"], false) << "it scrolls sideways";

  // What this looks for would be found.
  std::string worse = html;
  worse.replace(worse.find("base64,/9j/") + 7, 4, "AAAA");
  worse.replace(worse.find("<h1"), 0, "<img src=\"https://127.0.0.1:1/x.png\"><a href=\"#nowhere\">x</a>");
  spill(folder_ / "worse.html", worse);
  const Opened found = browser.open(folder_ / "worse.html", look);
  EXPECT_EQ(found.found["broken"], 2) << found.found;
  EXPECT_EQ(found.found["lost"], Json({"#nowhere"}));
  EXPECT_FALSE(found.said.empty()) << "a picture from elsewhere is refused, and that is said";
}

TEST_F(PageOfSmall, OfSeveralTraineesIsAClassAndOfOneItsAttemptsAsTheyBegan) {
  const auto of = [&](const std::string& file, int session, const std::string& trainee,
                      const std::string& began) {
    std::string text = text_;
    const std::size_t at = text.find("\"began\":\"");
    text.replace(at, 30, fmt::format(R"("trainee":"{}","began":"{}")", trainee, began));
    spill(folder_ / file, of_session(text, session));
  };
  of("a.jsonl", 1, "T-01", "2026-02-01T10:00:00Z");
  of("b.jsonl", 2, "T-01", "2026-01-01T10:00:00Z");
  EXPECT_EQ(calot({"page", "a.jsonl", "b.jsonl", "--no-pictures", "-o", "p.html"}).code, 0);
  const std::string curve = slurp(folder_ / "p.html");
  EXPECT_THAT(curve, HasSubstr("Learning curve"));
  EXPECT_LT(curve.find("href=\"#r2-recording\""), curve.find("href=\"#r1-recording\""))
      << "the earlier one is the first";
  EXPECT_LT(curve.find("id=\"r2-recording\""), curve.find("id=\"r1-recording\""))
      << "so do their sections stand";
  of("b.jsonl", 2, "T-02", "2026-01-01T10:00:00Z");
  const Outcome made = calot({"page", "a.jsonl", "b.jsonl", "--no-pictures", "-o", "p.html"});
  EXPECT_THAT(made.err, HasSubstr("several trainees"));
  EXPECT_THAT(slurp(folder_ / "p.html"), Not(HasSubstr("Learning curve")));
}

TEST_F(PageOfSmall, SaysWhereItsReplayMeasuresOtherwiseThanTheRecordingClaims) {
  EXPECT_EQ(calot({"page", "out/recording.jsonl", "-o", "p.html"}).code, 0);
  EXPECT_THAT(slurp(folder_ / "p.html"), Not(HasSubstr("is not what its replay measures")));
  std::string forged = text_;
  const std::string key = "\"left.path_length_mm\":";
  const std::size_t at = forged.find(key) + key.size();
  forged.replace(at, forged.find_first_of(",}", at) - at, "1.5");
  spill(folder_ / "forged.jsonl", sealed(forged));
  EXPECT_EQ(calot({"page", "forged.jsonl", "-o", "p.html"}).code, 0);
  EXPECT_THAT(slurp(folder_ / "p.html"),
              HasSubstr("is not what its replay measures: left.path_length_mm is 1.5 in the recording"));
}

TEST_F(PageOfSmall, WithoutPicturesWhatARecordingHoldsIsNotPlayedAgain) {
  const std::string file = (folder_ / "other.jsonl").string();
  Recording recording = read_recording((folder_ / "out" / "recording.jsonl").string()).value();
  recording.steps[3].state_hash = 1;  // who plays it notices
  {
    Result<RecordingWriter> writer = RecordingWriter::create(file, recording.header);
    for (const RecordedStep& step : recording.steps) ASSERT_TRUE(writer->write(step));
    ASSERT_TRUE(writer->write(*recording.measured) && writer->finish(recording.end));
  }
  const auto page = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"page", "other.jsonl", "-o", "p.html"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(calot(words).code, 0);
    return slurp(folder_ / "p.html");
  };
  EXPECT_THAT(page({}), HasSubstr("The replay parts from the recording at step 4"));
  const std::string html = page({"--no-pictures"});
  EXPECT_THAT(html, Not(HasSubstr("parts from")));
  EXPECT_THAT(html, HasSubstr("Way of the tip"));
  EXPECT_THAT(html, HasSubstr("Forces are known only where the recording is played again"));
}

/// Asks as a session does, and draws a small picture where that is wanted.
struct Drawn {
  explicit Drawn(PageMoments& moments) : moments_(moments) {}
  void at(double time) {
    if (moments_.wanted(progress).empty()) return;
    Frame frame;
    frame.time = time;
    frame.image = {16, 16, std::vector<unsigned char>(16 * 16 * 3)};
    EXPECT_FALSE(moments_.take(frame));
  }
  void event(EventKind kind, double time) {
    progress.add_event({kind, time, "left", "", 0});
    at(time);
  }
  Progress progress;

 private:
  PageMoments& moments_;
};

TEST(PageMoments, ErrorsThatFollowEachOtherFastShareAPicture) {
  PageMoments moments({EventKind::slip, EventKind::overforce});
  Drawn drawn(moments);
  drawn.event(EventKind::contact, 0.5);
  EXPECT_TRUE(moments.pictures.empty()) << "no error";
  drawn.event(EventKind::slip, 1);
  drawn.event(EventKind::slip, 1.2);
  drawn.event(EventKind::overforce, 1.3);
  drawn.event(EventKind::slip, 2);
  ASSERT_EQ(moments.pictures.size(), 3u);
  EXPECT_EQ(moments.events, (std::map<std::size_t, std::size_t>{{1, 0}, {2, 0}, {3, 1}, {4, 2}}));
  EXPECT_EQ(moments.left_out, 0u);
}

TEST(PageMoments, ThereAreOnlySoManyPicturesAndTheRestIsCounted) {
  PageMoments moments(
      {EventKind::slip, EventKind::overforce, EventKind::empty_grasp, EventKind::overstretch});
  Drawn drawn(moments);
  for (int i = 0; i < 30; ++i) {
    drawn.progress.begin_step(10 * i, "s", "Step", {0});
    drawn.at(10 * i);
    drawn.event(EventKind::slip, 10 * i + 1);
    drawn.event(EventKind::overforce, 10 * i + 2);
    drawn.event(EventKind::empty_grasp, 10 * i + 3);
  }
  EXPECT_EQ(moments.step_begins.size(), PageMoments::most_of_steps);
  EXPECT_EQ(moments.events.size(), PageMoments::most_of_errors);
  EXPECT_EQ(moments.pictures.size(), PageMoments::most_of_steps + PageMoments::most_of_errors);
  EXPECT_EQ(moments.left_out, 120 - moments.pictures.size());
}

}  // namespace
}  // namespace calot::test

// The page as a browser, a search for trouble and a screen reader see it.

#include "page/page.h"

#include <gmock/gmock.h>

#include <set>

#include "page/html.h"
#include "page/page_for_tests.h"

namespace calot::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Two recordings and one without a score.
std::string whole_page() {
  PageRow lost;
  lost.name = "lost", lost.verdict = "no score", lost.problem = "cannot read lost.jsonl";
  Page page = page_of({row("r1-", 40), row("r3-", 90, true)});
  page.not_counted = {lost};
  return page_html(
      page, {recording_html(made_up("r1-", 500, 30, 5, 100)), recording_html(made_up("r3-", 500, 30, 0, 0))});
}

TEST(ThePage, AsksForNoNetwork) {
  const std::string html = whole_page();
  for (const char* word :
       {"http:", "https:", "//", "<script", "<link", "<iframe", "@import", "url(", "srcset"})
    EXPECT_THAT(html, Not(HasSubstr(word))) << word;
  EXPECT_THAT(html, HasSubstr("content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\""));
  const std::vector<std::string> sources = all(html, "src=\"([^\"]{0,22})");
  EXPECT_EQ(sources.size(), 5u);
  for (const std::string& source : sources) EXPECT_EQ(source, "data:image/jpeg;base64");
}

TEST(ThePage, HasThePlaceOfEveryLinkOnce) {
  const std::string html = whole_page();
  const std::vector<std::string> ids = all(html, " id=\"([^\"]*)\"");
  const std::set<std::string> unique(ids.begin(), ids.end());
  EXPECT_EQ(unique.size(), ids.size());
  const std::vector<std::string> links = all(html, "href=\"([^\"]*)\"");
  for (const std::string& link : links) {
    ASSERT_EQ(link.substr(0, 1), "#") << link;
    EXPECT_TRUE(unique.contains(link.substr(1))) << link;
  }
  for (const char* prefix : {"r1-", "r3-"})
    for (int i = 1; i <= 30; ++i) {
      const std::string event = prefix + fmt::format("event-{}", i),
                        mark = prefix + fmt::format("mark-{}", i);
      EXPECT_THAT(links, Contains("#" + event)) << "from the timeline";
      EXPECT_THAT(links, Contains("#" + mark)) << "from the row";
      EXPECT_TRUE(unique.contains(event) && unique.contains(mark));
    }
  const std::string alone = recording_html(made_up("", 500, 30, 5, 100));
  EXPECT_THAT(alone, HasSubstr("<tr id=\"event-12\""));
  EXPECT_THAT(alone, HasSubstr("<figure id=\"picture-3\""));
  EXPECT_THAT(all(alone, "href=\"([^\"]*)\""), Contains("#picture-3"));
}

TEST(ThePage, AStepIsTickedByItsPointsWhereItHasAnyAndSaysHowItIsDoneWhereTheyAreLost) {
  PageRecording recording = made_up("", 100, 0, 0, 0);
  recording.steps.resize(2);
  recording.steps[0].hint = recording.steps[1].hint = "like this";
  const auto row = [&](double points, double most) {
    recording.steps[0].points = points, recording.steps[0].most = most;
    const std::string html = recording_html(recording);
    const std::size_t begin = html.find("<tr id=\"step-1\"");
    return html.substr(begin, html.find("</tr>", begin) - begin);
  };
  const std::string ticked = "&#10003;</span> ", crossed = "&#10007;</span> ";
  EXPECT_THAT(row(0, 0), HasSubstr(ticked + "done"));
  EXPECT_THAT(row(0, 0), Not(HasSubstr("like this")));
  EXPECT_THAT(row(2.4, 80), HasSubstr(crossed + "2.4 of 80.0"));
  EXPECT_THAT(row(2.4, 80), Not(HasSubstr(ticked))) << "it was done, and badly";
  EXPECT_THAT(row(2.4, 80), HasSubstr("like this"));
  EXPECT_THAT(row(80, 80), HasSubstr(ticked + "80.0 of 80.0"));
  EXPECT_THAT(row(80, 80), Not(HasSubstr("like this")));
}

TEST(ThePage, EscapesTextFromOutside) {
  const std::string evil = "<script>x</script>\"'><img onerror=x>&\x01";
  Page page = page_of({row("r1-", 40), row("r2-", 50)});
  page.title = page.scenario = page.file = page.benchmarks = page.calibration = evil;
  page.groups[0].title = evil;
  page.groups[0].parts = {{evil, evil}, {evil, evil}};
  for (PageRow& row : page.groups[0].rows)
    row.name = row.verdict = row.trainee = row.began = row.steps = evil;
  page.not_counted = {page.groups[0].rows[0]};
  page.not_counted[0].problem = evil;
  for (const bool of_a_class : {false, true}) {
    page.of_a_class = of_a_class;
    const std::string html = page_html(page, {recording_html(made_up("r1-", 100, 20, 2, 10, evil))});
    EXPECT_THAT(html, Not(HasSubstr("<script")));
    EXPECT_THAT(html, Not(HasSubstr("<img onerror")));
    EXPECT_EQ(html.find('\x01'), std::string::npos);
    EXPECT_GT(all(html, "(&lt;script&gt;x&lt;/script&gt;&quot;&#39;&gt;)").size(), 50u);
    // A quote that got through would end its attribute and begin another.
    EXPECT_EQ(all(html, "(\"'>)").size(), 0u);
  }
}

TEST(ThePage, OfALongRunStaysUnderFiveMegabytes) {
  // Five minutes at 50 Hz with four instruments, all pictures that are ever drawn, each larger than any seen, and all
  // events that are ever listed.
  const std::string html =
      page_html(page_of({row("", 40)}), {recording_html(made_up("", 15000, 1000, 40, 50'000))});
  EXPECT_LT(html.size(), 5'000'000u);
  EXPECT_GT(html.size(), 40 * 50'000u * 4 / 3) << "the pictures are inside";
}

TEST(ThePage, IsToldToWhoCannotSeeIt) {
  const std::string html = whole_page();
  EXPECT_THAT(html, HasSubstr("<html lang=\"en\">"));
  EXPECT_THAT(html, HasSubstr("width=device-width"));
  EXPECT_THAT(html, HasSubstr("<a class=\"skip\" href=\"#main\">"));
  EXPECT_EQ(all(html, "(<img )").size(), all(html, "(<img [^>]*alt=\"[^\"]+\")").size());
  EXPECT_EQ(all(html, "(<table>)").size(),
            all(html, "(<table><caption><span>[^<]+</span></caption>)").size());
  const std::size_t hidden = all(html, "(<svg [^>]*aria-hidden)").size();
  EXPECT_EQ(
      all(html, "(<svg )").size(),
      hidden +
          all(html, "(<svg [^>]*aria-labelledby=\"[^\"]+\"><title [^>]*>[^<]+</title><desc [^>]*>[^<]+<)")
              .size());
  int before = 0;
  for (const std::string& level : all(html, "<h([1-6])[ >]")) {
    EXPECT_LE(level[0] - '0', before + 1) << "a level of headings is left out";
    before = level[0] - '0';
  }
  EXPECT_EQ(all(html, "(<h1)").size(), 1u);
}

/// Of WCAG 2: relative luminance of "#rgb" or "#rrggbb".
double luminance(const std::string& colour) {
  const double weights[] = {0.2126, 0.7152, 0.0722};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string hex = colour.size() == 4 ? std::string(2, colour[i + 1]) : colour.substr(1 + 2 * i, 2);
    const double c = std::stoi(hex, nullptr, 16) / 255.0;
    sum += weights[i] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return sum;
}

TEST(ThePage, HasTextThatStandsOutInLightAndDark) {
  const std::string style = page_style();
  const auto values = [&](const std::string& name) { return all(style, "--" + name + ":(#[0-9a-f]+)"); };
  for (const char* ground : {"bg", "card", "mark"})
    for (const char* text : {"fg", "soft", "link", "bad", "good"}) {
      ASSERT_EQ(values(ground).size(), 2u) << ground;
      ASSERT_EQ(values(text).size(), 2u) << text;
      for (std::size_t scheme = 0; scheme < 2; ++scheme) {
        const double a = luminance(values(ground)[scheme]), b = luminance(values(text)[scheme]);
        EXPECT_GE((std::max(a, b) + 0.05) / (std::min(a, b) + 0.05), 4.5)  // WCAG's AA for text
            << text << " on " << ground << (scheme == 0 ? ", light" : ", dark");
      }
    }
}

TEST(Overview, HasBestMedianAndWorstOfWhatWasFinished) {
  Page page = page_of({row("r1-", 40), row("r2-", 90, true), row("r3-", 99, false, false), row("r4-", 60)});
  const std::optional<ClassTotals> totals = class_totals(page.groups[0]);
  ASSERT_TRUE(totals);
  EXPECT_EQ(totals->best, 90);
  EXPECT_EQ(totals->median, 60);
  EXPECT_EQ(totals->worst, 40);
  const std::string html = overview_html(page);
  EXPECT_THAT(html, HasSubstr("1 of 4 passed"));
  EXPECT_THAT(html, HasSubstr("1 unfinished"));
  EXPECT_THAT(html, HasSubstr("3 finished of 4 attempts"));
  EXPECT_EQ(overview_html(page_of({row("", 40)})), "") << "a single one has its section";
}

TEST(Overview, KeepsGroupsApartAndListsWhatIsNotCounted) {
  Page page = page_of({row("r1-", 40), row("r2-", 60)});
  page.groups.push_back({"practice", 70, {{"C", "100.0"}}, {row("r3-", 90, true), row("r4-", 100, true)}});
  page.not_counted = {row("r5-", 0)};
  page.not_counted[0].problem = "the same session as another one";
  const std::string html = overview_html(page);
  EXPECT_THAT(html, HasSubstr("<h3>exam</h3>"));
  EXPECT_THAT(html, HasSubstr("<h3>practice</h3>"));
  EXPECT_THAT(html, HasSubstr("0 of 2 passed; the pass mark is 80."));
  EXPECT_THAT(html, HasSubstr("2 of 2 passed; the pass mark is 70."));
  EXPECT_THAT(html, HasSubstr("the same session as another one"));
  EXPECT_EQ(all(html, "(median</t[dh]>)").size(), 2u) << "each group has its own";
  EXPECT_EQ(all(html, "id=\"(totals-[12]-title)").size(), 2u);
}

TEST(Overview, JoinsAttemptsInTheirOrderAndAClassNotAtAll) {
  Page page = page_of({row("r1-", 20), row("r2-", 99, false, false), row("r3-", 100, true)});
  const std::string curve = overview_html(page);
  EXPECT_THAT(curve, HasSubstr("Learning curve"));
  const std::vector<std::string> way = all(curve, "d=\"([^\"]*)\" class=\"curve c0\"");
  ASSERT_EQ(way.size(), 1u);
  EXPECT_EQ(std::count(way[0].begin(), way[0].end(), 'L'), 1) << "what was cut is left out: " << way[0];
  page.of_a_class = true;
  const std::string side_by_side = overview_html(page);
  EXPECT_THAT(side_by_side, Not(HasSubstr("Learning curve")));
  EXPECT_THAT(side_by_side, Not(HasSubstr("class=\"curve")));
  EXPECT_THAT(side_by_side, HasSubstr(">median<"));
}

TEST(Overview, MarksUnfinishedAttemptsWithTheirStepsAndUnsafeOnesWithACross) {
  Page page = page_of({row("r1-", 90, true), row("r2-", 30, false, false), row("r3-", 20, false, false)});
  page.groups[0].rows[1].steps = "2/5";
  page.groups[0].rows[2].unsafe = true;
  const std::string curve = overview_html(page);
  EXPECT_EQ(all(curve, "(class=\"disc\")").size(), 1u);
  EXPECT_EQ(all(curve, "(class=\"ring cut\")").size(), 1u);
  EXPECT_EQ(all(curve, "(class=\"cross\")").size(), 1u);
  EXPECT_THAT(curve, HasSubstr(">2/5</text>"));
  EXPECT_THAT(curve, HasSubstr("1 unfinished. 1 unsafe."));
}

TEST(Html, Base64IsThatOfItsStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace calot::test

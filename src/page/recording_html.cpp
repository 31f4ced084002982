#include <fmt/format.h>

#include <algorithm>

#include "page/html.h"
#include "page/page.h"
#include "page/svg.h"

namespace calot {
namespace {

constexpr std::size_t most_links = 12;

class Section {
 public:
  explicit Section(const PageRecording& recording) : recording_(recording), prefix_(recording.prefix) {}

  std::string html() const {
    return fmt::format(
               "<section id=\"{0}recording\" aria-labelledby=\"{0}name\"><h2 id=\"{0}name\">{1}</h2>\n",
               prefix_, escaped(recording_.name)) +
           verdict() + warnings() + parts() + timeline() + pictures() + plots() + steps() + events() +
           figures() + "</section>\n";
  }

 private:
  std::string head(const char* id, const char* words) const {
    return fmt::format("<h3 id=\"{}{}\">{}</h3>\n", prefix_, id, words);
  }
  template <class Html>
  static std::string each(std::size_t count, const Html& html) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i) out += html(i);
    return out;
  }
  std::string event_link(std::size_t index, const std::string& words) const {
    return fmt::format("<a href=\"#{}event-{}\">{}</a>", prefix_, index + 1, escaped(words));
  }
  std::string event_links(const std::vector<std::size_t>& events) const {
    std::string out;
    for (std::size_t i = 0; i < std::min(events.size(), most_links); ++i) {
      const PageEvent& event = recording_.events[events[i]];
      out += (i == 0 ? "" : ", ") + event_link(events[i], event.kind + " " + seconds(event.time));
    }
    if (events.size() > most_links)
      out += fmt::format(" and {} more among the <a href=\"#{}events\">events</a>",
                         events.size() - most_links, prefix_);
    return out;
  }

  std::string verdict() const {
    const PageScore& score = recording_.score;
    std::string out = fmt::format(
        "<p class=\"soft path\">{}</p><p class=\"total\"><b>{:.1f}</b> of 100 points {}</p>"
        "<p>Pass mark {:g}. The recording lasts {}.",
        escaped(recording_.file), score.total, verdict_html(recording_.verdict, recording_.passed),
        recording_.pass_mark, seconds(recording_.stopped_at));
    for (const PageGate& gate : score.gates)
      out +=
          fmt::format(" <strong>{}</strong> ({}): it {}caps the total at {:g} ({:.1f} without it){}{}.",
                      escaped(gate.reason), escaped(gate.found), gate.fails ? "fails the exercise and " : "",
                      gate.cap, score.uncapped, gate.events.empty() ? "" : ": ", event_links(gate.events));
    return out + "</p>\n";
  }

  std::string warnings() const {
    std::string out;
    for (const std::string& warning : recording_.warnings)
      out += fmt::format("<p class=\"warning\" role=\"note\">{}</p>\n", escaped(warning));
    return out;
  }

  std::string part(std::size_t index) const {
    const PagePart& part = recording_.score.parts[index];
    std::string out = fmt::format(
        "<li><h4>{}</h4><p class=\"soft path\">{}</p><p><b>{:.1f}</b> of {:.1f} points</p><p>{}.</p>",
        escaped(part.title), escaped(part.name), part.points, 100 * part.weight, escaped(part.explanation));
    if (!part.rule.empty()) out += fmt::format("<p>{}</p>", escaped(part.rule));
    out += benchmark_bar(part, fmt::format("{}part-{}", prefix_, index + 1));
    out += fmt::format("<p class=\"soft\">Figures: {}.</p>", escaped(part.calibration));
    if (!part.events.empty()) out += "<p>Events: " + event_links(part.events) + ".</p>";
    return out + "</li>\n";
  }

  std::string parts() const {
    return head("score", "Score, part by part") + "<ul class=\"cards\">\n" +
           each(recording_.score.parts.size(), [this](std::size_t i) { return part(i); }) + "</ul>\n";
  }

  std::string timeline() const {
    std::string out =
        head("time", "Timeline") +
        "<p class=\"soft\">Bars are steps, diamonds errors, rings other events; each leads to its row "
        "below.</p>\n" +
        timeline_html(recording_);
    if (recording_.events_left_out > 0)
      out += fmt::format(
          "<p class=\"warning\" role=\"note\">{} events are left out; of the others all that are errors "
          "come first.</p>\n",
          recording_.events_left_out);
    return out;
  }

  std::string picture_link(std::size_t index) const {
    return fmt::format("<a href=\"#{}picture-{}\">picture at {}</a>", prefix_, index + 1,
                       seconds(recording_.pictures[index].time));
  }

  std::string picture(std::size_t index) const {
    const PagePicture& picture = recording_.pictures[index];
    return fmt::format(
        "<figure id=\"{}picture-{}\"><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"The laparoscope's "
        "picture at {}: {}\"><figcaption><b>{}</b> {}</figcaption></figure>\n",
        prefix_, index + 1, data_uri(picture.media_type, picture.bytes), picture.width, picture.height,
        seconds(picture.time), escaped(picture.caption), seconds(picture.time), escaped(picture.caption));
  }

  std::string pictures() const {
    std::string out = head("pictures", "Pictures");
    if (!recording_.drawn) return out + "<p>None were asked for.</p>\n";
    out +=
        "<p class=\"soft\">Drawn anew by playing the recording again: where a step begins or ends, and at "
        "errors.</p>"
        "<div class=\"pictures\">\n";
    out += each(recording_.pictures.size(), [this](std::size_t i) { return picture(i); }) + "</div>\n";
    if (recording_.pictures_left_out > 0)
      out += fmt::format(
          "<p class=\"warning\" role=\"note\">{} more moments have no picture: a page holds only so many. "
          "Draw others with calot replay --at.</p>\n",
          recording_.pictures_left_out);
    return out;
  }

  std::string plots() const {
    if (recording_.plots.empty()) return {};
    std::string out = head("plots", recording_.simulated ? "Forces and paths" : "Paths");
    if (!recording_.simulated)
      out +=
          "<p class=\"soft\">Of where the instruments were sent. Forces are known only where the recording "
          "is "
          "played again, as for pictures.</p>\n";
    out += "<div class=\"plots\">\n";
    return out + each(recording_.plots.size(), [this](std::size_t i) { return plot_html(recording_, i); }) +
           "</div>\n";
  }

  /// How it is done, to who has not done it well.
  static std::string what_is_asked(const PageStep& step) {
    if (step.hint.empty() || (step.outcome == "done" && !(step.points < step.most)))
      return escaped(step.title);
    return fmt::format("{}<br><span class=\"soft\">{}</span>", escaped(step.title), escaped(step.hint));
  }

  /// A step that only takes its time is done however it was done: its points say more.
  static std::string outcome(const PageStep& step) {
    const bool done = step.outcome == "done";
    return done && step.most > 0 ? escaped(step.outcome) : verdict_html(step.outcome, done);
  }

  static std::string points(const PageStep& step) {
    if (!(step.most > 0)) return {};
    return verdict_html(fmt::format("{:.1f} of {:.1f}", step.points, step.most),
                        2 * step.points >= step.most);
  }

  std::string steps() const {
    HtmlTable table;
    table.caption = "Steps of the exercise";
    table.heads = {"step", "what is asked", "begins", "ends", "takes", "outcome", "points", "see"};
    table.numbers = "llrrrlll";
    for (std::size_t i = 0; i < recording_.steps.size(); ++i) {
      const PageStep& step = recording_.steps[i];
      std::string see;
      if (step.begin_picture) see += picture_link(*step.begin_picture);
      if (step.end_picture && step.end_picture != step.begin_picture)
        see += (see.empty() ? "" : ", ") + picture_link(*step.end_picture);
      table.rows.push_back(
          {fmt::format(" id=\"{}step-{}\"", prefix_, i + 1),
           {escaped(step.name), what_is_asked(step), seconds(step.started), seconds(step.ended),
            seconds(step.ended - step.started), outcome(step), points(step), see}});
    }
    return head("steps", "Steps") + (table.rows.empty() ? "<p>None was begun.</p>\n" : calot::html(table));
  }

  std::string events() const {
    HtmlTable table;
    table.caption = "Events; a row that is an error says so";
    table.heads = {"no.",   "time",  "event",     "instrument", "tissue",
                   "value", "cause", "place, mm", "step",       "see"};
    table.numbers = "rrlllrllll";
    for (std::size_t i = 0; i < recording_.events.size(); ++i) {
      const PageEvent& event = recording_.events[i];
      std::string see = fmt::format(
          "<a href=\"#{0}mark-{1}\" aria-label=\"event {1} on the timeline\">timeline</a>", prefix_, i + 1);
      if (event.picture) see += ", " + picture_link(*event.picture);
      table.rows.push_back(
          {fmt::format(" id=\"{}event-{}\"{}", prefix_, i + 1, event.error ? " class=\"error-row\"" : ""),
           {fmt::format("{}", i + 1), seconds(event.time),
            fmt::format("<span title=\"{}\">{}</span>{}", escaped(event.meaning), escaped(event.kind),
                        event.error ? " <b class=\"bad\">error</b>" : ""),
            escaped(event.instrument), escaped(event.organ), escaped(event.value), escaped(event.cause),
            escaped(event.place), escaped(event.step), see}});
    }
    return head("events", "Events") + (table.rows.empty() ? "<p>None happened.</p>\n" : calot::html(table));
  }

  static std::string facts(const char* caption, const std::vector<PageFact>& facts) {
    if (facts.empty()) return {};
    HtmlTable table;
    table.caption = caption;
    table.heads = {"name", "value"};
    table.numbers = "lr";
    for (const PageFact& fact : facts) table.rows.push_back({"", {escaped(fact.name), escaped(fact.value)}});
    return calot::html(table);
  }

  std::string figures() const {
    std::string out = head("figures", "All figures") + facts("The attempt", recording_.attempt) +
                      facts("Parameters of the exercise", recording_.parameters) +
                      facts("What the exercise noted", recording_.noted) +
                      "<details><summary>Everything that was measured</summary>" +
                      facts("Metrics; a name ends with its unit", recording_.metrics) + "</details>\n";
    if (recording_.notes.empty()) return out;
    out += "<h4>Notes</h4><ul>";
    for (const std::string& note : recording_.notes) out += "<li>" + escaped(note) + "</li>";
    return out + "</ul>\n";
  }

  const PageRecording& recording_;
  const std::string& prefix_;
};

}  // namespace

std::string recording_html(const PageRecording& recording) { return Section(recording).html(); }

}  // namespace calot

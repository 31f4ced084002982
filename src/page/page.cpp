#include "page/page.h"

#include <fmt/format.h>

#include "page/html.h"

namespace calot {
namespace {

/// Where to go from the top.
std::string contents(const Page& page) {
  std::string out = "<nav aria-label=\"Contents\"><ul>";
  if (page.count() != 1 || page.groups.empty()) out += "<li><a href=\"#overview\">Overview</a></li>";
  const std::pair<const char*, const char*> parts[] = {
      {"score", "Score"},       {"time", "Timeline"},
      {"pictures", "Pictures"}, {"plots", "Forces and paths"},
      {"events", "Events"},     {"figures", "All figures"}};
  for (const PageGroup& group : page.groups)
    for (const PageRow& row : group.rows) {
      if (page.count() > 1) {
        out += fmt::format("<li><a href=\"#{}recording\">{}</a></li>", row.prefix, escaped(row.name));
        continue;
      }
      for (const auto& [id, words] : parts)
        out += fmt::format("<li><a href=\"#{}{}\">{}</a></li>", row.prefix, id, words);
    }
  return out + "</ul></nav>\n";
}

std::string about(const Page& page) {
  return fmt::format(
      "<p>Exercise <b>{}</b> (<span class=\"path\">{}</span>). Benchmarks: {} (<strong>{}</strong>); each "
      "part of "
      "the score says where its figures come from.</p>\n",
      escaped(page.scenario), escaped(page.file), escaped(page.benchmarks), escaped(page.calibration));
}

}  // namespace

std::string page_html(const Page& page, const std::vector<std::string>& sections) {
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{0}: "
      "performance</title>\n<style>{1}</style></head>\n"
      "<body><a class=\"skip\" href=\"#main\">Skip to the content</a>\n<header><p class=\"soft\">Calot: "
      "report of a "
      "performance</p><h1>{0}</h1>\n",
      escaped(page.title), page_style());
  out +=
      about(page) + contents(page) + "</header>\n<main id=\"main\" tabindex=\"-1\">\n" + overview_html(page);
  for (const std::string& section : sections) out += section;
  return out + "</main></body></html>\n";
}

}  // namespace calot

#include "goldens/report.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/hash.h"
#include "page/html.h"
#include "process/project.h"
#include "render/png.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// A picture as an <img> of a data URI; the PNG goes through a scratch file, as the writer knows only files.
Result<std::string> figure(const std::string& caption, const Image& image, const fs::path& scratch) {
  if (image.width == 0)
    return fmt::format("<figure><div class=none>none</div><figcaption>{}</figcaption></figure>", caption);
  const Result<std::string> written = write_png(scratch.string(), image);
  if (!written) return written.failure();
  const Result<std::string> bytes = read_text(scratch);
  if (!bytes) return bytes.failure();
  return fmt::format("<figure><img alt=\"{0}\" src=\"{1}\"><figcaption>{0}</figcaption></figure>", caption,
                     data_uri("image/png", bytes.value()));
}

Result<std::string> section(const GoldenResult& result, const fs::path& scratch) {
  const Judgement& judgement = result.judgement;
  std::string html =
      fmt::format("<section class={}><h2>{}/{}: {}</h2><p>{}</p>", judgement.passed ? "ok" : "bad",
                  escaped(result.scenario), escaped(result.frame), to_text(judgement.verdict),
                  escaped(judgement.message));
  if (result.actual) html += fmt::format("<p>State {}.</p>", hex(result.actual->sidecar.state_hash));
  const Image none;
  const std::pair<const char*, const Image*> pictures[] = {
      {"expected", result.golden ? &result.golden->image : &none},
      {"actual", result.actual ? &result.actual->image : &none},
      {"difference", judgement.difference ? &judgement.difference->picture : &none}};
  for (const auto& [caption, image] : pictures) {
    const Result<std::string> part = figure(caption, *image, scratch);
    if (!part) return part.failure();
    html += part.value();
  }
  return html + "</section>\n";
}

const char* const head =
    "<!doctype html><html lang=en><meta charset=utf-8><title>Calot: golden images</title><style>"
    "body{font:15px/1.4 sans-serif;margin:2em;background:#15181c;color:#ddd}"
    "section{border-left:6px solid #4a7;padding:0 1em;margin:1.5em 0}section.bad{border-color:#c44}"
    "h2{font-size:1.1em;margin:0}figure{display:inline-block;width:32%;margin:0 1% 0 0;vertical-align:top}"
    "img{width:100%}figcaption,.none{color:#999}</style>\n";

}  // namespace

std::optional<Failure> GoldenPage::add(const GoldenResult& result) {
  std::string name = (fs::temp_directory_path() / "calot-report-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    return fail(FailureKind::usage, "cannot make a temporary folder", "set TMPDIR");
  const Result<std::string> part = section(result, fs::path(name) / "picture.png");
  std::error_code ignored;
  fs::remove_all(name, ignored);
  if (!part) return part.failure();
  ++all_;
  if (!result.judgement.passed) ++failed_;
  (result.judgement.passed ? passed_sections_ : failed_sections_) += part.value();
  return std::nullopt;
}

std::string GoldenPage::html() const {
  return head + fmt::format("<h1>{} of {} frames differ</h1>\n", failed_, all_) + failed_sections_ +
         passed_sections_ + "</html>\n";
}

}  // namespace calot

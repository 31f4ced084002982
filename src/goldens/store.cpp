#include "goldens/store.h"

#include <fmt/format.h>

#include "base/hash.h"
#include "process/project.h"
#include "render/png.h"
#include "session/build_info.h"
#include "session/json_fields.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

constexpr const char* schema = "calot.golden/1";
constexpr std::size_t longest_sidecar = 1 << 16;  // bytes: a hundred times what is written

fs::path with_extension(const fs::path& stem, const char* extension) {
  return stem.parent_path() / (stem.filename().string() + extension);  // frame names hold dots
}

CompareTolerance parse_tolerance(const Json& json, std::vector<std::string>& problems) {
  constexpr int all_pixels = 4096 * 4096;
  JsonFields fields(json, problems, "tolerance.");
  CompareTolerance tolerance;
  tolerance.small_delta = fields.integer("small_delta", 0, 255);
  tolerance.differing_pixels = fields.integer("differing_pixels", 0, all_pixels);
  tolerance.large_delta = fields.integer("large_delta", 0, 255);
  tolerance.blob_pixels = fields.integer("blob_pixels", 0, all_pixels);
  fields.expect_no_others();
  return tolerance;
}

GoldenSidecar parse_sidecar(const std::string& text, std::vector<std::string>& problems) {
  GoldenSidecar sidecar;
  std::string broken;
  const Json json = parse_json(text, broken);
  if (!broken.empty()) {
    problems.push_back(broken);
    return sidecar;
  }
  JsonFields fields(json, problems);
  if (fields.text("schema") != schema) {
    problems = {fmt::format("this is not of schema {}", schema)};
    return sidecar;
  }
  sidecar.width = fields.integer("width_px", 16, 4096);
  sidecar.height = fields.integer("height_px", 16, 4096);
  sidecar.time = fields.number("time_s", 0);
  sidecar.tolerance = parse_tolerance(fields.any("tolerance"), problems);
  sidecar.renderer = fields.text("renderer");
  sidecar.scenario_hash = fields.hash("scenario_hash");
  sidecar.state_hash = fields.hash("state_hash");
  sidecar.make = {fields.text("toolchain"), fields.text("instruction_set"), fields.text("mathematics")};
  fields.expect_no_others();
  return sidecar;
}

std::string sidecar_text(const GoldenSidecar& sidecar) {
  const CompareTolerance& tolerance = sidecar.tolerance;
  const OrderedJson json = {{"schema", schema},
                            {"width_px", sidecar.width},
                            {"height_px", sidecar.height},
                            {"time_s", sidecar.time},
                            {"tolerance",
                             {{"small_delta", tolerance.small_delta},
                              {"differing_pixels", tolerance.differing_pixels},
                              {"large_delta", tolerance.large_delta},
                              {"blob_pixels", tolerance.blob_pixels}}},
                            {"renderer", sidecar.renderer},
                            {"scenario_hash", hex(sidecar.scenario_hash)},
                            {"state_hash", hex(sidecar.state_hash)},
                            {"toolchain", sidecar.make.toolchain},
                            {"instruction_set", sidecar.make.instruction_set},
                            {"mathematics", sidecar.make.mathematics}};
  return json.dump(2) + "\n";
}

/// What differs in how the two were made, in words; empty when nothing does.
std::string other_make(const GoldenSidecar& golden, const GoldenSidecar& actual) {
  std::string text;
  const auto add = [&](const char* what, const std::string& a, const std::string& b) {
    if (a != b) text += fmt::format("{}{}: golden {}, here {}", text.empty() ? "" : "; ", what, a, b);
  };
  add("renderer", golden.renderer, actual.renderer);
  add("toolchain", golden.make.toolchain, actual.make.toolchain);
  add("instruction set", golden.make.instruction_set, actual.make.instruction_set);
  add("mathematics", golden.make.mathematics, actual.make.mathematics);
  return text;
}

std::string pixels_text(const ImageDifference& difference) {
  return fmt::format(
      "{} pixels differ, by up to {} of 255; the largest blob has {} pixels in {} x {} at ({}, {})",
      difference.differing_pixels, difference.max_delta, difference.largest_blob, difference.blob_width,
      difference.blob_height, difference.blob_x, difference.blob_y);
}

Failure unfit(const fs::path& path, const std::vector<std::string>& problems) {
  Failure failure{FailureKind::usage, {}};
  for (const std::string& problem : problems)
    failure.problems.push_back({{path.string(), 0, {}}, problem, "restore it, or accept the frame anew"});
  keep_first(failure.problems);
  return failure;
}

}  // namespace

std::string to_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::same:
      return "same";
    case Verdict::same_picture:
      return "same picture";
    case Verdict::physics_changed:
      return "physics changed";
    case Verdict::rendering_changed:
      return "rendering changed";
    case Verdict::missing:
      return "missing";
    case Verdict::unreadable:
      return "unreadable";
    case Verdict::stale:
      return "stale";
    case Verdict::no_scenario:
      return "no scenario";
    case Verdict::not_played:
      return "not played";
  }
  return "not played";
}

Result<Golden> read_golden(const fs::path& stem) {
  const fs::path path = with_extension(stem, ".json");
  const Result<std::string> text = read_text(path, longest_sidecar);
  if (!text) return text.failure();
  std::vector<std::string> wrong;
  Golden golden;
  golden.sidecar = parse_sidecar(text.value(), wrong);
  if (!wrong.empty()) return unfit(path, wrong);
  const fs::path picture = with_extension(stem, ".png");
  Result<Image> image = read_png(picture.string());
  if (!image) return image.failure();
  golden.image = std::move(image).value();
  if (golden.image.width != golden.sidecar.width || golden.image.height != golden.sidecar.height)
    return unfit(path, {fmt::format("width_px and height_px are {} x {}, but {} has {} x {}",
                                    golden.sidecar.width, golden.sidecar.height, picture.filename().string(),
                                    golden.image.width, golden.image.height)});
  return golden;
}

Result<std::string> write_golden(const fs::path& stem, const Golden& golden) {
  const Result<fs::path> folder = make_folder(stem.parent_path());
  if (!folder) return folder.failure();
  const Result<std::string> written = write_png(with_extension(stem, ".png").string(), golden.image);
  if (!written) return written.failure();
  return write_text(with_extension(stem, ".json"), sidecar_text(golden.sidecar));
}

Golden make_golden(const Frame& frame) {
  Golden golden;
  golden.image = frame.image;
  golden.sidecar.width = frame.image.width;
  golden.sidecar.height = frame.image.height;
  golden.sidecar.time = frame.time;
  golden.sidecar.renderer = frame.renderer;
  golden.sidecar.scenario_hash = frame.source_hash;
  golden.sidecar.state_hash = frame.state_hash;
  golden.sidecar.make = this_make();
  return golden;
}

Judgement judge(const Golden& golden, const Golden& actual) {
  const GoldenSidecar &stored = golden.sidecar, &present = actual.sidecar;
  const std::string make = other_make(stored, present);
  const std::string in_brackets = make.empty() ? "" : fmt::format(" ({})", make);
  const bool same_state = stored.state_hash == present.state_hash;
  const bool same_binary = same_bits(stored.make, present.make);
  Judgement judgement;
  Result<ImageDifference> difference =
      compare(golden.image, actual.image, make.empty() ? CompareTolerance() : stored.tolerance);
  const bool same_picture = difference && difference->within;
  const std::string pixels = difference ? pixels_text(difference.value()) : to_text(difference.failure());
  const std::string edited = stored.scenario_hash == present.scenario_hash
                                 ? ""
                                 : "; the scenario's text has changed too: look there first";
  if (difference) judgement.difference = std::move(difference).value();
  if (same_state && same_picture) {
    if (judgement.difference->max_delta > 0) judgement.message = pixels + in_brackets;
  } else if (same_state) {
    judgement.verdict = Verdict::rendering_changed;
    judgement.message = pixels + edited + in_brackets;
  } else if (same_picture && !same_binary) {
    judgement.verdict = Verdict::same_picture;
    judgement.message = "other bits are expected here, and the picture does not differ" + in_brackets;
  } else {
    judgement.verdict = Verdict::physics_changed;
    judgement.message =
        fmt::format("state {}, golden {}; {}{}{}{}", hex(present.state_hash), hex(stored.state_hash),
                    same_picture ? "no pixel shows it" : pixels, edited,
                    same_binary ? "" : "; other bits are expected here, but not this much", in_brackets);
  }
  judgement.passed = judgement.verdict == Verdict::same || judgement.verdict == Verdict::same_picture;
  return judgement;
}

}  // namespace calot

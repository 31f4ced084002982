#include "app/golden_store.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/project.h"
#include "base/hash.h"
#include "render/png.h"
#include "session/build_info.h"

namespace calot {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* schema = "calot.golden/1";

fs::path with_extension(const fs::path& stem, const char* extension) {
  return stem.parent_path() / (stem.filename().string() + extension);  // frame names hold dots
}

std::uint64_t parse_hash(const Json& json) { return std::stoull(json.get<std::string>(), nullptr, 16); }

GoldenSidecar parse_sidecar(const std::string& text) {
  const Json json = Json::parse(text);
  if (json.at("schema") != schema) throw std::runtime_error(fmt::format("this is not of schema {}", schema));
  GoldenSidecar sidecar;
  sidecar.width = json.at("width_px");
  sidecar.height = json.at("height_px");
  sidecar.time = json.at("time_s");
  const Json& tolerance = json.at("tolerance");
  sidecar.tolerance.small_delta = tolerance.at("small_delta");
  sidecar.tolerance.differing_pixels = tolerance.at("differing_pixels");
  sidecar.tolerance.large_delta = tolerance.at("large_delta");
  sidecar.tolerance.blob_pixels = tolerance.at("blob_pixels");
  sidecar.renderer = json.at("renderer");
  sidecar.scenario_hash = parse_hash(json.at("scenario_hash"));
  sidecar.state_hash = parse_hash(json.at("state_hash"));
  sidecar.toolchain = json.at("toolchain");
  sidecar.instruction_set = json.at("instruction_set");
  return sidecar;
}

std::string sidecar_text(const GoldenSidecar& sidecar) {
  const CompareTolerance& tolerance = sidecar.tolerance;
  const Json json = {{"schema", schema},
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
                     {"toolchain", sidecar.toolchain},
                     {"instruction_set", sidecar.instruction_set}};
  return json.dump(2) + "\n";
}

/// What differs in how the two were made, in words; empty when nothing does.
std::string other_make(const GoldenSidecar& golden, const GoldenSidecar& actual) {
  std::string text;
  const auto add = [&](const char* what, const std::string& a, const std::string& b) {
    if (a != b) text += fmt::format("{}{}: golden {}, here {}", text.empty() ? "" : "; ", what, a, b);
  };
  add("renderer", golden.renderer, actual.renderer);
  add("toolchain", golden.toolchain, actual.toolchain);
  add("instruction set", golden.instruction_set, actual.instruction_set);
  return text;
}

std::string pixels_text(const ImageDifference& difference) {
  return fmt::format(
      "{} pixels differ, by up to {} of 255; the largest blob has {} pixels in {} x {} at ({}, {})",
      difference.differing_pixels, difference.max_delta, difference.largest_blob, difference.blob_width,
      difference.blob_height, difference.blob_x, difference.blob_y);
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
    case Verdict::stale:
      return "stale";
    case Verdict::not_played:
      return "not played";
  }
  return "not played";
}

Result<Golden> read_golden(const fs::path& stem) {
  const fs::path path = with_extension(stem, ".json");
  const Result<std::string> text = read_text(path);
  if (!text) return text.failure();
  Golden golden;
  try {
    golden.sidecar = parse_sidecar(text.value());
  } catch (const std::exception& error) {
    return fail(FailureKind::usage, error.what(), "restore it, or accept the frame anew",
                {path.string(), 0, {}});
  }
  Result<Image> image = read_png(with_extension(stem, ".png").string());
  if (!image) return image.failure();
  golden.image = std::move(image).value();
  return golden;
}

Result<std::string> write_golden(const fs::path& stem, const Golden& golden) {
  const Result<fs::path> folder = make_folder(stem.parent_path());
  if (!folder) return folder.failure();
  const Result<std::string> written = write_png(with_extension(stem, ".png").string(), golden.image);
  if (!written) return written.failure();
  return write_text(with_extension(stem, ".json"), sidecar_text(golden.sidecar));
}

Golden make_golden(const Frame& frame, const ExerciseDefinition& exercise, const std::string& renderer) {
  Golden golden;
  golden.image = frame.image;
  golden.sidecar.width = frame.image.width;
  golden.sidecar.height = frame.image.height;
  golden.sidecar.time = frame.time;
  golden.sidecar.renderer = renderer;
  golden.sidecar.scenario_hash = exercise.source_hash;
  golden.sidecar.state_hash = frame.state_hash;
  golden.sidecar.toolchain = toolchain();
  golden.sidecar.instruction_set = instruction_set();
  return golden;
}

Judgement judge(const Golden& golden, const Golden& actual) {
  const GoldenSidecar &stored = golden.sidecar, &present = actual.sidecar;
  const std::string make = other_make(stored, present);
  const std::string in_brackets = make.empty() ? "" : fmt::format(" ({})", make);
  const bool same_state = stored.state_hash == present.state_hash;
  const bool same_binary =
      stored.toolchain == present.toolchain && stored.instruction_set == present.instruction_set;
  Judgement judgement;
  Result<ImageDifference> difference =
      compare(golden.image, actual.image, make.empty() ? CompareTolerance() : stored.tolerance);
  const bool same_picture = difference && difference->within;
  const std::string pixels = difference ? pixels_text(difference.value()) : to_text(difference.failure());
  if (difference) judgement.difference = std::move(difference).value();
  if (same_state && same_picture) {
    if (judgement.difference->max_delta > 0) judgement.message = pixels + in_brackets;
  } else if (same_state) {
    judgement.verdict = Verdict::rendering_changed;
    judgement.message = pixels + in_brackets;
  } else if (same_picture && !same_binary) {
    judgement.verdict = Verdict::same_picture;
    judgement.message = "the state differs, the picture does not" + in_brackets;
  } else {
    judgement.verdict = Verdict::physics_changed;
    judgement.message = fmt::format(
        "state {}, golden {}; {}{}{}", hex(present.state_hash), hex(stored.state_hash),
        same_picture ? "no pixel shows it" : pixels,
        stored.scenario_hash == present.scenario_hash ? "" : "; the scenario's text has changed too",
        in_brackets);
  }
  judgement.passed = judgement.verdict == Verdict::same || judgement.verdict == Verdict::same_picture;
  return judgement;
}

}  // namespace calot

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
  sidecar.course = parse_course(fields.any("course"), problems);
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
                            {"course", course_json(sidecar.course)},
                            {"renderer", sidecar.renderer},
                            {"scenario_hash", hex(sidecar.scenario_hash)},
                            {"state_hash", hex(sidecar.state_hash)},
                            {"toolchain", sidecar.make.toolchain},
                            {"instruction_set", sidecar.make.instruction_set},
                            {"mathematics", sidecar.make.mathematics}};
  return json.dump(2) + "\n";
}

Failure unfit(const fs::path& path, const std::vector<std::string>& problems) {
  Failure failure{FailureKind::usage, {}};
  for (const std::string& problem : problems)
    failure.problems.push_back({{path.string(), 0, {}}, problem, "restore it, or accept the frame anew"});
  keep_first(failure.problems);
  return failure;
}

}  // namespace

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
  return write_sidecar(stem, golden.sidecar);
}

Result<std::string> write_sidecar(const fs::path& stem, const GoldenSidecar& sidecar) {
  return write_text(with_extension(stem, ".json"), sidecar_text(sidecar));
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

}  // namespace calot

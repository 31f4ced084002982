#include <fmt/format.h>

#include "app/commands.h"
#include "base/processor.h"
#include "play/play.h"
#include "process/project.h"
#include "process/terminal.h"
#include "render/offscreen.h"
#include "session/build_info.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

struct Finding {
  bool ok;
  std::string what, detail, remedy;
};

/// That this build runs here is sure; whether one for a newer instruction set would, is not.
Finding processor() {
  const Make make = this_make();
  const char* offers = processor_has_x86_64_v3() ? "offers x86-64-v3" : "does not offer x86-64-v3";
  const char* faster = processor_has_x86_64_v3() && !built_for_x86_64_v3
                           ? ": scripts/run builds a faster program, unless CALOT_ARCH says otherwise"
                           : "";
  return {true, "processor",
          fmt::format("{}; this build uses {} ({}){}", offers, make.instruction_set, make.toolchain, faster),
          ""};
}

/// What else decides the bits of a state: where this differs, so do hashes.
Finding mathematics() { return {true, "mathematics", this_make().mathematics, ""}; }

Finding threads() {
  return {true, "threads",
          fmt::format("{} unless told by --threads, of {} cores", usual_threads(),
                      std::thread::hardware_concurrency()),
          ""};
}

Finding folder(const std::string& name, const std::string& use) {
  std::error_code ignored;
  const fs::path path = project_part(name);
  const bool found = fs::is_directory(path, ignored);
  return {found, use, path.string() + (found ? "" : " is missing"), "run from inside a copy of the project"};
}

Finding renderer() {
  Result<OffscreenRenderer> created = OffscreenRenderer::create();
  if (!created)
    return {false, "pictures", to_text(created.failure()), "install libosmesa6, or use --no-render"};
  SceneMesh mesh;
  mesh.positions = {{-0.01, 0.1, 0}, {0.01, 0.1, 0}, {0, 0.1, 0.01}};
  mesh.normals = {3, -Vec3::UnitY()};
  mesh.rest_positions = mesh.positions;
  mesh.triangles = {{0, 1, 2}};
  Scene scene;
  scene.meshes.push_back(mesh);
  const Result<Image> image = created->render(scene);
  if (!image) return {false, "pictures", to_text(image.failure()), "install libosmesa6, or use --no-render"};
  return {true, "pictures", created->description(), ""};
}

Finding output() {
  const Result<fs::path> made = make_folder("out");
  const fs::path probe = fs::path("out") / ".doctor";
  const Result<std::string> written =
      made ? write_text(probe, std::string(100'000, ' ')) : Result<std::string>(made.failure());
  if (!written)
    return {false, "output folder", to_text(written.failure()),
            "run in a folder you may write to, or give -o DIR"};
  std::error_code ignored;
  fs::remove(probe, ignored);
  return {true, "output folder", fs::absolute(made.value()).string(), ""};
}

/// Every scenario of the project loads and comes to rest.
Finding scenarios() {
  const std::vector<fs::path> files = project_scenarios();
  for (const fs::path& file : files) {
    const Result<ExerciseDefinition> exercise = load_definition(file);
    if (!exercise)
      return {false, "scenarios", to_text(exercise.failure()), "calot check " + shell_word(file.string())};
  }
  return {!files.empty(), "scenarios", fmt::format("{} load without errors", files.size()),
          "calot new my_exercise"};
}

}  // namespace

ExitCode doctor_command(const DoctorCommand& command) {
  if (command.dry_run) return ExitCode::ok;
  tell_borrowed_project();
  bool ok = true;
  for (const Finding& finding :
       {processor(), mathematics(), threads(), folder("scripts/lua", "Lua modules"),
        folder("assets", "assets"), folder("golden", "goldens"), scenarios(), renderer(), output()}) {
    print(fmt::format("{}  {}: {}", finding.ok ? green("ok    ") : red("FAILED"), finding.what,
                      finding.detail));
    if (finding.ok) continue;
    ok = false;
    std::fflush(stdout);
    std::fprintf(stderr, "Next: %s\n", finding.remedy.c_str());
  }
  return ok ? ExitCode::ok : ExitCode::mismatch;
}

}  // namespace calot

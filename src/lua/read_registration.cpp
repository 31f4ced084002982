#include "lua/read_registration.h"

#include <fmt/format.h>

#include "base/suggest.h"
#include "base/units.h"
#include "lua/table_file.h"
#include "lua/table_reader.h"

namespace calot {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr double axes_slack = 1e-6;  // of what is written with few decimals or computed

const KeyTable& columns_keys() {
  using Columns = CsvColumns;
  const auto column = [](const char* name, std::string Columns::*member, const char* doc) {
    return text(name, member, doc);
  };
  static const KeyTable table =
      keys_of<Columns>("columns", "what a CSV file's columns are called: { time = \"Time (s)\" }",
                       {column("time", &Columns::time, "time"),
                        column("instrument", &Columns::instrument, "which tool the row is of"),
                        column("tip_x", &Columns::tip_x, "tip"), column("tip_y", &Columns::tip_y, "tip"),
                        column("tip_z", &Columns::tip_z, "tip"),
                        column("dir_x", &Columns::dir_x, "along the shaft, to the tip"),
                        column("dir_y", &Columns::dir_y, "along the shaft"),
                        column("dir_z", &Columns::dir_z, "along the shaft"),
                        column("pitch", &Columns::pitch, "of the trocar's pivot"),
                        column("yaw", &Columns::yaw, "of the pivot"),
                        column("insertion", &Columns::insertion, "trocar to tip"),
                        column("roll", &Columns::roll, "about the shaft"),
                        column("jaw", &Columns::jaw, "angle between the jaws, or see jaw_closed")});
  return table;
}

const KeyTable& tool_keys() {
  using Tool = ForeignInstrument;
  static const KeyTable table = keys_of<Tool>(
      "foreign_instrument", "one tool of the file: { name = \"left\", source = \"slave_left\" }",
      {required(text("name", &Tool::name, "the exercise's instrument")),
       required(text("source", &Tool::source, "what the file calls it")),
       point("port", quantity::number, 1e6, "", "the trocar's place in the file's frame and unit"),
       bound(point("tip", quantity::number, 1e6, "", "the tip in the tool's own frame, the file's unit"),
             &Tool::tip),
       direction("along", &Tool::along, "the shaft towards the tip in the tool's own frame"),
       direction("across", &Tool::across, "in the plane in which the jaws open, in the tool's own frame"),
       text("jaw", &Tool::jaw, "sequence: the frame field of the jaws' opening"),
       number("jaw_closed", &Tool::jaw_closed, quantity::number, -endless, endless, "",
              "the file's value of closed jaws"),
       number("jaw_open", &Tool::jaw_open, quantity::number, -endless, endless, "",
              "the file's value of open jaws")});
  return table;
}

const KeyTable& registration_keys() {
  using Table = Registration;
  static const KeyTable table = keys_of<Table>(
      "registration", "a registration: { version = 1, exercise = ..., format = ..., instruments = { ... } }",
      {required(
           count("version", &Table::version, 1, 1'000'000, "", "of the table: a whole number that grows")),
       required(text("exercise", &Table::exercise, "the id of the exercise that it is for")),
       required(choice("format", &Table::format, motion_format_names(), "of the files")),
       number("unit", &Table::unit, quantity::number, 1e-9, 1e3, "a length in m",
              "their unit of length in m"),
       number("angle_unit", &Table::angle_unit, quantity::number, 1e-9, 1e3, "an angle in rad",
              "theirs in rad"),
       number("time_unit", &Table::time_unit, quantity::number, 1e-12, 1e3, "a time in s", "theirs in s"),
       number("time_step", &Table::time_step, quantity::time, 1e-6, 10, "a time between rows",
              "between rows, of files without times"),
       direction("x_axis", &Table::x_axis, "their x axis in the patient's frame"),
       direction("y_axis", &Table::y_axis, "their y axis in the patient's frame"),
       direction("z_axis", &Table::z_axis, "their z axis in the patient's frame"),
       number("longest_gap", &Table::longest_gap, quantity::time, 1e-3, 3600, "",
              "what is further apart is not joined"),
       calot::table("columns", "columns", "what a CSV file's columns are called"),
       required(list("instruments", "foreign_instrument", "which tool of the file is which instrument"))});
  return table;
}

class RegistrationReader {
 public:
  explicit RegistrationReader(const TableFile& file) : file_(file) {}

  Result<Registration> read() {
    const TableReader reader(check_, &file_.root, "", registration_keys());
    reader.read(result_);
    if (const Value* columns = reader.take("columns"))
      TableReader(check_, columns, "columns", columns_keys()).read(result_.columns);
    if (const Value* tools = reader.take("instruments"))
      for (std::size_t i = 0; i < tools->items.size(); ++i)
        read_tool(tools->items[i], indexed("instruments", i));
    if (reader.has("instruments") && result_.instruments.empty())
      check_.problem("instruments", "there are none", tool_keys().doc);
    check_axes(reader);
    if (reader.has("format") && result_.format == MotionFormat::jigsaws && !reader.has("time_step"))
      check_.problem("format", "\"time_step\" is missing",
                     "these files have no times: add time_step = 1 / 30 * s");
    std::vector<Problem> problems = check_.take();
    for (Problem& problem : problems) locate(problem, file_.map, file_.file);
    keep_first(problems);
    if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
    result_.place = {file_.file, std::max(1, file_.map.line_of("instruments")), "instruments"};
    return std::move(result_);
  }

 private:
  void read_tool(const Value& value, const std::string& path) {
    ForeignInstrument tool;
    const TableReader reader(check_, &value, path, tool_keys());
    reader.read(tool);
    if (reader.has("port")) reader.take("port", tool.port.emplace());
    if (reader.has("jaw_closed") != reader.has("jaw_open"))
      check_.problem(path, "one of jaw_closed and jaw_open is missing",
                     "give both, or neither where the file has angles");
    else if (tool.jaw_closed && *tool.jaw_closed == *tool.jaw_open)
      check_.problem(path + ".jaw_open", "it is the value of closed jaws too", "they must differ");
    if (result_.format == MotionFormat::jigsaws) {
      if (reader.has("source")) check_.known(path + ".source", tool.source, jigsaws_arms(), "arm");
      if (!tool.port)
        check_.problem(
            path, "\"port\" is missing",
            "these tools have wrists, whose directions are not the shaft's: add port = { x, y, z }");
    }
    for (const auto& [key, direction] : {std::pair{"along", &tool.along}, {"across", &tool.across}})
      if (!(direction->norm() > 0))
        check_.problem(path + "." + key, "this has no direction", "such as { 0, 0, 1 }");
    tool.place = {file_.file, file_.map.line_of(path), path};
    result_.instruments.push_back(std::move(tool));
  }

  void check_axes(const TableReader& reader) {
    Mat3 axes;
    axes << result_.x_axis, result_.y_axis, result_.z_axis;
    const double off = (axes.transpose() * axes - Mat3::Identity()).cwiseAbs().maxCoeff();
    if (off < axes_slack && axes.determinant() > 0) return;
    const std::string key = reader.has("x_axis") ? "x_axis" : reader.has("y_axis") ? "y_axis" : "z_axis";
    check_.problem(key,
                   off < axes_slack ? "these axes are left-handed"
                                    : "these axes are not of length 1 and upright on each other",
                   "give x_axis, y_axis and z_axis of a right-handed frame");
  }

  const TableFile& file_;
  FieldCheck check_;
  Registration result_;
};

}  // namespace

Result<Registration> read_registration(const std::filesystem::path& path,
                                       const std::filesystem::path& modules) {
  const Result<TableFile> file = read_table_file(path, modules, "return " + registration_keys().doc);
  if (!file) return file.failure();
  return RegistrationReader(file.value()).read();
}

}  // namespace calot

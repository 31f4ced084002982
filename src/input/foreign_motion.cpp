#include "input/foreign_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <string_view>

#include "base/byte_order_mark.h"
#include "base/suggest.h"
#include "input/registration.h"
#include "session/csv.h"

namespace calot {
namespace {

constexpr std::size_t longest_row = 1 << 16;  // bytes
constexpr int most_rows = 5'000'000;          // of a file
constexpr double rotation_slack = 1e-2;       // of R R^T - 1: files give few digits
constexpr std::size_t jigsaws_numbers = 76, arm_numbers = 19;

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  return begin == std::string_view::npos ? ""
                                         : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::optional<double> finite_number(std::string_view text) {
  double value = 0;
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The numbers of a text that spaces separate; none where one of its words is no number.
std::optional<std::vector<double>> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t at = text.find_first_not_of(" \t\r"); at != std::string_view::npos;
       at = text.find_first_not_of(" \t\r", at)) {
    const std::size_t end = std::min(text.find_first_of(" \t\r", at), text.size());
    const std::optional<double> number = finite_number(text.substr(at, end - at));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    at = end;
  }
  return numbers;
}

/// What all formats share: lines, and what is wrong with them.
class MotionReader {
 public:
  MotionReader(const std::string& path, const Registration& registration)
      : registration_(registration), in_(path, std::ios::binary) {
    motion_.file = path;
    motion_.tracks.resize(registration.instruments.size());
  }
  virtual ~MotionReader() = default;

  Result<ForeignMotion> read() {
    if (!in_)
      return fail(FailureKind::usage, fmt::format("cannot read {}", motion_.file), "give the path of a file");
    while (problems_.size() <= 100 && next_line() && take_line(std::string_view(line_).substr(0, length_))) {
    }
    if (in_.bad()) problem("this cannot be read", "");
    finish();
    shorten_problems();
    keep_first(problems_);
    if (!problems_.empty()) return Failure{FailureKind::usage, std::move(problems_)};
    return std::move(motion_);
  }

 protected:
  /// False where nothing that follows matters.
  virtual bool take_line(std::string_view line) = 0;
  virtual void finish() {}

  void problem(std::string message, std::string hint) {
    problems_.push_back({{motion_.file, std::max(1, row_), {}}, std::move(message), std::move(hint)});
  }
  const std::vector<ForeignInstrument>& instruments() const { return registration_.instruments; }

  const Registration& registration_;
  ForeignMotion motion_;
  int row_ = 0;
  std::vector<Problem> problems_;

 private:
  bool next_line() {
    if (in_.peek() == std::ifstream::traits_type::eof()) return false;
    ++row_;
    in_.getline(line_.data(), static_cast<std::streamsize>(line_.size()));
    const bool last = in_.eof();  // without a line end
    length_ = static_cast<std::size_t>(in_.gcount()) - (in_ && !last ? 1U : 0U);
    if (!in_.fail() && row_ <= most_rows) return true;
    problem(fmt::format("this line has {} bytes or more, or is one of more than {}", longest_row, most_rows),
            "this is no file of this format");
    return false;
  }

  /// Of a file of which nothing is right a few rows say enough.
  void shorten_problems() {
    constexpr std::size_t enough = 3;
    const bool nothing = std::all_of(motion_.tracks.begin(), motion_.tracks.end(),
                                     [](const std::vector<ForeignSample>& track) { return track.empty(); });
    if (!nothing || problems_.size() <= enough) return;
    problems_.resize(enough);
    problem(fmt::format("not one row is right: is this a file of format {}?",
                        motion_format_names()[static_cast<std::size_t>(registration_.format)]),
            "see the registration's format");
  }

  std::ifstream in_;
  std::string line_ = std::string(longest_row, '\0');
  std::size_t length_ = 0;
};

class CsvReader final : public MotionReader {
 public:
  using MotionReader::MotionReader;

 private:
  bool take_line(std::string_view line) override {
    if (row_ == 1) return read_head(line);
    if (trimmed(line).empty()) return true;
    const std::optional<std::vector<std::string>> fields = csv_fields(line, separator_);
    if (!fields)
      problem("a quotation does not end on this line", "mend or remove the row");
    else if (fields->size() != columns_)
      problem(fmt::format("{} fields, where the first line names {}", fields->size(), columns_),
              "mend or remove the row");
    else
      take_row(*fields);
    return true;
  }

  bool read_head(std::string_view line) {
    line = without_byte_order_mark(line);
    for (const char c : {',', ';', '\t'})
      if (line.find(c) != std::string_view::npos) {
        separator_ = c;
        break;
      }
    const std::optional<std::vector<std::string>> names = csv_fields(line, separator_);
    if (!names) {
      problem("a quotation does not end on this line", "the first line names the columns");
      return false;
    }
    columns_ = names->size();
    for (std::size_t i = 0; i < columns_; ++i) at_[(*names)[i]] = i;
    const CsvColumns& called = registration_.columns;
    pivot_ = has(called.pitch) && has(called.yaw) && has(called.insertion);
    const bool by_name = instruments().size() > 1;
    std::vector<std::string> needed{called.time};
    if (by_name) needed.push_back(called.instrument);
    for (const std::string& name : pivot_ ? std::vector{called.pitch, called.yaw, called.insertion}
                                          : std::vector{called.tip_x, called.tip_y, called.tip_z})
      needed.push_back(name);
    for (const std::string& name : needed)
      if (!has(name))
        problem(fmt::format("there is no column \"{}\"", name),
                suggestion(name, *names) + "; or name yours in the registration's columns");
    return problems_.empty();
  }

  bool has(const std::string& name) const { return at_.contains(name); }

  /// Nothing, and a problem, where the field is no number.
  double number(const std::vector<std::string>& fields, const std::string& name) {
    const std::string& text = fields[at_.at(name)];
    if (const std::optional<double> value = finite_number(text)) return *value;
    problem(fmt::format("{} is \"{}\", no number", name, shortened(text, 40)), "mend or remove the row");
    return 0;
  }
  Vec3 point(const std::vector<std::string>& fields, const std::string& x, const std::string& y,
             const std::string& z) {
    return {number(fields, x), number(fields, y), number(fields, z)};
  }

  void take_row(const std::vector<std::string>& fields) {
    const CsvColumns& called = registration_.columns;
    std::size_t track = 0;
    if (has(called.instrument)) {
      const std::string& who = fields[at_.at(called.instrument)];
      while (track < instruments().size() && instruments()[track].source != who) ++track;
      if (track == instruments().size()) return;  // a camera, or a tool of someone else
    }
    ForeignSample sample;
    sample.row = row_;
    sample.time = number(fields, called.time);
    if (pivot_) {
      sample.pivot = InstrumentPose{number(fields, called.pitch), number(fields, called.yaw),
                                    number(fields, called.insertion)};
    } else {
      sample.tip = point(fields, called.tip_x, called.tip_y, called.tip_z);
      if (has(called.dir_x) && has(called.dir_y) && has(called.dir_z)) take_direction(fields, sample);
    }
    if (has(called.roll)) sample.roll = number(fields, called.roll);
    if (has(called.jaw)) sample.jaw = number(fields, called.jaw);
    motion_.tracks[track].push_back(sample);
  }

  void take_direction(const std::vector<std::string>& fields, ForeignSample& sample) {
    const CsvColumns& called = registration_.columns;
    const Vec3 direction = point(fields, called.dir_x, called.dir_y, called.dir_z);
    if (direction.norm() > 0)
      sample.along = direction.normalized();
    else
      problem("the direction has no length", "mend or remove the row");
  }

  char separator_ = ',';
  std::size_t columns_ = 0;
  std::map<std::string, std::size_t> at_;
  bool pivot_ = false;
};

class JigsawsReader final : public MotionReader {
 public:
  using MotionReader::MotionReader;

 private:
  bool take_line(std::string_view line) override {
    if (trimmed(line).empty()) return true;
    const std::optional<std::vector<double>> numbers = numbers_of(line);
    if (!numbers)
      problem("what stands here is not all numbers", "mend or remove the row");
    else if (numbers->size() != jigsaws_numbers)
      problem(fmt::format("{} numbers, not {}", numbers->size(), jigsaws_numbers), "mend or remove the row");
    else
      for (std::size_t i = 0; i < instruments().size(); ++i) take_arm(*numbers, i);
    return true;
  }

  /// An arm has its tip, the rows of its rotation, two velocities, and the gripper's angle.
  void take_arm(const std::vector<double>& numbers, std::size_t track) {
    const ForeignInstrument& tool = instruments()[track];
    const std::vector<std::string>& arms = jigsaws_arms();
    const auto arm =
        static_cast<std::size_t>(std::find(arms.begin(), arms.end(), tool.source) - arms.begin());
    const double* const own = numbers.data() + arm * arm_numbers;
    const Mat3 axes = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(own + 3);
    if (!is_rotation(axes))
      return problem(fmt::format("{}: numbers 4 to 12 of its 19 are no rotation", tool.source),
                     "mend or remove the row");
    ForeignSample sample;
    sample.row = row_;
    sample.time = (row_ - 1) * registration_.time_step / registration_.time_unit;
    set_frame(sample, tool, axes, Vec3(own[0], own[1], own[2]));
    sample.along.reset();  // the wrist's, not the shaft's
    sample.jaw = own[18];
    motion_.tracks[track].push_back(sample);
  }
};

/// "Seq_Frame0012_LeftToTrackerTransform = 16 numbers", "..._LeftToTrackerTransformStatus = OK", "..._Timestamp = 3.5";
/// the picture follows ElementDataFile.
class SequenceReader final : public MotionReader {
 public:
  using MotionReader::MotionReader;

 private:
  using Fields = std::map<std::string, std::pair<std::string, int>>;  ///< name to text and line

  bool take_line(std::string_view line) override {
    const std::size_t equals = line.find('=');
    const std::string_view name = trimmed(line.substr(0, equals));
    if (equals == std::string_view::npos) {
      problem("this line has no =", "this is no header of a sequence file");
      return false;
    }
    const std::string_view value = trimmed(line.substr(equals + 1));
    if (name == "ElementDataFile") return false;
    constexpr std::string_view prefix = "Seq_Frame";
    if (!name.starts_with(prefix)) return true;
    const std::size_t end = name.find('_', prefix.size());
    int frame = -1;
    const char* const from = name.data() + prefix.size();
    if (end == std::string_view::npos ||
        std::from_chars(from, name.data() + end, frame).ptr != name.data() + end || frame < 0)
      problem(fmt::format("{} is no field of a frame", shortened(name, 60)),
              "such as Seq_Frame0000_Timestamp");
    else
      frames_[frame][std::string(name.substr(end + 1))] = {std::string(value), row_};
    return true;
  }

  void finish() override {
    motion_.framed = true;
    if (frames_.empty() && problems_.empty())
      problem("this file has no frames (Seq_Frame0000_...)", "give a sequence file");
    for (const auto& [number, fields] : frames_)
      for (std::size_t i = 0; i < instruments().size(); ++i) take_frame(number, fields, i);
    if (invalid_ > 0)
      motion_.notes.push_back(
          fmt::format("{} transforms are not valid, as their status says: left out", invalid_));
  }

  const std::string* field(const Fields& fields, const std::string& name) {
    const auto found = fields.find(name);
    if (found == fields.end()) return nullptr;
    row_ = found->second.second;
    return &found->second.first;
  }

  void take_frame(int number, const Fields& fields, std::size_t track) {
    const ForeignInstrument& tool = instruments()[track];
    const auto wrong = [&](const std::string& what) {
      problem(fmt::format("frame {}: {}", number, what), "mend or remove the frame");
    };
    if (const std::string* status = field(fields, tool.source + "Status");
        status != nullptr && *status != "OK") {
      ++invalid_;
      return;
    }
    const std::string* time = field(fields, "Timestamp");
    const std::optional<double> stamp = time != nullptr ? finite_number(*time) : std::nullopt;
    if (!stamp) return wrong("Timestamp is missing, or no number");
    const std::string* transform = field(fields, tool.source);
    const auto numbers = transform != nullptr ? numbers_of(*transform) : std::optional<std::vector<double>>();
    if (!numbers || numbers->size() != 16) return wrong(tool.source + " is missing, or not 16 numbers");
    const Mat4 matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers->data());
    if (!is_rotation(matrix.topLeftCorner<3, 3>()))
      return wrong(tool.source + " does not turn and move alone");
    ForeignSample sample;
    sample.row = number;
    sample.time = *stamp;
    set_frame(sample, tool, matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>());
    if (!tool.jaw.empty()) {
      const std::string* jaw = field(fields, tool.jaw);
      sample.jaw = jaw != nullptr ? finite_number(*jaw) : std::nullopt;
      if (!sample.jaw) return wrong(tool.jaw + " is missing, or no number");
    }
    motion_.tracks[track].push_back(sample);
  }

  using Mat4 = Eigen::Matrix4d;
  std::map<int, Fields> frames_;
  int invalid_ = 0;
};

}  // namespace

bool is_rotation(const Mat3& r) {
  return (r * r.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < rotation_slack && r.determinant() > 0;
}

void set_frame(ForeignSample& sample, const ForeignInstrument& tool, const Mat3& axes, const Vec3& origin) {
  sample.tip = origin + axes * tool.tip;
  sample.along = (axes * tool.along).normalized();
  sample.across = (axes * tool.across).normalized();
}

const std::vector<std::string>& motion_format_names() {
  static const std::vector<std::string> names{"csv", "jigsaws", "sequence"};
  return names;
}

const std::vector<std::string>& jigsaws_arms() {
  static const std::vector<std::string> names{"master_left", "master_right", "slave_left", "slave_right"};
  return names;
}

Result<ForeignMotion> read_foreign_motion(const std::string& path, const Registration& registration) {
  switch (registration.format) {
    case MotionFormat::csv:
      return CsvReader(path, registration).read();
    case MotionFormat::jigsaws:
      return JigsawsReader(path, registration).read();
    case MotionFormat::sequence:
      break;
  }
  return SequenceReader(path, registration).read();
}

}  // namespace calot

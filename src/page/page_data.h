#pragma once
// What a page about recordings shows, as plain data: page.h makes it HTML. Texts are as they came from outside.

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace calot {

struct PagePicture {
  double time = 0;         ///< s
  std::string caption;     ///< what is seen, and why it was drawn
  std::string media_type;  ///< "image/jpeg"
  std::string bytes;       ///< of the picture's file
  int width = 0, height = 0;
};

struct PageStep {
  std::string name, title, outcome;  ///< outcome as in StepRecord
  double started = 0, ended = 0;     ///< s
  std::optional<std::size_t> begin_picture, end_picture;
  std::string hint;             ///< how it is done; empty where that is not known
  double points = 0, most = 0;  ///< of the parts of the score that this step is measured by
};

struct PageEvent {
  std::string kind, meaning;  ///< "overforce", and what that is
  double time = 0;            ///< s
  std::string step, instrument, organ, value;
  bool error = false;
  std::optional<std::size_t> picture;
  std::string cause, place;  ///< what did it; where, mm in the patient's frame; may be empty
};

struct PagePart {
  std::string name, title, explanation;  ///< as the author calls it; what it is of, in words, with the unit
  double weight = 0, points = 0;
  std::optional<double> measured;
  std::optional<std::array<double, 2>> novice_expert;  ///< none of a penalty
  std::string rule;                                    ///< of a penalty: what each event costs
  std::string calibration;
  std::vector<std::size_t> events;  ///< behind it, ascending
};

/// What caps the total.
struct PageGate {
  std::string reason, found;
  double cap = 0;  ///< points
  bool fails = true;
  std::vector<std::size_t> events;
};

struct PageScore {
  double total = 0, uncapped = 0;
  std::vector<PagePart> parts;
  std::vector<PageGate> gates;  ///< that were tripped
};

struct PageCurve {
  std::string name;
  std::vector<std::array<double, 2>> points;
};

struct PageLevel {
  std::string name;
  double y = 0;
};

/// What is asked for while something lasts.
struct PageBand {
  std::string name;
  double low = 0, high = 0, from = 0, to = 0;  ///< of y; of x
};

struct PagePlot {
  std::string title, x_label, y_label;
  bool is_path = false;  ///< both axes to one scale; else x is time, s
  std::vector<PageCurve> curves;
  std::vector<PageLevel> levels;  ///< not of a path
  std::vector<PageBand> bands;    ///< not of a path
};

/// A name and what it is, such as a metric's.
struct PageFact {
  std::string name, value;
};

/// A recording that was scored. Indices are into its own lists.
struct PageRecording {
  std::string prefix;  ///< of all its ids: empty where it is alone on the page, else such as "r2-"
  std::string name, file, verdict;
  bool passed = false;
  double pass_mark = 0;   ///< points
  double stopped_at = 0;  ///< s
  PageScore score;
  std::vector<std::string> warnings;  ///< what a reader must know before all else
  std::vector<PageStep> steps;
  std::vector<PageEvent> events;
  std::size_t events_left_out = 0;
  std::vector<PagePicture> pictures;
  bool drawn = true;      ///< pictures were asked for
  bool simulated = true;  ///< again: else forces are not known
  std::size_t pictures_left_out = 0;
  std::vector<PagePlot> plots;
  std::vector<PageFact> attempt;  ///< who, when and by what
  std::vector<PageFact> parameters, metrics, noted;
  std::vector<std::string> notes;
};

/// A recording's line in the overview.
struct PageRow {
  std::string prefix, name, verdict;
  std::string problem;         ///< why it has no score; then nothing follows
  std::string trainee, began;  ///< may be empty
  bool finished = false, passed = false, unsafe = false;
  std::optional<double> total;                ///< points; none where the simulation failed
  std::string steps;                          ///< done, of how many: "3/5"
  double stopped_at = 0;                      ///< s
  std::vector<std::optional<double>> points;  ///< by part; none of a part that it does not have
  std::size_t errors = 0;
};

/// A part's column in the overview.
struct PagePartHead {
  std::string title, points;  ///< as PagePart's; what it may earn
};

/// Attempts that may be compared: of one mode, one set of parameters and one score.
struct PageGroup {
  std::string title;     ///< what tells it from the others: "exam, anatomy = wide"
  double pass_mark = 0;  ///< points
  std::vector<PagePartHead> parts;
  std::vector<PageRow> rows;
};

/// All but the recordings' own sections.
struct Page {
  std::string title, scenario, file;
  std::string benchmarks, calibration;  ///< whose figures, and where they come from
  bool of_a_class = false;  ///< recordings of different people; else of one, in the order of their attempts
  std::vector<PageGroup> groups;
  std::vector<PageRow> not_counted;  ///< without a score, or copies: with their problem
  std::size_t count() const {
    std::size_t rows = not_counted.size();
    for (const PageGroup& group : groups) rows += group.rows.size();
    return rows;
  }
};

}  // namespace calot

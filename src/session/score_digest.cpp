#include "base/hash.h"
#include "session/scoring.h"

namespace calot {
namespace {

/// Values one after another; a list begins with its length, and so does a text. Every struct is taken apart by all of its
/// members: one that gets another member is an error here until that is named.
class ScoreHash {
 public:
  template <class... Each>
  void put_all(const Each&... each) {
    (put(each), ...);
  }
  std::uint64_t value() const { return hash_.value(); }

 private:
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) { hash_.add(value); }
  void put(const std::string& text) {
    hash_.add(text.size());
    hash_.add(std::string_view(text));
  }
  void put(EventKind kind) { put(to_text(kind)); }
  void put(ScorePartKind kind) { put(score_part_kinds()[static_cast<std::size_t>(kind)]); }
  void put(const std::optional<double>& value) { put_all(value.has_value(), value.value_or(0)); }
  template <class T>
  void put(const std::vector<T>& list) {
    put(list.size());
    for (const T& each : list) put(each);
  }
  void put(const ScorePart& part) {
    const auto& [name, kind, metric, novice, expert, event, each, steps, minor, major, minor_costs,
                 major_costs, reference, limit, errors, each_s, satisfactory, full, rule, weight, calibration,
                 place] = part;
    put_all(name, kind, metric, novice, expert, event, each, steps, minor, major, minor_costs, major_costs,
            reference, limit, errors, each_s, satisfactory, full, weight);
  }
  void put(const GateDefinition& gate) {
    const auto& [reason, event, organ, only_after, after_organ, metric, below, above, unless, cap, fails,
                 place] = gate;
    put_all(event, organ, only_after, after_organ, metric, below, above, unless, cap, fails);
  }

  Hash hash_;
};

}  // namespace

std::uint64_t score_digest(const ExerciseDefinition& exercise) {
  const auto& [parts, critical, gates, cap, pass, bail_out_completes, bail_out, rules] = exercise.score;
  ScoreHash hash;
  hash.put_all(exercise.api, exercise.step_names, parts, critical, gates, cap, pass, bail_out_completes);
  if (rules) hash.put_all(hex(exercise.source_hash));
  return hash.value();
}

}  // namespace calot

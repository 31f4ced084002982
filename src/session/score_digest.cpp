#include "base/hash.h"
#include "session/scoring.h"

namespace calot {
namespace {

/// Values one after another; a list begins with its length, and so does a text.
class Digest {
 public:
  void add(double value) { hash_.add(value); }
  void add(const std::string& text) {
    hash_.add(text.size());
    hash_.add(std::string_view(text));
  }
  void add(EventKind kind) { add(to_text(kind)); }
  void add(const std::optional<double>& value) {
    hash_.add(value.has_value());
    hash_.add(value.value_or(0));
  }
  void add(const ScorePart& part) {
    add(part.name);
    add(score_part_kinds()[static_cast<std::size_t>(part.kind)]);
    add(part.metric);
    add(part.event);
    for (const double figure :
         {part.novice, part.expert, part.each, part.minor_costs, part.major_costs, part.reference, part.limit,
          part.each_s, part.satisfactory, part.full, part.weight})
      add(figure);
    add(part.steps);
    add(part.minor);
    add(part.major);
    add(part.errors);
  }
  void add(const GateDefinition& gate) {
    for (const std::string* text :
         {&gate.event, &gate.organ, &gate.only_after, &gate.after_organ, &gate.metric, &gate.unless})
      add(*text);
    for (const std::optional<double>& figure : {gate.below, gate.above, gate.cap}) add(figure);
    hash_.add(gate.fails);
  }
  template <class T>
  void add(const std::vector<T>& list) {
    hash_.add(list.size());
    for (const T& entry : list) add(entry);
  }
  std::uint64_t value() const { return hash_.value(); }

 private:
  Hash hash_;
};

}  // namespace

std::uint64_t score_digest(const ExerciseDefinition& exercise) {
  const ScoreDefinition& score = exercise.score;
  Digest digest;
  digest.add(static_cast<double>(exercise.api));
  digest.add(exercise.step_names);
  digest.add(score.parts);
  digest.add(score.critical);
  digest.add(score.gates);
  digest.add(score.cap);
  digest.add(score.pass);
  digest.add(static_cast<double>(score.bail_out_completes));
  if (score.rules) digest.add(hex(exercise.source_hash));
  return digest.value();
}

}  // namespace calot

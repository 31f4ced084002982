#pragma once
// Which moments of a session get a picture on its page: where a step begins or ends, and errors; only so many.

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "page/page_data.h"
#include "play/play.h"

namespace calot {

/// Events that a trainee should not cause: what the score penalises or calls critical, and what is never wanted.
std::set<EventKind> error_kinds(const ExerciseDefinition& exercise);

class PageMoments {
 public:
  static constexpr std::size_t most_of_steps = 20, most_of_errors = 20, most_of_a_kind = 8;
  /// s; errors of one kind that follow each other as fast share a picture.
  static constexpr double shared_within = 0.5;

  explicit PageMoments(std::set<EventKind> errors) : errors_(std::move(errors)) {}

  /// As PlayRequest::moment.
  std::string wanted(const Progress& progress);
  /// As PlayRequest::on_picture, of the moment that was wanted last.
  std::optional<Failure> take(const Frame& frame);

  std::vector<PagePicture> pictures;
  /// Picture by step or event.
  std::map<std::size_t, std::size_t> step_begins, step_ends, events;
  std::size_t left_out = 0;  ///< moments without a picture

 private:
  struct Moment {
    std::vector<std::size_t> begins, ends, events;
    std::vector<std::string> words;
  };
  struct LastOfKind {
    double time = 0;  ///< s
    std::size_t picture = 0, count = 0;
  };
  bool add_steps(const Progress& progress);
  bool add_errors(const Progress& progress);

  std::set<EventKind> errors_;
  std::map<EventKind, LastOfKind> last_;
  Moment moment_;
  std::size_t begun_ = 0, ended_ = 0, seen_ = 0, of_steps_ = 0, of_errors_ = 0;
};

}  // namespace calot

#pragma once
// Errors as values: a place, what is wrong, and what to do next. Nothing here throws.

#include <cstdlib>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace calot {

/// Where a problem is. `path` names a field ("scene.solver.rate"); the Lua room turns it into file and line.
struct Place {
  std::string file;
  int line = 0;
  std::string path;
};

struct Problem {
  Place place;
  std::string message;  ///< what is wrong, with the value
  std::string hint;     ///< what to do next; may be empty
};

/// The kind of a failure; the program's exit codes follow from it (see process/exit_code.h).
enum class FailureKind { usage, scenario, simulation, resource, interrupted, internal };

struct Failure {
  FailureKind kind = FailureKind::internal;
  std::vector<Problem> problems;
};

/// Keeps the first hundred, of which the last then says how many there were more: nobody reads a million lines.
void keep_first(std::vector<Problem>& problems);

/// "file:line: message (hint)" a problem, one a line.
std::string to_text(const Problem& problem);
std::string to_text(const Failure& failure);

inline Failure fail(FailureKind kind, std::string message, std::string hint = {}, Place place = {}) {
  return {kind, {{std::move(place), std::move(message), std::move(hint)}}};
}

/// A value or a Failure. Taking the value of a failed result ends the process: check first.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}
  Result(Failure failure) : state_(std::move(failure)) {}
  explicit operator bool() const { return state_.index() == 0; }
  T& value() & { return *checked(); }
  const T& value() const& { return *const_cast<Result*>(this)->checked(); }
  T&& value() && { return std::move(*checked()); }
  T* operator->() { return checked(); }
  const T* operator->() const { return const_cast<Result*>(this)->checked(); }
  const Failure& failure() const { return std::get<1>(state_); }

 private:
  T* checked() {
    if (state_.index() != 0) std::abort();
    return &std::get<0>(state_);
  }
  std::variant<T, Failure> state_;
};

}  // namespace calot

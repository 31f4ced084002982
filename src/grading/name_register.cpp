#include "grading/name_register.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/byte_order_mark.h"
#include "process/project.h"
#include "session/attempt.h"
#include "session/csv.h"
#include "session/json_fields.h"

namespace calot {
namespace {

constexpr const char* example =
    "write a first line trainee,name and then a line for each, such as T-07,Anna Muster";

/// Reads line by line, and keeps what is wrong.
class RegisterReader {
 public:
  RegisterReader(const std::string& file, std::string_view text)
      : file_(file), text_(without_byte_order_mark(text)) {}

  Result<NameRegister> read() {
    std::size_t begin = 0;
    while (begin < text_.size() && (line_ == 0 || problems_.empty() || trainee_ >= 0)) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      std::string line = text_.substr(begin, end - begin);
      if (line.ends_with('\r')) line.pop_back();
      begin = end + 1;
      ++line_;
      if (line_ == 1)
        read_head(line);
      else if (!line.empty())
        read_row(line);
    }
    if (line_ == 0) add_problem("this register is empty", example);
    if (!problems_.empty()) return Failure{FailureKind::usage, std::move(problems_)};
    return std::move(names_);
  }

 private:
  void read_head(const std::string& line) {
    if (line.find(';') != std::string::npos) separator_ = ';';  // as spreadsheets write it in many countries
    const std::optional<std::vector<std::string>> head = csv_fields(line, separator_);
    for (std::size_t i = 0; head && i < head->size(); ++i) {
      if ((*head)[i] == "trainee") trainee_ = static_cast<int>(i);
      if ((*head)[i] == "name") name_ = static_cast<int>(i);
    }
    if (trainee_ >= 0 && name_ >= 0) return;
    trainee_ = -1;
    add_problem("this is no register of names: its first line does not name the columns trainee and name",
                example);
  }

  void read_row(const std::string& line) {
    const std::optional<std::vector<std::string>> fields = csv_fields(line, separator_);
    if (!fields || static_cast<int>(fields->size()) <= std::max(trainee_, name_))
      return add_problem("this line has no trainee and name, or a quotation in it has no end", example);
    const std::string &trainee = (*fields)[static_cast<std::size_t>(trainee_)],
                      &name = (*fields)[static_cast<std::size_t>(name_)];
    if (std::optional<Failure> wrong = check_pseudonym(trainee))
      return add_problem(wrong->problems[0].message,
                         "give 1 to 40 letters, digits, full stops, hyphens and underscores");
    if (name.empty() || !is_utf8(name))
      return add_problem(fmt::format("{} has no name, or one that is not UTF-8", trainee), example);
    if (!names_.emplace(trainee, name).second)
      add_problem(fmt::format("{} stands twice", trainee), "a pseudonym is one person's");
  }

  void add_problem(std::string message, std::string hint) {
    problems_.push_back({{file_, std::max(1, line_), {}}, std::move(message), std::move(hint)});
  }

  const std::string& file_;
  std::string text_;
  int line_ = 0, trainee_ = -1, name_ = -1;
  char separator_ = ',';
  NameRegister names_;
  std::vector<Problem> problems_;
};

}  // namespace

Result<NameRegister> read_names(const std::string& file) {
  if (file.empty()) return NameRegister();
  constexpr std::size_t most_bytes = std::size_t{1} << 20;
  Result<std::string> text = read_text(file, most_bytes);
  if (!text)
    return fail(FailureKind::usage,
                fmt::format("cannot read {} as a register of names of up to {} bytes", file, most_bytes),
                example);
  return RegisterReader(file, std::move(text).value()).read();
}

std::string with_name(const std::string& trainee, const NameRegister& names) {
  const auto found = names.find(trainee);
  return found == names.end() ? trainee : fmt::format("{} ({})", found->second, trainee);
}

}  // namespace calot

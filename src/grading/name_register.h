#pragma once
// Whose pseudonym is whose: a file that stays with the instructor. It is joined when a table is printed or a page is
// written. No recording and no folder of results has a name in it; a page that was made with names has them.

#include <map>
#include <string>

#include "base/status.h"

namespace calot {

/// Names by pseudonym.
using NameRegister = std::map<std::string, std::string>;

/// An empty register where `file` is empty, else CSV (RFC 4180) with the columns trainee and name, in either order, after a line that says so; other columns are left
/// alone. Fails (usage), each problem with its line, where the file cannot be read, a pseudonym is none or stands twice, or a
/// name is empty.
Result<NameRegister> read_names(const std::string& file);

/// "Anna Muster (T-07)" of one who is in the register, else the pseudonym.
std::string with_name(const std::string& trainee, const NameRegister& names);

}  // namespace calot

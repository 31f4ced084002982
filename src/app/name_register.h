#pragma once
// Whose pseudonym is whose: a file that stays with the instructor. It is joined when a table or a page is printed, and
// nothing that Calot keeps has a name in it.

#include <map>
#include <string>

#include "base/status.h"

namespace calot {

/// Names by pseudonym.
using NameRegister = std::map<std::string, std::string>;

/// CSV (RFC 4180) with the columns trainee and name, in either order, after a line that says so; other columns are left
/// alone. Fails (usage), each problem with its line, where the file cannot be read, a pseudonym is none or stands twice, or a
/// name is empty.
Result<NameRegister> read_names(const std::string& file);

/// None without a file.
Result<NameRegister> names_of(const std::string& file);

/// "Anna Muster (T-07)" of one who is in the register, else the pseudonym.
std::string with_name(const std::string& trainee, const NameRegister& names);

}  // namespace calot

#pragma once
// Which program this is, by what it was built from.

#include <string>

namespace calot {

/// A digest of the build ids that the linker gave this program and the libraries it has loaded, and of what else decides
/// the bits of a result (session/build_info.h). Empty where the program has no build id.
std::string loaded_code();

}  // namespace calot

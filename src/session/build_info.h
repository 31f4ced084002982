#pragma once
// What decides the bits of a state, besides the sources: state hashes may only be compared between equal ones.

#include <string>
#include <vector>

namespace calot {

/// Of the program.
std::string version();

/// What made a result, each part in words; an empty part is not known.
struct Make {
  std::string toolchain;        ///< compiler with version: "GNU 12.2.0"
  std::string instruction_set;  ///< what was compiled for, not what the processor offers: "x86-64-v3"
  /// The C library, which of its variants it chose for this processor, a hash of values they give, and the solver's
  /// library: "glibc 2.36 with FMA, values 0123456789abcdef, CHOLMOD 3.0.14".
  std::string mathematics;
  bool operator==(const Make&) const = default;
};

/// Of this process; the C library's choice depends on the processor and on GLIBC_TUNABLES.
Make this_make();

/// "GNU 12.2.0, x86-64-v3, glibc 2.36 ...", known parts only.
std::string to_text(const Make& make);

/// True where no part that both know differs.
bool same_bits(const Make& a, const Make& b);

}  // namespace calot

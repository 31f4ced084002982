#pragma once
// Four numbers side by side, one for each of four points of a rule: the processor does their arithmetic at once, each
// lane with the bits that it would have alone.

#include <cstring>

#if defined(__FMA__)
#include <immintrin.h>
#endif

namespace calot {

using Lanes = double __attribute__((vector_size(4 * sizeof(double))));
inline constexpr int lane_count = 4;

inline Lanes all_lanes(double value) { return Lanes{value, value, value, value}; }
inline Lanes load_lanes(const double* from) {
  Lanes out;
  std::memcpy(&out, from, sizeof out);
  return out;
}
inline void store_lanes(const Lanes& value, double* to) { std::memcpy(to, &value, sizeof value); }

/// a b + c, rounded once where the instruction set can.
inline Lanes fused(const Lanes& a, const Lanes& b, const Lanes& c) {
#if defined(__FMA__)
  return Lanes(_mm256_fmadd_pd(a, b, c));
#else
  return a * b + c;
#endif
}

inline double sum_of(const Lanes& v) { return (v[0] + v[2]) + (v[1] + v[3]); }

/// A vector of space in each lane.
struct Lanes3 {
  Lanes at[3] = {};

  const Lanes& operator[](int c) const { return at[c]; }
  Lanes& operator[](int c) { return at[c]; }
};

inline Lanes3 operator+(const Lanes3& a, const Lanes3& b) {
  return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}
inline Lanes3 operator-(const Lanes3& a, const Lanes3& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
inline Lanes3 operator*(const Lanes& s, const Lanes3& a) { return {{s * a[0], s * a[1], s * a[2]}}; }
inline Lanes dot(const Lanes3& a, const Lanes3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

}  // namespace calot

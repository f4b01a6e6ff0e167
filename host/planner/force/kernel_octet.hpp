// Eight doubles and what the kernel does with them, by the instruction set that the file is compiled for. The
// same bits from each: no fused multiply-add, and no sum whose order depends on the width. Internal linkage
// only; to be included by kernel_body.hpp alone.

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace pinjaw::planner::kernel {
namespace {

#if defined(__AVX512F__)

struct Octet {
  __m512d v;
};
using Mask = __mmask8;

inline Octet load(const double* from) {
  return {_mm512_load_pd(from)};
}
inline void store(double* to, Octet a) {
  _mm512_store_pd(to, a.v);
}
inline Octet all(double a) {
  return {_mm512_set1_pd(a)};
}
inline Octet operator+(Octet a, Octet b) {
  return {_mm512_add_pd(a.v, b.v)};
}
inline Octet operator-(Octet a, Octet b) {
  return {_mm512_sub_pd(a.v, b.v)};
}
inline Octet operator*(Octet a, Octet b) {
  return {_mm512_mul_pd(a.v, b.v)};
}
inline Octet operator/(Octet a, Octet b) {
  return {_mm512_div_pd(a.v, b.v)};
}
inline Octet larger(Octet a, Octet b) {
  return {_mm512_max_pd(a.v, b.v)};
}
inline Octet magnitude(Octet a) {
  return {_mm512_abs_pd(a.v)};
}
inline Mask below(Octet a, Octet b) {
  return _mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ);
}
inline Octet choose(Mask where, Octet a, Octet b) {
  return {_mm512_mask_blend_pd(where, b.v, a.v)};
}
inline unsigned bits_of(Mask mask) {
  return mask;
}
inline Mask mask_of(unsigned bits) {
  return static_cast<Mask>(bits);
}
inline double least_of(Octet a) {
  return _mm512_reduce_min_pd(a.v);
}
inline double largest_of(Octet a) {
  return _mm512_reduce_max_pd(a.v);
}
inline unsigned lanes_at(Octet a, double value) {
  return _mm512_cmp_pd_mask(a.v, _mm512_set1_pd(value), _CMP_EQ_OQ);
}

#else

#if defined(__AVX2__)
constexpr int kWidth = 4;
#else
constexpr int kWidth = 2;
#endif
constexpr int kPacks = 8 / kWidth;
using Pack = double __attribute__((vector_size(kWidth * sizeof(double))));
using IntPack = long long __attribute__((vector_size(kWidth * sizeof(double))));

struct Octet {
  Pack v[kPacks];
};
struct Mask {
  IntPack v[kPacks];
};

template <class Function>
inline Octet each(Function function) {
  Octet result;
  for (int p = 0; p < kPacks; ++p) result.v[p] = function(p);
  return result;
}

inline Octet load(const double* from) {
  return each([&](int p) { return *reinterpret_cast<const Pack*>(from + p * kWidth); });
}
inline void store(double* to, Octet a) {
  for (int p = 0; p < kPacks; ++p) *reinterpret_cast<Pack*>(to + p * kWidth) = a.v[p];
}
inline Octet all(double a) {
  return each([&](int) { return Pack{} + a; });
}
inline Octet operator+(Octet a, Octet b) {
  return each([&](int p) { return a.v[p] + b.v[p]; });
}
inline Octet operator-(Octet a, Octet b) {
  return each([&](int p) { return a.v[p] - b.v[p]; });
}
inline Octet operator*(Octet a, Octet b) {
  return each([&](int p) { return a.v[p] * b.v[p]; });
}
inline Octet operator/(Octet a, Octet b) {
  return each([&](int p) { return a.v[p] / b.v[p]; });
}
inline Octet larger(Octet a, Octet b) {
  return each([&](int p) { return a.v[p] > b.v[p] ? a.v[p] : b.v[p]; });
}
inline Octet magnitude(Octet a) {
  return each([&](int p) { return a.v[p] < 0.0 ? -a.v[p] : a.v[p]; });
}
inline Mask below(Octet a, Octet b) {
  Mask result;
  for (int p = 0; p < kPacks; ++p) result.v[p] = a.v[p] < b.v[p];
  return result;
}
inline Octet choose(Mask where, Octet a, Octet b) {
  return each([&](int p) { return where.v[p] ? a.v[p] : b.v[p]; });
}
inline unsigned bits_of(Mask mask) {
  unsigned bits = 0;
  for (int p = 0; p < kPacks; ++p) {
#if defined(__AVX2__)
    const int here = _mm256_movemask_pd(reinterpret_cast<__m256d>(mask.v[p]));
#elif defined(__SSE2__)
    const int here = _mm_movemask_pd(reinterpret_cast<__m128d>(mask.v[p]));
#else
    const int here = (mask.v[p][0] != 0 ? 1 : 0) | (mask.v[p][1] != 0 ? 2 : 0);
#endif
    bits |= static_cast<unsigned>(here) << (p * kWidth);
  }
  return bits;
}
inline Mask mask_of(unsigned bits) {
  Mask result;
  for (int p = 0; p < kPacks; ++p) {
    IntPack lane{};
    for (int i = 0; i < kWidth; ++i) lane[i] = 1LL << (p * kWidth + i);
    result.v[p] = ((IntPack{} + static_cast<long long>(bits)) & lane) == lane;
  }
  return result;
}
inline double least_of(Octet a) {
  Pack least = a.v[0];
  for (int p = 1; p < kPacks; ++p) least = a.v[p] < least ? a.v[p] : least;
  double result = least[0];
  for (int i = 1; i < kWidth; ++i) result = least[i] < result ? least[i] : result;
  return result;
}
inline double largest_of(Octet a) {
  return -least_of(all(0) - a);
}
inline unsigned lanes_at(Octet a, double value) {
  Mask result;
  for (int p = 0; p < kPacks; ++p) result.v[p] = a.v[p] == (Pack{} + value);
  return bits_of(result);
}

#endif

/// One lane set to `value`.
inline Octet insert(Octet a, int lane, double value) {
  return choose(mask_of(1U << lane), all(value), a);
}

}  // namespace
}  // namespace pinjaw::planner::kernel

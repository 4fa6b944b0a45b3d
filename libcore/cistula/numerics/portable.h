// The only header that asks which compiler compiles it: all other source is the same for host and device.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#ifdef __CUDACC__
#define CISTULA_HD __host__ __device__
#else
#define CISTULA_HD
#endif

// 1 in device code, 0 in code that nvcc compiles for the host.
#ifdef __CUDA_ARCH__
#define CISTULA_ON_DEVICE 1
#else
#define CISTULA_ON_DEVICE 0
#endif

#if defined(__FAST_MATH__)
#error "Cistula's images are defined by IEEE arithmetic: build without -ffast-math."
#endif

// GCC decides about inlining by size, which is wrong for the ray loops. The primitive tests (CISTULA_HOST_NOINLINE) are
// calls instead: on the host a call costs nothing measurable, and the code of each effect mask does not repeat them.
#if defined(__GNUC__)
#define CISTULA_INLINE CISTULA_HD inline __attribute__((always_inline))
#else
#define CISTULA_INLINE CISTULA_HD inline
#endif
#if defined(__GNUC__) && !CISTULA_ON_DEVICE
#define CISTULA_HOST_NOINLINE CISTULA_HD __attribute__((noinline))
#else
#define CISTULA_HOST_NOINLINE CISTULA_HD inline
#endif

// CISTULA_LANES: put before a loop that the compiler may vectorize, since no iteration touches what another does. It
// adds up nothing: Clang would reorder the sum. CISTULA_VECTORS: put before a short loop to vectorize instead of
// unrolling.
#if defined(__CUDACC__)
#define CISTULA_LANES
#define CISTULA_VECTORS
#elif defined(__clang__)
#define CISTULA_LANES _Pragma("clang loop vectorize(assume_safety)")
#define CISTULA_VECTORS _Pragma("clang loop unroll(disable)")
#elif defined(__GNUC__)
#define CISTULA_LANES _Pragma("GCC ivdep")
#define CISTULA_VECTORS _Pragma("GCC unroll 1")
#else
#define CISTULA_LANES
#define CISTULA_VECTORS
#endif

// Put before a loop that the device compiler must not unroll: device instruction caches are small.
#if CISTULA_ON_DEVICE
#define CISTULA_NOT_UNROLLED _Pragma("unroll 1")
#else
#define CISTULA_NOT_UNROLLED
#endif

// A function that is called rarely and kept out of line, so that the hot loop fits the instruction cache.
#define CISTULA_NOINLINE CISTULA_HD __attribute__((noinline))

namespace cistula {

/// a * b + c with a single rounding on host and device. Contraction is off everywhere, so this is the only fused
/// operation.
CISTULA_INLINE float fused(float a, float b, float c) {
    return fmaf(a, b, c);
}
CISTULA_INLINE double fused(double a, double b, double c) {
    return ::fma(a, b, c);
}

/// Square root, correctly rounded (IEEE 754) on host and device.
CISTULA_INLINE float square_root(float a) {
    return sqrtf(a);
}
CISTULA_INLINE double square_root(double a) {
    return ::sqrt(a);
}

/// 1 / a, correctly rounded, for |a| in [2^-120, 2^120]. The device version omits the branches that other values need:
/// one Newton step from the hardware's estimate is exact for floats in that range (bench/gpu checks every significand).
CISTULA_INLINE float reciprocal(float a) {
#if CISTULA_ON_DEVICE
    float r;
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(r) : "f"(a));
    return fmaf(r, fmaf(-a, r, 1.0f), r);
#else
    return 1.0f / a;
#endif
}
/// 1 / a in double, correctly rounded, for |a| in [2^-120, 2^120]. On the device a third-order step brings the estimate
/// to within an ulp, from which a Newton step is exact (Markstein 1990) unless all bits of the significand are set. In
/// that case it is exact if the estimate is too large, which setting its lower half ensures.
CISTULA_INLINE double reciprocal(double a) {
#if CISTULA_ON_DEVICE
    double r;
    asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(r) : "d"(a));
    r = __hiloint2double(__double2hiint(r), 0x40000000);
    const double off = ::fma(-a, r, 1.0);
    r = ::fma(r, ::fma(off, off, off), r);
    return ::fma(r, ::fma(-a, r, 1.0), r);
#else
    return 1.0 / a;
#endif
}

/// Minimum and maximum of two numbers that are not NaN and not both zero: one instruction on the device.
CISTULA_INLINE float min_no_nan(float a, float b) {
#if CISTULA_ON_DEVICE
    return fminf(a, b);
#else
    return a < b ? a : b;
#endif
}
CISTULA_INLINE float max_no_nan(float a, float b) {
#if CISTULA_ON_DEVICE
    return fmaxf(a, b);
#else
    return a < b ? b : a;
#endif
}
CISTULA_INLINE double min_no_nan(double a, double b) {
    return a < b ? a : b;
}
CISTULA_INLINE double max_no_nan(double a, double b) {
    return a < b ? b : a;
}

/// Forces `a` into a register: the device compiler might otherwise compute it again at every use.
CISTULA_INLINE void materialize([[maybe_unused]] float& a) {
#if CISTULA_ON_DEVICE
    asm volatile("" : "+f"(a));
#endif
}
CISTULA_INLINE void materialize(double&) {}

CISTULA_INLINE float floor_of(float a) {
    return floorf(a);
}
CISTULA_INLINE double floor_of(double a) {
    return ::floor(a);
}

/// floor(a) and ceil(a) as integers, for a in [0, 2^63).
template <class Real>
CISTULA_INLINE int64_t whole_of(Real a) {
    return static_cast<int64_t>(a);
}
template <class Real>
CISTULA_INLINE int64_t whole_above(Real a) {
#if CISTULA_ON_DEVICE
    if constexpr (sizeof(Real) == sizeof(float))
        return __float2ll_ru(a);
    else
        return __double2ll_ru(a);
#else
    const int64_t whole = static_cast<int64_t>(a);
    return whole + (static_cast<Real>(whole) < a ? 1 : 0);
#endif
}

/// std::bit_cast, which device code cannot call everywhere.
template <class To, class From>
CISTULA_INLINE To bits_as(const From& from) {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    memcpy(&to, &from, sizeof(To));
    return to;
}

/// Index of the lowest set bit, for bits != 0.
CISTULA_INLINE uint32_t lowest_bit(uint32_t bits) {
#if CISTULA_ON_DEVICE
    return uint32_t(__ffs(int(bits)) - 1);
#else
    return uint32_t(__builtin_ctz(bits));
#endif
}

/// The sign bits of eight lanes: bit i is set if lanes[i] < 0. `lanes` is aligned to 32 bytes.
CISTULA_INLINE uint32_t sign_bits(const int32_t (&lanes)[8]) {
#if defined(__AVX__) && !defined(__CUDACC__)
    using Eight __attribute__((vector_size(32))) = float;
    Eight eight;
    memcpy(&eight, lanes, sizeof eight);
    return uint32_t(__builtin_ia32_movmskps256(eight));
#else
    uint32_t bits = 0;
    for (int i = 0; i < 8; ++i) bits |= uint32_t(lanes[i] < 0) << i;
    return bits;
#endif
}

/// A non-owning view of `size` elements: std::span without its host-only members.
template <class T>
struct Span {
    const T* data = nullptr;
    uint32_t size = 0;

    CISTULA_INLINE const T& operator[](uint32_t i) const { return data[i]; }
    CISTULA_INLINE const T* begin() const { return data; }
    CISTULA_INLINE const T* end() const { return data + size; }
    CISTULA_INLINE bool empty() const { return size == 0; }
};

/// Adds to a word to which other threads of a kernel may add. On the host a word belongs to one thread.
CISTULA_INLINE void add_to_word(int64_t& to, int64_t value) {
#ifdef __CUDA_ARCH__
    atomicAdd(reinterpret_cast<unsigned long long*>(&to), static_cast<unsigned long long>(value));
#else
    to += value;
#endif
}

/// Puts `value` into a word that is 0. Returns what the word held before.
CISTULA_INLINE int64_t claim_word(int64_t& word, int64_t value) {
#ifdef __CUDA_ARCH__
    return static_cast<int64_t>(
        atomicCAS(reinterpret_cast<unsigned long long*>(&word), 0ull, static_cast<unsigned long long>(value)));
#else
    const int64_t before = word;
    if (before == 0) word = value;
    return before;
#endif
}

/// The threads of a warp that come here together, which may vote as long as they stay together. On the host a thread is
/// by itself.
class TogetherThreads {
  public:
#if CISTULA_ON_DEVICE
    CISTULA_INLINE TogetherThreads() : threads_(__activemask()) {}
    /// How many of them it is true for.
    CISTULA_INLINE int count(bool yes) const {
        return __popc(__ballot_sync(threads_, yes));
    }

  private:
    const unsigned int threads_;
#else
    CISTULA_INLINE int count(bool yes) const {
        return yes;
    }
#endif
};

}  // namespace cistula

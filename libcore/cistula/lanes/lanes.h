// Lanes: a SIMD register of numbers that computes like one number, for code that traces several rays at once on the
// host. Every lane gets the bits that a number would. Another instruction set needs its own form of register_avx2.h.
#pragma once

#include <utility>

#ifdef __AVX512DQ__
#include "cistula/lanes/register_avx512.h"
#else
#include "cistula/lanes/register_avx2.h"
#endif
#include "cistula/numerics/double_double.h"
#include "cistula/numerics/select.h"
#include "cistula/numerics/vec.h"

namespace cistula {

/// A mask of n lanes of so many bytes each.
template <int bytes, int n>
struct LaneMask {
    using Register = native::MaskRegister<bytes>;
    Register v;

    LaneMask() = default;
    CISTULA_INLINE LaneMask(Register a) : v(a) {}
    CISTULA_INLINE LaneMask(bool a) : v(native::mask_of_all<bytes>(a)) {}
    CISTULA_INLINE static LaneMask of_bits(uint32_t bits) { return native::mask_of<bytes>(bits); }
    CISTULA_INLINE static LaneMask first(int count) { return of_bits((1u << count) - 1u); }
    CISTULA_INLINE uint32_t bits() const { return native::bits(v); }

    friend CISTULA_INLINE LaneMask operator&(LaneMask a, LaneMask b) { return Register(a.v & b.v); }
    friend CISTULA_INLINE LaneMask operator|(LaneMask a, LaneMask b) { return Register(a.v | b.v); }
    friend CISTULA_INLINE LaneMask operator!(LaneMask a) { return Register(~a.v); }
    CISTULA_INLINE LaneMask& operator&=(LaneMask b) { return *this = *this & b; }
    CISTULA_INLINE LaneMask& operator|=(LaneMask b) { return *this = *this | b; }
};

/// A mask of two registers.
template <int bytes, int n>
requires(bytes* n > lane_bytes) struct LaneMask<bytes, n> {
    using Half = LaneMask<bytes, n / 2>;
    Half low, high;

    LaneMask() = default;
    CISTULA_INLINE LaneMask(Half a, Half b) : low(a), high(b) {}
    CISTULA_INLINE LaneMask(bool a) : low(a), high(a) {}
    CISTULA_INLINE uint32_t bits() const { return low.bits() | high.bits() << n / 2; }

    friend CISTULA_INLINE LaneMask operator&(LaneMask a, LaneMask b) { return {a.low & b.low, a.high & b.high}; }
    friend CISTULA_INLINE LaneMask operator|(LaneMask a, LaneMask b) { return {a.low | b.low, a.high | b.high}; }
    friend CISTULA_INLINE LaneMask operator!(LaneMask a) { return {!a.low, !a.high}; }
    CISTULA_INLINE LaneMask& operator&=(LaneMask b) { return *this = *this & b; }
    CISTULA_INLINE LaneMask& operator|=(LaneMask b) { return *this = *this | b; }
};

template <int bytes, int n>
CISTULA_INLINE bool any(LaneMask<bytes, n> mask) {
    return mask.bits() != 0;
}
template <int bytes, int n>
CISTULA_INLINE bool all(LaneMask<bytes, n> mask) {
    return mask.bits() == (1u << n) - 1u;
}

/// n numbers, integers of 32 or 64 bits included, in one register.
template <class T, int n>
struct Lanes {
    using Vector = typename VectorOf<T, n>::Type;
    using Mask = LaneMask<int(sizeof(T)), n>;
    Vector v;

    Lanes() = default;
    CISTULA_INLINE Lanes(T a) : v(broadcast(a, std::make_index_sequence<size_t(n)>())) {}
    CISTULA_INLINE explicit Lanes(Vector a) : v(a) {}
    /// From the lanes of the next higher precision, rounded.
    template <class From>
    requires(std::is_same_v<T, float>&& std::is_same_v<From, double>) CISTULA_INLINE
        explicit Lanes(const Lanes<From, n>& a)
        : v(native::joined(a.low.v, a.high.v)) {}

    CISTULA_INLINE static Lanes at(const T* from) {
        Lanes a;
        memcpy(&a.v, from, sizeof a.v);
        return a;
    }
    CISTULA_INLINE void put(T* to) const { memcpy(to, &v, sizeof v); }
    CISTULA_INLINE T operator[](int lane) const { return v[lane]; }
    CISTULA_INLINE void set(int lane, T a) { v[lane] = a; }

    friend CISTULA_INLINE Lanes operator+(Lanes a, Lanes b) { return Lanes(Vector(Wrapping(a.v) + Wrapping(b.v))); }
    friend CISTULA_INLINE Lanes operator-(Lanes a, Lanes b) { return Lanes(Vector(Wrapping(a.v) - Wrapping(b.v))); }
    friend CISTULA_INLINE Lanes operator*(Lanes a, Lanes b) { return Lanes(Vector(Wrapping(a.v) * Wrapping(b.v))); }
    friend CISTULA_INLINE Lanes operator/(Lanes a, Lanes b) { return Lanes(a.v / b.v); }
    friend CISTULA_INLINE Lanes operator-(Lanes a) { return Lanes(-a.v); }
    friend CISTULA_INLINE Lanes operator&(Lanes a, Lanes b) { return Lanes(a.v & b.v); }
    friend CISTULA_INLINE Lanes operator|(Lanes a, Lanes b) { return Lanes(a.v | b.v); }
    friend CISTULA_INLINE Lanes operator^(Lanes a, Lanes b) { return Lanes(a.v ^ b.v); }
    friend CISTULA_INLINE Lanes operator<<(Lanes a, int b) { return Lanes(a.v << b); }
    friend CISTULA_INLINE Lanes operator<<(Lanes a, Lanes b) { return Lanes(a.v << b.v); }
    friend CISTULA_INLINE Lanes operator>>(Lanes a, int b) { return Lanes(a.v >> b); }
    friend CISTULA_INLINE Mask operator<(Lanes a, Lanes b) { return native::less(a.v, b.v); }
    friend CISTULA_INLINE Mask operator<=(Lanes a, Lanes b) { return native::less_equal(a.v, b.v); }
    friend CISTULA_INLINE Mask operator>(Lanes a, Lanes b) { return native::less(b.v, a.v); }
    friend CISTULA_INLINE Mask operator>=(Lanes a, Lanes b) { return native::less_equal(b.v, a.v); }
    friend CISTULA_INLINE Mask operator==(Lanes a, Lanes b) { return native::equal(a.v, b.v); }
    friend CISTULA_INLINE Mask operator!=(Lanes a, Lanes b) { return native::unequal(a.v, b.v); }
    CISTULA_INLINE Lanes& operator+=(Lanes b) { return *this = *this + b; }
    CISTULA_INLINE Lanes& operator-=(Lanes b) { return *this = *this - b; }
    CISTULA_INLINE Lanes& operator*=(Lanes b) { return *this = *this * b; }
    CISTULA_INLINE Lanes& operator/=(Lanes b) { return *this = *this / b; }

  private:
    using Wrapping = WrappingOf<T, n>;

    template <size_t... i>
    CISTULA_INLINE static Vector broadcast(T a, std::index_sequence<i...>) {
        return Vector{(void(i), a)...};
    }
};

/// Lanes of two registers.
template <class T, int n>
requires(n* int(sizeof(T)) > lane_bytes) struct Lanes<T, n> {
    using Half = Lanes<T, n / 2>;
    using Mask = LaneMask<int(sizeof(T)), n>;
    Half low, high;

    Lanes() = default;
    CISTULA_INLINE Lanes(T a) : low(a), high(a) {}
    CISTULA_INLINE Lanes(Half a, Half b) : low(a), high(b) {}
    template <class From>
    requires(std::is_same_v<T, double>&& std::is_same_v<From, float>) CISTULA_INLINE explicit Lanes(Lanes<From, n> a)
        : low(native::low_half(a.v)), high(native::high_half(a.v)) {}
    CISTULA_INLINE T operator[](int lane) const { return lane < n / 2 ? low[lane] : high[lane - n / 2]; }
    CISTULA_INLINE void set(int lane, T a) { lane < n / 2 ? low.set(lane, a) : high.set(lane - n / 2, a); }

    friend CISTULA_INLINE Lanes operator+(Lanes a, Lanes b) { return {a.low + b.low, a.high + b.high}; }
    friend CISTULA_INLINE Lanes operator-(Lanes a, Lanes b) { return {a.low - b.low, a.high - b.high}; }
    friend CISTULA_INLINE Lanes operator*(Lanes a, Lanes b) { return {a.low * b.low, a.high * b.high}; }
    friend CISTULA_INLINE Lanes operator/(Lanes a, Lanes b) { return {a.low / b.low, a.high / b.high}; }
    friend CISTULA_INLINE Lanes operator-(Lanes a) { return {-a.low, -a.high}; }
    friend CISTULA_INLINE Lanes operator&(Lanes a, Lanes b) { return {a.low & b.low, a.high & b.high}; }
    friend CISTULA_INLINE Lanes operator|(Lanes a, Lanes b) { return {a.low | b.low, a.high | b.high}; }
    friend CISTULA_INLINE Lanes operator^(Lanes a, Lanes b) { return {a.low ^ b.low, a.high ^ b.high}; }
    friend CISTULA_INLINE Lanes operator<<(Lanes a, int b) { return {a.low << b, a.high << b}; }
    friend CISTULA_INLINE Lanes operator>>(Lanes a, int b) { return {a.low >> b, a.high >> b}; }
    friend CISTULA_INLINE Mask operator<(Lanes a, Lanes b) { return {a.low < b.low, a.high < b.high}; }
    friend CISTULA_INLINE Mask operator<=(Lanes a, Lanes b) { return {a.low <= b.low, a.high <= b.high}; }
    friend CISTULA_INLINE Mask operator>(Lanes a, Lanes b) { return {a.low > b.low, a.high > b.high}; }
    friend CISTULA_INLINE Mask operator>=(Lanes a, Lanes b) { return {a.low >= b.low, a.high >= b.high}; }
    friend CISTULA_INLINE Mask operator==(Lanes a, Lanes b) { return {a.low == b.low, a.high == b.high}; }
    friend CISTULA_INLINE Mask operator!=(Lanes a, Lanes b) { return {a.low != b.low, a.high != b.high}; }
    CISTULA_INLINE Lanes& operator+=(Lanes b) { return *this = *this + b; }
};

template <class T, int n>
inline constexpr bool is_pair = n* int(sizeof(T)) > lane_bytes;

#define CISTULA_LANE_FUNCTION(name, arguments, halves, vectors) \
    template <class T, int n>                                   \
    CISTULA_INLINE Lanes<T, n> name arguments {                 \
        if constexpr (is_pair<T, n>)                            \
            return halves;                                      \
        else                                                    \
            return Lanes<T, n>(vectors);                        \
    }
CISTULA_LANE_FUNCTION(fused, (Lanes<T, n> a, std::type_identity_t<Lanes<T, n>> b, std::type_identity_t<Lanes<T, n>> c),
                      (Lanes<T, n>(fused(a.low, b.low, c.low), fused(a.high, b.high, c.high))),
                      native::fused(a.v, b.v, c.v))
CISTULA_LANE_FUNCTION(square_root, (Lanes<T, n> a), (Lanes<T, n>(square_root(a.low), square_root(a.high))),
                      native::square_root(a.v))
CISTULA_LANE_FUNCTION(floor_of, (Lanes<T, n> a), (Lanes<T, n>(floor_of(a.low), floor_of(a.high))),
                      native::floor_of(a.v))
CISTULA_LANE_FUNCTION(min_or_second, (Lanes<T, n> a, Lanes<T, n> b),
                      (Lanes<T, n>(min_or_second(a.low, b.low), min_or_second(a.high, b.high))),
                      native::min_or_second(a.v, b.v))
CISTULA_LANE_FUNCTION(max_or_second, (Lanes<T, n> a, Lanes<T, n> b),
                      (Lanes<T, n>(max_or_second(a.low, b.low), max_or_second(a.high, b.high))),
                      native::max_or_second(a.v, b.v))
CISTULA_LANE_FUNCTION(select, (LaneMask<int(sizeof(T)), n> m, Lanes<T, n> a, std::type_identity_t<Lanes<T, n>> b),
                      (Lanes<T, n>(select(m.low, a.low, b.low), select(m.high, a.high, b.high))),
                      native::select(m.v, a.v, b.v))
#undef CISTULA_LANE_FUNCTION

template <class T, int n>
CISTULA_INLINE Lanes<T, n> min_no_nan(Lanes<T, n> a, Lanes<T, n> b) {
    return min_or_second(a, b);
}
/// Like the scalar's, the first of equals.
template <class T, int n>
CISTULA_INLINE Lanes<T, n> max_no_nan(Lanes<T, n> a, Lanes<T, n> b) {
    return max_or_second(b, a);
}
template <class T, int n>
CISTULA_INLINE Lanes<T, n> magnitude(Lanes<T, n> a) {
    using Bits = typename VectorOf<SignedOf<sizeof(T)>, n>::Type;
    return Lanes<T, n>((typename Lanes<T, n>::Vector)((Bits)a.v & std::numeric_limits<SignedOf<sizeof(T)>>::max()));
}
template <class T, int n>
CISTULA_INLINE Lanes<T, n> reciprocal(Lanes<T, n> a) {
    return Lanes<T, n>(T(1)) / a;
}

/// Entries of a table, which has at most native::table_entries.
template <class Table, class T, int n>
CISTULA_INLINE auto looked_up(const Table& table, const Lanes<T, n>& index) {
    return Lanes<std::remove_cvref_t<decltype(table.of[0])>, n>(native::looked_up(table.of, index.v));
}
/// Vectors, a table for each component.
template <class Table, class T, int n>
CISTULA_INLINE auto looked_up(const Table (&table)[3], const Lanes<T, n>& index) {
    using Real = Lanes<std::remove_cvref_t<decltype(table[0].of[0])>, n>;
    return Vec3<Real>(looked_up(table[0], index), looked_up(table[1], index), looked_up(table[2], index));
}
/// Whole numbers as integers, in float below 2^31.
template <int n>
CISTULA_INLINE Lanes<int32_t, n> whole_of(const Lanes<float, n>& a) {
    return Lanes<int32_t, n>(__builtin_convertvector(a.v, typename Lanes<int32_t, n>::Vector));
}
/// Whole numbers in [-2^51, 2^51) as integers, and back.
template <int n>
CISTULA_INLINE Lanes<int64_t, n> whole_of(const Lanes<double, n>& a) {
    if constexpr (is_pair<double, n>)
        return {whole_of(a.low), whole_of(a.high)};
    else
        return Lanes<int64_t, n>((native::Longs)(a + Lanes<double, n>(0x1.8p52)).v - 0x4338000000000000);
}
template <int n>
CISTULA_INLINE Lanes<double, n> double_of(const Lanes<int64_t, n>& a) {
    if constexpr (is_pair<double, n>)
        return {double_of(a.low), double_of(a.high)};
    else
        return Lanes<double, n>((typename Lanes<double, n>::Vector)(a.v + 0x4338000000000000)) -
               Lanes<double, n>(0x1.8p52);
}
/// `a` where the mask holds, else 0.
template <class T, int n>
CISTULA_INLINE Lanes<T, n> masked(LaneMask<int(sizeof(T)), n> mask, const Lanes<T, n>& a) {
    if constexpr (is_pair<T, n>)
        return {masked(mask.low, a.low), masked(mask.high, a.high)};
    else
        return Lanes<T, n>(native::masked(mask.v, a.v));
}

/// -1 where the mask holds, else 0.
template <int bytes, int n>
CISTULA_INLINE Lanes<SignedOf<bytes>, n> minus_one_where(LaneMask<bytes, n> mask) {
    return Lanes<SignedOf<bytes>, n>(native::minus_ones(mask.v));
}

template <int bytes, int n, class T>
CISTULA_INLINE glm::vec<3, Lanes<T, n>, glm::defaultp> select(LaneMask<bytes, n> mask,
                                                              const glm::vec<3, Lanes<T, n>, glm::defaultp>& a,
                                                              const glm::vec<3, Lanes<T, n>, glm::defaultp>& b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

template <int n>
CISTULA_INLINE DoubleDoubleOf<Lanes<double, n>> select(LaneMask<8, n> mask, const DoubleDoubleOf<Lanes<double, n>>& a,
                                                       const DoubleDoubleOf<Lanes<double, n>>& b) {
    return {select(mask, a.high, b.high), select(mask, a.low, b.low)};
}
template <int bytes, int n, class T>
CISTULA_INLINE void assign_where(LaneMask<bytes, n> mask, T& to, const std::type_identity_t<T>& from) {
    to = select(mask, from, to);
}
template <int bytes, int n>
CISTULA_INLINE void assign_where(LaneMask<bytes, n> mask, LaneMask<bytes, n>& to, LaneMask<bytes, n> from) {
    to = (mask & from) | ((!mask) & to);
}

template <class T, int n>
struct LaneTraits<Lanes<T, n>> {
    using Scalar = T;
    using Mask = LaneMask<int(sizeof(T)), n>;
    using Index = Lanes<SignedOf<sizeof(T)>, n>;
    using Key = Index;
    using Wide = Lanes<double, n>;
    using Loss = Lanes<int64_t, n>;  // bits of uint64_t
    static constexpr int lanes = n;
};

template <int n>
struct RealTraits<Lanes<float, n>> : RealTraits<float> {
    using Up = Lanes<double, n>;
};
template <int n>
struct RealTraits<Lanes<double, n>> : RealTraits<double> {
    using Up = DoubleDoubleOf<Lanes<double, n>>;
};

template <class Real, int bytes, int n>
CISTULA_INLINE MaskOf<Real> narrowed(LaneMask<bytes, n> mask) {
    if constexpr (std::is_same_v<MaskOf<Real>, LaneMask<bytes, n>>)
        return mask;
    else
        return native::joined(mask.low.v, mask.high.v);
}
/// A mask of floats for lanes of twice the size.
template <int n>
CISTULA_INLINE LaneMask<8, n> widened(LaneMask<4, n> mask) {
    return {native::low_half(mask.v), native::high_half(mask.v)};
}
template <int n>
CISTULA_INLINE LaneMask<8, n> widened(LaneMask<8, n> mask) {
    return mask;
}

template <class T, int n>
CISTULA_INLINE Lanes<T, n> channel(const Lanes<T, n>& a, int) {
    return a;
}
template <class T, int n>
CISTULA_INLINE Lanes<T, n> largest_component(const Lanes<T, n>& a) {
    return a;
}

/// A lane of a number or a vector.
template <class T, int n>
CISTULA_INLINE T lane_of(const Lanes<T, n>& a, int lane) {
    return a[lane];
}
template <class T, int n>
CISTULA_INLINE glm::vec<3, T, glm::defaultp> lane_of(const glm::vec<3, Lanes<T, n>, glm::defaultp>& a, int lane) {
    return {a.x[lane], a.y[lane], a.z[lane]};
}

/// Lanes in memory, to be written one by one and then read at once: writing into a register costs a round trip each.
template <class Real>
struct LaneArray {
    using T = ScalarOf<Real>;
    alignas(lane_bytes) T of[LaneTraits<Real>::lanes];

    LaneArray() = default;
    CISTULA_INLINE explicit LaneArray(const Real& a) { a.put(of); }
    CISTULA_INLINE Real all() const { return Real::at(of); }
};
template <class Real>
struct LaneVectors {
    using T = ScalarOf<Real>;
    LaneArray<Real> x, y, z;

    LaneVectors() = default;
    CISTULA_INLINE explicit LaneVectors(const Vec3<Real>& a) : x(a.x), y(a.y), z(a.z) {}
    CISTULA_INLINE void set(int lane, const Vec3<T>& a) { x.of[lane] = a.x, y.of[lane] = a.y, z.of[lane] = a.z; }
    CISTULA_INLINE Vec3<T> operator[](int lane) const { return {x.of[lane], y.of[lane], z.of[lane]}; }
    CISTULA_INLINE Vec3<Real> all() const { return {x.all(), y.all(), z.all()}; }
};

/// The vectors that begin with the numbers from[stride place].
template <int stride, class From, class T, int n>
CISTULA_INLINE auto vectors_at(const From* from, const Lanes<T, n>& place) {
    if constexpr (sizeof(From) == 4 && sizeof(T) == 4) {
        Vec3<Lanes<float, n>> all;
        native::gather_three(from, (place * Lanes<T, n>(stride)).v, all.x.v, all.y.v, all.z.v);
        return all;
    } else {
        using Real = Lanes<std::conditional_t<sizeof(T) == 4, float, double>, n>;
        const LaneArray<Lanes<T, n>> places(place);
        LaneVectors<Real> all;
        for (int lane = 0; lane < n; ++lane) {
            const From* of = from + stride * size_t(places.of[lane]);
            all.set(lane, Vec3<ScalarOf<Real>>(Vec3<From>(of[0], of[1], of[2])));
        }
        return all.all();
    }
}

/// Calls visit(lane) for each lane of a mask.
template <int bytes, int n, class Visit>
CISTULA_INLINE void for_each_lane(LaneMask<bytes, n> mask, const Visit& visit) {
    for (uint32_t left = mask.bits(); left != 0; left &= left - 1) visit(int(lowest_bit(left)));
}

/// Calls visit(value, mask) for each value that an index has in the lanes of a mask, with the lanes that have it.
template <int bytes, int n, class T, class Visit>
CISTULA_INLINE void for_each_value(LaneMask<bytes, n> mask, const Lanes<T, n>& index, const Visit& visit) {
    for (uint32_t left = mask.bits(); left != 0;) {
        const T value = index[int(lowest_bit(left))];
        const LaneMask<bytes, n> same = mask & (index == Lanes<T, n>(value));
        left &= ~same.bits();
        visit(uint32_t(value), same);
    }
}

}  // namespace cistula

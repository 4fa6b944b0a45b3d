// A register of lanes computes what a number computes, lane by lane, special values included.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "cistula/lanes/lane_shadow.h"
#include "cistula/lanes/lane_sums.h"
#include "cistula/lanes/lane_surface.h"
#include "verify/draw.h"

using namespace cistula;

namespace {

template <class T>
struct Numbers {
    using Real = Lanes<T, lane_bytes / int(sizeof(T))>;
    static constexpr int lanes = LaneTraits<Real>::lanes;
    T of[lanes];
    Real all;
};

template <class T>
class LanesTest : public ::testing::Test {
  public:
    using Real = typename Numbers<T>::Real;
    static constexpr int lanes = Numbers<T>::lanes;

    /// Any bits as often as ordinary numbers and special ones.
    T number() {
        switch (draw_.below(3)) {
            case 0:
                return draw_.template special<T>();
            case 1:
                return draw_.template centered<T>(T(4));
            default:
                return draw_.template pattern<T>();
        }
    }
    Numbers<T> numbers() {
        Numbers<T> n;
        for (T& one : n.of) one = number();
        n.all = Real::at(n.of);
        return n;
    }

    static bool same(T a, T b) {
        return (a != a && b != b) || bits_as<SignedOf<sizeof(T)>>(a) == bits_as<SignedOf<sizeof(T)>>(b);
    }

    template <class OfLanes, class OfNumbers>
    void expect(const char* what, const OfLanes& found, const OfNumbers& expected) {
        for (int i = 0; i < lanes; ++i) ASSERT_TRUE(same(found[i], expected(i))) << what << ", lane " << i;
    }
    template <class Mask, class OfNumbers>
    void expect_mask(const char* what, const Mask& found, const OfNumbers& expected) {
        uint32_t bits = 0;
        for (int i = 0; i < lanes; ++i) bits |= uint32_t(expected(i)) << i;
        ASSERT_EQ(found.bits(), bits) << what;
    }

    verify::Draw draw_{1, 38};
};

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(LanesTest, Reals);

TYPED_TEST(LanesTest, ArithmeticIsThatOfNumbers) {
    for (int turn = 0; turn < 20000; ++turn) {
        const auto a = this->numbers(), b = this->numbers(), c = this->numbers();
        this->expect("+", a.all + b.all, [&](int i) { return a.of[i] + b.of[i]; });
        this->expect("-", a.all - b.all, [&](int i) { return a.of[i] - b.of[i]; });
        this->expect("*", a.all * b.all, [&](int i) { return a.of[i] * b.of[i]; });
        this->expect("/", a.all / b.all, [&](int i) { return a.of[i] / b.of[i]; });
        this->expect("negative", -a.all, [&](int i) { return -a.of[i]; });
        this->expect("fused", fused(a.all, b.all, c.all), [&](int i) { return fused(a.of[i], b.of[i], c.of[i]); });
        this->expect("square_root", square_root(a.all), [&](int i) { return square_root(a.of[i]); });
        this->expect("floor_of", floor_of(a.all), [&](int i) { return floor_of(a.of[i]); });
        this->expect("magnitude", magnitude(a.all), [&](int i) { return magnitude(a.of[i]); });
        this->expect("min_or_second", min_or_second(a.all, b.all),
                     [&](int i) { return min_or_second(a.of[i], b.of[i]); });
        this->expect("max_or_second", max_or_second(a.all, b.all),
                     [&](int i) { return max_or_second(a.of[i], b.of[i]); });
        this->expect("max_no_nan", max_no_nan(a.all, b.all), [&](int i) { return max_no_nan(a.of[i], b.of[i]); });
        this->expect("clamped", clamped(a.all, b.all, c.all),
                     [&](int i) { return clamped(a.of[i], b.of[i], c.of[i]); });
        this->expect_mask("<", a.all < b.all, [&](int i) { return a.of[i] < b.of[i]; });
        this->expect_mask("<=", a.all <= b.all, [&](int i) { return a.of[i] <= b.of[i]; });
        this->expect_mask(">", a.all > b.all, [&](int i) { return a.of[i] > b.of[i]; });
        this->expect_mask(">=", a.all >= b.all, [&](int i) { return a.of[i] >= b.of[i]; });
        this->expect_mask("==", a.all == b.all, [&](int i) { return a.of[i] == b.of[i]; });
        this->expect_mask("!=", a.all != b.all, [&](int i) { return a.of[i] != b.of[i]; });
        this->expect("select", select(a.all < b.all, c.all, a.all),
                     [&](int i) { return a.of[i] < b.of[i] ? c.of[i] : a.of[i]; });
    }
}

TYPED_TEST(LanesTest, HigherPrecisionIsThatOfNumbers) {
    using Real = typename TestFixture::Real;
    using Up = typename RealTraits<Real>::Up;
    using UpOne = typename RealTraits<TypeParam>::Up;
    for (int turn = 0; turn < 5000; ++turn) {
        TypeParam a[TestFixture::lanes], b[TestFixture::lanes];
        for (int i = 0; i < TestFixture::lanes; ++i) {
            a[i] = TypeParam(0.1) + TypeParam(3) * this->draw_.template unit<TypeParam>();
            b[i] = TypeParam(0.1) + TypeParam(3) * this->draw_.template unit<TypeParam>();
        }
        const Up x(Real::at(a)), y(Real::at(b));
        const auto one = [&](int i) { return std::pair(UpOne(a[i]), UpOne(b[i])); };
        this->expect("up", Real(up_sqrt(x * y + x / y) - y), [&](int i) {
            const auto [p, q] = one(i);
            return TypeParam(up_sqrt(p * q + p / q) - q);
        });
        this->expect_mask("up >", narrowed<Real>(x > y), [&](int i) { return one(i).first > one(i).second; });
    }
}

TYPED_TEST(LanesTest, IntegersAreThoseOfNumbers) {
    using Real = typename TestFixture::Real;
    for (int turn = 0; turn < 20000; ++turn) {
        TypeParam a[TestFixture::lanes];
        for (TypeParam& one : a) {
            const TypeParam share = this->draw_.template unit<TypeParam>();
            one = this->draw_.one_in(8) ? TypeParam(0)
                                        : share * TypeParam(std::ldexp(1.0, int(this->draw_.below(190)) - 128));
        }
        const Lanes<double, TestFixture::lanes> wide(Real::at(a));
        const auto below = integers_of<false>(wide), above = integers_of<true>(wide);
        for (int i = 0; i < TestFixture::lanes; ++i) {
            ASSERT_EQ(below[i], whole_of(a[i])) << a[i];
            ASSERT_EQ(above[i], whole_above(a[i])) << a[i];
        }
    }
}

TYPED_TEST(LanesTest, LossesAreThoseOfNumbersUpToWhereNothingPasses) {
    using Real = typename TestFixture::Real;
    constexpr int n = TestFixture::lanes;
    const uint64_t all = loss_of_all;
    for (int turn = 0; turn < 5000; ++turn) {
        Lanes<int64_t, n> sums(int64_t{0});
        Lanes<double, n> depths(0.0);
        uint64_t expected[n] = {};
        for (int i = 0; i < n; ++i) {
            depths.set(i, this->draw_.one_in(8) ? this->draw_.template special<double>()
                                                : std::ldexp(this->draw_.template centered<double>(1.0),
                                                             int(this->draw_.below(64)) - 48));
            expected[i] = absorption_loss(depths[i]);
        }
        add_loss(LaneMask<8, n>(true), absorption_loss(depths), sums);
        const uint32_t mask = uint32_t(this->draw_.below(1u << n));
        const auto active = widened(MaskOf<Real>::of_bits(mask));
        for (int term = 0; term < 6; ++term) {
            const uint64_t loss = this->draw_.one_in(4) ? largest_loss : this->draw_.shifted(0, 63);
            add_loss(active, loss, sums);
            for (int i = 0; i < n; ++i) add_loss((mask >> i & 1u) != 0, loss, expected[i]);
        }
        const Real shares = uncached_transmittance<TypeParam>(sums);
        for (int i = 0; i < n; ++i) {
            ASSERT_EQ(uint64_t(sums[i]), std::min(expected[i], all)) << depths[i];
            ASSERT_TRUE(this->same(shares[i], transmittance_of<TypeParam>(expected[i]))) << expected[i];
        }
    }
}

TYPED_TEST(LanesTest, EntriesOfTablesAndVectorsAreTakenByIndex) {
    using Real = typename TestFixture::Real;
    using Index = IndexOf<Real>;
    LaneTable<TypeParam> table;
    LaneTable<ScalarOf<Index>> integers;
    std::vector<TypeParam> vectors(3 * 16);  // as long as they are: nothing is read behind the last
    for (int i = 0; i < 16; ++i) {
        table.of[i] = this->number();
        integers.of[i] = ScalarOf<Index>(this->draw_.below(1u << 30));
        for (int c = 0; c < 3; ++c) vectors[size_t(3 * i + c)] = this->number();
    }
    for (int turn = 0; turn < 1000; ++turn) {
        Index index = 0, place = 0;
        for (int i = 0; i < TestFixture::lanes; ++i) {
            index.set(i, ScalarOf<Index>(this->draw_.below(native::table_entries<sizeof(TypeParam)>)));
            place.set(i, ScalarOf<Index>(this->draw_.below(16)));
        }
        this->expect("entry", looked_up(table, index), [&](int i) { return table.of[index[i]]; });
        const Index found = looked_up(integers, index);
        const Vec3<Real> vector = vectors_at<3>(vectors.data(), place);
        for (int i = 0; i < TestFixture::lanes; ++i) ASSERT_EQ(found[i], integers.of[index[i]]);
        for (int c = 0; c < 3; ++c)
            this->expect("vector", vector[c], [&](int i) { return vectors[size_t(3 * place[i] + c)]; });
    }
}

TYPED_TEST(LanesTest, TexturesRepeatAsForNumbers) {
    using Real = typename TestFixture::Real;
    for (const uint32_t size : {1u, 2u, 3u, 7u, 640u, 65535u})
        for (int turn = 0; turn < 2000; ++turn) {
            auto a = this->numbers();
            for (TypeParam& one : a.of)
                one = std::floor(this->draw_.one_in(2) ? one
                                                       : TypeParam(1e5) * this->draw_.template centered<TypeParam>(1));
            a.all = Real::at(a.of);
            const auto found = repeated(a.all, size);
            for (int i = 0; i < TestFixture::lanes; ++i)
                ASSERT_EQ(uint32_t(found[i]), repeated(a.of[i], size)) << a.of[i] << " " << size;
        }
}

/// Solids that are entered and left in any order, as many as fit and one more.
TYPED_TEST(LanesTest, NamedSetsHoldUpToThreeSolids) {
    using Real = typename TestFixture::Real;
    using Index = IndexOf<Real>;
    const std::vector<uint32_t> solids{0, 1, 2, 511, 512, 1020, 1021};
    for (int turn = 0; turn < 500; ++turn) {
        LaneMedia<Real> media{Index(0), true};
        std::set<uint32_t> expected[TestFixture::lanes];
        for (int step = 0; step < 12; ++step) {
            Index solid = 0;
            const auto enters = MaskOf<Real>::of_bits(uint32_t(this->draw_.below(1u << TestFixture::lanes)));
            for (int i = 0; i < TestFixture::lanes; ++i)
                solid.set(i, ScalarOf<Index>(solids[this->draw_.below(solids.size())]));
            const auto is_inside = media.contains(solid);
            const auto fits = media.cross(enters, !enters, solid);
            for (int i = 0; i < TestFixture::lanes; ++i) {
                const auto own = uint32_t(solid[i]);
                const bool enter = (enters.bits() >> i & 1u) != 0, was_inside = expected[i].count(own) != 0;
                ASSERT_EQ((is_inside.bits() >> i & 1u) != 0, was_inside);
                const bool possible = enter ? !was_inside && expected[i].size() < 3 : was_inside;
                ASSERT_EQ((fits.bits() >> i & 1u) != 0, possible);
                if (possible && enter) expected[i].insert(own);
                if (possible && !enter) expected[i].erase(own);
                ASSERT_EQ(media.of(i).count(), expected[i].size());
                for (const uint32_t other : solids) {
                    ASSERT_EQ(media.of(i).contains(other), expected[i].count(other) != 0);
                    ASSERT_EQ((media.contains(other).bits() >> i & 1u) != 0, expected[i].count(other) != 0);
                }
                ASSERT_EQ(media.of(i).last(), expected[i].empty() ? no_solid : *expected[i].rbegin());
                ASSERT_EQ(InteriorSet::of(media.of(i).list(), true).count(), expected[i].size());
            }
        }
    }
}

TYPED_TEST(LanesTest, MasksAndPacking) {
    using Real = typename TestFixture::Real;
    constexpr int n = TestFixture::lanes;
    const auto a = this->numbers();
    for (uint32_t bits = 0; bits < 1u << n; ++bits) {
        const auto mask = MaskOf<Real>::of_bits(bits);
        ASSERT_EQ(mask.bits(), bits);
        ASSERT_EQ((!mask).bits(), ~bits & ((1u << n) - 1));
        ASSERT_EQ(any(mask), bits != 0);
        ASSERT_EQ(all(mask), bits == (1u << n) - 1);
        ASSERT_EQ(narrowed<Real>(widened(mask)).bits(), bits);
        const Real packed(native::packed(a.all.v, bits));
        for (int lane = 0, next = 0; lane < n; ++lane)
            if (bits >> lane & 1) {
                ASSERT_TRUE(this->same(packed[next++], a.of[lane]));
            }
    }
}

}  // namespace

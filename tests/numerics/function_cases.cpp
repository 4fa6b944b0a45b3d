// testing/parity/function_cases.h on the host alone: the inputs of the function parity check cover what they claim,
// results repeat, and a planted difference is found.
#include "testing/parity/function_cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "testing/parity/function_compare.h"

namespace cistula::parity {
namespace {

constexpr uint64_t inputs = 20000, seed = 7;

/// Calls visit(input, words) for every input of a case.
template <class Case, class Visit>
void for_each_input(const Visit& visit) {
    for (uint64_t i = 0; i < inputs; ++i) {
        Draw draw(i, seed);
        const typename Case::Input input = Case::make(draw);
        uint64_t words[most_words];
        Words out(words);
        Case::run(input, out);
        ASSERT_EQ(out.count(), Case::words);
        visit(input, words);
    }
}

template <class Real>
Real real_of(uint64_t word) {
    if (word == 0x7ff8000000000000u) return std::numeric_limits<Real>::quiet_NaN();
    return bits_as<Real>(typename Layout<Real>::Bits(word));
}

template <class Case>
void expect_sound() {
    SCOPED_TRACE(std::string(Case::name) + " " + RealTraits<typename Case::Number>::name);
    static_assert(Case::words <= most_words);
    std::set<std::vector<uint64_t>> distinct;
    for_each_input<Case>([&](const auto&, const uint64_t* words) { distinct.emplace(words, words + Case::words); });
    EXPECT_GT(distinct.size(), inputs / 8);
    // Results do not depend on where a range starts or how it is divided; another seed gives other results.
    std::vector<uint64_t> whole(1000 * Case::words), part(whole), other(whole);
    run_on_host<Case>(seed, 5000, 1000, whole.data());
    run_on_host<Case>(seed, 5000, 400, part.data());
    run_on_host<Case>(seed, 5400, 600, part.data() + 400 * Case::words);
    run_on_host<Case>(seed + 1, 5000, 1000, other.data());
    EXPECT_EQ(whole, part);
    EXPECT_NE(whole, other);
}

template <class... Cases>
void expect_all_sound(CaseList<Cases...>) {
    (expect_sound<Cases>(), ...);
}

TEST(FunctionCases, WordsAreComplete) {
    expect_all_sound(AllCases());
}

TEST(FunctionCases, EveryFunctionHasBothPrecisionsOrIsDoubleOnly) {
    std::map<std::string, std::set<std::string>> precisions;
    for (const CaseRunner& runner : host_runners(AllCases())) precisions[runner.name].insert(runner.precision);
    size_t both = 0;
    for (const auto& [name, has] : precisions) {
        EXPECT_TRUE(has.count("double")) << name;
        both += has.size() == 2;
    }
    EXPECT_EQ(both, 21u);
    EXPECT_EQ(precisions.size(), 34u);
}

template <class Real>
void expect_one_nan() {
    using Bits = typename Layout<Real>::Bits;
    const Real nan = no_number<Real>, payload = bits_as<Real>(Bits(bits_as<Bits>(nan) + 5));
    uint64_t words[6];
    Words out(words);
    out.real(nan);
    out.real(-nan);
    out.real(payload);
    out.real(Real(0));
    out.real(-Real(0));
    out.unsigned_zero(-Real(0));
    EXPECT_EQ(words[0], words[1]);
    EXPECT_EQ(words[0], words[2]);
    EXPECT_NE(words[3], words[4]);
    EXPECT_EQ(words[3], words[5]);
}

TEST(FunctionCases, NaNsAreOneAndZerosAreTwo) {
    expect_one_nan<float>();
    expect_one_nan<double>();
}

template <class Real>
class FunctionInputs : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(FunctionInputs, Precisions);

TYPED_TEST(FunctionInputs, NumbersOfAllKindsAreDrawn) {
    using Real = TypeParam;
    int classes[5] = {}, negative_zeros = 0, powers = 0, least = 0;
    for (uint64_t i = 0; i < inputs; ++i) {
        Draw draw(i, seed);
        const Real x = draw.any<Real>();
        ++classes[std::isnan(x) ? 0 : std::isinf(x) ? 1 : x == 0 ? 2 : std::fpclassify(x) == FP_SUBNORMAL ? 3 : 4];
        negative_zeros += x == 0 && std::signbit(x);
        least += magnitude(x) == std::numeric_limits<Real>::denorm_min();
        int exponent;
        powers += std::isfinite(x) && magnitude(std::frexp(x, &exponent)) == Real(0.5);
        const Real u = draw.unit<Real>();
        ASSERT_TRUE(u >= 0 && u < 1);
        const Real s = draw.scaled<Real>(-3, 2);
        ASSERT_TRUE(magnitude(s) >= Real(0.125) && magnitude(s) < Real(8));
        const Vec3<Real> d = draw.direction<Real>();
        ASSERT_NEAR(double(dot(d, d)), 1.0, 16 * double(RealTraits<Real>::unit));
    }
    for (const int count : classes) EXPECT_GT(count, 200);
    EXPECT_GT(negative_zeros, 100);
    EXPECT_GT(least, 100);
    EXPECT_GT(powers, 500);
    EXPECT_EQ(two_to<Real>(std::numeric_limits<Real>::min_exponent - std::numeric_limits<Real>::digits),
              std::numeric_limits<Real>::denorm_min());
}

TYPED_TEST(FunctionInputs, ReciprocalsAreThoseOfItsRange) {
    using Real = TypeParam;
    const Real low = Real(0x1p-120), high = Real(0x1p120);
    int negative = 0, at_low = 0, at_high = 0, powers = 0, below_power = 0;
    for_each_input<ReciprocalCase<Real>>([&](const auto& in, const uint64_t* words) {
        const Real size = magnitude(in.x);
        ASSERT_TRUE(size >= low && size <= high);
        ASSERT_EQ(real_of<Real>(words[0]), Real(1) / in.x);
        negative += in.x < 0;
        at_low += size == low;
        at_high += size == high;
        int exponent;
        powers += std::frexp(size, &exponent) == Real(0.5);
        below_power += std::frexp(stepped(size, 1), &exponent) == Real(0.5);
    });
    EXPECT_GT(negative, int(inputs) / 3);
    EXPECT_LT(negative, int(inputs) * 2 / 3);
    for (const int count : {at_low, at_high, powers, below_power}) EXPECT_GT(count, 200);
}

TYPED_TEST(FunctionInputs, LesserAndGreaterOfAllThatMayBeAsked) {
    using Real = TypeParam;
    int equal = 0, neighbors = 0, opposite = 0, with_zero = 0, infinite = 0, subnormal = 0, less = 0, more = 0;
    for_each_input<LesserGreaterCase<Real>>([&](const auto& in, const uint64_t* words) {
        ASSERT_FALSE(std::isnan(in.a) || std::isnan(in.b));
        ASSERT_FALSE(in.a == 0 && in.b == 0);
        ASSERT_EQ(real_of<Real>(words[0]), std::fmin(in.a, in.b));
        ASSERT_EQ(real_of<Real>(words[1]), std::fmax(in.a, in.b));
        equal += in.a == in.b;
        neighbors += in.b == stepped(in.a, 1) || in.b == stepped(in.a, -1);
        opposite += in.a == -in.b;
        with_zero += in.a == 0 || in.b == 0;
        infinite += std::isinf(in.a) || std::isinf(in.b);
        subnormal += std::fpclassify(in.a) == FP_SUBNORMAL && std::fpclassify(in.b) == FP_SUBNORMAL;
        less += in.a < in.b;
        more += in.a > in.b;
    });
    EXPECT_GT(less, int(inputs) / 4);
    EXPECT_GT(more, int(inputs) / 4);
    for (const int count : {equal, neighbors, opposite, with_zero, infinite, subnormal}) EXPECT_GT(count, 200);
}

TYPED_TEST(FunctionInputs, TrianglesAreHitAtEdgesAndCornersToo) {
    using Real = TypeParam;
    int hit = 0, sheets = 0, enters = 0, leaves = 0, second = 0, equal_t = 0, at_zero = 0, not_finite = 0;
    int owned = 0, refused = 0, no_area = 0, corners = 0;
    for_each_input<TriangleCase<Real>>([&](const ClusterInput<Real>& in, const uint64_t* words) {
        const Real t = real_of<Real>(words[0]), next_t = real_of<Real>(words[5]);
        if (words[1] != no_key) {
            ++hit;
            const CrossingKind kind = key_kind(words[1]);
            ++(kind == CrossingKind::sheet ? sheets : kind == CrossingKind::enter ? enters : leaves);
            at_zero += t == 0;
            second += words[6] != no_key;
            equal_t += words[6] != no_key && t == next_t;
        }
        not_finite += !is_finite(in.ray);
        const auto ray = TriangleRay<Real>::of(in.ray.origin, in.ray.direction);
        for (uint32_t lane = 0; lane < in.cluster.count; ++lane) {
            const auto s = ShearedTriangle<Real>::of(in.cluster, int(lane), ray);
            if (!s.within()) continue;
            const int zeros = int(s.edge[0] == 0) + int(s.edge[1] == 0) + int(s.edge[2] == 0);
            const Real det = s.edge[0] + s.edge[1] + s.edge[2];
            no_area += det == 0;
            if (det == 0 || zeros == 0) continue;
            ++(s.owns_zero_edges(det > 0 ? Real(1) : Real(-1)) ? owned : refused);
            corners += zeros == 2;
        }
    });
    std::printf(
        "%s: hit %d (sheets %d, enter %d, leave %d), again %d, at equal t %d, at 0 %d; on edges %d owned, %d refused, "
        "corners %d, no area %d; rays not finite %d\n",
        RealTraits<Real>::name, hit, sheets, enters, leaves, second, equal_t, at_zero, owned, refused, corners, no_area,
        not_finite);
    EXPECT_GT(hit, int(inputs) / 4);
    EXPECT_LT(hit, int(inputs) * 9 / 10);
    for (const int count : {sheets, enters, leaves, second, owned, refused, no_area, corners}) EXPECT_GT(count, 500);
    for (const int count : {equal_t, at_zero}) EXPECT_GT(count, 100);
    EXPECT_GT(not_finite, 10);
}

/// The inputs of a shadow case reach every kind of shadow. All shadow cases have the words loss, path, opaque, share.
template <class Case>
void expect_shadows_of_all_kinds() {
    using Real = typename Case::Number;
    int unshadowed = 0, dark = 0, partly = 0, lossy = 0, saturated = 0;
    for_each_input<Case>([&](const auto&, const uint64_t* words) {
        const uint64_t loss = words[0] | words[1] | words[2];
        unshadowed += loss == 0 && words[6] == 0;
        dark += words[6] == 7;
        partly += words[6] != 0 && words[6] != 7;
        saturated += words[0] == largest_loss;
        const Real share = real_of<Real>(words[7]);
        ASSERT_TRUE(share >= 0 && share <= 1);
        lossy += share > 0 && share < 1;
    });
    std::printf("%s %s: unshadowed %d, dark %d, opaque in part %d, dimmed %d, saturated %d\n", Case::name,
                RealTraits<Real>::name, unshadowed, dark, partly, lossy, saturated);
    for (const int count : {unshadowed, dark, partly, lossy, saturated}) EXPECT_GT(count, 100);
}

TYPED_TEST(FunctionInputs, ShadowsAreOfAllKinds) {
    using Real = TypeParam;
    expect_shadows_of_all_kinds<TriangleShadowCase<Real>>();
    expect_shadows_of_all_kinds<ConvexShadowCase<Real>>();
    int absorbing = 0;
    for_each_input<TriangleShadowCase<Real>>([&](const auto&, const uint64_t* words) { absorbing += words[3] != 0; });
    EXPECT_GT(absorbing, 1000);
    int held = 0, outside = 0;
    for_each_input<ConvexShadowCase<Real>>([&](const typename ConvexShadowCase<Real>::Input& in, const uint64_t*) {
        SceneView<Real> scene = view_of(in.shape);
        scene.incidents = {in.shadow.incidents, 2};
        const LightSide side = light_on_convex(scene, in.shadow.light, 0, in.shape.ray.origin);
        held += side != LightSide::none;
        outside += side == LightSide::outside;
    });
    EXPECT_GT(held, 1000);
    EXPECT_GT(outside, 200);
}

TYPED_TEST(FunctionInputs, ConvexSolidsAreMetFromEverywhere) {
    using Real = TypeParam;
    int entered = 0, passed = 0, left = 0, from_face = 0, missed = 0, tied = 0, before = 0, parallel = 0, ties = 0,
        beyond_eight = 0;
    std::set<uint32_t> slab_counts;
    for_each_input<ConvexCase<Real>>([&](const ConvexInput<Real>& in, const uint64_t* words) {
        slab_counts.insert(in.solid.slab_count);
        const bool inside = in.ray.media.contains(0);
        const bool hit = words[1] != no_key;
        entered += hit && !inside;
        left += hit && inside;
        from_face += hit && in.ray.from_solid == 0;
        missed += !hit;
        passed += hit && words[4] != no_key;
        (words[6] == words[1] ? tied : before) += hit;
        beyond_eight += hit && key_face(words[1]) >= 2 * slab_lanes;
        int at_enter = 0;
        bool flat = false;
        for (uint32_t i = 0; i < in.solid.slab_count; ++i) {
            Real enter, leave;
            cross_slab(in.slabs[i].normal, in.slabs[i].low, in.slabs[i].high, in.ray.origin, in.ray.direction, enter,
                       leave);
            flat |= magnitude(dot(in.slabs[i].normal, in.ray.direction)) < RealTraits<Real>::least_normal;
            at_enter += hit && (inside ? leave : enter) == real_of<Real>(words[0]);
        }
        parallel += flat;
        ties += at_enter > 1;
    });
    std::printf(
        "%s: entered %d, then left %d, left from inside %d, from a face %d, missed %d; ties of faces %d, parallel to a "
        "slab %d, slabs beyond eight %d, won ties %d, lost %d\n",
        RealTraits<Real>::name, entered, passed, left, from_face, missed, ties, parallel, beyond_eight, tied, before);
    EXPECT_EQ(slab_counts, (std::set<uint32_t>{3, 4, 6, 10}));
    for (const int count : {entered, passed, left, from_face, missed, parallel, tied, before}) EXPECT_GT(count, 1000);
    for (const int count : {ties, beyond_eight}) EXPECT_GT(count, 100);
}

// The tables are those of solids: a corner lies on as many faces as meet there, and inside the others.
TEST(FunctionCases, PlatonicCornersLieOnTheirFaces) {
    const uint32_t meeting[] = {3, 3, 4, 3, 5};
    for (uint32_t kind = 0; kind < solid_kinds; ++kind) {
        const PlatonicTables tables = platonic_tables(kind);
        for (uint32_t i = 0; i < tables.corners; ++i) {
            uint32_t faces = 0;
            for (uint32_t s = 0; s < tables.slabs; ++s) {
                const double n = dot(platonic_normal(kind, s), platonic_corner(kind, i));
                const double height = kind == 0 ? n : magnitude(n);
                EXPECT_LT(height, tables.inradius + 1e-15);
                faces += height > tables.inradius - 1e-15;
            }
            EXPECT_EQ(faces, meeting[kind]) << kind << " " << i;
        }
    }
}

TYPED_TEST(FunctionInputs, IntervalsOfAllKinds) {
    using Real = TypeParam;
    int met = 0, empty = 0, inside = 0, zero = 0, spared = 0, beyond = 0, skipping = 0;
    for_each_input<ConvexIntervalCase<Real>>([&](const auto&, const uint64_t* words) {
        const Real enter = real_of<Real>(words[0]), leave = real_of<Real>(words[1]);
        ASSERT_EQ(enter, enter);
        ASSERT_EQ(leave, leave);
        met += words[3] != 0;
        empty += enter > leave;
        zero += enter == 0 || leave == 0;
        skipping += words[1] != words[2];
        inside += (words[4] & 2u) != 0;
        beyond += (words[4] & 5u) == 4;
        spared += (words[4] & 1u) != 0;
    });
    for (const int count : {met, empty, inside, spared, beyond, skipping}) EXPECT_GT(count, 1000);
    EXPECT_GT(zero, 100);
}

TYPED_TEST(FunctionInputs, BallsAndDisksAreMetFromEverywhere) {
    using Real = TypeParam;
    int entered = 0, passed = 0, left = 0, missed = 0, from_surface = 0, from_kin = 0, grazed = 0, tied = 0, before = 0;
    for_each_input<BallCase<Real>>([&](const BallInput<Real>& in, const uint64_t* words) {
        const bool inside = in.ray.media.contains(0), hit = words[1] != no_key;
        const Real square = real_of<Real>(words[7]);
        entered += hit && !inside;
        left += hit && inside;
        missed += !hit;
        passed += hit && !inside && words[4] != no_key;
        from_surface += hit && in.ray.from_solid == 0;
        from_kin += in.ray.from_solid == 1 && in.balls[0].has_kin != 0;
        grazed += magnitude(square) < Real(0x1p-18) * in.balls[0].radius * in.balls[0].radius;
        (words[5] == words[1] ? tied : before) += hit;
    });
    std::printf(
        "%s balls: entered %d, then left %d, left from inside %d, missed %d, from the surface %d, from kin %d, "
        "grazed %d; won ties %d, lost %d\n",
        RealTraits<Real>::name, entered, passed, left, missed, from_surface, from_kin, grazed, tied, before);
    for (const int count : {entered, passed, left, missed, from_surface, from_kin}) EXPECT_GT(count, 1000);
    for (const int count : {grazed, tied, before}) EXPECT_GT(count, 100);
    int met = 0, outside = 0, moved = 0, near_ball = 0, turned = 0, endless = 0, again = 0;
    for_each_input<DiskCase<Real>>([&](const DiskInput<Real>& in, const uint64_t* words) {
        const bool hit = words[1] != no_key;
        met += hit;
        outside += !hit && real_of<Real>(words[7]) > 0;
        moved += real_of<Real>(words[11]) > 0;
        near_ball += hit && in.solids[0].first_group != 0;
        turned += hit && in.solids[0].first_group != 0 && in.ray.from_solid == 1;
        endless += hit && in.disk.square > 1000;
        again += words[5] != no_key;
    });
    std::printf("%s disks: met %d, passed by %d, from afar %d, near a ball %d, from it %d, endless %d\n",
                RealTraits<Real>::name, met, outside, moved, near_ball, turned, endless);
    for (const int count : {met, outside, near_ball, endless}) EXPECT_GT(count, 1000);
    for (const int count : {moved, turned}) EXPECT_GT(count, 100);
    EXPECT_EQ(again, 0);  // a plane is crossed once
}

TYPED_TEST(FunctionInputs, RefractionOnBothSidesOfTheCriticalAngle) {
    using Real = TypeParam;
    int total = 0, equal = 0, just_total = 0, just_not = 0, head_on = 0, grazing = 0, behind = 0;
    for_each_input<RefractCase<Real>>([&](const Arrival<Real>& in, const uint64_t* words) {
        const long double n = (long double)in.to / in.from;
        long double c = 0;
        for (int k = 0; k < 3; ++k) c -= (long double)in.direction[k] * in.normal[k];
        const long double g2 = (n - 1) * (n + 1) + (c > 0 ? c * c : 0), close = 64 * RealTraits<Real>::unit;
        total += words[0] != 0;
        equal += in.from == in.to;
        just_total += words[0] != 0 && g2 > -close;
        just_not += words[0] == 0 && g2 < close && n < 1;
        head_on += c > 1 - close;
        grazing += magnitude(c) < close;
        behind += c < -close;
    });
    std::printf(
        "%s: total %d, equal indices %d, at the critical angle %d total, %d not; head on %d, grazing %d, behind %d\n",
        RealTraits<Real>::name, total, equal, just_total, just_not, head_on, grazing, behind);
    EXPECT_GT(total, int(inputs) / 10);
    EXPECT_LT(total, int(inputs) / 2);
    for (const int count : {equal, just_total, just_not, head_on, grazing}) EXPECT_GT(count, 500);
    EXPECT_GT(behind, 100);
    int none = 0, all = 0, some = 0;
    for_each_input<FresnelCase<Real>>([&](const Arrival<Real>&, const uint64_t* words) {
        const Real reflectance = real_of<Real>(words[0]);
        ++(reflectance == 0 ? none : reflectance == 1 ? all : some);
    });
    for (const int count : {none, all, some}) EXPECT_GT(count, 500);
}

TYPED_TEST(FunctionInputs, LightsAndTexelsOfAllKinds) {
    using Real = TypeParam;
    int seen[2] = {}, unseen = 0, twice = 0;
    for_each_input<VisibleLightCase<Real>>(
        [&](const typename VisibleLightCase<Real>::Input& in, const uint64_t* words) {
            ++(words[1] == no_light ? unseen : seen[words[1]]);
            twice += words[1] == 0 && in.lights[0].center == in.lights[1].center;
        });
    for (const int count : {seen[0], seen[1], unseen, twice}) EXPECT_GT(count, 500);
    int texels = 0, mixed_ones = 0, none = 0;
    for_each_input<TextureCase<Real>>([&](const typename TextureCase<Real>::Input& in, const uint64_t* words) {
        bool one = false;
        for (const Vec3<float>& texel : in.texels) one |= real_of<Real>(words[0]) == Real(texel.x);
        const Real value = real_of<Real>(words[0]);
        ++(!(value == value) ? none : one ? texels : mixed_ones);
    });
    for (const int count : {texels, mixed_ones, none}) EXPECT_GT(count, 200);
    int no_normal = 0, normals = 0;
    for_each_input<ApexCase<Real>>([&](const auto&, const uint64_t* words) {
        const Real x = real_of<Real>(words[0]);
        ++(x == x ? normals : no_normal);
    });
    EXPECT_GT(normals, int(inputs) / 2);
    int highlights = 0;
    for_each_input<PhongCase<Real>>([&](const typename PhongCase<Real>::Input& in, const uint64_t*) {
        const Real r_v = Real(2) * in.n_l * dot(in.normal, in.to_viewer) - dot(in.to_light, in.to_viewer);
        highlights += highlight(in.material, r_v) > Real(0.01);
    });
    EXPECT_GT(highlights, 2000);
}

TYPED_TEST(FunctionInputs, SumsThatFitAndThatDoNot) {
    using Real = TypeParam;
    int fits = 0, refused = 0, exact = 0, whole_one = 0;
    for_each_input<ToFixedCase<Real>>([&](const typename ToFixedCase<Real>::Input& in, const uint64_t* words) {
        ASSERT_EQ(words[0], words[2]);
        ++(words[0] != 0 ? fits : refused);
        exact += words[0] != 0 && words[1] == words[3] && words[1] != 0;
        whole_one += in.x == Real(1);
        if (words[0] != 0) {
            ASSERT_LE(words[3] - words[1], 1u);
        }
    });
    for (const int count : {fits, refused, exact, whole_one}) EXPECT_GT(count, 500);
    int halves = 0, infinite = 0, subnormal = 0, ordinary = 0;
    for_each_input<ResolveCase<Real>>([&](const typename ResolveCase<Real>::Input& in, const uint64_t* words) {
        ASSERT_EQ(words[1], words[2]);
        halves += in.samples % 2 == 0 && in.sum % in.samples == in.samples / 2;
        const Real value = real_of<Real>(words[1]);
        ++(std::isinf(value) ? infinite : std::fpclassify(value) == FP_SUBNORMAL ? subnormal : ordinary);
    });
    for (const int count : {halves, infinite, subnormal, ordinary}) EXPECT_GT(count, 200);
    int none = 0, one = 0, between = 0;
    for_each_input<TransmittanceCase<Real>>([&](const auto&, const uint64_t* words) {
        const Real share = real_of<Real>(words[0]);
        ++(share == 0 ? none : share == 1 ? one : between);
    });
    for (const int count : {none, one, between}) EXPECT_GT(count, 100);
}

template <class Case>
void expect_results_of_all_kinds(bool zeros, bool subnormals, bool infinities) {
    int count[5] = {};
    for_each_input<Case>([&](const auto&, const uint64_t* words) {
        const double x = real_of<double>(words[0]);
        ++count[std::isnan(x) ? 0 : std::isinf(x) ? 1 : x == 0 ? 2 : std::fpclassify(x) == FP_SUBNORMAL ? 3 : 4];
    });
    EXPECT_GT(count[0], 20) << Case::name << ": NaN";
    EXPECT_EQ(count[1] > 20, infinities) << Case::name << ": infinity " << count[1];
    EXPECT_EQ(count[2] > 20, zeros) << Case::name << ": zero " << count[2];
    EXPECT_EQ(count[3] > 20, subnormals) << Case::name << ": subnormal " << count[3];
    EXPECT_GT(count[4], int(inputs) / 3) << Case::name << ": ordinary";
}

TEST(FunctionCases, ElementaryFunctionsAreTriedAtTheirEnds) {
    expect_results_of_all_kinds<Exp2Case>(true, true, true);
    expect_results_of_all_kinds<Log2Case>(true, false, true);
    expect_results_of_all_kinds<PowCase>(true, true, true);
    expect_results_of_all_kinds<SinCase>(true, true, false);
    expect_results_of_all_kinds<CosCase>(false, false, false);
    expect_results_of_all_kinds<TanCase>(true, true, false);
    expect_results_of_all_kinds<SrgbCase>(true, true, true);
    int large = 0, small = 0;
    for_each_input<SinCase>([&](const OneDouble& in, const uint64_t*) {
        if (std::isfinite(in.x)) ++(magnitude(in.x) < 0x1p30 ? small : large);
    });
    EXPECT_GT(large, 2000);
    EXPECT_GT(small, 2000);
    int saturated = 0, nothing = 0, losses = 0;
    for_each_input<AbsorptionCase>([&](const OneDouble&, const uint64_t* words) {
        ++(words[0] == largest_loss ? saturated : words[0] == 0 ? nothing : losses);
    });
    for (const int count : {saturated, nothing, losses}) EXPECT_GT(count, 500);
}

void run_with_differences(uint64_t run_seed, uint64_t first, uint64_t count, uint64_t* out) {
    run_on_host<Exp2Case>(run_seed, first, count, out);
    for (const uint64_t at : {uint64_t{17}, inputs_at_once + 5, inputs_at_once + 6, inputs_at_once + 7})
        if (at >= first && at < first + count) out[at - first] ^= 1u;
}
void run_with_last_word_changed(uint64_t run_seed, uint64_t first, uint64_t count, uint64_t* out) {
    run_on_host<Log2PairCase>(run_seed, first, count, out);
    out[2 * count - 1] ^= uint64_t{1} << 63;
}
void run_nothing(uint64_t, uint64_t, uint64_t, uint64_t*) {}

TEST(FunctionCases, PlantedDifferencesAreFound) {
    const uint64_t count = inputs_at_once + 100;
    const CaseRunner host{"exp2", "double", 1, &run_on_host<Exp2Case>};
    const FunctionParity same = compare_case(host, host, count, seed);
    EXPECT_EQ(same.compared, count);
    EXPECT_EQ(same.differing, 0u);
    EXPECT_EQ(same.first_difference, "");
    EXPECT_EQ(same.name + " " + same.precision, "exp2 double");

    const CaseRunner planted{"exp2", "double", 1, &run_with_differences};
    const FunctionParity differs = compare_case(host, planted, count, seed);
    EXPECT_EQ(differs.compared, count);
    EXPECT_EQ(differs.differing, 4u);
    uint64_t word = 0;
    run_on_host<Exp2Case>(seed, 17, 1, &word);
    EXPECT_EQ(differs.first_difference.rfind(fmt::format("input 17 (seed 7): host {:016x}, device {:016x}; input {} ",
                                                         word, word ^ 1u, inputs_at_once + 5),
                                             0),
              0u)
        << differs.first_difference;
    EXPECT_EQ(differs.first_difference.find(std::to_string(inputs_at_once + 7)), std::string::npos);

    const CaseRunner pair{"log2_pair", "double", 2, &run_on_host<Log2PairCase>};
    const CaseRunner other{"log2_pair", "double", 2, &run_with_last_word_changed};
    EXPECT_EQ(compare_case(pair, other, 1000, seed).differing, 1u);

    // 2^23 floats of each sign and the two ends, as a GPU would have counted them.
    const FunctionParity whole = reciprocal_parity({(1u << 24) + 2, ~0ull}, 1, 2);
    EXPECT_EQ(whole.compared, (1u << 24) + 2);
    EXPECT_EQ(whole.differing, 0u);
    EXPECT_EQ(whole.first_difference, "");
    const FunctionParity one_off = reciprocal_parity({(1u << 24) + 1, 0x400000003f000001}, 1, 2);
    EXPECT_EQ(one_off.differing, 1u);
    EXPECT_EQ(one_off.first_difference, "input 40000000: reciprocal 3f000001, quotient 3f000000");
    EXPECT_EQ(reciprocal_parity({}, 1, 2).differing, (1u << 24) + 2);

    const CaseRunner silent{"exp2", "double", 1, &run_nothing};
    EXPECT_EQ(compare_case(silent, silent, 1000, seed).differing, 1000u);
}

}  // namespace
}  // namespace cistula::parity

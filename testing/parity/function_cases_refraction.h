// Function parity, directions: vectors, refraction, Fresnel, mirrors.
#pragma once

#include "cistula/shading/snell.h"
#include "testing/parity/function_case.h"

namespace cistula::parity {

template <class Real>
struct VectorCase : CaseOf<Real, 13> {
    static constexpr const char* name = "vectors";
    struct Input {
        Vec3<Real> a, b;
        Real t;
    };
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.a = draw.any_vector<Real>();
        in.b = draw.any_vector<Real>();
        if (draw.one_in(4))  // nearly along one another
            for (int k = 0; k < 3; ++k) in.b[k] = draw.near(in.a[k] * Real(3), 2);
        in.t = draw.any<Real>();
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        out.real(dot(in.a, in.b));
        out.vec(cross(in.a, in.b));
        out.vec(along(in.a, in.t, in.b));
        out.vec(normalized(in.a));
        out.real(length(in.b));
        out.real(difference_of_products(in.a.x, in.b.y, in.a.z, in.b.x));
        out.bits(uint64_t(is_finite(in.a)) + 2 * uint64_t(is_finite(in.t)));
    }
};

/// A face between two media and a ray that arrives there.
template <class Real>
struct Arrival {
    Vec3<Real> direction, normal;
    double from, to;
};

/// A random arrival: any angle, near the critical one, grazing, head on, or from behind; indices equal, nearly equal,
/// ordinary, or at the ends of their range.
template <class Real>
CISTULA_HD inline Arrival<Real> arrival(Draw& draw) {
    Arrival<Real> a;
    const double common[] = {1, 1, 1.000293, 1.31, 1.333, 1.5, 1.52, 2.417, 0.01, 100};
    a.from = draw.one_in(2) ? common[draw.below(10)] : 1 + 2 * draw.unit<double>();
    a.to = draw.one_in(2) ? common[draw.below(10)] : 1 + 2 * draw.unit<double>();
    if (draw.one_in(8)) a.to = draw.near(a.from, 2);
    const bool critical = draw.one_in(3);
    if (critical && a.to > a.from) {
        const double index = a.from;
        a.from = a.to;
        a.to = index;
    }
    a.normal = draw.direction<Real>();
    if (draw.one_in(16)) {
        a.direction = draw.direction<Real>();  // perhaps from behind
        return a;
    }
    // Computed in double: d = sine * tangent - cosine * N.
    const Vec3<double> n(a.normal);
    Vec3<double> tangent = cross(n, draw.in_cube<double>(1.0));
    const double size = length(tangent);
    tangent = size > 0x1p-20 ? tangent / size : Vec3<double>(0.0);
    double sine = draw.unit<double>();
    if (critical) {
        sine = a.to / a.from;
        if (draw.one_in(2)) sine *= 1 + draw.centered(8.0) * double(RealTraits<Real>::unit);
    } else if (draw.one_in(3)) {
        sine = draw.one_in(2) ? 0.0 : draw.near(1.0, 1);
    }
    const double square = 1 - sine * sine;
    const double cosine = square > 0 ? square_root(square) : 0.0;
    a.direction = Vec3<Real>(sine * tangent - cosine * n);
    if (draw.one_in(4)) {
        const int axis = draw.between(0, 2);
        a.direction[axis] = draw.near(a.direction[axis], 3);
    }
    return a;
}

template <class Real>
struct RefractCase : CaseOf<Real, 4> {
    static constexpr const char* name = "refract";
    using Input = Arrival<Real>;
    CISTULA_HD static Input make(Draw& draw) { return arrival<Real>(draw); }
    CISTULA_HD static void run(const Input& in, Words& out) {
        const Refraction<Real> refraction = refracted(in.direction, in.normal, in.from, in.to);
        out.bits(refraction.total);
        out.vec(refraction.total ? Vec3<Real>(Real(0)) : refraction.direction);
    }
};

template <class Real>
struct FresnelCase : CaseOf<Real, 1> {
    static constexpr const char* name = "fresnel";
    using Input = Arrival<Real>;
    CISTULA_HD static Input make(Draw& draw) {
        draw.bits();  // makes the inputs differ from those of the refraction case
        Input in = arrival<Real>(draw);
        if (draw.one_in(8)) in.direction = draw.any_vector<Real>();
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        out.real(refracted(in.direction, in.normal, in.from, in.to).reflectance);
    }
};

template <class Real>
struct ReflectCase : CaseOf<Real, 6> {
    static constexpr const char* name = "reflect";
    struct Input {
        Vec3<Real> direction, normal;
    };
    CISTULA_HD static Input make(Draw& draw) {
        const Arrival<Real> a = arrival<Real>(draw);
        Input in{a.direction, a.normal};
        if (draw.one_in(4)) in.direction = draw.any_vector<Real>();
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        out.vec(reflected(in.direction, in.normal));
        out.vec(renormalized(in.direction));
    }
};

}  // namespace cistula::parity

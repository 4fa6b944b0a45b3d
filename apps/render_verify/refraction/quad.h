// Reference results of snell.h in 113 bits, and records of them for the device. Host only, except for reading records.
#pragma once

#include <cmath>
#include <stdexcept>
#include <vector>

#include "apps/render_verify/setup.h"

namespace cistula::verify::refraction {

using Quad = __float128;

/// Square root by Newton's method from the root in double; each step doubles the number of digits.
inline Quad root(Quad a) {
    if (!(a > 0)) return 0;
    Quad r = Quad(std::sqrt(double(a)));
    for (int step = 0; step < 2; ++step) r = (r + a / r) / 2;
    return r;
}

/// Fields of a record of one refraction, in doubles. A number of more than 53 bits is a pair whose sum it is.
enum RecordField : uint32_t {
    record_from,
    record_to,
    record_direction,                         // 3
    record_normal = record_direction + 3,     // 3
    record_total = record_normal + 3,         // 1 or 0
    record_reflectance,                       // a pair
    record_through = record_reflectance + 2,  // 3 pairs
    record_size = record_through + 6,
};

/// Appends the record of the refraction of `direction`, rounded to Real; returns g^2.
template <class Real>
Quad add_record(const Vec3<double>& direction, const Vec3<double>& normal, double from, double to,
                std::vector<double>& numbers) {
    const Vec3<Real> d(direction), at(normal);
    const auto pair = [&](Quad x) {
        numbers.push_back(double(x));
        numbers.push_back(double(x - Quad(double(x))));
    };
    const Quad n = Quad(to) / Quad(from);
    Quad c = 0;
    for (int k = 0; k < 3; ++k) c -= Quad(d[k]) * Quad(at[k]);
    if (!(c > 0)) c = 0;
    const Quad g2 = (n - 1) * (n + 1) + c * c;
    const bool total = !(g2 > 0);
    numbers.insert(numbers.end(), {from, to});
    for (int k = 0; k < 3; ++k) numbers.push_back(double(d[k]));
    for (int k = 0; k < 3; ++k) numbers.push_back(double(at[k]));
    numbers.push_back(total ? 1 : 0);
    const Quad g = root(g2);
    // Fresnel's amplitudes in textbook form: perpendicular to the plane of incidence and in it.
    const Quad s = (c - g) / (c + g), p = (n * n * c - g) / (n * n * c + g);
    pair(total ? Quad(1) : (s * s + p * p) / 2);
    Quad through[3], square = 0;
    for (int k = 0; k < 3; ++k) through[k] = Quad(d[k]) + (c - g) * Quad(at[k]), square += through[k] * through[k];
    for (int k = 0; k < 3; ++k) pair(total ? Quad(0) : through[k] / root(square));
    return g2;
}
/// Appends records of one refraction for both precisions, side by side; returns the g^2 of double.
inline Quad add_records(const Vec3<double>& direction, const Vec3<double>& normal, double from, double to,
                        std::vector<double>& numbers) {
    add_record<float>(direction, normal, from, to, numbers);
    return add_record<double>(direction, normal, from, to, numbers);
}

/// Access to the record of ray i.
template <class Real>
class Record {
  public:
    CISTULA_HD Record(const Setup<Real>& setup, uint64_t i)
        : data_(setup.numbers.data + (2 * i + (sizeof(Real) == sizeof(double) ? 1 : 0)) * record_size) {}

    CISTULA_HD double from() const { return data_[record_from]; }
    CISTULA_HD double to() const { return data_[record_to]; }
    CISTULA_HD Vec3<Real> direction() const { return at(record_direction); }
    CISTULA_HD Vec3<Real> normal() const { return at(record_normal); }
    CISTULA_HD bool total() const { return data_[record_total] != 0; }
    /// Deviation of a reflectance from the exact value in ulps.
    CISTULA_HD double reflectance_off(Real found) const {
        const double high = data_[record_reflectance], off = (double(found) - high) - data_[record_reflectance + 1];
        const uint64_t exponent = bits_as<uint64_t>(high) & 0x7ff0000000000000u;
        return magnitude(off) / (bits_as<double>(exponent) * (2 * double(RealTraits<Real>::unit)));
    }
    /// Length of a refracted direction's deviation from the exact one, in u.
    CISTULA_HD double through_off(const Vec3<Real>& found) const {
        Vec3<double> off;
        for (int k = 0; k < 3; ++k)
            off[k] = (double(found[k]) - data_[record_through + 2 * k]) - data_[record_through + 2 * k + 1];
        return length(off) / double(RealTraits<Real>::unit);
    }

  private:
    CISTULA_HD Vec3<Real> at(uint32_t field) const {
        return {Real(data_[field]), Real(data_[field + 1]), Real(data_[field + 2])};
    }

    const double* data_;
};

struct IndexPair {
    double from, to;
};

/// A random unit vector perpendicular to `normal`.
inline Vec3<double> tangent_to(const Vec3<double>& normal, Draw& draw) {
    for (;;) {
        const Vec3<double> other = draw.in_cube<double>(1.0), across = other - dot(other, normal) * normal;
        if (dot(across, across) > 0x1p-8) return normalized(across);
    }
}
/// The incoming direction for a cosine and a sine of incidence.
inline Vec3<double> incoming(const Vec3<double>& normal, double cosine, double sine, Draw& draw) {
    const Vec3<double> tangent = tangent_to(normal, draw);
    return sine * tangent - cosine * normal;
}
inline Vec3<double> axis_normal(Draw& draw) {
    Vec3<double> normal(0.0);
    const int axis = draw.between(0, 2);
    normal[axis] = draw.sign();
    return normal;
}

}  // namespace cistula::verify::refraction

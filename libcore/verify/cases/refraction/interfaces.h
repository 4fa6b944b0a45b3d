// One refraction at a face, compared with results in 113 bits.
#pragma once

#include "cistula/shading/interface.h"
#include "verify/setup.h"

namespace cistula::verify::refraction {

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
    CISTULA_HD Refraction<Real> refract() const { return refracted(direction(), normal(), from(), to()); }
    /// Deviation of a reflectance from the exact value in ulps.
    CISTULA_HD double reflectance_off(Real found) const {
        const double high = data_[record_reflectance];
        const double off = (double(found) - high) - data_[record_reflectance + 1];
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

// ---- of records

/// At normal incidence: the reflectance; the direction is unchanged.
struct FresnelNormal {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Refraction<Real> found = record.refract();
        tally.expect(!found.total && found.direction == record.direction());
        tally.measure(record.reflectance_off(found.reflectance));
    }
};

struct FresnelGrazing {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Vec3<Real> normal = record.normal();
        const Vec3<Real> direction = record.direction();
        const Refraction<Real> found = record.refract();
        tally.expect(found.total == record.total());
        tally.measure(record.reflectance_off(found.reflectance));
        // A cosine that rounding made negative counts as 0.
        for (const Real cosine : {Real(0), -RealTraits<Real>::unit}) {
            Vec3<Real> along_face = direction;
            for (int k = 0; k < 3; ++k)
                if (normal[k] != Real(0)) along_face[k] = -cosine * normal[k];
            const Refraction<Real> flat = refracted(along_face, normal, record.from(), record.to());
            tally.expect(flat.total == (record.from() > record.to()) && flat.reflectance == Real(1));
        }
    }
};

/// At any other angle. The direction's components are rounded once, then multiplied by one factor, u each: 2 u across
/// it. The factor sets the length: the square's three roundings reach it halved, 1.5 u, and its own is another u. 2 u
/// + 2.5 u in all.
struct AnyAngle {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Refraction<Real> found = record.refract();
        tally.expect(found.total == record.total());
        if (found.total || record.total()) return;
        tally.measure(record.reflectance_off(found.reflectance));
        tally.expect(record.through_off(found.direction) <= 4.5);
    }
};

/// The reflectance at Brewster's angle.
struct BrewsterShare {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Refraction<Real> found = record.refract();
        tally.expect(!found.total);
        tally.measure(record.reflectance_off(found.reflectance));
    }
};

/// Perpendicularity of the reflected and the refracted ray at Brewster's angle.
struct BrewsterAngle {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Vec3<Real> direction = record.direction();
        const Vec3<Real> normal = record.normal();
        const Refraction<Real> found = record.refract();
        tally.expect(!found.total);
        if (found.total) return;
        const Vec3<Real> mirrored = reflected(direction, normal);
        // Two components at most are not zero: the difference of two equal products, its sign and digits kept.
        double across = 0;
        for (int k = 0; k < 3; ++k) {
            const int j = k == 2 ? 0 : k + 1;
            if (mirrored[k] != Real(0) && mirrored[j] != Real(0))
                across = difference_of_products(double(mirrored[k]), double(found.direction[k]), -double(mirrored[j]),
                                                double(found.direction[j]));
        }
        tally.measure(magnitude(across) / double(RealTraits<Real>::unit));
    }
};

/// Total or not.
struct CriticalAngle {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Refraction<Real> found = record.refract();
        tally.expect(found.total == record.total() && (!found.total || found.reflectance == Real(1)));
    }
};

// ---- of directions that are drawn

/// Equal indices: nothing is reflected or refracted, g = c and D = 0 to the last bit.
struct FresnelEqual {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> normal(on_sphere(draw));
        const Vec3<double> tangent = normalized(cross(Vec3<double>(normal), on_sphere(draw)));
        const double cosine = magnitude(draw.scaled<double>(-20, -1));
        const Vec3<Real> direction(square_root(1 - cosine * cosine) * tangent - cosine * Vec3<double>(normal));
        const double index = 1 + draw.below(1024) * 0x1p-8;
        const Refraction<Real> found = refracted(direction, normal, index, index);
        // A material that is not clear needs no refraction.
        Material<Real> material = Material<Real>();
        material.reflection = Real(0.25);
        material.transmission = Real(0.5);
        material.tint = Vec3<Real>(Real(1), Real(0.5), Real(0));
        material.fresnel = 1;
        material.transparency = Transparency::partial;
        const InterfaceSplit<Real> split = split_at<Real, Effects<all_effects>>(
            setup.scene, material, direction, normal, InteriorList(), InteriorList(), false, normal, false);
        tally.expect(!found.total && found.reflectance == Real(0) && found.direction == renormalized(direction) &&
                     !split.bends && split.through == direction && split.reflection == Real(0) &&
                     split.filter == material.tint * Real(0.75));
    }
};

/// What rounding makes of a direction that is refracted and refracted back, in u, over the numbers that multiply it.
/// With s, c the sine and cosine of incidence and g = n times the cosine beyond: the first refraction is off by 2 u
/// across (any-angle), and what comes back by g / c times that, and 2 u of its own. A direction longer than 1 by e
/// turns by s |D| / (n^2 g) e, which comes back as s |D| / (n^2 c) e; the one in between by s |D| / c e. e is 3 u at
/// most. So 2 + 2 g/c + 3 s |D| / c (1 + 1/n^2) + 2.5 of length, at most 4.5 (1 + g/c + s |D| / c (1 + 1/n^2)).
struct Condition {
    double cosine, g, value;
};
CISTULA_HD inline Condition condition_of(const Vec3<double>& direction, const Vec3<double>& normal, double from,
                                         double to) {
    const double n = to / from;
    const double excess = (n - 1) * (n + 1);
    const double c = -dot(direction, normal);
    const double g2 = excess + c * c;
    const double g = g2 > 0 ? square_root(g2) : 0;
    const double s = square_root(max_or_second(1 - c * c, 0.0));
    return {c, g, 1 + g / c + s * magnitude(excess) / c * (1 + 1 / (n * n))};
}

/// A refracted direction, reversed and refracted back, is the original direction.
struct Reversibility {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const double from = 1 + 1.5 * draw.unit<double>();
        const double to = 1 + 1.5 * draw.unit<double>();
        const Vec3<Real> normal(on_sphere(draw));
        const Vec3<Real> direction(on_sphere(draw));
        const Condition condition = condition_of(Vec3<double>(direction), Vec3<double>(normal), from, to);
        // Grazing rays come back at the critical angle, where rounding may turn them round.
        if (condition.cosine < 0x1p-5 || condition.g < 0x1p-5) return;
        const Refraction<Real> there = refracted(direction, normal, from, to);
        tally.expect(!there.total);
        if (there.total) return;
        const Refraction<Real> back = refracted(-there.direction, -normal, to, from);
        tally.expect(!back.total);
        if (back.total) return;
        const Vec3<double> off = Vec3<double>(back.direction) + Vec3<double>(direction);
        tally.measure(length(off) / (double(RealTraits<Real>::unit) * condition.value));
        tally.witness(true);
    }
};

}  // namespace cistula::verify::refraction

// Texture lookup: linear RGB texels, continued infinitely.
#pragma once

#include "cistula/model/scene_view.h"

namespace cistula {

/// i modulo n as i - floor(i / n) n, exact for integers i below 2^23 in float and 2^52 in double: no fractional
/// quotient then rounds to an integer.
template <class Real>
CISTULA_INLINE uint32_t remainder(Real i, uint32_t n) {
    const Real r = i - floor_of(i / Real(n)) * Real(n);
    return uint32_t(clamped(r, Real(0), Real(n - 1)));
}
/// i modulo n for any integer i, kept out of line.
CISTULA_NOINLINE inline uint32_t any_remainder(float i, uint32_t n) {
    return magnitude(i) < 0x1p23f ? remainder(i, n) : remainder(double(i), n);
}
CISTULA_NOINLINE inline uint32_t any_remainder(double i, uint32_t n) {
    return remainder(i, n);
}

/// i modulo n for an integer i, without a division or a call where n is a power of two.
template <class Real>
CISTULA_INLINE uint32_t repeated(Real i, uint32_t n) {
    constexpr Real few = sizeof(Real) == sizeof(float) ? Real(0x1p23) : Real(0x1p31);
    return (((n & (n - 1)) == 0) & (magnitude(i) < few)) ? uint32_t(int32_t(i)) & (n - 1) : any_remainder(i, n);
}

/// The texel at an integer i of an axis that is clamped or mirrored, kept out of line.
template <class Real>
CISTULA_NOINLINE IndexOf<Real> wrapped_inward(Real i, uint32_t n, TextureWrap wrap) {
    using T = ScalarOf<Real>;
    using Index = IndexOf<Real>;
    if (wrap == TextureWrap::clamp) return Index(whole_of(clamped(i, Real(0), Real(T(n - 1)))));
    const Index place = repeated(i, 2 * n);
    return select(place < Index(int(n)), place, Index(int(2 * n - 1)) - place);
}

/// The texel, from 0 to n - 1, at any integer i of an axis.
template <class Real>
CISTULA_INLINE IndexOf<Real> wrapped(const Real& i, uint32_t n, TextureWrap wrap) {
    return wrap == TextureWrap::repeat ? repeated(i, n) : wrapped_inward(i, n, wrap);
}

/// Bilinear interpolation between the four texels around (x, y); texel(column, row) gives a texel's color.
template <class Real, class Texel>
CISTULA_NOINLINE Vec3<Real> bilinear(const Texture& texture, Real x, Real y, const Texel& texel) {
    const Real left = floor_of(x - Real(0.5));
    const Real top = floor_of(y - Real(0.5));
    const Real fx = (x - Real(0.5)) - left;
    const Real fy = (y - Real(0.5)) - top;
    const IndexOf<Real> column[2] = {wrapped(left, texture.width, texture.wrap[0]),
                                     wrapped(left + Real(1), texture.width, texture.wrap[0])};
    const IndexOf<Real> row[2] = {wrapped(top, texture.height, texture.wrap[1]),
                                  wrapped(top + Real(1), texture.height, texture.wrap[1])};
    const Vec3<Real> upper = texel(column[0], row[0]) * (Real(1) - fx) + texel(column[1], row[0]) * fx;
    const Vec3<Real> lower = texel(column[0], row[1]) * (Real(1) - fx) + texel(column[1], row[1]) * fx;
    return upper * (Real(1) - fy) + lower * fy;
}

/// The place of uv, the object's coordinates, in units of texels, whose centers lie at half-integers. Texture::repeat
/// applies to uv.
template <class Real>
CISTULA_INLINE Vec2<Real> in_texels(const Texture& texture, const Vec2<Real>& uv) {
    using T = ScalarOf<Real>;
    return {uv.x * Real(T(texture.repeat[0])) * Real(T(texture.width)),
            uv.y * Real(T(texture.repeat[1])) * Real(T(texture.height))};
}

/// The first of the texels that give the color at uv: the only one, or the upper left one of four.
template <class Real>
CISTULA_INLINE Vec2<Real> first_texel(const Texture& texture, const Vec2<Real>& uv) {
    const Vec2<Real> place = in_texels(texture, uv);
    const Real offset = texture.filter == TextureFilter::nearest ? Real(0) : Real(0.5);
    return {floor_of(place.x - offset), floor_of(place.y - offset)};
}

/// The texel at a column and a row of a texture's texels. (In lanes: lane_surface.h.)
template <class Real>
CISTULA_INLINE Vec3<Real> texel_at(const Vec3<float>* texels, const Texture& texture, uint32_t column, uint32_t row) {
    return Vec3<Real>(texels[row * texture.width + column]);
}

/// The color of a texture at uv, the object's coordinates.
template <class Real, class Scene>
CISTULA_HD inline Vec3<Real> texture_at(const Scene& scene, const Texture& texture, const Vec2<Real>& uv) {
    const Vec3<float>* texels = scene.texels.data + texture.first_texel;
    const Vec2<Real> place = in_texels(texture, uv);
    const Real x = place.x;
    const Real y = place.y;
    const auto texel = [&](const IndexOf<Real>& column, const IndexOf<Real>& row) {
        return texel_at<Real>(texels, texture, column, row);
    };
    if (texture.filter == TextureFilter::nearest)
        return texel(wrapped(floor_of(x), texture.width, texture.wrap[0]),
                     wrapped(floor_of(y), texture.height, texture.wrap[1]));
    return bilinear(texture, x, y, texel);
}

}  // namespace cistula

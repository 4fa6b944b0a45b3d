// Accumulation of samples in a pixel and in its layers, as integers that add up to the pixel's own.
#pragma once

#include <type_traits>

#include "cistula/model/effects.h"
#include "cistula/model/layers.h"
#include "cistula/transport/pixel_sums.h"

namespace cistula {

/// Sums that also enter a pixel's layers. Each contribution is rounded to units once and goes, whole, into one layer of
/// each division, so the layers of a division add up to the pixel's radiance exactly.
template <class Real>
class LayeredSums : public PixelSums<Real, true> {
  public:
    using PixelSums<Real, true>::PixelSums;

    /// Sets where layers go. `groups`: the light group of each of the scene's lights.
    CISTULA_INLINE void divide(const LayerPlan& plan, const PixelLayers& layers, const Span<uint32_t>& groups) {
        plan_ = &plan;
        layers_ = layers;
        groups_ = &groups;
    }

    /// Notes that what follows comes in through the ray that the first surface mirrored, or transmitted.
    CISTULA_INLINE void enter(bool mirrored) { way_ = mirrored ? PathLayer::reflection : PathLayer::transmission; }

    CISTULA_INLINE void add(const Vec3<Real>& radiance, LightSource source, bool = true) {
        int64_t units[3];
        this->add_units(radiance, units);
        const bool is_background = source == LightSource::background;
        const PathLayer own = is_background                          ? PathLayer::background
                              : source == LightSource::visible_light ? PathLayer::emission
                                                                     : PathLayer::ambient;
        const LightLayer from = is_background                          ? LightLayer::environment
                                : source == LightSource::visible_light ? LightLayer::glow
                                                                       : LightLayer::ambient;
        give(plan_->path, way_ == PathLayer::emission ? int(own) : int(way_), units);
        give(plan_->light, int(from), units);
    }

    /// Adds what light i sends. diffuse() is the diffuse part of `radiance`; the specular layer gets the rest.
    template <class Diffuse>
    CISTULA_INLINE void add_light(const Vec3<Real>& radiance, uint32_t i, const Diffuse& diffuse, bool = true) {
        int64_t units[3];
        this->add_units(radiance, units);
        give(plan_->light, common_light_layers + int((*groups_)[i]), units);
        if (plan_->path < 0) return;
        if (way_ != PathLayer::emission) return give(plan_->path, int(way_), units);
        int64_t part[3], rest[3];
        this->units_of(diffuse(), part);
        for (int c = 0; c < 3; ++c) rest[c] = units[c] - part[c];
        give(plan_->path, int(PathLayer::diffuse), part);
        give(plan_->path, int(PathLayer::specular), rest);
    }

  private:
    CISTULA_INLINE void give(int place, int layer, const int64_t (&units)[3]) {
        if (place < 0) return;
        for (int c = 0; c < 3; ++c)
            if (units[c] != 0) add_to_word(layers_.words[place + 3 * layer + c], layers_.weight * units[c]);
    }

    const LayerPlan* plan_ = nullptr;
    const Span<uint32_t>* groups_ = nullptr;
    PixelLayers layers_;
    PathLayer way_ = PathLayer::emission;  // emission: the primary ray is under way
};

/// The type of sums, which lanes specialize.
template <class Real, bool layers, bool limited>
struct SumsType {
    using Type = std::conditional_t<layers, LayeredSums<Real>, PixelSums<Real, limited>>;
};
/// The sums of trees that are rendered with effects E.
template <class Real, class E>
using SumsOf = typename SumsType<Real, E::has(fills_layers), E::has(keeps_budget)>::Type;

}  // namespace cistula

// Sums of the pixels of a tile to which lanes add, and of the pixels' layers.
#pragma once

#include "cistula/lanes/lane_branch.h"
#include "cistula/lanes/lane_sums.h"

namespace cistula {

/// LayeredSums in lanes. Layers are written once for a register of branches: a branch either ends, on a visible light
/// or on the background, or its surface adds ambient light and that of point lights.
template <class Real>
class LayeredLaneSums : public LaneSums<Real> {
    using Base = LaneSums<Real>;
    using Integers = typename Base::Integers;

  public:
    using Mask = typename Base::Mask;
    using Base::Base;

    /// Sets how layers are laid out. `groups`: the light group of each of the scene's lights.
    CISTULA_INLINE void divide(const LayerPlan& plan, const Span<uint32_t>& groups) {
        plan_ = &plan;
        groups_ = &groups;
    }

    /// Begins with these branches. Those that the first surface mirrored are marked, for their descendants.
    template <class Branch>
    CISTULA_INLINE void begin(Branch& branch) {
        using Index = IndexOf<Real>;
        at_first_ = branch.depth == 0;
        if (branch.depth == 1 && branch.mirrored) branch.pixel = branch.pixel | Index(Branch::by_mirror);
        Base::begin(branch);
        mirrored_ = (branch.pixel & Index(Branch::by_mirror)) != 0;
        ends_ = glows_ = false;
        for (int c = 0; c < 3; ++c) lights_[c] = diffuse_[c] = int64_t(0);
    }

    CISTULA_INLINE void end(const Mask& active) {
        Base::end(active);
        if (plan_->path < 0 && plan_->light < 0) return;
        const uint32_t glows = glows_.bits();
        const uint32_t mirrored = mirrored_.bits();
        const auto way = [&](int lane, PathLayer own) {
            return at_first_ ? own : (mirrored >> lane & 1u) != 0 ? PathLayer::reflection : PathLayer::transmission;
        };
        const Units all(this->radiance_);
        for_each_lane(active & ends_, [&](int lane) {
            const bool glow = (glows >> lane & 1u) != 0;
            give(plan_->path, int(way(lane, glow ? PathLayer::emission : PathLayer::background)), all, lane);
            give(plan_->light, int(glow ? LightLayer::glow : LightLayer::environment), all, lane);
        });
        const Mask lit = active & !ends_;
        if (!any(lit)) return;
        Integers rest[3], specular[3];
        for (int c = 0; c < 3; ++c) {
            rest[c] = this->radiance_[c] - lights_[c];
            specular[c] = lights_[c] - diffuse_[c];
        }
        const Units ambient(rest), parts[] = {Units(diffuse_), Units(specular)};
        for_each_lane(lit, [&](int lane) {
            give(plan_->light, int(LightLayer::ambient), ambient, lane);
            give(plan_->path, int(way(lane, PathLayer::ambient)), at_first_ ? ambient : all, lane);
            if (!at_first_) return;
            give(plan_->path, int(PathLayer::diffuse), parts[0], lane);
            give(plan_->path, int(PathLayer::specular), parts[1], lane);
        });
    }

    /// Adds what is at the end of branches: visible lights, where `glows` holds, or else the background.
    CISTULA_INLINE void add_end(const Vec3<Real>& radiance, const Mask& glows, const Mask& active) {
        Base::add_end(radiance, glows, active);
        ends_ |= active;
        glows_ |= active & glows;
    }

    template <class Diffuse>
    CISTULA_INLINE void add_light(const Vec3<Real>& radiance, uint32_t i, const Diffuse& diffuse, const Mask& active) {
        Integers added[3];
        this->add_units(radiance, active, added);
        for (int c = 0; c < 3; ++c) lights_[c] += added[c];
        if (at_first_ && plan_->path >= 0) {
            Integers part[3];
            this->units_of(diffuse(), active, part);
            for (int c = 0; c < 3; ++c) diffuse_[c] += part[c];
        }
        if (plan_->light < 0) return;
        const Units units(added);
        for_each_lane(active,
                      [&](int lane) { give(plan_->light, common_light_layers + int((*groups_)[i]), units, lane); });
    }

  private:
    /// Sums of lanes in memory.
    struct Units {
        alignas(lane_bytes) int64_t of[3][Base::lanes];

        CISTULA_INLINE explicit Units(const Integers (&from)[3]) {
            for (int c = 0; c < 3; ++c) memcpy(of[c], &from[c], sizeof of[c]);
        }
    };

    /// Gives a layer what a lane has for it.
    CISTULA_INLINE void give(int place, int layer, const Units& units, int lane) const {
        if (place < 0) return;
        const PixelLayers& layers = this->pixels_[this->pixel_[lane]].layers;
        int64_t* to = layers.words + place + 3 * layer;
        for (int c = 0; c < 3; ++c) to[c] += layers.weight * units.of[c][lane];
    }

    const LayerPlan* plan_ = nullptr;
    const Span<uint32_t>* groups_ = nullptr;
    bool at_first_ = false;  // the primary rays are under way
    Mask mirrored_ = false;
    Mask ends_ = false;
    Mask glows_ = false;
    Integers lights_[3], diffuse_[3];  // of point lights; their diffuse parts, at the first surface
};

template <class T, int n, bool limited>
struct SumsType<Lanes<T, n>, true, limited> {
    using Type = LayeredLaneSums<Lanes<T, n>>;
};

}  // namespace cistula

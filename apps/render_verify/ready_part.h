// A part of a case after compilation, with its trees and lists.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "apps/render_verify/lane_path.h"
#include "apps/render_verify/plan.h"
#include "apps/render_verify/setup.h"
#include "backend_embree/embree/embree_tree.h"

namespace cistula::verify {

/// Limit on the primitive tests of the plain loop per part: of large scenes it takes the first rays only.
inline uint64_t plain_tests(bool quick) {
    return quick ? 10'000'000 : 500'000'000;
}
inline constexpr uint64_t least_plain_rays = 64;

/// A compiled part of a case with everything that intersectors need.
template <class Real>
class ReadyPart {
  public:
    ReadyPart(const Part& part, uint64_t number) : part_(part), compiled_(compile_scene<Real>(part.scene)) {
        if constexpr (sizeof(Real) == sizeof(float)) {
            if (part.edit_float) part.edit_float(*compiled_);
        } else {
            if (part.edit_double) part.edit_double(*compiled_);
        }
        build_primitive_tree(*compiled_);
        const double factor = std::ldexp(1.0, compiled_->scale);
        for (const glm::dvec3& p : part.points) points_.push_back((p - compiled_->center) * factor);  // as Frame::point
        numbers_ = part.numbers;
        if (part.frame_numbers) part.frame_numbers(compiled_->center, factor, numbers_);
        setup_.scene = compiled_->view();
        setup_.points = {points_.data(), uint32_t(points_.size())};
        setup_.numbers = {numbers_.data(), uint32_t(numbers_.size())};
        setup_.factor = factor;
        setup_.seed = number;
    }

    const Setup<Real>& setup() const { return setup_; }
    RTCScene embree() {
        if (!embree_) embree_ = std::make_unique<EmbreeTree<Real>>(setup_.scene, EmbreeOptions());
        return embree_->scene();
    }
    const LanePath<Real>& lanes(int most) {
        if (!lanes_) lanes_ = std::make_unique<LanePath<Real>>(setup_.scene, most);
        return *lanes_;
    }
    uint64_t plain_count(bool quick) const {
        const uint64_t primitives = setup_.scene.convex.size + setup_.scene.clusters.size;
        return std::min(part_.count,
                        std::max(plain_tests(quick) / std::max<uint64_t>(primitives, 1), least_plain_rays));
    }
    /// An expected warning that the scene did not give; empty: none is missing.
    std::string missing_warning() const {
        for (const std::string& text : part_.warnings) {
            const auto& all = compiled_->warnings;
            if (std::none_of(all.begin(), all.end(), [&](const auto& w) { return w.find(text) != std::string::npos; }))
                return fmt::format("{}: no warning \"{}\"", part_.label, text);
        }
        return "";
    }

  private:
    const Part& part_;
    std::unique_ptr<CompiledScene<Real>> compiled_;
    std::vector<Vec3<double>> points_;
    std::vector<double> numbers_;
    Setup<Real> setup_;
    std::unique_ptr<EmbreeTree<Real>> embree_;
    std::unique_ptr<LanePath<Real>> lanes_;
};

}  // namespace cistula::verify

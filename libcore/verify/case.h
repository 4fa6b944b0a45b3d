// Cases: what is exact, how far off it may be, and what is done with rays or images. A group of cases is a folder of
// cases/, whose GROUP.cpp names them in add_GROUP(); cases.cpp lists the groups.
#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "render/record/film.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/solids/smallest_part.h"
#include "scene/description/description.h"
#include "verify/called_intersector.h"
#include "verify/device_run.h"
#include "verify/verify.h"

namespace cistula::verify {

enum CaseFlag : uint32_t {
    needs_witness = 1,  // without a try that met the hazard, tally.witness(true), the case does not hold
    float_warns = 2,  // float must warn of some of its scenes (docs/rules.md 12) and hold in the others; double in all
};

enum class Measure { failures, worst };

struct Bound {
    Measure measure;
    bool must_fail;   // broken on purpose: holds only if at least `limit` tries fail
    double limit[2];  // float, double
    const char* unit;
    uint32_t flags = 0;  // CaseFlag bits
};

/// A bound on the number of failures: none; also for bit equality.
constexpr Bound no_failures(const char* unit, uint32_t flags = 0) {
    return {Measure::failures, false, {0, 0}, unit, flags};
}
/// A bound on the largest deviation; expectations must hold as well.
constexpr Bound at_most(double limit_in_float, double limit_in_double, const char* unit, uint32_t flags = 0) {
    return {Measure::worst, false, {limit_in_float, limit_in_double}, unit, flags};
}
constexpr Bound at_most(double limit, const char* unit, uint32_t flags = 0) {
    return at_most(limit, limit, unit, flags);
}
/// A bound for negative controls: at least that many tries must fail.
constexpr Bound must_fail(double at_least, const char* unit) {
    return {Measure::failures, true, {at_least, at_least}, unit};
}

/// The frame of a compiled scene, for numbers that depend on it.
struct PartFrame {
    glm::dvec3 center;
    double factor;  // frame lengths per scene unit

    glm::dvec3 point(const glm::dvec3& p) const { return (p - center) * factor; }
};
using Numbers = std::vector<double>;

/// A scene description, compiled as renderers compile it, and the rays to trace in it.
struct Part {
    std::string label;  // "icosahedron, scale 2^40"
    SceneDescription scene;
    std::vector<std::byte> functor;
    std::vector<glm::dvec3> points;  // in scene units; the functor gets them in the frame
    Numbers numbers;
    /// Appends numbers that depend on the frame.
    std::function<void(const PartFrame&, Numbers&)> frame_numbers;
    /// Texts that the scene's warnings must contain.
    std::vector<std::string> warnings;
    /// Changes the compiled scene into something that no description gives.
    std::function<void(CompiledScene<float>&)> edit_float;
    std::function<void(CompiledScene<double>&)> edit_double;
    uint64_t count = 0;

    /// Sets edit_float and edit_double to the same function.
    template <class Edit>
    void edit(const Edit& change) {
        edit_float = [change](CompiledScene<float>& compiled) { change(compiled); };
        edit_double = [change](CompiledScene<double>& compiled) { change(compiled); };
    }
};

/// The parts of a case of rays.
class Plan {
  public:
    Plan(bool is_quick, uint32_t scale) : quick(is_quick), scale_(scale) {}

    const bool quick;
    std::vector<Part> parts;

    /// The number of rays: in_full, or in_quick for a quick run; times the scale of the run.
    uint64_t rays(uint64_t in_full, uint64_t in_quick) const { return scale_ * (quick ? in_quick : in_full); }

    template <class Functor>
    Part& add(std::string label, SceneDescription scene, const Functor& functor, std::vector<glm::dvec3> points,
              uint64_t count) {
        static_assert(std::is_trivially_copyable_v<Functor>, "functors travel to devices byte by byte");
        Part& part = parts.emplace_back();
        part.label = std::move(label);
        part.scene = std::move(scene);
        part.functor.resize(sizeof(Functor));
        std::memcpy(part.functor.data(), &functor, sizeof(Functor));
        part.points = std::move(points);
        part.count = count;
        return part;
    }

  private:
    const uint32_t scale_;
};

/// The environment of a case of images: a renderer for any scene, on one intersector in one precision.
class Stage {
  public:
    using Render = std::function<Film(const SceneDescription&, const FrameSettings&)>;

    Stage(bool is_quick, Precision in, std::string by, Render render)
        : quick(is_quick), precision(in), intersector(std::move(by)), render_(std::move(render)) {}

    const bool quick;
    const Precision precision;
    const std::string intersector;  // "embree", "lanes", "bvh", "brute", "cuda"

    bool in_double() const { return precision == Precision::double_; }
    /// u: half an ulp of 1.
    double unit() const { return in_double() ? 0x1p-53 : 0x1p-24; }

    /// Whether this is float and warns of the scene, whose picture then need not hold (`float_warns`).
    bool warns_of(const SceneDescription& scene) {
        const bool warns = !in_double() && smallest_part(scene).share < least_share(Precision::single_);
        warned_ += warns ? 1 : 0;
        return warns;
    }
    uint64_t warned() const { return warned_; }

    /// Renders a frame. Throws Error if the film is unreliable (film.flags).
    Film render(const SceneDescription& scene, const FrameSettings& settings) const { return render_(scene, settings); }
    Film render(const SceneDescription& scene, int width, int height) const {
        FrameSettings settings;
        settings.set_size(width, height);
        settings.depth = scene.depth;
        settings.cutoff = scene.cutoff;
        return render(scene, settings);
    }
    /// Renders a scene at its own size, four times as wide and high in a full run.
    Film film(const SceneDescription& scene) const {
        const int times = quick ? 1 : 4;
        return render(scene, scene.film.width * times, scene.film.height * times);
    }

  private:
    Render render_;
    uint64_t warned_ = 0;
};

/// What a case of rays does to plan them, and one of images to judge them.
using MakePlan = std::function<void(Plan&)>;
using Render = std::function<void(Stage&, Tally&)>;

/// The functor of a case of rays in one precision: rays [first, last) into a tally, or one word for each.
template <class Real>
struct RayMethods {
    void (*tally)(const std::byte* functor, const Setup<Real>&, const CalledIntersector<Real>&, uint64_t first,
                  uint64_t last, uint64_t place, Tally&) = nullptr;
    void (*words)(const std::byte* functor, const Setup<Real>&, const CalledIntersector<Real>&, uint64_t first,
                  uint64_t last, uint64_t* out) = nullptr;
    DeviceMethods<Real> device;
};

struct Case {
    std::string name, exact;
    Bound bound;
    MakePlan plan;               // of rays
    Render render;               // of images
    bool own_traversal = false;  // asks no intersector: runs once on the host and once on the device
    RayMethods<float> in_float;
    RayMethods<double> in_double;

    bool is(CaseFlag flag) const { return (bound.flags & flag) != 0; }
    template <class Real>
    const RayMethods<Real>& methods() const {
        if constexpr (sizeof(Real) == sizeof(float))
            return in_float;
        else
            return in_double;
    }
};

template <class Functor, class Real, bool on_devices>
RayMethods<Real> methods_of() {
    RayMethods<Real> methods;
    if constexpr (HasWords<Functor>)
        methods.words = [](const std::byte* bytes, const Setup<Real>& setup, const CalledIntersector<Real>& intersector,
                           uint64_t first, uint64_t last, uint64_t* out) {
            const Functor functor = functor_of<Functor>(bytes);
            for (uint64_t i = first; i < last; ++i) out[i] = functor.fingerprint(setup, intersector, i);
        };
    else
        methods.tally = [](const std::byte* bytes, const Setup<Real>& setup, const CalledIntersector<Real>& intersector,
                           uint64_t first, uint64_t last, uint64_t place, Tally& tally) {
            const Functor functor = functor_of<Functor>(bytes);
            for (uint64_t i = first; i < last; ++i) {
                tally.place = place + i;
                call(functor, setup, intersector, i, tally);
            }
        };
#if CISTULA_HAS_CUDA
    if constexpr (on_devices) methods.device = device_methods<Functor, Real>();
#endif
    return methods;
}

/// The cases of a group, in order.
class Cases {
  public:
    std::string group;  // "contact/": what names begin with
    std::vector<Case> all;

    /// A case of images: render(stage, tally) is called with the renderer of every intersector.
    void images(const std::string& name, const char* exact, const Bound& bound, Render render) {
        all.push_back({group + name, exact, bound, {}, std::move(render)});
    }
    /// A case of rays: plan(plan) adds parts with functors of this type (device_run.h says what these are), which are
    /// run for i in [0, count) on every intersector. device_cases.cu lists all types but those of tests.
    template <class Functor, bool on_devices = true>
    void rays(const std::string& name, const char* exact, const Bound& bound, MakePlan plan) {
        Case& one = all.emplace_back(Case{group + name, exact, bound, std::move(plan), {}});
        one.own_traversal = AsksNothing<Functor>;
        one.in_float = methods_of<Functor, float, on_devices>();
        one.in_double = methods_of<Functor, double, on_devices>();
    }
};

/// All cases, by groups.
const std::vector<Case>& all_cases();

}  // namespace cistula::verify

// The parts of a case of rays: scene descriptions, compiled as renderers compile them, and the rays to trace in each.
#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/compile/compiled_scene.h"
#include "scene/description/description.h"

namespace cistula::verify {

struct Part {
    std::string label;  // "icosahedron, scale 2^40"
    SceneDescription scene;
    std::vector<std::byte> functor;
    std::vector<glm::dvec3> points;  // in scene units; the functor gets them in the frame
    std::vector<double> numbers;
    /// Appends numbers that depend on the frame: `factor` is frame lengths per scene unit.
    std::function<void(const glm::dvec3& center, double factor, std::vector<double>&)> frame_numbers;
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

class Plan {
  public:
    explicit Plan(bool is_quick) : quick(is_quick) {}

    const bool quick;
    std::vector<Part> parts;

    /// The number of rays: in_full, or in_quick for a quick run.
    uint64_t rays(uint64_t in_full, uint64_t in_quick) const { return quick ? in_quick : in_full; }

    template <class Functor>
    Part& add(std::string label, SceneDescription scene, const Functor& functor, std::vector<glm::dvec3> points,
              uint64_t count) {
        static_assert(std::is_trivially_copyable_v<Functor>, "functors travel to devices byte by byte");
        Part part;
        part.label = std::move(label);
        part.scene = std::move(scene);
        part.functor.resize(sizeof(Functor));
        std::memcpy(part.functor.data(), &functor, sizeof(Functor));
        part.points = std::move(points);
        part.count = count;
        parts.push_back(std::move(part));
        return parts.back();
    }
};

}  // namespace cistula::verify

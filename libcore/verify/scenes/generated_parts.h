// The state of a scene that is being generated, and the makers of its parts. Uses internals of libcore/scene.
#pragma once

#include <random>
#include <string>
#include <variant>
#include <vector>

#include "cistula/numerics/vec.h"
#include "scene/description/description.h"

namespace cistula::generated {

using glm::dvec3;

/// Random numbers with the standard library's engine and our own conversions. Two draws never stand in one expression,
/// except in braces, where their order is defined.
class Random {
  public:
    explicit Random(uint64_t seed) : engine_(seed) {}
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    uint32_t below(uint32_t n) { return static_cast<uint32_t>((engine_() >> 32) * n >> 32); }
    bool chance(double share) { return unit() < share; }
    dvec3 in_cube(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
    dvec3 direction() {
        for (;;) {
            const dvec3 p = in_cube(1);
            if (const double square = dot(p, p); square <= 1 && square > 0.01) return p / square_root(square);
        }
    }
    double of(std::initializer_list<double> list) { return list.begin()[below(static_cast<uint32_t>(list.size()))]; }
    dvec3 color() { return {between(0.05, 1), between(0.05, 1), between(0.05, 1)}; }
    dvec3 color_times(std::initializer_list<double> list) {
        const double strength = of(list);
        return strength * color();
    }

  private:
    std::mt19937_64 engine_;
};

/// The range of a scene's materials and lights; each palette needs another mask of effects.h.
enum class Palette { plain, mirrors, lights, everything };

constexpr double floor_height = -1;

struct Core {  // of a solid, which contains a ball of a third of this radius
    dvec3 center;
    double radius;
};

struct State {
    State(uint64_t seed, const std::string& folder) : random(seed), files(folder) {}

    SceneDescription scene;
    Random random;
    const std::string files;  // the folder of the repository's scenes, or empty
    Palette palette = Palette::plain;
    std::vector<Core> cores;
    std::vector<dvec3> centers;  // centers of groups
    double reach = 1;            // distance of the camera
    bool heavy = false;          // has a mesh of thousands of triangles, slow with the plain loop
};

/// Data that every maker of a part needs.
class Part {
  public:
    explicit Part(State& state)
        : scene_(state.scene),
          random_(state.random),
          files_(state.files),
          palette_(state.palette),
          cores_(state.cores),
          centers_(state.centers),
          reach_(state.reach),
          heavy_(state.heavy) {}

  protected:
    SceneDescription& scene_;
    Random& random_;
    const std::string& files_;
    const Palette& palette_;
    std::vector<Core>& cores_;
    std::vector<dvec3>& centers_;
    double& reach_;
    bool& heavy_;
};

/// Adds a floor, walls and sheets, then groups of closed bodies.
void add_objects(State& state);

}  // namespace cistula::generated

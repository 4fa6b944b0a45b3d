// The state of a scene that is being generated, and the makers of its parts. Uses internals of libcore/scene.
#pragma once

#include <random>
#include <string>
#include <variant>
#include <vector>

#include "cistula/numerics/vec.h"
#include "scene/description/description.h"
#include "verify/scenes/generated_scene.h"

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
enum class Palette { opaque, mirrors, clear, lights, everything };

/// The range of a scene's bodies: flat ones, what the loop over balls takes (ball_loop.h), or all.
enum class Bodies { flat, balls, all };

constexpr double floor_height = -1;

using Shape = decltype(ObjectDescription::shape);

struct Core {  // of a solid, which contains a ball of a third of this radius
    dvec3 center;
    double radius;
};

struct State {
    State(uint64_t seed, const std::string& folder) : random(seed), files(folder) {}

    SceneDescription scene;
    Random random;
    const std::string files;  // the folder of the repository's scenes, or empty
    Palette palette = Palette::opaque;
    Bodies bodies = Bodies::flat;
    std::vector<Core> cores;
    std::vector<dvec3> centers;  // centers of groups
    double reach = 1;            // distance of the camera
    bool heavy = false;          // has a mesh of thousands of triangles, slow with the plain loop
    int reused = -1;             // a material without a texture
    int edge_lights_left = 2;    // solids that may still get edge lights
};

/// Data that every maker of a part needs.
class Part {
  public:
    explicit Part(State& state)
        : scene_(state.scene),
          random_(state.random),
          files_(state.files),
          palette_(state.palette),
          bodies_(state.bodies),
          cores_(state.cores),
          centers_(state.centers),
          reach_(state.reach),
          heavy_(state.heavy) {}

  protected:
    SceneDescription& scene_;
    Random& random_;
    const std::string& files_;
    const Palette& palette_;
    const Bodies& bodies_;
    std::vector<Core>& cores_;
    std::vector<dvec3>& centers_;
    double& reach_;
    bool& heavy_;
};

/// Adds objects, each with a material.
class ObjectMaker : protected Part {
  public:
    explicit ObjectMaker(State& state)
        : Part(state), state_(state), reused_(state.reused), edge_lights_left_(state.edge_lights_left) {}

  protected:
    /// `see_through`: it is to transmit light more often than not.
    void add(Shape shape, bool see_through);
    /// Adds a solid as planes or as a mesh.
    void add_of(bool planes, const SolidObject& solid) {
        add(planes ? Shape(solid) : Shape(triangulated_solid(solid)), true);
    }

    dvec3 degrees();
    SolidObject solid(const dvec3& center, double radius);
    SphereObject ball(const dvec3& center, double radius);

    State& state_;

  private:
    int texture();
    dvec3 tint();
    void share_out(MaterialDescription& material, bool see_through);
    int add_material(bool see_through, bool textured);
    void add_edge_lights(EdgeLights& lights);

    int& reused_;
    int& edge_lights_left_;
};

/// Adds a floor, walls and sheets, then groups of closed bodies.
void add_objects(State& state);

/// Adds a group of balls and of what they touch, hold or are cut by, disks and planes without end among it; of what the
/// loop over balls takes if the scene has no more.
void add_round_group(State& state, const dvec3& center);

/// Gives some bodies keys, which a reader reads, and shows a frame between them; at frame 2 all is where it was.
/// `unit`: what was a length of 1 when the scene was made.
void set_keys(State& state, double unit);

}  // namespace cistula::generated

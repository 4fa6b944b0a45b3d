#include "scene/compile/solids/smallest_part.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <exception>

#include "scene/compile/lights/compile_lights.h"
#include "scene/compile/solids/placed_bodies.h"
#include "scene/description/platonic.h"

namespace cistula {
namespace {

using glm::dvec3;

bool apart(const Box& a, const Box& b, double range) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.low[axis] > b.high[axis] + range || b.low[axis] > a.high[axis] + range) return true;
    return false;
}

class SmallestPartSearch {
  public:
    explicit SmallestPartSearch(const SceneSource& source)
        : source_(source),
          bodies_(*source.bodies),
          normalization_(bodies_.normalization),
          extent_(normalization_.extent),
          range_(least_share(Precision::single_) * extent_) {}

    SmallestPart run() {
        add_solids();
        add_distances();
        for (uint32_t i = 0; i < source_.solids.size(); ++i) add_walls(i);
        return smallest_;
    }

    /// The smallest part of what changes from frame to frame, where meshes keep their size.
    SmallestPart run_between_keys() {
        add_radii();
        add_distances();
        return smallest_;
    }

  private:
    template <class What>
    void add(double size, const What& what) {
        if (!(size / extent_ < smallest_.share)) return;
        smallest_ = {size / extent_, what()};
    }
    static std::string name(const SourceSolid& solid) {
        return solid.name.empty() ? solid.place : solid.place + ": " + solid.name;
    }

    void add_distances() {
        add_lights();
        add_gaps();
        add_coat();
    }

    void add_solids() {
        for (uint32_t i = 0; i < source_.solids.size(); ++i)
            if (source_.solids[i].is_mesh()) add_mesh(i);
        add_radii();
    }

    void add_radii() {
        for (const SourceSolid& solid : source_.solids) {
            if (!solid.polyhedron) continue;
            const double radius = solid.polyhedron->radius * normalization_.factor;
            add(polyhedron_of(*solid.polyhedron).inradius * radius, [&] { return name(solid) + ": its inradius"; });
        }
        for (const PlacedBall& ball : bodies_.balls)
            add(ball.radius, [&] { return name(source_.solids[ball.solid]) + ": its radius"; });
    }

    void add_mesh(uint32_t number) {
        const SourceSolid& solid = source_.solids[number];
        const MeshSize& size = bodies_.sizes[number];
        if (size.triangles == 0) return;
        if (solid.closed)
            add(solid.thickness * normalization_.factor, [&] { return name(solid) + ": its thickness"; });
        else
            add(size.half_width, [&] { return name(solid) + ": its half width"; });
        if (!sends_lines_on(number)) return;
        add(size.least_height, [&] { return name(solid) + ": the least height of its triangles"; });
    }

    /// Whether lines start on a solid's triangles and go on.
    bool sends_lines_on(uint32_t number) const {
        const MaterialDescription& material = source_.materials[source_.solids[number].material];
        return (material.reflection > 0 || material.transmission > 0) && !has_planes(number);
    }

    bool has_planes(uint32_t number) const {
        const auto found = std::lower_bound(bodies_.convex.begin(), bodies_.convex.end(), number,
                                            [](const ConvexSolid& a, uint32_t wanted) { return a.solid < wanted; });
        return found != bodies_.convex.end() && found->solid == number;
    }

    /// Adds a light's distance from a solid's face unless it lies on that.
    void add_distance(double distance, uint32_t solid, const NormalizedLight& light) {
        if (distance > tolerance(solid, light))
            add(distance,
                [&] { return light.place + ": a light's distance from a face of " + source_.solids[solid].place; });
    }
    double tolerance(uint32_t solid, const NormalizedLight& light) const {
        return largest_tolerance(bodies_.contacts.solids[solid].reach, light);
    }

    void add_lights() {
        for (const NormalizedLight& light : normalize_lights(source_, normalization_, bodies_.convex)) {
            if (light.shown) add(light.radius, [&] { return light.place + ": a light's radius"; });
            if (!light.lights()) continue;
            const Box at{light.position, light.position};
            for (const ConvexSolid& solid : bodies_.convex) {
                if (apart(at, solid.box, range_)) continue;
                double beyond = -INFINITY;
                for (const PlanePair& plane : solid.planes) {
                    beyond = max_or_second(dot(plane.normal, light.position) - plane.high, beyond);
                    beyond = max_or_second(plane.low - dot(plane.normal, light.position), beyond);
                }
                add_distance(magnitude(beyond), solid.solid, light);
            }
            for (const PlacedBall& ball : bodies_.balls) add_distance(ball.distance(light.position), ball.solid, light);
            for (uint32_t i = 0; i < source_.solids.size(); ++i) {
                if (!source_.solids[i].is_mesh() || has_planes(i) || apart(at, bodies_.sizes[i].box, range_)) continue;
                add_distance(distance_to_triangles(source_.solids[i].mesh, normalization_, light.position,
                                                   tolerance(i, light), range_),
                             i, light);
            }
        }
    }

    /// Adds gaps that float would close (docs/rules.md, 11, A10).
    void add_gaps() {
        for (const auto* pairs : {&bodies_.contacts.near, &bodies_.contacts.apart})
            for (const NearPair& pair : *pairs)
                if (pair.gap <= 0x1p-20 * extent_)
                    add(max_or_second(pair.gap, least_share(Precision::double_) * extent_), [&] {
                        return name(source_.solids[pair.solids[1]]) + ": its distance from " +
                               source_.solids[pair.solids[0]].place;
                    });
    }

    /// Adds the thinnest coat, as gaps.
    void add_coat() {
        if (const std::optional<BallCoat>& coat = bodies_.coat)
            add(max_or_second(coat->distance, least_share(Precision::double_) * extent_), [&] {
                return name(source_.solids[coat->solids[1]]) + ": its distance from " +
                       source_.solids[coat->solids[0]].place;
            });
    }

    /// Adds half the thinnest wall of a mesh: what a plate has for its thickness. Not looked for where the scene takes
    /// double anyway, so that triangles are few beside it.
    void add_walls(uint32_t number) {
        const SourceSolid& solid = source_.solids[number];
        if (!solid.is_mesh() || smallest_.share < least_share(Precision::single_) || !sends_lines_on(number)) return;
        source_.stop.check();
        const double wall = thinnest_wall(solid, normalization_, least_share(Precision::double_) * extent_, 2 * range_);
        add(wall / 2, [&] { return name(solid) + ": half its thinnest wall"; });
    }

    const SceneSource& source_;
    const PlacedBodies& bodies_;
    const SceneNormalization& normalization_;
    const double extent_, range_;
    SmallestPart smallest_;
};

/// The smallest part at each of some frames, named by them. Throws the error of the first that has one.
std::vector<SmallestPart> parts_at(const std::vector<int>& frames, const SceneSource& source,
                                   SmallestPart (SmallestPartSearch::*run)()) {
    std::vector<SmallestPart> parts(frames.size());
    std::vector<std::exception_ptr> errors(frames.size());
    tbb::parallel_for(size_t(0), frames.size(), [&](size_t i) {
        try {
            const SceneSource there = gather_frame(source.moving, frames[i], source.stop);
            parts[i] = (SmallestPartSearch(there).*run)();
            parts[i].what += fmt::format(" at frame {}", frames[i]);
        } catch (const Error&) {
            errors[i] = std::current_exception();
        }
    });
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
    return parts;
}

}  // namespace

SmallestPart smallest_part(const SceneSource& source) {
    if (!source.moving) return SmallestPartSearch(source).run();
    SmallestPart smallest;
    const auto ask = [&](const std::vector<int>& frames, SmallestPart (SmallestPartSearch::*run)()) {
        for (const SmallestPart& part : parts_at(frames, source, run))
            if (part.share < smallest.share) smallest = part;
    };
    ask(source.moving->description.motion->frames, &SmallestPartSearch::run);
    if (smallest.share < least_share(Precision::single_)) return smallest;
    const SceneNormalization& normalization = source.bodies->normalization;
    const double reach = least_share(Precision::single_) * normalization.extent / normalization.factor;
    const MovingParts& parts = source.moving->parts;
    ask(parts.frames_of_smaller(source), &SmallestPartSearch::run);
    ask(parts.frames_of_meetings(source, reach), &SmallestPartSearch::run_between_keys);
    return smallest;
}

SmallestPart smallest_part(const SceneDescription& description) {
    return smallest_part(gather_scene(description));
}

namespace {

/// "float: /objects/1: pebble: its inradius is 7.9e-07 of the scene's extent; float holds from 1.2e-04 on".
std::string verdict(Precision chosen, const SmallestPart& part, Precision judged) {
    return fmt::format("{}: {} is {:.1e} of the scene's extent; {} holds from {:.1e} on", precision_name(chosen),
                       part.what, part.share, precision_name(judged), least_share(judged));
}

}  // namespace

PrecisionChoice choose_precision(const std::optional<Precision>& wanted, const SmallestPart& part) {
    const auto holds = [&](Precision precision) { return part.share >= least_share(precision); };
    PrecisionChoice choice;
    choice.precision = wanted.value_or(holds(Precision::single_) ? Precision::single_ : Precision::double_);
    if (!holds(choice.precision)) {
        choice.warning = verdict(choice.precision, part, choice.precision);
        if (choice.precision == Precision::single_) choice.warning += "; take `precision` double";
    } else if (!wanted && choice.precision == Precision::double_) {
        choice.note = verdict(Precision::double_, part, Precision::single_);
    }
    return choice;
}

}  // namespace cistula

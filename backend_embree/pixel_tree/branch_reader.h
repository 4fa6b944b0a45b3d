// Reconstructs a branch of a ray tree from its recorded queries and answers, by calling libcore's functions again on
// the same numbers.
#pragma once

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "backend_embree/pixel_tree/branch_trace.h"
#include "render/frame/frame_view.h"

namespace cistula {

template <class Real, class Intersector>
class BranchReader {
  public:
    using E = BranchEffects;
    using Trace = BranchTrace<Real>;

    BranchReader(const CompiledScene<Real>& compiled, const SceneView<Real>& scene, const Intersector& intersector,
                 const FrameView& frame)
        : compiled_(compiled), scene_(scene), intersector_(intersector), frame_(frame) {}

    /// Fills the branch's node and adds nodes for its children; `waiting` gets those that are on the stack, `crowd` the
    /// solids that its ray was inside, if they were too many and it is empty.
    void read(const Trace& trace, SampleTree& tree, uint32_t node, std::vector<uint32_t>& waiting,
              std::vector<std::string>& crowd) const {
        PixelBranch branch = std::move(tree.branches[node]);
        if (trace.looks.empty()) {
            branch.end = BranchEnd::pruned;
            branch.ledger = less(trace.end.pruned, trace.begin.pruned);
        } else {
            Replay replay{trace, branch, tree, waiting, crowd, trace.weight, 0};
            const Real from = begin_of(trace.looks[0].ray);
            replay.ahead = (from < Real(0) ? 0 : trace.start) - double(from);
            read_way(replay);
        }
        tree.branches[node] = std::move(branch);
    }

  private:
    struct Replay {
        const Trace& trace;
        PixelBranch& branch;
        SampleTree& tree;
        std::vector<uint32_t>& waiting;
        std::vector<std::string>& crowd;
        Vec3<Real> weight;
        double ahead;  // added to distances along the line, in frame units
    };

    /// Throws if the reconstruction disagrees with the recording, unless the pixel is flagged; then the branch is read
    /// as far as possible.
    void require(const Trace& trace, bool holds, const char* what) const {
        if (!holds && trace.flags == 0)
            throw std::logic_error(std::string("internal error: the ray tree does not add up: ") + what);
    }

    void read_way(Replay& replay) const {
        const auto& looks = replay.trace.looks;
        Ray<Real> ray = looks[0].ray;
        replay.branch.origin = to_scene(along(ray.origin, begin_of(ray), ray.direction));
        replay.branch.direction = Vec3<double>(ray.direction);
        Absorption<true> absorption;
        absorption.begin(scene_, ray.media, ray.after.t);
        for (size_t at = 0;;) {
            ray = looks[at].ray;
            const Hit<Real> hit = looks[at].hit;
            const VisibleLightHit<Real> visible = closest_visible_light(scene_, ray, hit.t);
            if (visible.light != no_light || !hit.found()) {
                const bool light = visible.light != no_light;
                absorption.dim(scene_, ray.media, light ? visible.t : hit.t, replay.weight);
                replay.branch.end = light ? BranchEnd::light : BranchEnd::background;
                replay.branch.visible_light = visible.light;
                replay.branch.distance = length_of(replay, light ? visible.t : hit.t);
                break;
            }
            size_t next = at + 1;
            SurfaceEvent<Real> event;
            resolve_event<E>(scene_, ReplayedIntersector<Real>{looks, next}, ray, hit, event);
            if (!event.fits) {
                replay.branch.end = BranchEnd::dropped;
                replay.branch.distance = length_of(replay, event.hit.t);
                if (replay.crowd.empty()) replay.crowd = names_around(ray, event);
                break;
            }
            const size_t after = next_on_line(looks, next, ray, event.last());
            if (after == looks.size()) {
                absorption.dim(scene_, ray.media, event.hit.t, replay.weight);
                replay.branch.end = BranchEnd::surface;
                replay.branch.distance = length_of(replay, event.hit.t);
                read_surface(replay, ray, event);
                break;
            }
            note_passed(replay, ray, event);
            for (int i = 0; i < event.count; ++i) absorption.cross(scene_, event.taken[i].key, event.taken[i].t);
            for (; next < after; ++next) {  // refused crossings, as in NextSurface::count_wrong_side
                const Hit<Real>& over = looks[next].hit;
                if (!Crossing<Real>{over.t, over.key}.before(event.taken[0].t, event.taken[0].key)) break;
                absorption.cross(scene_, over.key, over.t);
            }
            at = after;
        }
        replay.branch.arriving = Vec3<double>(replay.weight);
        replay.branch.adds = less(replay.trace.end.radiance, replay.trace.begin.radiance);
    }

    /// The query that continues a ray straight from a crossing, if there is one: nothing was shaded there then.
    static size_t next_on_line(const std::vector<typename Trace::Look>& looks, size_t from, const Ray<Real>& ray,
                               const Crossing<Real>& last) {
        const auto continues = [&](const Ray<Real>& next) {
            return next.after.t == last.t && next.after.key == last.key && next.origin == ray.origin &&
                   next.direction == ray.direction;
        };
        while (from < looks.size() && !continues(looks[from].ray)) ++from;
        return from;
    }

    void note_passed(Replay& replay, const Ray<Real>& ray, const SurfaceEvent<Real>& event) const {
        const uint32_t medium = ray.media.medium(scene_);
        for (int i = 0; i < event.count; ++i) {
            FacePassed face;
            fill(replay, face, event.taken[i].key, event.taken[i].t);
            face.inside = face.crossing != CrossingKind::sheet && medium != no_solid && medium > face.solid;
            replay.branch.passed.push_back(face);
        }
    }

    void read_surface(Replay& replay, const Ray<Real>& ray, const SurfaceEvent<Real>& event) const {
        PixelSurface& out = replay.branch.surface;
        fill(replay, out, event.hit.key, event.hit.t);
        for (int i = 0; i < event.count; ++i)
            if (event.taken[i].key != event.hit.key)
                fill(replay, out.also.emplace_back(), event.taken[i].key, event.taken[i].t);
        const Surface<Real> s = surface_at<Real, E>(scene_, ray, event.hit);
        const Material<Real>& m = scene_.materials[s.material];
        out.material = s.material;
        out.t = double(event.hit.t) * frame_.unit_length;
        out.point = to_scene(s.point);
        out.normal = Vec3<double>(s.shading);
        if (s.smooth) out.face_normal = Vec3<double>(s.normal);
        out.color = Vec3<double>(s.color);
        out.before = solids_of(ray.media);
        out.beyond = solids_of(event.beyond);
        out.index_before = index_of(scene_, ray.media);
        out.index_beyond = index_of(scene_, event.beyond);
        out.cosine = -double(dot(ray.direction, s.shading));
        const bool sheet = out.crossing == CrossingKind::sheet;
        take_opaque_index(scene_, m, m.fresnel != 0 && !sheet, out.index_beyond);
        const InterfaceSplit<Real> split =
            split_at<Real, E>(scene_, m, ray.direction, s.shading, ray.media, event.beyond, sheet, s.normal, s.smooth);
        out.local = double(m.local);
        out.mirrored = double(split.reflection);
        out.through = Vec3<double>(split.filter);
        out.bends = split.bends;
        if (split.bends) {
            const Refraction<Real> refraction =
                refracted<Real>(ray.direction, s.shading, out.index_before, out.index_beyond);
            out.total = split.total;
            if (!out.total) out.bent_cosine = -double(dot(refraction.direction, s.shading));
            if (m.fresnel != 0 && !sheet) out.fresnel = out.total ? 1 : double(refraction.reflectance);
        } else if (m.fresnel != 0 && !sheet) {
            out.fresnel = 0;
        }
        read_children(replay, split);
        if (m.local > Real(0)) read_light(replay, ray, event, s);
    }

    void read_children(Replay& replay, const InterfaceSplit<Real>& split) const {
        const Vec3<Real> weights[2] = {replay.weight * split.reflection, replay.weight * split.filter};
        const bool last = replay.branch.depth + 1 >= frame_.tree.depth;
        uint32_t number[2] = {0, 0};
        FixedColor cut{};
        for (int through = 0; through < 2; ++through) {
            const Vec3<Real>& weight = weights[through];
            if (!(weight.x + weight.y + weight.z > Real(0))) continue;
            PixelBranch child;
            child.kind = through ? BranchKind::transmitted : BranchKind::mirrored;
            child.depth = replay.branch.depth + 1;
            child.weight = child.arriving = Vec3<double>(weight);
            child.end = BranchEnd::cut;
            if (last) {
                for (int c = 0; c < 3; ++c) {
                    to_fixed_up(weight[c] * scene_.bound[c], frame_.tree.fixed_scale, child.ledger[size_t(c)]);
                    cut[size_t(c)] += child.ledger[size_t(c)];
                }
            }
            number[through] = uint32_t(replay.tree.branches.size());
            replay.branch.children.push_back(number[through]);
            replay.tree.branches.push_back(std::move(child));
        }
        require(replay.trace, cut == less(replay.trace.end.cut, replay.trace.begin.cut), "what the depth cuts");
        require(replay.trace, replay.trace.pushed.size() == (last ? 0 : replay.branch.children.size()),
                "the number of children");
        for (const typename Trace::Push& push : replay.trace.pushed) {
            const int through = push.branch.mirrored ? 0 : 1;
            require(replay.trace, number[through] != 0 && push.branch.weight == weights[through],
                    "the weight of a child");
            if (push.fits) replay.waiting.push_back(number[through]);
            if (!push.fits && number[through] != 0) replay.tree.branches[number[through]].end = BranchEnd::dropped;
        }
    }

    /// Evaluates the surface's local light again, with the recorded shadows.
    void read_light(Replay& replay, const Ray<Real>& ray, const SurfaceEvent<Real>& event,
                    const Surface<Real>& s) const {
        PixelSurface& out = replay.branch.surface;
        const auto& shadows = replay.trace.shadows;
        out.ambient = Vec3<double>(s.color * scene_.materials[s.material].ambient) * radiance_unit();
        out.ambient_adds =
            less(shadows.empty() ? replay.trace.end.radiance : shadows[0].before, replay.trace.begin.radiance);
        out.lights.resize(scene_.lights.size);
        size_t next = 0;
        bool agrees = true;
        const ReplayedShadows<Real, Intersector> replayed{shadows, next, agrees, intersector_};
        const Local local{*this, replay, s, next};
        DiscardedSums sums;
        PixelRays rays;
        add_local_light<Real, E>(scene_, replayed, ray, event, s, replay.weight * scene_.materials[s.material].local,
                                 sums, rays, local);
        require(replay.trace, agrees, "which lights cast shadows");
        require(replay.trace, next == shadows.size(), "the number of shadow rays");
    }

    /// Records what each light adds to a surface. `next`: the index of the next recorded shadow ray.
    struct Local {
        const BranchReader& reader;
        Replay& replay;
        const Surface<Real>& s;
        const size_t& next;

        LightContribution& contribution(uint32_t i) const {
            LightContribution& contribution = replay.branch.surface.lights[i];
            contribution.light = i;
            return contribution;
        }
        void aim(LightContribution& contribution, const LightAim<Real>& aim) const {
            contribution.distance = double(aim.distance) * reader.frame_.unit_length;
            contribution.cosine = double(aim.cosine);
        }
        void behind(uint32_t i, const Light<Real>& light) const {
            aim(contribution(i), LightAim<Real>::of(light, s.viewer_side, s.shading));
            contribution(i).fate = LightFate::behind;
        }
        void unshadowed(uint32_t i, const LightAim<Real>& to_light, const Vec3<Real>& lit) const {
            aim(contribution(i), to_light);
            contribution(i).unshadowed = Vec3<double>(lit) * reader.radiance_unit();
            contribution(i).fate = LightFate::nothing;
        }
        void arrives(uint32_t i, const ShadowRay<Real>& shadow, const Vec3<Real>& arrives) const {
            const auto& shadows = replay.trace.shadows;
            if (next == 0 || shadows[next - 1].shadow.light != shadow.light) return;  // no such shadow ray was traced
            LightContribution& to = contribution(i);
            to.arrives = Vec3<double>(arrives);
            to.adds = less(next < shadows.size() ? shadows[next].before : replay.trace.end.radiance,
                           shadows[next - 1].before);
            to.fate = arrives == Vec3<Real>(Real(0)) ? LightFate::shadow : LightFate::adds;
            if (arrives != Vec3<Real>(Real(1))) to.through = reader.solids_on_the_way(shadow);
        }
    };

    double radiance_unit() const { return elementary::power_of_two(compiled_.radiance_exponent); }

    /// The first eight solids that take light from a shadow ray, in the order in which it meets them.
    std::vector<uint32_t> solids_on_the_way(const ShadowRay<Real>& shadow) const {
        std::vector<uint32_t> solids;
        const TriangleRay<Real> triangle_ray = TriangleRay<Real>::of(shadow.ray.origin, shadow.ray.direction);
        const auto note = [&](uint32_t solid, uint32_t slot) {
            if (std::find(solids.begin(), solids.end(), solid) != solids.end()) return;
            ShadowSum<E> sum;
            if (scene_.solids[solid].kind == SolidKind::convex)
                shadow_convex<Real, E>(scene_, solid, shadow, sum);
            else if (is_disk(scene_.solids[solid]))
                sum.cross(scene_.materials[scene_.solids[solid].material]);
            else
                shadow_cluster<Real, E>(scene_, slot / cluster_lanes, shadow, triangle_ray, sum);
            bool takes = sum.opaque != 0;
            for (int c = 0; c < 3; ++c) takes = takes || sum.loss[c] != 0 || sum.path[c].sum != 0;
            if (takes) solids.push_back(solid);
        };
        shadow.ray.media.for_each([&](uint32_t solid, int count) {
            if (count > 0 && scene_.solids[solid].kind == SolidKind::convex) note(solid, 0);
        });
        Ray<Real> ray = shadow.ray;
        ray.accept_both_sides();
        for (int crossings = 0; crossings < 256 && solids.size() < 8; ++crossings) {
            const Hit<Real> hit = intersector_.closest(ray);
            if (!(hit.t < shadow.distance)) break;
            note(key_solid(hit.key), hit.slot);
            if (const int change = media_change(key_kind(hit.key)); change != 0)
                ray.media.add(key_solid(hit.key), change);
            ray.after = {hit.t, hit.key};
        }
        return solids;
    }

    void fill(const Replay& replay, FaceMet& face, uint64_t key, Real t) const {
        const Solid& solid = scene_.solids[key_solid(key)];
        face.solid = key_solid(key);
        face.triangle = solid.kind != SolidKind::convex && !is_disk(solid);
        face.round = is_ball(solid) || is_disk(solid);
        face.face = key_face(key) - (solid.kind != SolidKind::convex ? solid.first_triangle : 0);
        face.crossing = key_kind(key);
        face.distance = length_of(replay, t);
    }

    /// The solids that a ray is inside on either side of an event, in the order of the file.
    std::vector<std::string> names_around(const Ray<Real>& ray, const SurfaceEvent<Real>& event) const {
        std::set<uint32_t> solids;
        ray.media.for_each([&](uint32_t solid, int count) {
            if (count > 0) solids.insert(solid);
        });
        for (int i = 0; i < event.count; ++i) solids.insert(key_solid(event.taken[i].key));
        std::vector<std::string> names;
        for (const uint32_t solid : solids) names.push_back(compiled_.solid_names[solid]);
        return names;
    }

    double length_of(const Replay& replay, Real t) const { return (double(t) + replay.ahead) * frame_.unit_length; }

    glm::dvec3 to_scene(const Vec3<Real>& point) const {
        return Vec3<double>(point) * frame_.unit_length + compiled_.center;
    }

    static std::vector<uint32_t> solids_of(const InteriorList& media) {
        std::vector<uint32_t> solids;
        media.for_each([&](uint32_t solid, int count) {
            if (count > 0) solids.push_back(solid);
        });
        std::sort(solids.rbegin(), solids.rend());
        return solids;
    }

    const CompiledScene<Real>& compiled_;
    const SceneView<Real>& scene_;
    const Intersector& intersector_;
    const FrameView& frame_;
};

}  // namespace cistula

// Eight pixels at once (Wald, Slusallek, Benthin, Wagner 2001, Interactive Rendering with Coherent Ray Tracing), where
// no ray passes a face: a tree is one path then, and eight of them go from face to face side by side. Every lane takes
// the operations that render_pixel takes, so that its pixel is the same bit for bit.
#pragma once

#include <array>
#include <atomic>
#include <utility>

#include "backend_embree/packet_intersector.h"
#include "cistula/pixel.h"
#include "scene/put_pixels.h"

namespace cistula {

/// Masks that packets can be traced with: bodies, lamps, shadows that let nothing through, perhaps mirrors, and nothing
/// else.
template <class E>
inline constexpr bool fits_packets = E::has(effect_opaque_shadows) && (E::mask & ~mirrors) == 0;

template <class Real, class E>
class PacketTracer {
  public:
    using Scene = SmallScene<Real>;

    /// `in_view`: as BruteIntersector's. The camera is in no solid. Adds to `rays` and `flags` what is counted.
    PacketTracer(const Scene& scene, const FrameView& frame, uint32_t in_view, const std::atomic<bool>& stop,
                 RayCounts& rays, uint32_t& flags)
        : scene_(scene),
          frame_(frame),
          in_view_(in_view),
          stop_(stop),
          rays_(rays),
          flags_(flags),
          intersector_(scene) {}

    /// Pixels (x, y) to (x + count - 1, y), of which there are lane_count at most.
    void render(int x, int y, int count, const PixelWriter& writer, PixelRecord* pixels) {
        const int k = frame_.supersample;
        begin();
        for (int sample = 0; sample < k * k && !stopped(); ++sample) {
            const int row = k == 1 ? 0 : sample / k, column = sample - row * k;
            render_sample(x * k + column, y * k + row, (1u << count) - 1, column == k / 2 && row == k / 2);
        }
        for (int i = 0; i < count; ++i) end(i);
        // Apart: what was just set in parts takes long to read as a whole.
        for (int i = 0; i < count; ++i) writer.put(pixels[i], whole_record(records_[i]));
    }

  private:
    using Index = LaneIndex<Real>;
    using Record = RecordOf<E>;
    using Hits = PacketHits<Real>;
    using Ledgers = std::array<PixelSums<Real, Record>, lane_count>;  // for what is cut; add() has the radiance

    struct Path : RayPacket<Real> {
        Lanes<Real> weight;
    };
    /// Of what a sample sees first.
    struct Seen {
        bool middle;
        Lanes<double> start, facing;  // as PixelWork's
    };
    /// A face that some of the rays meet.
    struct Face {
        const Material<Real>& material;
        uint32_t solid, index;  // as in a key
        Vec3<Real> normal;
        VecLanes<Real> place, color;  // where rays on the viewer's side start; the material's, times its texture
    };

    bool stopped() const { return stop_.load(std::memory_order_relaxed); }

    void begin() {
        for (Record& record : records_) begin_pixel(record);
        samples_ = 0;
        reflected_ = shadow_ = {};
        for (Lanes<int64_t>& sums : radiance_) sums = {};
    }

    void end(int i) {
        PixelWork work;
        work.rays = {samples_, reflected_.of[i], 0, shadow_.of[i]};
        end_pixel(records_[i], work);
        for (int c = 0; c < 3; ++c) records_[i].radiance[c] = radiance_[c].of[i];
        rays_.add(work.rays);
    }

    template <size_t... lane>
    Ledgers ledgers(std::index_sequence<lane...>) {
        return {PixelSums<Real, Record>(frame_.tree, scene_, records_[lane], flags_)...};
    }

    /// Samples `across`, `across` + k, ... of row `down`, of all samples of the picture.
    void render_sample(int across, int down, uint32_t lanes, bool middle) {
        const int k = frame_.supersample, right = 2 * across + 1 - frame_.width * k,
                  below = 2 * down + 1 - frame_.height * k;
        const Camera camera = frame_.camera;
        const double half_sample = frame_.half_sample;
        Path path{};  // lanes without a ray hold numbers too, of which nothing is kept
        VecLanes<double> direction;
        for_lanes([&](int i) {
            direction.put(i, camera_direction(camera, double(right + 2 * k * i), double(below), half_sample));
            path.direction.put(i, Vec3<Real>(direction[i]));
            path.from_solid.of[i] = Index(no_solid);
            path.from_face.of[i] = 0;
            path.weight.of[i] = Real(1);
        });
        ++samples_;
        Seen seen;
        seen.middle = middle;
        for_lanes([&](int i) {
            seen.start.of[i] = 0;
            seen.facing.of[i] = dot(direction[i], camera.forward);
        });
        Hits hits;
        uint32_t found;
        if (frame_.is_far) {
            uint32_t near = 0;
            for_each_lane(lanes, [&](int i) {
                Ray<Real, OneMedium> ray;
                if (!primary_ray(scene_, frame_, direction[i], ray, seen.start.of[i])) return;
                path.origin.put(i, ray.origin);
                near |= 1u << i;
            });
            found = intersector_.closest(path, path.origin, in_view_, near, hits);
        } else {
            const SameVec<Real> eye = {Vec3<Real>(camera.position)};
            for_lanes([&](int i) { path.origin.put(i, eye[i]); });
            found = intersector_.closest(path, eye, in_view_, lanes, hits);
        }
        follow(path, hits, lanes, found, seen);
    }

    /// All that the rays see from here on. `found`: the lanes that hit anything.
    void follow(Path& path, Hits& hits, uint32_t lanes, uint32_t found, const Seen& seen) {
        Ledgers of_lanes = ledgers(std::make_index_sequence<lane_count>());
        for (int depth = 0;; ++depth) {
            if (found != lanes) {
                const Vec3<Real> background = scene_.background;
                VecLanes<Real> ends;
                for_lanes([&](int i) { ends.put(i, path.weight.of[i] * background); });
                add(lanes & ~found, ends);
            }
            Path next{};
            uint32_t on = 0;
            for (uint32_t left = found; left != 0;) {
                const uint32_t alike = on_the_same_face(hits, left);
                left &= ~alike;
                on |= shade(path, hits, alike, depth, seen, of_lanes, next);
            }
            if (on == 0 || stopped()) return;
            path = next;
            lanes = on;
            found = intersector_.closest(path, path.origin, ~0u, lanes, hits);
        }
    }

    /// Of `lanes` those that hit the face of the first of them, and from its side.
    CISTULA_INLINE uint32_t on_the_same_face(const Hits& hits, uint32_t lanes) const {
        const uint32_t one = lowest_bit(lanes);
        const Index solid = hits.solid.of[one], face = hits.face.of[one];
        uint32_t alike =
            lanes & lanes_where([&](int i) { return (hits.solid.of[i] == solid) & (hits.face.of[i] == face); });
        if (!is_convex<E>(scene_.solids[uint32_t(solid)])) {
            const bool enters = hits.on_triangle[one].enters;
            for_each_lane(alike, [&](int i) { alike &= ~(uint32_t(hits.on_triangle[i].enters != enters) << i); });
        }
        return alike;
    }

    /// Adds what is seen of one face. The lanes of `next` whose rays it sends on.
    CISTULA_INLINE uint32_t shade(const Path& path, const Hits& hits, uint32_t lanes, int depth, const Seen& seen,
                                  Ledgers& of_lanes, Path& next) {
        const Hit<Real> one = intersector_.hit(hits, int(lowest_bit(lanes)));
        const Solid& solid = scene_.solids[key_solid(one.key)];
        Face face{
            scene_.materials[solid.material], key_solid(one.key), key_face(one.key), normal_at<E>(scene_, one), {}, {}};
        if (is_convex<E>(solid)) {
            const Vec3<Real> color = face.material.color;
            for_lanes([&](int i) {
                face.place.put(i, along(path.origin[i], hits.t.of[i], path.direction[i]));
                face.color.put(i, color);
            });
        } else {
            for_each_lane(lanes, [&](int i) {
                const Surface<Real> s = surface_at<Real, E>(scene_, path.ray(i), hits.on_triangle[i]);
                face.place.put(i, s.viewer_side);
                face.color.put(i, s.color);
            });
        }
        if (depth == 0) note_first(hits, face, lanes, seen);
        if (!is_finite(face.normal)) flags_ |= flag_not_finite;
        uint32_t on = 0;
        if constexpr (E::has(effect_reflection)) on = send_on(path, face, lanes, depth, of_lanes, next);
        if (face.material.local > Real(0)) add_local_light(path, face, lanes);
        return on;
    }

    CISTULA_INLINE void note_first(const Hits& hits, const Face& face, uint32_t lanes, const Seen& seen) {
        for_each_lane(lanes, [&](int i) {
            PixelWork work;
            work.start = seen.start.of[i];
            work.facing = seen.facing.of[i];
            FirstSeen<Real>{frame_, work, records_[i], seen.middle}.surface(intersector_.hit(hits, i), face.normal);
        });
    }

    CISTULA_INLINE uint32_t send_on(const Path& path, const Face& face, uint32_t lanes, int depth, Ledgers& of_lanes,
                                    Path& next) {
        const Real share = face.material.reflection;
        uint32_t on = 0;
        for_each_lane(lanes, [&](int i) {
            const Real mirrored = path.weight.of[i] * share;
            if (!(total(mirrored) > Real(0))) return;
            if (depth + 1 >= frame_.tree.depth) return of_lanes[size_t(i)].cut(mirrored);
            if (!of_lanes[size_t(i)].afford(mirrored)) return;
            ++reflected_.of[i];
            on |= 1u << i;
            next.weight.of[i] = mirrored;
            next.from_solid.of[i] = Index(face.solid);
            next.from_face.of[i] = Index(face.index);
            next.origin.put(i, face.place[i]);
            next.direction.put(i, reflected(path.direction[i], face.normal));
        });
        return on;
    }

    /// As cistula::add_local_light.
    CISTULA_INLINE void add_local_light(const Path& path, const Face& face, uint32_t lanes) {
        const Material<Real>& material = face.material;
        const Real local = material.local;
        const Vec3<Real> ambient = material.ambient, normal = face.normal;
        Lanes<Real> weight;
        VecLanes<Real> adds;
        for_lanes([&](int i) {
            weight.of[i] = path.weight.of[i] * local;
            adds.put(i, weight.of[i] * (face.color[i] * ambient));
        });
        add(lanes, adds);
        RayPacket<Real> shadow;
        for_lanes([&](int i) {
            shadow.origin.put(i, face.place[i]);
            shadow.from_solid.of[i] = Index(face.solid);
            shadow.from_face.of[i] = Index(face.index);
        });
        const Real least_height = incidence<Real> * scene_.extent;
        for (uint32_t number = 0; number < scene_.lights.size; ++number) {
            const Light<Real> light = scene_.lights[number];
            Lanes<Real> distance, n_l;
            uint32_t lit = lanes & lanes_where([&](int i) {
                               Vec3<Real> to_light = light.position - face.place[i];
                               const bool before = dot(normal, to_light) > least_height;
                               distance.of[i] = length(to_light);
                               to_light *= reciprocal(distance.of[i]);
                               shadow.direction.put(i, to_light);
                               n_l.of[i] = dot(normal, to_light);
                               return before & (n_l.of[i] > Real(0));
                           });
            if (lit == 0) continue;
            Lanes<Real> shine;
            for_lanes([&](int i) {
                shine.of[i] = mirror_cosine(normal, shadow.direction[i], -path.direction[i], n_l.of[i]);
            });
            if constexpr (E::has(effect_specular))
                for_each_lane(lit, [&](int i) { shine.of[i] = highlight(material, shine.of[i]); });
            lit &= lanes_where([&](int i) {
                const Vec3<Real> of_light =
                    phong<Real, E>(material, face.color[i], light, n_l.of[i], shine.of[i], distance.of[i]);
                adds.put(i, of_light);
                return (of_light.x != Real(0)) | (of_light.y != Real(0)) | (of_light.z != Real(0));
            });
            if (lit == 0) continue;
            const uint32_t dark = intersector_.shadowed(shadow, face.solid, number, distance, lit);
            Lanes<Real> arrives;
            for (int i = 0; i < lane_count; ++i) {
                arrives.of[i] = dark >> i & 1u ? Real(0) : Real(1);
                shadow_.of[i] += lit >> i & 1u;
            }
            for_lanes([&](int i) { adds.put(i, weight.of[i] * (arrives.of[i] * adds[i])); });
            add(lit, adds);
        }
    }

    /// As PixelSums::add.
    CISTULA_INLINE void add(uint32_t lanes, const VecLanes<Real>& radiance) {
        const Real scale = Real(frame_.tree.fixed_scale);
        const Lanes<Real>* of_color[3] = {&radiance.x, &radiance.y, &radiance.z};
        for (int c = 0; c < 3; ++c) {
            Lanes<Real> units;
            const uint32_t faults = lanes & lanes_where([&](int i) {
                                        Real of_lane = fused(of_color[c]->of[i], scale, Real(0));
                                        const bool is_fault = clear_fault(of_lane, scale);
                                        units.of[i] = of_lane;
                                        return is_fault;
                                    });
            if (faults != 0) flags_ |= flag_not_finite;
            for_each_lane(lanes, [&](int i) { radiance_[c].of[i] += whole_of(units.of[i]); });
        }
    }

    const Scene& scene_;
    const FrameView& frame_;
    const uint32_t in_view_;
    const std::atomic<bool>& stop_;
    RayCounts& rays_;
    uint32_t& flags_;
    const PacketIntersector<Real, E> intersector_;
    // Of the pixels under way:
    Record records_[lane_count];  // their radiance only once they are done
    uint32_t samples_;            // of each
    Lanes<uint32_t> reflected_, shadow_;
    Lanes<int64_t> radiance_[3];
};

}  // namespace cistula

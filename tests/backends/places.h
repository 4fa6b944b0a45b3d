// How the bodies of a scene lie to one another, found in the description and not where it was made.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"

namespace cistula::test {

using glm::dvec3;

struct Face {
    dvec3 normal;  // unit, outward
    std::vector<dvec3> corners;
    dvec3 middle() const {
        dvec3 sum(0);
        for (const dvec3& p : corners) sum += p;
        return sum / double(corners.size());
    }
    double height(const dvec3& p) const { return dot(normal, p - corners[0]); }
    bool holds(const dvec3& p, double tolerance) const {
        if (magnitude(height(p)) > tolerance) return false;
        for (size_t i = 0; i < corners.size(); ++i) {
            const dvec3 edge = corners[(i + 1) % corners.size()] - corners[i];
            if (dot(cross(edge, p - corners[i]), normal) < 0) return false;
        }
        return true;
    }
};

/// A Platonic solid, or a mesh of few triangles.
struct Body {
    bool convex = false;  // known to be
    bool closed = true;
    double tolerance = 0;
    dvec3 center{0};
    std::vector<Face> faces;
    std::vector<dvec3> vertices;

    bool contains(const dvec3& p) const {
        for (const Face& face : faces)
            if (face.height(p) > -tolerance) return false;
        return convex;
    }
};

inline Body body_of(const SolidObject& solid) {
    Body body{true, true, 1e-9 * (solid.radius + length(solid.center)), solid.center, {}, world_vertices(solid)};
    for (const auto& f : polyhedron_of(solid).faces) {
        Face face{Rotation(solid.rotation)(f.normal), {}};
        for (const uint32_t v : f.vertices) face.corners.push_back(body.vertices[v]);
        body.faces.push_back(face);
    }
    return body;
}

inline Body body_of(const TrianglesObject& mesh) {
    Body body;
    body.vertices = mesh.vertices;
    for (const auto& t : mesh.triangles) {
        const dvec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        body.tolerance = max_or_second(body.tolerance, 1e-9 * (length(b - a) + length(a)));
        body.faces.push_back({normalized(cross(b - a, c - a)), {a, b, c}});
    }
    return body;
}

/// Faces of two bodies in one plane, one of them with its middle on the other: 1 where they look the same way, else -1.
inline int shared_face(const Body& a, const Body& b) {
    const double tolerance = a.tolerance + b.tolerance;
    for (const Face& f : a.faces)
        for (const Face& g : b.faces) {
            const double cosine = dot(f.normal, g.normal);
            if (magnitude(cosine) < 1 - 1e-9) continue;
            if (f.holds(g.middle(), tolerance) || g.holds(f.middle(), tolerance)) return cosine > 0 ? 1 : -1;
        }
    return 0;
}

class Places {
  public:
    Places(const SceneDescription& scene, const CompiledScene<double>& compiled) {
        for (size_t i = 0; i < scene.objects.size(); ++i) {
            const auto& shape = scene.objects[i].shape;
            if (const auto* solid = std::get_if<SolidObject>(&shape)) bodies_.push_back(body_of(*solid));
            if (const auto* ball = std::get_if<SphereObject>(&shape)) balls_.push_back(*ball);
            if (const auto* disk = std::get_if<DiskObject>(&shape)) {
                disks_.push_back(*disk);
                disks_.back().normal = normalized(disk->normal);
            }
            const auto* mesh = std::get_if<TrianglesObject>(&shape);
            if (!mesh || mesh->triangles.size() > 40) continue;
            bodies_.push_back(body_of(*mesh));
            bodies_.back().closed = compiled.solids[i].kind != SolidKind::sheet;
            bodies_.back().convex = compiled.solids[i].kind == SolidKind::convex;
            note(bodies_.back().convex, "mesh given by planes");
        }
        look_at_lights(scene);
        look_at_bodies();
        for (const SphereObject& ball : balls_) look_at_ball(ball);
        for (const DiskObject& disk : disks_) look_at_disk(disk);
    }

    std::set<std::string> found;

  private:
    void note(bool is, const std::string& what) {
        if (is) found.insert(what);
    }

    void look_at_lights(const SceneDescription& scene) {
        for (const LightDescription& light : scene.lights) {
            if (light.color == dvec3(0)) continue;
            for (const Body& body : bodies_) note(body.contains(light.position), "light in a solid");
            for (const SphereObject& ball : balls_)
                note(length(light.position - ball.center) < ball.radius, "light in a ball");
        }
    }

    void look_at_bodies() {
        for (const Body& a : bodies_)
            for (const Body& b : bodies_) {
                if (&a == &b || !a.closed || !b.closed) continue;
                size_t inside = 0;
                for (const dvec3& p : a.vertices) inside += b.contains(p);
                note(inside == a.vertices.size(), "nested");
                note(inside > 0 && inside < a.vertices.size(), "overlapping");
                const int shared = shared_face(a, b);
                const std::string what = a.convex && b.convex   ? " of planes"
                                         : a.convex || b.convex ? " of both kinds"
                                                                : " of meshes";
                note(shared < 0, "shared face" + what);
                note(shared > 0, "faces in one place" + what);
            }
    }

    void look_at_ball(const SphereObject& ball) {
        const double tolerance = 1e-9 * (ball.radius + length(ball.center));
        for (const SphereObject& other : balls_) {
            if (&other == &ball) continue;
            const double apart = length(other.center - ball.center);
            const double outside = apart - (ball.radius + other.radius);
            const double within = apart - (ball.radius - other.radius);  // of the other in this
            const double around = apart - (other.radius - ball.radius);
            const bool equal = magnitude(within) <= tolerance && magnitude(around) <= tolerance;
            note(equal, "balls in one place");
            note(magnitude(outside) <= tolerance, "balls that touch");
            note(magnitude(within) <= tolerance && !equal, "ball that touches the ball around it");
            note(within < -tolerance, "ball in a ball");
            note(outside < -tolerance && within > tolerance && around > tolerance, "balls that overlap");
        }
        for (const Body& body : bodies_) {
            const double off = tolerance + body.tolerance;
            size_t inside = 0, on = 0;
            for (const dvec3& p : body.vertices) {
                const double height = length(p - ball.center) - ball.radius;
                inside += height < -off;
                on += magnitude(height) <= off;
            }
            note(inside == body.vertices.size(), "flat body in a ball");
            note(body.closed && on == body.vertices.size(), "all corners on a ball");
            size_t within = 0, touched = 0;
            for (const Face& face : body.faces) {
                const double height = face.height(ball.center);
                within += height < -ball.radius - off;
                touched += look_at_plane(
                    ball, face.normal, face.corners[0], off, [&](const dvec3& foot) { return face.holds(foot, off); },
                    body.closed ? "face" : "sheet");
            }
            note(body.convex && within == body.faces.size(), "ball in a flat body");
            note(body.convex && touched == body.faces.size(), "ball that touches all faces around it");
        }
        for (const DiskObject& disk : disks_) {
            const auto holds = [&](const dvec3& foot) { return length(foot - disk.center) <= disk.radius; };
            look_at_plane(ball, disk.normal, disk.center, tolerance, holds, disk.is_endless() ? "plane" : "disk");
            const double height = dot(disk.normal, ball.center - disk.center);
            const bool on_axis = length(ball.center - height * disk.normal - disk.center) <= tolerance;
            const double rim = square_root(height * height + disk.radius * disk.radius);
            note(on_axis && magnitude(rim - ball.radius) <= tolerance, "rim on a ball");
        }
    }

    /// Whether the ball touches what lies in a plane; notes that, or that it is cut.
    bool look_at_plane(const SphereObject& ball, const dvec3& normal, const dvec3& on, double tolerance,
                       const std::function<bool(const dvec3&)>& holds, const std::string& what) {
        const double height = dot(normal, ball.center - on);
        if (!holds(ball.center - height * normal)) return false;
        const bool touches = magnitude(magnitude(height) - ball.radius) <= tolerance;
        note(touches && height > 0, "ball on a " + what);
        note(touches && height < 0, "ball under a " + what);
        note(magnitude(height) < ball.radius - tolerance, "ball cut by a " + what);
        note(magnitude(height) <= tolerance, "ball halved by a " + what);
        return touches;
    }

    void look_at_disk(const DiskObject& disk) {
        const std::string name = disk.is_endless() ? "plane" : "disk";
        for (const DiskObject& other : disks_) {
            if (&other == &disk) continue;
            const double tolerance = 1e-9 * (1 + length(disk.center) + length(other.center));
            const double cosine = magnitude(dot(disk.normal, other.normal));
            const bool coplanar =
                cosine > 1 - 1e-12 && magnitude(dot(disk.normal, other.center - disk.center)) <= tolerance;
            note(coplanar && length(other.center - disk.center) < disk.radius, "disk on a " + name);
            note(disk.is_endless() && other.is_endless() && cosine < 0.99, "planes that cross");
        }
        for (const Body& body : bodies_)
            for (const Face& face : body.faces) {
                const dvec3 middle = face.middle();
                const bool coplanar = magnitude(dot(disk.normal, face.normal)) > 1 - 1e-12 &&
                                      magnitude(dot(disk.normal, middle - disk.center)) <= body.tolerance;
                const bool meet = face.holds(disk.center, body.tolerance) || length(middle - disk.center) < disk.radius;
                note(coplanar && meet, name + " on a face");
            }
    }

    std::vector<Body> bodies_;
    std::vector<SphereObject> balls_;
    std::vector<DiskObject> disks_;  // with unit normals
};

}  // namespace cistula::test

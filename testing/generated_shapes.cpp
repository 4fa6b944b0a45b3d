#include "scene/compile/scene_normalization.h"
#include "scene/description/rotation.h"
#include "testing/generated_mesh.h"
#include "testing/generated_parts.h"

namespace cistula::generated {

TrianglesObject placed(TrianglesObject mesh, const dvec3& center, double scale, const dvec3& degrees) {
    const Rotation rotation(degrees);
    for (dvec3& p : mesh.vertices) p = center + rotation(scale * p);
    return mesh;
}

SolidObject cube(const dvec3& center, double radius, const dvec3& rotation) {
    SolidObject s;
    s.solid = PlatonicSolid::cube;
    s.center = center;
    s.radius = radius;
    s.rotation = rotation;
    return s;
}

dvec3 Shapes::degrees() {
    const double kind = random_.unit();
    if (kind < 0.25) return dvec3(0);
    if (kind < 0.45) return {random_.of({0, 90, 180}), random_.of({0, 90, 270}), random_.of({0, 45, -90})};
    return random_.in_cube(180);
}

SolidObject Shapes::solid(const dvec3& center, double radius) {
    SolidObject s;
    s.solid = static_cast<PlatonicSolid>(random_.below(5));
    s.center = center;
    s.radius = radius;
    s.rotation = degrees();
    return s;
}

Shape Shapes::closed_mesh(const dvec3& center, double radius) {
    const dvec3 turn = degrees();
    switch (random_.below(5)) {
        case 0:
            return placed(bumpy_sphere(static_cast<uint32_t>(random_.of({60, 200, 700, 1500}))), center, radius, turn);
        case 1: {
            const uint32_t around = 5 + random_.below(28);
            return placed(torus(0.7, 0.3, around, 4 + random_.below(12)), center, radius, turn);
        }
        case 2:
            return placed(star(random_.of({0.4, 0.6})), center, radius, turn);
        case 3:
            heavy_ = true;
            if (!files_.empty()) {
                MeshObject mesh;
                mesh.file = files_ + "/knot.ply";
                mesh.center = center;
                mesh.scale = 0.6 * radius;
                mesh.rotation = turn;
                return mesh;
            }
            return placed(torus(0.6, 0.35, 40, 12), center, radius, turn);
        default:
            return triangulated_solid(solid(center, radius));
    }
}

Shape Shapes::closed(const dvec3& center, double radius) {
    if (random_.chance(0.65)) return solid(center, radius);
    return closed_mesh(center, radius);
}

}  // namespace cistula::generated

// Lights on a face shared by two solids.
#pragma once

#include "apps/render_verify/shadows/half_spaces.h"

namespace cistula::verify::shadows {

/// Lights between two touching cubes of planes or triangles, and at the border of the shared face.
struct LightsInContact : HalfSpaces {
    static constexpr const char* name = "shadows/lights-in-contact";
    static constexpr const char* exact = "lights on the face that two solids share: each by its own half-spaces";
    static constexpr Bound bound = no_failures("shadow rays");
    static constexpr bool needs_witness = true;

    static void plan(Plan& plan) {
        const double half_diagonal = 0.86602540378443864676;  // half the diagonal of a cube of side 1
        const PlatonicShape& shape = platonic_shape(PlatonicSolid::cube);
        for (int shapes = 0; shapes < 4; ++shapes)
            for (const bool glass : {false, true}) {
                const std::vector<SolidObject> solids = {solid_object(PlatonicSolid::cube, {-0.5, 0, 0}, half_diagonal),
                                                         solid_object(PlatonicSolid::cube, {0.5, 0, 0}, half_diagonal)};
                SceneDescription scene = empty_scene();
                scene.materials[0] = glass_or_opaque(scene, glass);
                std::vector<std::vector<OnSolid>> on(2);
                for (int s = 0; s < 2; ++s)
                    add_solid(scene, shapes >> s & 1 ? Shape::triangles : Shape::planes, solids[s]);
                for (const glm::dvec3& light : {glm::dvec3(0, 0, 0), glm::dvec3(0, 0.1, 0.2), glm::dvec3(0, 0.5, 0.125),
                                                glm::dvec3(0, 0.5, -0.5), glm::dvec3(0, -0.25, 0.5)}) {
                    add_light(scene, light);
                    for (int s = 0; s < 2; ++s) {
                        OnSolid place{light, 0};
                        for (uint32_t f = 0; f < shape.faces.size(); ++f)
                            place.faces |=
                                uint32_t(magnitude(dot(shape.faces[f].normal, light - solids[s].center) - 0.5) < 1e-9)
                                << f;
                        on[s].push_back(place);
                    }
                }
                Part& part = plan.add("cubes", scene, LightsInContact{{2, 6, uint32_t(on[0].size()), glass}}, {},
                                      plan.rays(300'000, 3000));
                add_half_spaces(part, solids, on);
            }
    }
};

}  // namespace cistula::verify::shadows

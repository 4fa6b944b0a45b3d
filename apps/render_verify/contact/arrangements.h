// Ways in which bodies touch.
#pragma once

#include "apps/render_verify/contact/site.h"

namespace cistula::verify::contact {

/// What an arrangement is made of: materials of two kinds of body and of what they stand on; their form.
struct Parts {
    int one, other, ground;
    Shape shape = Shape::planes;
};

inline void on_floor(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.cube(-0.3, 0.1, 0, 0.9, 0, parts.one, parts.shape);
    site.cube(0.7, -0.5, 0, 0.5, 33, parts.other, parts.shape);
}
inline void on_tessellated_floor(Site& site, const Parts& parts) {
    site.tessellated_floor(parts.ground, 9);
    site.cube(-0.3, 0.1, 0, 0.9, 0, parts.one, parts.shape);
    site.cube(0.7, -0.5, 0, 0.5, 33, parts.other, parts.shape);
}
inline void on_solid(Site& site, const Parts& parts) {
    site.cube(-0.3, 0.1, 0, 0.9, 0, parts.one, parts.shape);
    site.cube(0.7, -0.5, 0, 0.5, 33, parts.other, parts.shape);
    site.cube(0, 0, -3, 3, 0, parts.ground);  // opaque bodies come later: they fill what they share with glass
}
inline void side_by_side(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.cube(-0.3, 0, 0, 0.6, 0, parts.one, parts.shape);
    site.cube(0.3, 0, 0, 0.6, 0, parts.other, parts.shape);
    site.cube(0.2, 0.5, 0, 0.4, 0, parts.one, parts.shape);  // on part of the second one's face
}
inline void over_the_edge(Site& site, const Parts& parts) {
    site.quad({-2, -2, 0}, {2.1, 0, 0}, {0, 4, 0}, parts.ground);
    site.cube(0, 0.1, 0, 0.9, 25, parts.one, parts.shape);
    site.cube(-0.15, -0.9, 0, 0.5, 0, parts.other, parts.shape);  // two edges in one place
}
inline void across_two_quads(Site& site, const Parts& parts) {
    site.quad({-2, -2, 0}, {2.1, 0, 0}, {0, 4, 0}, parts.ground);
    site.quad({-0.2, -2, 0}, {2.2, 0, 0}, {0, 4, 0}, parts.ground);
    site.cube(0, 0.1, 0, 0.9, 25, parts.one, parts.shape);
}
inline void in_a_corner(Site& site, const Parts& parts) {
    site.quad({-1, -1, 0}, {3, 0, 0}, {0, 3, 0}, parts.ground);
    site.quad({-1, -1, 0}, {0, 3, 0}, {0, 0, 2}, parts.ground);
    site.quad({-1, -1, 0}, {0, 0, 2}, {3, 0, 0}, parts.ground);
    site.cube(-0.6, -0.6, 0, 0.8, 0, parts.one, parts.shape);
    site.cube(-0.7, 0.1, 0, 0.6, 0, parts.other, parts.shape);  // at a wall and at the first one
}
inline void along_an_edge(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.cube(-0.3, 0, 0, 0.6, 0, parts.one, parts.shape);
    site.cube(0.3, 0, 0.6, 0.6, 0, parts.other, parts.shape);
}
inline void at_a_vertex(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.cube(-0.3, -0.3, 0, 0.6, 0, parts.one, parts.shape);
    site.cube(0.3, 0.3, 0.6, 0.6, 0, parts.other, parts.shape);
}
inline void stacked(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.decal({-0.1, -0.1, 0}, {0.2, 0, 0}, {0, 0.2, 0}, parts.ground);
    site.cube(0, 0, 0, 0.8, 10, parts.one, parts.shape);
    site.cube(0.05, -0.02, 0.8, 0.5, 40, parts.other, parts.shape);
    site.cube(0, 0.02, 1.3, 0.3, -25, parts.one, parts.shape);
}

using Build = void (*)(Site&, const Parts&);

/// The view of an arrangement.
inline void look_at_it(Site& site, Build build) {
    if (build == Build(in_a_corner))
        site.look({2.6, 3.1, 2.3}, {-0.4, -0.3, 0.4}, 40);
    else
        site.look({1.4, -3.6, 2.1}, {0, 0, 0.45}, 40);
}
/// The light of an arrangement, beside ambient light.
inline void light_it(Site& site, Build build) {
    site.light(build == Build(in_a_corner) ? dvec3(1.5, 1.1, 1.8) : dvec3(1.8, -1.5, 3.2));
}

}  // namespace cistula::verify::contact

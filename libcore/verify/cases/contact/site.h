// Bodies that stand on, lie on and touch one another, on grounds that are turned so that no normal is along an axis.
#pragma once

#include "verify/cases/scenes.h"

namespace cistula::verify::contact {

using glm::dvec3;

/// Where a site lies: turned by Rotation(degrees), then moved.
struct Ground {
    dvec3 degrees, origin;
};
inline constexpr Ground grounds[] = {
    {{0, 0, 0}, {0, 0, 0}}, {{20, 35, 50}, {0.3, -0.2, 0.1}}, {{-71, 12, 163}, {7.3, -11.9, 5.7}}};

/// A cube of a site, in the site's coordinates: turned by `turn` radians about the vertical through its middle.
struct SiteCube {
    dvec3 middle;
    double half, turn;
    int material;
};
/// A parallelogram of a site, in the site's coordinates.
struct SiteSheet {
    dvec3 corner, along, across;
    int material;
};

/// A scene under construction, in coordinates of its own: the ground is z = 0, z is up.
class Site {
  public:
    SceneDescription scene = empty_scene();
    double size = 1;  // of cubes about their middles: next to 1, they are a hair apart or overlap by one
    double lift = 0;  // of each decal above the one before
    std::vector<SiteCube> cubes;
    std::vector<SiteSheet> sheets;
    std::vector<dvec3> lights;

    explicit Site(const Ground& ground) : degrees_(ground.degrees), origin_(ground.origin) {
        const Rotation rotation(ground.degrees);
        // Rotation turns about x first: an angle about up is added to that about x.
        x_ = rotation({0, 1, 0}), y_ = rotation({0, 0, 1}), z_ = rotation({1, 0, 0});
        scene.film.width = 48, scene.film.height = 36;
        scene.depth = 24;
        scene.ambient = {0.35, 0.4, 0.45};
        scene.background = {0.2, 0.5, 0.8};
    }
    /// The site of a solid that stands on one of its faces, at the origin.
    Site(const SolidObject& solid, size_t face) : Site(Ground{{0, 0, 0}, {0, 0, 0}}) {
        const Polyhedron& shape = platonic_shape(solid.solid);
        const Rotation rotation(solid.rotation);
        const auto& standing = shape.faces[face];
        z_ = -rotation(standing.normal);
        x_ = normalized(rotation(shape.vertices[standing.vertices[1]] - shape.vertices[standing.vertices[0]]));
        y_ = cross(z_, x_);
        origin_ = solid.center - z_ * (shape.inradius * solid.radius);
    }

    dvec3 direction(const dvec3& d) const { return x_ * d.x + y_ * d.y + z_ * d.z; }
    dvec3 place(const dvec3& p) const { return origin_ + direction(p); }
    /// A point, or a direction, of the scene in the site's coordinates.
    dvec3 own_direction(const dvec3& d) const { return {dot(d, x_), dot(d, y_), dot(d, z_)}; }
    dvec3 own(const dvec3& p) const { return own_direction(p - origin_); }

    /// A cube on the height `low`, turned by `turn` degrees.
    void cube(double x, double y, double low, double side, double turn, int material, Shape shape = Shape::planes) {
        const dvec3 middle(x, y, low + side / 2);
        cubes.push_back({middle, side / 2, turn * (3.14159265358979323846 / 180), material});
        add_solid(scene, shape,
                  solid_object(PlatonicSolid::cube, place(middle), std::sqrt(3.0) / 2 * side * size,
                               degrees_ + dvec3(turn, 0, 0)),
                  material);
    }
    /// The parallelogram corner, corner + along, corner + along + across, corner + across; its uv are lengths.
    void quad(const dvec3& corner, const dvec3& along, const dvec3& across, int material) {
        sheets.push_back({corner, along, across, material});
        TrianglesObject sheet = parallelogram(corner, along, across);
        for (dvec3& p : sheet.vertices) p = place(p);
        const double u = length(along);
        const double v = length(across);
        sheet.uvs = {{0, 0}, {u, 0}, {u, v}, {0, v}};
        add_object(scene, sheet, material);
    }
    /// A parallelogram that lies on something: its front is along x across.
    void decal(const dvec3& corner, const dvec3& along, const dvec3& across, int material) {
        decals_ += lift;
        quad(corner + normalized(cross(along, across)) * decals_, along, across, material);
    }
    void floor(int material, double half = 2) { quad({-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0}, material); }
    /// A floor of cells x cells squares, two triangles each, whose corners lie unevenly.
    void tessellated_floor(int material, int cells, double half = 2) {
        sheets.push_back({{-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0}, material});
        TrianglesObject mesh;
        for (int j = 0; j <= cells; ++j)
            for (int i = 0; i <= cells; ++i) {
                const bool inner = i > 0 && j > 0 && i < cells && j < cells;
                const double x = i + (inner ? 0.3 * std::sin(5.0 * i + 3 * j) : 0);
                const double y = j + (inner ? 0.3 * std::cos(4.0 * i - 7 * j) : 0);
                mesh.vertices.push_back(place({(2 * x / cells - 1) * half, (2 * y / cells - 1) * half, 0}));
            }
        const auto corner = [&](int i, int j) { return uint32_t(j * (cells + 1) + i); };
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i) {
                mesh.triangles.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
                mesh.triangles.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
            }
        add_object(scene, mesh, material);
    }
    void light(const dvec3& position, const dvec3& color = dvec3(0.6)) {
        lights.push_back(position);
        add_light(scene, place(position)).color = color;
    }
    void look(const dvec3& from, const dvec3& at, double field_of_view = 45) {
        scene.camera.position = place(from);
        scene.camera.target = place(at);
        scene.camera.up = z_;
        scene.camera.field_of_view = field_of_view;
    }

  private:
    dvec3 degrees_, origin_, x_, y_, z_;
    double decals_ = 0;
};

}  // namespace cistula::verify::contact

// A scene as the shading code sees it: non-owning flat arrays, with the same layout on host and device.
#pragma once

#include "cistula/numerics/vec.h"

namespace cistula {

enum class SolidKind : uint32_t {
    convex,  // slabs, or a ball; no edges, nothing to leak
    mesh,    // a closed triangle mesh, counter-clockwise seen from outside
    sheet,   // open triangles, seen from both sides, with no inside
};

/// A slab: the points with low <= normal.x <= high. A single plane has low = -infinity. Face 2 i is slab i's low side,
/// face 2 i + 1 its high side.
template <class Real>
struct alignas(16) Slab {  // aligned for wide loads
    Vec3<Real> normal;     // unit
    Real low, high;
};

/// A plane that faces of several solids share, so that a ray meets them all at one t (docs/rules.md, 11).
template <class Real>
struct alignas(16) SharedPlane {
    Vec3<Real> normal;                  // unit
    Real offset;                        // normal.x on the plane
    Real slack;                         // s u M, the unit of all distances from it that count as none
    uint32_t first_solid, solid_count;  // the convex solids with a face on it: plane_solids[first_solid + i]
    uint32_t mesh_count;                // ... and the closed meshes, which follow them there
};

/// A ball, a solid sphere (docs/rules.md, 14). Those that coincide to within 16 u M are a family, of one center and
/// radius.
template <class Real>
struct alignas(16) Ball {
    Vec3<Real> center;
    Real radius;
    uint32_t family;       // the first ball of its family
    uint32_t has_kin;      // 1 if others are in its family
    uint32_t near_meshes;  // 1 if a closed mesh may touch its surface
    uint32_t first_plane,
        plane_count;         // the planes of flat sheets near it: near_planes[first_plane + i] of ball_planes,
    uint32_t touched_count;  // ... of which it only touches the first so many
    Vec3<double> axes[3];    // those of its longitudes and latitudes (texture_uv)
};

/// The plane of flat sheets near balls.
template <class Real>
struct alignas(16) BallPlane {
    Vec3<Real> normal;  // unit
    Real offset;        // normal.x on the plane
    uint32_t shared;    // the same plane among shared_planes, or no_plane
};

/// A disk on a shared plane. A plane without end is one of radius 2^12 M that goes on for all lines but the flattest.
template <class Real>
struct alignas(16) Disk {
    Vec3<Real> center;
    Real square;         // of the radius
    Real least_slope;    // |n.d| of lines that meet it beyond the radius: `horizon` of planes, above 1 of disks
    Vec3<Real> axes[2];  // texture coordinates k of a point p: axes[k].p + shift[k]
    Real shift[2];
    uint32_t plane;  // among shared_planes
    uint32_t solid;
    uint32_t face;  // a number like those of triangles, of which it has one: triangle_planes[face] is `plane`

    /// Whether it is a plane without end.
    CISTULA_INLINE bool is_endless() const { return least_slope < Real(1); }
};

/// The |n.d| of a plane without end below which lines that are rounded once more may not tell on which side they go.
template <class Real>
inline constexpr Real horizon = 8 * RealTraits<Real>::unit;

inline constexpr int slab_lanes = 8;

/// Eight slabs in structure-of-arrays form, so that the host tests a ray against all at once. Unused lanes have a zero
/// normal and infinite bounds.
template <class Real>
struct alignas(32) SlabGroup {
    Real nx[slab_lanes], ny[slab_lanes], nz[slab_lanes], low[slab_lanes], high[slab_lanes];
    Real light_reach;   // first group of a solid: maximum reach of visible lights from its edges (edge_lights.h)
    Real light_square;  // ... and the square of the radius of a sphere around them all
    bool lights_apart;  // no visible light of another solid reaches into this one
};

/// A solid. Solids are numbered in file order, which is also the priority of their media: a later transparent solid
/// wins.
struct alignas(16) Solid {
    Vec3<float> center;        // convex, mesh on a shared plane: of a sphere around it,
    float padded_square;       // ... and the square of its radius plus sphere_padding
    Vec3<float> plane_normal;  // flat sheet: unit normal of its plane,
    float plane_offset;        // ... and normal.x on it
    SolidKind kind;
    uint32_t material;
    uint32_t first_slab, slab_count;  // convex: its slabs; a ball has none, and is balls[first_slab]; smooth mesh: 1 +
                                      // the place of its first normal, and 1 if others may be within its bulges;
                                      // disk: disks[first_slab], and disk_slabs
    uint32_t first_group;     // convex: the same slabs, ceil(slab_count / 8) groups; flat sheet near a ball: 1 +
                              // its plane in ball_planes; else 0
    uint32_t first_triangle;  // mesh, sheet: scene-wide number of its first triangle
    uint32_t first_uv;        // textured: uvs[first_uv + 3 (triangle - first_triangle) + corner]
    uint32_t flat;            // sheet: 1 if all of it lies in one plane, to within a few u M: a line that starts
                              // on it does not meet it again
    uint32_t may_touch;       // convex, mesh: 1 if its padded box meets that of another such solid
    uint32_t isolated;        // convex: 1 if nothing else is inside it: whatever a ray inside it hits next is its
                              // own face
    uint32_t first_near, near_count;  // the shared planes that reach it: near_planes[first_near + i]
};

/// Whether a convex solid is a ball.
CISTULA_INLINE bool is_ball(const Solid& solid) {
    return solid.kind == SolidKind::convex && solid.slab_count == 0;
}

/// The slab_count of a sheet that is a disk or a plane without end.
inline constexpr uint32_t disk_slabs = 2;
CISTULA_INLINE bool is_disk(const Solid& solid) {
    return solid.kind == SolidKind::sheet && solid.slab_count == disk_slabs;
}

/// Whether triangles have normals at their corners (docs/rules.md, 17): those of a face are normals[first_slab - 1 +
/// 3 (triangle - first_triangle) + corner], outward, all 0 if it is flat.
CISTULA_INLINE bool is_smooth(const Solid& solid) {
    return solid.kind != SolidKind::convex && solid.first_slab != 0 && !is_disk(solid);
}

/// Whether a solid is a flat sheet near balls.
CISTULA_INLINE bool is_sheet_near_ball(const Solid& solid) {
    return solid.kind == SolidKind::sheet && solid.first_group != 0;
}

/// The bounding sphere of a convex solid, or of a mesh on a shared plane.
template <class Real>
struct alignas(16) BoundingSphere {
    Vec3<Real> center;
    Real padded_square;

    CISTULA_INLINE static BoundingSphere of(const Solid& solid) {
        return {Vec3<Real>(solid.center), Real(solid.padded_square)};
    }
};

/// The plane of a flat sheet, and a padded box around the sheet.
template <class Real>
struct alignas(16) SheetPlane {
    Vec3<Real> normal;
    Real offset;
    uint32_t solid;
    uint32_t flat;
    Vec3<Real> center, half;  // half: infinite if unknown

    CISTULA_INLINE static SheetPlane of(const Solid& solid, uint32_t index) {
        return {Vec3<Real>(solid.plane_normal),        Real(solid.plane_offset), index, solid.flat, Vec3<Real>(Real(0)),
                Vec3<Real>(RealTraits<Real>::infinity)};
    }
};

/// A copy of a convex solid with its number and bounding sphere, which is tested first and rejects most rays.
template <class Real>
struct IndexedSolid {
    BoundingSphere<Real> sphere;
    uint32_t index;
    Solid solid;
};

/// Padding of the squared radius of bounding spheres, so that rounding never makes the sphere test reject a ray that
/// the slabs accept: the terms of the test are at most 64 for lengths within 4 M, each with an error of a few u of
/// float.
inline constexpr float sphere_padding = 0x1p-11f;

/// Padding for distances from a flat sheet's plane: far above the rounding of such a distance, of the sheet's own
/// corners and of a shear.
inline constexpr float plane_padding = 0x1p-10f;

inline constexpr int cluster_lanes = 8;

/// Up to eight neighboring triangles of one solid in structure-of-arrays form, so that eight are tested at once.
template <class Real>
struct alignas(32) Cluster {
    Real corner[3][3][cluster_lanes];  // [corner][axis][lane]; unused lanes hold a zero-area triangle
    uint32_t solid;
    uint32_t count;                    // beside the corners, as every test reads it
    uint32_t triangle[cluster_lanes];  // scene-wide triangle numbers
    Real height[2][cluster_lanes];     // apex height h, [0] on the side normals point away from (inside), [1] outside
};

/// A single triangle, as in the leaves of the device's tree, where a thread tests one at a time. It is the triangle in
/// lane slot % 8 of cluster slot / 8.
template <class Real>
struct alignas(16) Facet {
    Real corner[3][3];  // [corner][axis]
    uint32_t solid, triangle, slot;
};

/// What rays meet at a material's faces.
enum class Transparency : uint32_t {
    opaque,   // none passes: kt tint = 0; with fresnel, (kr + kt) tint = 0. A body of it is no medium
    partial,  // some light passes
    whole,    // of closed solids, with fresnel: kr + kt = 1, white tint, kr > 0: invisible unless the index changes
    clear,    // kr = 0, kt = 1, white tint: likewise, and of sheets, too
};

/// A material. The shares of light are: local 1 - kr - kt, reflected kr, transmitted kt * tint.
template <class Real>
struct Material {
    // The local (Phong) light.
    Vec3<Real> color;
    Vec3<Real> ambient;        // ka * A, with the scene's ambient light A
    Vec3<Real> specular;       // ks * S
    Real diffuse;              // kd
    Real exponent;             // n; used where integer_exponent < 0
    int32_t integer_exponent;  // n if it is an integer in [0, 1024], else -1; 0 where there is no highlight
    Real local;                // max(0, 1 - kr - kt), rounded down
    // What goes on.
    Real reflection;    // kr
    Real transmission;  // kt
    Vec3<Real> filter;  // kt * tint
    Vec3<Real> tint;
    Vec3<Real> absorption;    // per unit of scene-frame length; 0 where no ray passes
    double index;             // index of refraction
    uint64_t filter_loss[3];  // -log2(kt * tint), Q11.52; 0 for opaque channels
    uint32_t opaque;          // bit c: channel c is blocked (kt * tint = 0)
    int32_t texture;          // -1: none
    uint32_t fresnel;         // 0 or 1
    Transparency transparency;
};

/// A point light with an intensity above zero.
template <class Real>
struct Light {
    Vec3<Real> position;
    Vec3<Real> intensity;
    Real clamp_distance;      // 0: no falloff; else 1 / max(distance, clamp_distance)^2
    uint32_t first_incident;  // faces that the light lies on, grouped by solid
    uint32_t incident_count;
};

/// The distance from a plane, relative to M, within which a light lies on a face (docs/rules.md, 5).
template <class Real>
inline constexpr Real incidence = 16 * RealTraits<Real>::unit;

/// A face on which a light lies: slab side 2 slab + side of a convex solid, or a scene-wide triangle number.
struct Incident {
    uint32_t solid;
    uint32_t face;
};

/// A visible light: a sphere of constant radiance that casts no shadow.
template <class Real>
struct VisibleLight {
    Vec3<Real> center;
    Real radius;
    Vec3<Real> radiance;
};

enum class TextureFilter : uint16_t { nearest, bilinear };

/// What lies beyond the edges of a texture along an axis: the texture again, its outermost texels, or its mirror image.
enum class TextureWrap : uint8_t { repeat, clamp, mirror };

/// A texture: linear RGB texels, row 0 at v = 0 (the top of the picture file), continued infinitely.
struct Texture {
    uint32_t width, height;
    uint32_t first_texel;
    TextureFilter filter;
    TextureWrap wrap[2];  // along u, v
    double repeat[2];     // factors of uv
};

enum class SkyKind : uint32_t { none, gradient, picture };

/// A color of a gradient, at an angle to its axis.
struct SkyStop {
    double cosine;
    Vec3<double> color;
};

/// What is around a scene in place of a background of one color.
struct Sky {
    SkyKind kind = SkyKind::none;
    uint32_t texture = 0;                                      // of a picture
    double scale = 1;                                          // of its texels
    Vec3<double> axes[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};  // x, y, z of a picture, unit; a gradient's is the last
};

/// Maximum depth of a tree, and so the size of traversal stacks.
inline constexpr int max_tree_depth = 48;

/// A node of a BVH over primitives, with the padded boxes of both children. A child >= 0 is a node; a child < 0 is a
/// leaf that holds items [~child, ~child + count).
struct alignas(16) TreeNode {
    float low[2][3], high[2][3];
    int32_t child[2];
    uint32_t count[2];
};

/// A node of the four-wide tree over visible lights. Few rays come near a light, so testing four boxes at once pays
/// more than visiting the nearer of two first. Boxes are padded and stored as center and half size, so that their test
/// does not depend on the ray's direction; an absent child has a box of negative size.
struct alignas(16) LightNode {
    static constexpr int width = 4;
    struct alignas(16) Lanes {
        float of[width];
    };
    struct alignas(16) Children {
        int32_t of[width];  // a node, or ~light
    };
    Lanes center[3], half[3];  // by axis
    Children children;

    /// Whether child i exists; absent children have a negative half size.
    CISTULA_HD bool has_child(int i) const { return half[0].of[i] >= 0.0f; }
};

template <class Real>
struct SceneView {
    using Scalar = Real;
    Span<Solid> solids;
    Span<Slab<Real>> slabs;
    Span<SlabGroup<Real>> slab_groups;
    Span<SharedPlane<Real>> shared_planes;  // with the four arrays below: empty where no faces coincide
    Span<uint32_t> slab_planes;             // shared plane of each slab's low and high side, or no_plane
    Span<uint32_t> triangle_planes;         // ... of each triangle, by its scene-wide number
    Span<uint32_t> near_planes, plane_solids;
    Span<Ball<Real>> balls;
    Span<BallPlane<Real>> ball_planes;
    Span<Disk<Real>> disks;
    Span<uint32_t> convex;         // the convex solids, balls too; primitive p < convex.size is convex[p]
    Span<Cluster<Real>> clusters;  // primitive p >= convex.size is clusters[p - convex.size]
    Span<Facet<Real>> facets;      // or, where there are any, facets[p - convex.size]
    Span<Vec2<Real>> uvs;
    Span<Vec3<Real>> normals;  // of smooth meshes
    Span<Material<Real>> materials;
    Span<Light<Real>> lights;
    Span<Incident> incidents;
    Span<VisibleLight<Real>> visible_lights;
    Span<Texture> textures;
    Span<Vec3<float>> texels;
    Span<TreeNode> tree;  // over primitives; may be empty (then brute force or Embree finds hits)
    Span<uint32_t> tree_items;
    Span<LightNode> visible_light_tree;  // over visible_lights; empty where there are few
    Span<uint32_t> light_groups;         // of each of lights
    Span<SkyStop> sky_stops;             // of a gradient
    Sky sky;
    Vec3<Real> background;
    Vec3<Real> bound;    // radiance bound B per channel, at most 1, slack included
    Real largest_bound;  // largest component of bound
    Real extent;         // M: the largest coordinate, in [1, 2)
    bool unseen_faces;   // whether shadow rays may cross faces that rays pass unseen (shadow.h)
};

/// Whether any material absorbs, so that transmittance toward lights varies gradually. Depends on the scene alone, not
/// on the compiled effects, which must not change the image.
template <class Scene>
CISTULA_INLINE bool shades_gradually(const Scene& scene) {
    bool any = false;
    for (uint32_t i = 0; i < scene.materials.size; ++i) any |= largest_component(scene.materials[i].absorption) > 0;
    return any;
}

}  // namespace cistula

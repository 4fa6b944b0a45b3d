// A scene as the shading code sees it: flat arrays, nothing owned, the same layout on host and device.
// Lengths are in the scene's frame (docs/rules.md, 1: centered, scaled by a power of two so that coordinates stay under
// 2); radiances are scaled by a power of two so that the radiance bound is at most 1.
#pragma once

#include "cistula/numerics/vec.h"

namespace cistula {

enum class SolidKind : uint32_t {
    convex,  // slabs; no edges, nothing to leak
    mesh,    // a closed triangle mesh, counter-clockwise seen from outside
    sheet,   // open triangles, seen from both sides, with no inside
};

/// The points with low <= normal.x <= high. A single plane has low = -infinity. Face 2 i is slab i's low side, 2 i + 1
/// its high one.
template <class Real>
struct alignas(16) Slab {  // wide loads
    Vec3<Real> normal;     // unit
    Real low, high;
};

inline constexpr int slab_lanes = 8;

/// Eight slabs side by side, so that the host tests a ray against all at once. Unused lanes have a zero normal and no
/// sides.
template <class Real>
struct alignas(32) SlabGroup {
    Real nx[slab_lanes], ny[slab_lanes], nz[slab_lanes], low[slab_lanes], high[slab_lanes];
    Real light_reach;   // of a solid's first group: no seen light is farther from the solid's edges (edge_lights.h)
    Real light_square;  // ... and the square of the radius of a sphere around them all
    bool lights_apart;  // no light of another solid reaches into this one
};

/// Solids are numbered in file order, which is also the priority of their media: later wins.
struct alignas(16) Solid {
    Vec3<float> center;        // convex: of a sphere around it,
    float padded_square;       // ... and the square of its radius plus sphere_padding
    Vec3<float> plane_normal;  // flat sheet: unit normal of its plane,
    float plane_offset;        // ... and normal.x on it
    SolidKind kind;
    uint32_t material;
    uint32_t first_slab, slab_count;  // convex: its slabs
    uint32_t first_group;             // convex: the same slabs, ceil(slab_count / 8) groups
    uint32_t first_triangle;          // mesh, sheet: scene-wide number of its first triangle
    uint32_t first_uv;                // textured: uvs[first_uv + 3 (triangle - first_triangle) + corner]
    uint32_t flat;     // sheet: 1 if all of it lies in one plane, to within a few u M: a line that starts
                       // on it does not meet it again
    uint32_t touched;  // convex, mesh: 1 if its padded box meets that of another such solid
    uint32_t alone;    // convex: 1 if its padded box meets no other primitive's: whatever a ray inside it
                       // hits next is its own face
};

/// The sphere around a convex solid.
template <class Real>
struct alignas(16) Ball {
    Vec3<Real> center;
    Real padded_square;

    CISTULA_INLINE static Ball of(const Solid& solid) { return {Vec3<Real>(solid.center), Real(solid.padded_square)}; }
};

/// The plane of a flat sheet, and a padded box around what lies in it.
template <class Real>
struct alignas(16) SheetPlane {
    Vec3<Real> normal;
    Real offset;
    uint32_t solid;
    uint32_t flat;
    Vec3<Real> center, half;  // half: infinite where nobody knows

    CISTULA_INLINE static SheetPlane of(const Solid& solid, uint32_t index) {
        return {Vec3<Real>(solid.plane_normal),        Real(solid.plane_offset), index, solid.flat, Vec3<Real>(Real(0)),
                Vec3<Real>(RealTraits<Real>::infinity)};
    }
};

/// A solid, and what is asked of it first: its sphere with the number beside it, as most rays ask for no more.
template <class Real>
struct NumberedSolid {
    Ball<Real> ball;
    uint32_t index;
    Solid solid;
};

/// So much that rounding never turns a ray that the slabs accept into one that passes the sphere by: the terms of the
/// test are at most 64 for lengths within 4 M, and carry an error of a few u of float each.
inline constexpr float sphere_padding = 0x1p-11f;

/// Far above the rounding of a distance from a sheet's plane, of the sheet's own corners from it, and of a shear.
inline constexpr float plane_padding = 0x1p-10f;

inline constexpr int cluster_lanes = 8;

/// Up to eight neighbouring triangles of one solid, corner by corner and axis by axis, so that eight are tested at
/// once.
template <class Real>
struct alignas(32) Cluster {
    Real corner[3][3][cluster_lanes];  // [corner][axis][lane]; unused lanes hold a zero-area triangle
    uint32_t solid;
    uint32_t count;                    // beside the corners, as every test reads it
    uint32_t triangle[cluster_lanes];  // scene-wide triangle numbers
    Real height[2][cluster_lanes];     // apex height h, [0] on the side normals point away from (inside), [1] outside
};

/// A triangle by itself, in whole words: what a tree of the device has in its leaves, since a thread there tests one at
/// a time and reads no more than it tests. The same triangle as lane slot % 8 of cluster slot / 8.
template <class Real>
struct alignas(16) Facet {
    Real corner[3][3];  // [corner][axis]
    uint32_t solid, triangle, slot;
};

/// What of a face's material its own light depends on.
template <class Real>
struct LocalMaterial {
    Vec3<Real> color;
    Vec3<Real> ambient;        // ka * A, the scene's ambient colour taken in
    Vec3<Real> specular;       // ks * S
    Real diffuse;              // kd
    Real exponent;             // n; used where integer_exponent < 0
    int32_t integer_exponent;  // n if it is an integer in [0, 1024], else -1
    Real local;                // max(0, 1 - kr - kt), rounded down
};

/// What a face is made of. Shares: local 1 - kr - kt, reflected kr, transmitted kt * tint.
template <class Real>
struct Material : LocalMaterial<Real> {
    Real reflection;    // kr
    Real transmission;  // kt
    Vec3<Real> filter;  // kt * tint
    Vec3<Real> tint;
    Vec3<Real> absorption;    // per unit of scene-frame length
    double index;             // index of refraction
    uint64_t filter_loss[3];  // -log2(kt * tint), Q11.52; 0 for opaque channels
    uint32_t opaque;          // bit c: channel c does not pass (kt * tint = 0)
    int32_t texture;          // -1: none
    uint32_t fresnel;         // 0 or 1
    uint32_t clear;           // 1: kr = 0, kt = 1, white tint: nothing to shade where the medium does not change either
};

/// A point light that lights (its intensity is not zero).
template <class Real>
struct Light {
    Vec3<Real> position;
    Vec3<Real> intensity;
    Real clamp_distance;      // 0: no falloff; else 1 / max(distance, clamp_distance)^2
    uint32_t first_incident;  // faces that the light lies on, grouped by solid
    uint32_t incident_count;
};

/// A light lies on a face if it is within this much of the plane, as a share of M (docs/rules.md, 5).
template <class Real>
inline constexpr Real incidence = 16 * RealTraits<Real>::unit;

/// A face that a light lies on. face: of a convex solid 2 slab + side, of triangles the scene-wide triangle number.
struct Incident {
    uint32_t solid;
    uint32_t face;
};

/// A light that is seen: a sphere of constant radiance. It casts no shadow.
template <class Real>
struct SeenLight {
    Vec3<Real> center;
    Real radius;
    Vec3<Real> radiance;
};

enum class TextureFilter : uint32_t { nearest, bilinear };

/// Linear RGB texels, row 0 at v = 0 (the top of the picture file), repeated without end.
struct Texture {
    uint32_t width, height;
    uint32_t first_texel;
    TextureFilter filter;
    double repeat[2];  // uv are multiplied by these first
};

/// No tree is deeper, so traversal stacks of this size never run over.
inline constexpr int max_tree_depth = 48;

/// A node of a binary tree over primitives: the boxes of both children, already padded.
/// A child >= 0 is a node; a child < 0 is a leaf that holds items [~child, ~child + count).
struct alignas(16) TreeNode {
    float low[2][3], high[2][3];
    int32_t child[2];
    uint32_t count[2];
};

/// A node of a tree over seen lights: few rays come near one, so that four boxes at a time are worth more than the
/// nearer of two first. Boxes are already padded, and stored so that a ray from any side reads them alike; that of a
/// child that is not there is less than empty.
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

    /// The boxes of others are empty.
    CISTULA_HD bool has_child(int i) const { return half[0].of[i] >= 0.0f; }
};

template <class Real>
struct SceneView {
    using Scalar = Real;
    Span<Solid> solids;
    Span<Slab<Real>> slabs;
    Span<SlabGroup<Real>> slab_groups;
    Span<uint32_t> convex;         // the convex solids; primitive p < convex.size is convex[p]
    Span<Cluster<Real>> clusters;  // primitive p >= convex.size is clusters[p - convex.size]
    Span<Facet<Real>> facets;      // or, where there are any, facets[p - convex.size]
    Span<Vec2<Real>> uvs;
    Span<Material<Real>> materials;
    Span<Light<Real>> lights;
    Span<Incident> incidents;
    Span<SeenLight<Real>> seen_lights;
    Span<Texture> textures;
    Span<Vec3<float>> texels;
    Span<TreeNode> tree;  // over primitives; may be empty (then brute force or Embree finds hits)
    Span<uint32_t> tree_items;
    Span<LightNode> seen_tree;  // over seen_lights; empty where there are few
    Vec3<Real> background;
    Vec3<Real> bound;    // B per channel, at most 1, slack included
    Real largest_bound;  // of these
    Real extent;         // M: the largest coordinate, in [1, 2)
};

/// Whether any body absorbs: what arrives of a light then changes gradually. Asked of the scene, not of the effects
/// that are compiled in, so that these leave the image alone.
template <class Scene>
CISTULA_INLINE bool shades_gradually(const Scene& scene) {
    bool any = false;
    for (uint32_t i = 0; i < scene.materials.size; ++i) any |= largest_component(scene.materials[i].absorption) > 0;
    return any;
}

}  // namespace cistula

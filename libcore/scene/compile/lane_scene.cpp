#include "scene/compile/lane_scene.h"

#include <algorithm>

#include "base/default_rounding.h"
#include "cistula/shading/contact.h"
#include "cistula/transport/pixel.h"
#include "cistula/traversal/bvh.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/constant_scene.h"
#include "scene/compile/scene_copies.h"

namespace cistula {
namespace {

/// The least number of lanes with which rays toward so many clusters of closed meshes are faster than with Embree,
/// which visits fewer nodes. Four lanes take 0.9 of Embree's time at 840 clusters of opaque meshes, 1.1 at 3,750. Rays
/// that were refracted go apart: eight take 0.94 at 138 clusters of transparent ones, 1.02 at 190, 1.2 at 435; sixteen
/// 0.91 and 1.07.
int least_lanes_for(uint32_t opaque, uint32_t transparent) {
    if (transparent > 320) return 32;
    if (transparent > 160) return 16;
    return opaque > 1024 || transparent > 64 ? 8 : 1;
}

template <class Real>
bool fits_lanes(const SceneView<Real>& scene) {
    if (scene.solids.size >= LaneKey::solids) return false;
    uint32_t closed = 0;
    for (const Solid& solid : scene.solids) {
        closed += solid.kind != SolidKind::sheet;
        if (2 * solid.slab_count > LaneKey::faces) return false;
        if (is_disk(solid) && solid.first_triangle > LaneKey::faces) return false;
    }
    if (closed > LaneScene<Real>::most_closed) return false;
    // Rays that start at a contact of a mesh count the meshes around them, one after the other: most of those in glass.
    for (const SharedPlane<Real>& plane : scene.shared_planes)
        for (uint32_t i = 0; i < plane.mesh_count; ++i)
            if (!is_opaque(scene, scene.plane_solids[plane.first_solid + plane.solid_count + i])) return false;
    return std::all_of(scene.clusters.begin(), scene.clusters.end(), [](const Cluster<Real>& cluster) {
        return std::all_of(cluster.triangle, cluster.triangle + cluster.count,
                           [](uint32_t triangle) { return triangle <= LaneKey::faces; });
    });
}

}  // namespace

/// Indices of refraction that are looked for one by one.
constexpr size_t most_indices = 4;

template <class Real>
OwnedLaneScene<Real>::OwnedLaneScene(const SceneView<Real>& from, uint32_t most_with_bits) {
    static_cast<SceneView<Real>&>(scene_) = from;
    number_solids(from, most_with_bits);
    copy_parts();
    find_tree();
    find_columns();
    fill_tables();
}

template <class Real>
void OwnedLaneScene<Real>::number_solids(const SceneView<Real>& from, uint32_t most_with_bits) {
    std::vector<uint32_t> place(from.solids.size);
    for (const bool is_closed : {true, false})
        for (uint32_t i = 0; i < from.solids.size; ++i) {
            if ((from.solids[i].kind != SolidKind::sheet) != is_closed) continue;
            place[i] = static_cast<uint32_t>(numbers_.size());
            if (from.solids[i].kind == SolidKind::convex) convex_.push_back(place[i]);
            scene_.closed += is_closed;
            numbers_.push_back(i);
            solids_.push_back(from.solids[i]);
        }
    places_ = place;
    scene_.named = scene_.closed > most_with_bits;
    clusters_.assign(from.clusters.begin(), from.clusters.end());
    for (Cluster<Real>& cluster : clusters_) cluster.solid = place[cluster.solid];
    incidents_.assign(from.incidents.begin(), from.incidents.end());
    for (Incident& incident : incidents_) incident.solid = place[incident.solid];
    disks_.assign(from.disks.begin(), from.disks.end());
    for (Disk<Real>& disk : disks_) disk.solid = place[disk.solid];
    scene_.disks = span_of(disks_);
    plane_solids_.assign(from.plane_solids.begin(), from.plane_solids.end());
    for (uint32_t& solid : plane_solids_) solid = place[solid];
    scene_.numbers = span_of(numbers_);
    scene_.solids = span_of(solids_);
    scene_.convex = span_of(convex_);
    scene_.places = span_of(places_);
    find_sets(from);
    scene_.clusters = span_of(clusters_);
    scene_.incidents = span_of(incidents_);
    scene_.plane_solids = span_of(plane_solids_);
}

template <class Real>
void OwnedLaneScene<Real>::find_sets(const SceneView<Real>& from) {
    const auto fill = [&](SolidSet& set, const auto& has) {
        std::vector<uint32_t>& each = sets_.emplace_back();
        for (uint32_t i = 0; i < solids_.size(); ++i) {
            const uint32_t is_in_it = has(i) ? 1u : 0u;
            each.push_back(is_in_it);
            set.any |= is_in_it != 0;
            if (i < LaneScene<Real>::most_with_bits) set.bits |= is_in_it << i;
        }
        set.each = span_of(each);
    };
    const auto is_closed = [&](uint32_t i) { return i < scene_.closed; };
    fill(scene_.meshes, [&](uint32_t i) { return solids_[i].kind == SolidKind::mesh; });
    fill(scene_.isolated, [&](uint32_t i) { return solids_[i].kind == SolidKind::convex && solids_[i].isolated != 0; });
    fill(scene_.transparent, [&](uint32_t i) { return is_closed(i) && !is_opaque(from, numbers_[i]); });
    fill(scene_.absorbing, [&](uint32_t i) {
        return is_closed(i) && largest_component(scene_.materials[solids_[i].material].absorption) > Real(0);
    });
    fill(scene_.clear, [&](uint32_t i) { return is_clear(from, numbers_[i]); });
    for (uint32_t i = 0; i < scene_.closed && indices_.size() <= most_indices; ++i) {
        const double index = scene_.materials[solids_[i].material].index;
        const auto same = [&](const SolidsOfIndex& one) { return one.index == index; };
        if (std::none_of(indices_.begin(), indices_.end(), same)) indices_.push_back({index, {}});
    }
    if (indices_.size() > most_indices) indices_.clear();
    for (SolidsOfIndex& one : indices_)
        fill(one.solids,
             [&](uint32_t i) { return is_closed(i) && scene_.materials[solids_[i].material].index == one.index; });
    scene_.indices = span_of(indices_);
    const auto ball = [&](uint32_t i) { return from.balls[solids_[i].first_slab]; };
    fill(scene_.kin, [&](uint32_t i) { return is_ball(solids_[i]) && ball(i).has_kin != 0; });
    fill(scene_.from_balls,
         [&](uint32_t i) { return is_ball(solids_[i]) && (ball(i).plane_count != 0 || ball(i).near_meshes != 0); });
    fill(scene_.transmitting, [&](uint32_t i) { return transmits(from, numbers_[i]); });
}

template <class Real>
void OwnedLaneScene<Real>::copy_parts() {
    uint32_t of_meshes[2] = {};  // opaque, transparent
    for (const Cluster<Real>& cluster : clusters_)
        of_meshes[scene_.transparent.has(cluster.solid)] += scene_.meshes.has(cluster.solid);
    scene_.least_lanes = least_lanes_for(of_meshes[0], of_meshes[1]);
    convex_places_.resize(solids_.size());
    for (const uint32_t i : convex_) {
        convex_places_[i] = static_cast<uint32_t>(convex_copies_.size());
        convex_copies_.push_back(indexed_solid(scene_, i));
    }
    scene_.convex_places = span_of(convex_places_);
    for (uint32_t i = 0; i < clusters_.size(); ++i) planes_.push_back(boxed_plane(scene_, i));
    for (uint32_t slot = 0; slot < clusters_.size() * cluster_lanes; ++slot) sides_.push_back(sides_of(scene_, slot));
    scene_.convex_copies = span_of(convex_copies_);
    scene_.planes = span_of(planes_);
    scene_.sides = span_of(sides_);
    plane_bodies_.resize(scene_.named ? 0 : scene_.shared_planes.size);
    for (uint32_t plane = 0; plane < plane_bodies_.size(); ++plane)
        for (const uint32_t i : convex_) {
            const int side = inner_side(scene_, i, plane);
            (side > 0 ? plane_bodies_[plane].above : plane_bodies_[plane].below) |= uint32_t(side != 0) << i;
        }
    scene_.plane_bodies = span_of(plane_bodies_);
    for (const Material<Real>& material : scene_.materials)
        scene_.has_opaque_fresnel |= material.transparency == Transparency::opaque && bool(material.fresnel);
    cache_transmittances(scene_.materials, scene_.cached_transmittances);
}

template <class Real>
void OwnedLaneScene<Real>::find_tree() {
    scene_.loops = takes_loop(scene_) && !scene_.meshes.any;  // of a mesh, nothing but boxes tells what a ray misses
    if (scene_.loops) {
        scene_.tree = {};
        scene_.tree_items = {};
        return;
    }
    PrimitiveTree tree = primitive_tree(scene_);
    tree_ = std::move(tree.nodes);
    tree_items_ = std::move(tree.items);
    scene_.tree = span_of(tree_);
    scene_.tree_items = span_of(tree_items_);
}

/// Lists balls for the loop, which takes more of them than of other primitives: a miss is some twenty operations.
template <class Real>
void OwnedLaneScene<Real>::find_columns() {
    const size_t others = convex_.size() - scene_.balls.size + clusters_.size();
    if (scene_.named || scene_.meshes.any || scene_.kin.any || others > most_in_loop) return;
    for (const uint32_t i : convex_)
        if (is_ball(solids_[i])) scene_.columns.add(scene_.balls[solids_[i].first_slab], i);
    scene_.loops |= scene_.columns.count > 0;
}

template <class Real>
void OwnedLaneScene<Real>::fill_tables() {
    ShadingTables<Real>& tables = scene_.tables;
    const auto entries = std::size(tables.diffuse.of);
    for (const Solid& solid : solids_)
        shading_.push_back({int32_t(solid.material), int32_t(form_of(solid)), int32_t(solid.first_slab)});
    scene_.shading = span_of(shading_);
    for (size_t i = 0; i < std::min(shading_.size(), entries); ++i) {
        tables.material.of[i] = shading_[i].material;
        tables.form.of[i] = shading_[i].form;
        tables.first_slab.of[i] = shading_[i].first_slab;
    }
    for (uint32_t i = 0; i < std::min<size_t>(scene_.materials.size, entries); ++i) {
        const Material<Real>& material = scene_.materials[i];
        const auto set = [i](auto& table, const auto& value) {
            if constexpr (std::is_array_v<std::remove_reference_t<decltype(table)>>)
                for (int c = 0; c < 3; ++c) table[c].of[i] = value[c];
            else
                table.of[i] = value;
        };
        set(tables.color, material.color);
        set(tables.ambient, material.ambient);
        set(tables.specular, material.specular);
        set(tables.filter, material.filter);
        set(tables.tint, material.tint);
        set(tables.diffuse, material.diffuse);
        set(tables.local, material.local);
        set(tables.reflection, material.reflection);
        set(tables.transmission, material.transmission);
        set(tables.integer_exponent, material.integer_exponent);
        set(tables.fresnel, int(material.fresnel));
        set(tables.texture, material.texture);
    }
}

template <class Real>
size_t OwnedLaneScene<Real>::memory() const {
    const auto bytes = [](const auto&... arrays) { return (... + bytes_of(arrays)); };
    return sizeof *this + bytes(numbers_, places_, convex_, convex_places_, tree_items_, solids_, convex_copies_,
                                shading_, indices_, clusters_, planes_, sides_, incidents_, tree_, plane_solids_,
                                plane_bodies_, disks_);
}

template <class Real>
std::unique_ptr<const OwnedLaneScene<Real>> lane_scene(const SceneView<Real>& scene) {
    if (!fits_lanes(scene)) return nullptr;
    return in_default_rounding([&] { return std::make_unique<const OwnedLaneScene<Real>>(scene); });
}

template <class Real>
bool find_camera_solids(const LaneScene<Real>& scene, FrameView& frame) {
    const SceneView<Real>& view = scene;
    const bool fits = view.tree.empty() ? find_camera_solids(view, BruteIntersector<Real>{view}, frame)
                                        : find_camera_solids(view, BvhIntersector<Real>{view}, frame);
    for (int i = 0; i < 1 << frame.camera_planes; ++i) {
        InteriorList list;
        frame.camera_sides[i].media.for_each([&](uint32_t solid, int count) { list.add(scene.numbers[solid], count); });
        frame.camera_sides[i].media = list;
    }
    return fits;
}

template class OwnedLaneScene<float>;
template class OwnedLaneScene<double>;
template std::unique_ptr<const OwnedLaneScene<float>> lane_scene(const SceneView<float>&);
template std::unique_ptr<const OwnedLaneScene<double>> lane_scene(const SceneView<double>&);
template bool find_camera_solids(const LaneScene<float>&, FrameView&);
template bool find_camera_solids(const LaneScene<double>&, FrameView&);

}  // namespace cistula

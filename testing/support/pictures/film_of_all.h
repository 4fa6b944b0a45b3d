// Films of all of the host's intersectors.
#pragma once

#include "backend_embree/embree/embree_renderer.h"
#include "render/record/film_difference.h"
#include "render/record/film_picture.h"
#include "scene/description/camera_path.h"
#include "testing/support/scene.h"
#include "verify/reference_renderers.h"

namespace cistula::test {

inline Film rendered(Renderer& renderer, const SceneDescription& scene) {
    FrameSettings settings;
    settings.set_size(scene.film.width, scene.film.height);
    settings.depth = scene.depth;
    settings.cutoff = scene.cutoff;
    Film film;
    RenderProgress progress;
    renderer.render(camera_at(scene.camera, 0), settings, film, progress);
    EXPECT_EQ(film.flags, 0u);
    return film;
}

/// The film of all of the host's intersectors.
template <class Real>
Film film_of_all(const SceneDescription& scene) {
    const std::shared_ptr<CompiledScene<Real>> compiled = compile<Real>(scene, true);
    const Film film = rendered(*make_host_renderer<Real>(compiled, HostIntersector::brute), scene);
    const auto differing = [&](Renderer& renderer) {
        return film_difference(rendered(renderer, scene), film).differing;
    };
    EXPECT_EQ(differing(*make_host_renderer<Real>(compiled, HostIntersector::bvh)), 0u) << "bvh";
    EXPECT_EQ(differing(*make_embree_renderer<Real>(compiled, {.always_tree = true})), 0u) << "embree";
    return film;
}

/// The share of pixels that differ by more than half of 1/255 in some channel.
inline double share_apart(const Film& a, const Film& b) {
    const ColorPicture x = to_color(a), y = to_color(b);
    size_t apart = 0;
    for (size_t i = 0; i < x.texels.size(); ++i) {
        float off = 0;
        for (int c = 0; c < 3; ++c) off = std::max(off, std::abs(x.texels[i][c] - y.texels[i][c]));
        apart += off > 0.5f / 255;
    }
    return double(apart) / double(x.texels.size());
}

}  // namespace cistula::test

#include "scene/mirrored_cover.h"

#include <algorithm>

#include "scene/mirror_planes.h"

namespace cistula {

template <class Real>
FrameCover mirrored_cover(const CompiledScene<Real>& scene, const FrameView& frame, const PixelRect& rect) {
    FrameCover cover(rect);
    uint32_t last = no_solid;
    for (const MirrorPlane& mirror : mirror_planes(scene.view())) {
        if (mirror.solid == last || scene.solids[mirror.solid].kind != SolidKind::sheet) continue;
        last = mirror.solid;
        const double side = dot(mirror.normal, frame.camera.position) - mirror.offset;
        FrameView beyond = frame;
        beyond.camera = mirrored(frame.camera, mirror);
        for (const uint32_t solid : scene.convex) {
            const Hull& hull = scene.hulls[solid];
            const bool is_before = std::any_of(hull.points.begin(), hull.points.end(), [&](const Vec3<double>& p) {
                return (dot(mirror.normal, p) - mirror.offset) * side > 0;
            });
            if (is_before) cover.add(solid, hull, double(scene.extent), beyond);
        }
    }
    return cover;
}

template FrameCover mirrored_cover(const CompiledScene<float>&, const FrameView&, const PixelRect&);
template FrameCover mirrored_cover(const CompiledScene<double>&, const FrameView&, const PixelRect&);

}  // namespace cistula

#include "render/frame/frame_hints.h"

#include "base/box.h"
#include "cistula/adaptive/adaptive_pixel.h"

namespace cistula {
namespace {

/// Most hulls that are outlined one by one; a scene of more gets a single box, since outlining each would cost more
/// time than it saves.
constexpr size_t most_hulls = 64;

Hull box_around(const std::vector<Hull>& hulls) {
    Box box;
    for (const Hull& hull : hulls)
        for (const Vec3<double>& p : hull.points) {
            box.add(p - hull.reach);
            box.add(p + hull.reach);
        }
    const auto corners = box.corners();
    return {{corners.begin(), corners.end()}, length(box.high - box.low) < INFINITY ? 0 : INFINITY};
}

template <class Real>
FrameCover frame_cover(const CompiledScene<Real>& scene, const FrameView& frame, const PixelRect& rect) {
    FrameCover cover(rect);
    const double extent = double(scene.extent);
    if (scene.hulls.size() > most_hulls)
        cover.add(FrameCover::Outline::all, box_around(scene.hulls), extent, frame);
    else
        for (size_t i = 0; i < scene.hulls.size(); ++i) cover.add(i, scene.hulls[i], extent, frame);
    if (scene.sky.kind != SkyKind::none) cover.add_all(FrameCover::Outline::all);  // it shows everywhere
    return cover;
}

template <class Real>
BackgroundPixel background_pixel(const CompiledScene<Real>& scene, const FrameView& frame, bool adaptive,
                                 bool checked) {
    const SceneView<Real> view = scene.view();
    BackgroundPixel pixel;
    const auto add_sample = [&](PixelRecord& record) {
        PixelSums<Real>(frame.tree, view, record, pixel.work.flags).add(view.background);
        record.rays += 1;
        pixel.work.rays.primary += 1;
    };
    PixelRecord& record = pixel.record;
    begin_pixel(record);
    if (adaptive) {
        sample_adaptively(frame, checked, record, [&](int, const TreeThreshold&, PixelRecord& taken) {
            begin_pixel(taken);
            add_sample(taken);
            return 0u;
        });
    } else {
        for (int sample = 0; sample < frame.supersample * frame.supersample; ++sample) add_sample(record);
        record.samples = pixel.work.rays.primary;
    }
    pixel.units = units_lost(record, frame.supersample * frame.supersample);
    return pixel;
}

}  // namespace

template <class Real>
FrameHints frame_hints(const CompiledScene<Real>& scene, const FrameView& frame, const FrameSettings& settings) {
    const bool adaptive = settings.adaptive();
    return {frame_cover(scene, frame, settings.crop), background_pixel(scene, frame, adaptive, false),
            background_pixel(scene, frame, adaptive, adaptive), adaptive};
}

template FrameHints frame_hints(const CompiledScene<float>&, const FrameView&, const FrameSettings&);
template FrameHints frame_hints(const CompiledScene<double>&, const FrameView&, const FrameSettings&);

}  // namespace cistula

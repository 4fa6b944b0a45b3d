#include "scene/light_images.h"

#include <algorithm>
#include <cmath>

#include "scene/frame_cover.h"
#include "scene/frame_view.h"
#include "scene/mirror_planes.h"
#include "scene/picture_margins.h"

namespace cistula {
namespace {

/// Images that together hold more pixels, in windows of a mirror or in pictures, are one: any light may show all over
/// it.
constexpr int64_t overlap = 4, straight_overlap = 16;
/// By so much of M a line that was mirrored once may be off, and more: its direction by a few u, its start by some u M.
constexpr double mirrored_share = 0x1p-14;

/// The tangents at which a circle around (x, z) begins and ends, for an eye at the origin that looks along z.
struct Range {
    double low, high;
};
Range range_of(double x, double z, double radius) {
    constexpr double infinity = RealTraits<double>::infinity;
    const double square = x * x + z * z - radius * radius;
    if (!(square > 0)) return {-infinity, infinity};
    const double reach = std::sqrt(square);  // to where lines touch it
    const double z_low = z * reach + x * radius, z_high = z * reach - x * radius;
    return {z_low > 0 ? (x * reach - z * radius) / z_low : -infinity,
            z_high > 0 ? (x * reach + z * radius) / z_high : infinity};
}

/// The whole pixels from `low` to `high`, within [begin, end]; all of these if nobody knows.
void clip(double low, double high, int begin, int end, int& first, int& size) {
    if (!(low <= high)) low = begin, high = end;
    const auto inside = [&](double value) {
        return std::clamp(value, double(begin), double(end));
    };  // whatever fits no int
    first = int(std::floor(inside(low - picture_margin)));
    size = int(std::ceil(inside(high + picture_margin))) - first;
}

int64_t area(const PixelRect& rect) {
    return int64_t{rect.width} * rect.height;
}

/// The pixels around a hull's outline.
PixelRect window_of(const FrameCover& cover, size_t hull) {
    const PixelRect& rect = cover.rect();
    for (const FrameCover::Outline& outline : cover.outlines()) {
        if (outline.hull != hull) continue;
        int left = rect.width, right = 0, top = rect.height, bottom = 0;
        for (size_t i = 0; i < outline.runs.size(); ++i) {
            const PixelRun& run = outline.runs[i];
            const int row = (outline.first_band + int(i)) * FrameCover::band_rows;
            if (run.begin >= run.end) continue;
            left = std::min(left, run.begin), right = std::max(right, run.end);
            top = std::min(top, row), bottom = std::min(row + FrameCover::band_rows, rect.height);
        }
        return {left, top, std::max(right - left, 0), std::max(bottom - top, 0)};
    }
    return {0, 0, rect.width, rect.height};
}

/// Whether the mask that runs asks what mirrors show. Adaptive frames do not: on the CPU they run with all effects, and
/// on devices a warp renders pixels of several blocks.
bool asks_mirrors(uint32_t effects, const FrameSettings& settings, const FrameView& frame) {
    if (settings.adaptive()) return false;
    const uint32_t mask = effect_masks[mask_to_run(effects, settings, frame)];
    return (mask & effect_visible_lights) != 0 && (mask & effect_refraction) == 0;
}

}  // namespace

LitCells::LitCells(const LightImages& images, int width, int height)
    : columns_((images.rect().width + width - 1) / width) {
    constexpr uint64_t straight = uint64_t{1} << MirrorNumbers::straight;
    cells_.push_back({images.knows_mirrors() ? 0 : ~straight});
    if (images.images().empty()) return;
    const auto for_each_cell = [&](const PixelRect& rect, const auto& visit) {
        const int first = rect.x / width, end = (rect.x + rect.width + width - 1) / width;
        for (int row = rect.y / height; row * height < rect.y + rect.height; ++row)
            for (int column = first; column < end; ++column)
                visit(indices_[size_t(row) * size_t(columns_) + size_t(column)]);
    };
    uint64_t unlisted = 0;  // mirrors
    for (const LightImage& image : images.images())
        if (image.light == LightImage::any) unlisted |= uint64_t{1} << image.mirror;
    const auto is_listed = [&](const LightImage& image) { return (unlisted >> image.mirror & 1u) == 0; };

    // How many there are in each cell, and one more where there is any image at all.
    indices_.assign(size_t(columns_) * size_t((images.rect().height + height - 1) / height), 0);
    for (const LightImage& image : images.images()) {
        const uint32_t listed = is_listed(image);
        for_each_cell(image.rect, [&](uint32_t& count) { count = (count == 0 ? 1 : count) + listed; });
    }
    std::vector<uint8_t> has_list = {0};
    uint32_t size = 0;
    for (uint32_t& index : indices_) {
        if (index == 0) continue;
        const uint32_t count = index - 1;
        index = uint32_t(cells_.size());
        cells_.push_back({cells_[0].mirrors, size});
        has_list.push_back(count <= LitCell::most);
        if (has_list.back()) size += count;
    }
    lights_.resize(size);
    for (const LightImage& image : images.images()) {
        const bool listed = is_listed(image);
        for_each_cell(image.rect, [&](uint32_t index) {
            LitCell& cell = cells_[index];
            cell.mirrors |= uint64_t{1} << image.mirror;
            if (listed && has_list[index])
                lights_[cell.first + cell.count++] = ShownLight::of(image.light, image.mirror);
        });
    }
}

LightView::LightView(const FrameView& frame, const Camera& camera, const PixelRect& rect, const PixelRect& window)
    : camera_(camera), window_(window) {
    pixels_ = frame.width / (2 * camera.tan_half_width);
    middle_x_ = frame.width / 2.0 - rect.x;
    middle_y_ = frame.height / 2.0 - rect.y;
    const auto side = [&](double pixels, double& tangent, double& at) {
        tangent = pixels / pixels_;
        at = std::sqrt(1 + tangent * tangent);
    };
    side(window.x - picture_margin - middle_x_, left_, at_left_);
    side(window.x + window.width + picture_margin - middle_x_, right_, at_right_);
    side(middle_y_ - (window.y + window.height + picture_margin), bottom_, at_bottom_);
    side(middle_y_ - (window.y - picture_margin), top_, at_top_);
}

PixelRect LightView::image_of(const Vec3<double>& center, double radius) const {
    const Vec3<double> there = center - camera_.position;
    const double x = dot(there, camera_.right), y = dot(there, camera_.up), z = dot(there, camera_.forward);
    // Behind the eye, or on the outer side of one of the planes through it and a side of the window.
    if (z < -radius || x - left_ * z < -radius * at_left_ || right_ * z - x < -radius * at_right_ ||
        y - bottom_ * z < -radius * at_bottom_ || top_ * z - y < -radius * at_top_)
        return {};
    const Range across = range_of(x, z, radius), upward = range_of(y, z, radius);
    PixelRect image;
    clip(middle_x_ + across.low * pixels_, middle_x_ + across.high * pixels_, window_.x, window_.x + window_.width,
         image.x, image.width);
    clip(middle_y_ - upward.high * pixels_, middle_y_ - upward.low * pixels_, window_.y, window_.y + window_.height,
         image.y, image.height);
    return image.width > 0 && image.height > 0 ? image : PixelRect();
}

template <class Real>
LightImages light_images(const CompiledScene<Real>& scene, const FrameView& frame, const FrameSettings& settings,
                         const FrameCover& cover) {
    LightImages images(cover.rect());
    const double extent = double(scene.extent);
    if (scene.seen_lights.empty()) return images;
    if (scene.seen_lights.size() > ShownLight::most || !margins_suffice(frame, extent)) {
        images.add_everywhere(MirrorNumbers::straight);
        return images;
    }
    // shows(center, reach): whether a ball is in sight at all.
    const auto add = [&](const LightView& view, const PixelRect& window, int64_t most, uint32_t mirror, double growth,
                         const auto& shows) {
        std::vector<LightImage> shown;
        int64_t pixels = 0;
        for (uint32_t i = 0; i < scene.seen_lights.size(); ++i) {
            const Vec3<double> center(scene.seen_lights[i].center);
            const double reach = double(scene.seen_lights[i].radius) + growth;
            if (!shows(center, reach)) continue;
            const PixelRect image = view.image_of(center, reach);
            if (image.width > 0) shown.push_back({image, mirror, i});
            if ((pixels += area(image)) > most) {
                shown = {{window, mirror}};
                break;
            }
        }
        for (const LightImage& image : shown) images.add(image);
    };
    const double growth = picture_growth(frame, extent);
    const PixelRect all = {0, 0, cover.rect().width, cover.rect().height};
    add(LightView(frame, frame.camera, cover.rect(), all), all, straight_overlap * area(all), MirrorNumbers::straight,
        growth, [](const Vec3<double>&, double) { return true; });
    if (!asks_mirrors(scene.effects, settings, frame)) return images;
    const std::vector<MirrorPlane> planes = mirror_planes(scene.view());
    if (!planes.empty()) images.know_mirrors();
    for (const MirrorPlane& mirror : planes) {
        const double side = dot(mirror.normal, frame.camera.position) - mirror.offset;
        const double off = growth + mirrored_share * extent + 2 * mirror.thickness + mirror.shift;
        if (!(magnitude(side) > off)) {  // nobody knows which lights are before it
            images.add_everywhere(mirror.number);
            continue;
        }
        const PixelRect window = window_of(cover, mirror.solid);
        if (area(window) == 0) continue;
        const double toward = side > 0 ? 1 : -1;  // the camera's side, from which lines come and to which they return
        add(LightView(frame, mirrored(frame.camera, mirror), cover.rect(), window), window, overlap * area(window),
            mirror.number, off, [&](const Vec3<double>& center, double reach) {
                return !(toward * (dot(mirror.normal, center) - mirror.offset) < -reach);
            });
    }
    return images;
}

template LightImages light_images(const CompiledScene<float>&, const FrameView&, const FrameSettings&,
                                  const FrameCover&);
template LightImages light_images(const CompiledScene<double>&, const FrameView&, const FrameSettings&,
                                  const FrameCover&);

}  // namespace cistula

#include "scene/frame_cover.h"

#include <algorithm>
#include <cmath>

#include "scene/frame.h"

namespace cistula {
namespace {

/// So much, as a share of M and of the camera's distance, hulls grow: far more than rays and faces are off by rounding, in
/// either precision (NUMERICS, 1 and 2).
constexpr double share_of_extent = 0x1p-16, share_of_distance = 0x1p-44;
/// Beyond these nothing is left out: the margins above would be in doubt.
constexpr double farthest = 0x1p40, widest_tangent = 256;
/// Hulls are cut this share of that in front of the camera. What they have nearer, in a view no wider than the above, is so
/// near that the grown hull holds the camera, and is cut to an outline wider than the view.
constexpr double share_of_growth = 0x1p-12;
/// Around outlines, in pixels: their corners are rounded in double.
constexpr double margin = 0x1p-6;
/// Scenes of more hulls are covered by one box: to outline each would take longer than it spares.
constexpr size_t most_hulls = 64;
/// ... and lights of more are looked for everywhere.
constexpr size_t most_lights = 1024;

double cross(double ax, double ay, double bx, double by) {
    return ax * by - ay * bx;
}

/// The corners of the convex hull, in order (Andrew's monotone chain, 1979). Reorders `points`.
template <class Point>
std::vector<Point> convex_outline(std::vector<Point>& points) {
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<Point> outline;
    const auto add = [&](const Point& p, size_t fewest) {
        while (outline.size() >= fewest + 2) {
            const Point &b = outline.back(), &a = outline[outline.size() - 2];
            if (cross(b.x - a.x, b.y - a.y, p.x - b.x, p.y - b.y) > 0) break;
            outline.pop_back();
        }
        outline.push_back(p);
    };
    for (const Point& p : points) add(p, 0);
    const size_t lower = outline.size() - 1;
    for (size_t i = points.size(); i-- > 0;) add(points[i], lower);
    return outline;
}

Hull box_around(const std::vector<Hull>& hulls) {
    Box box;
    for (const Hull& hull : hulls)
        for (const Vec3<double>& p : hull.points) {
            box.add(p - hull.reach);
            box.add(p + hull.reach);
        }
    const auto corners = box.corners();
    return {{corners.begin(), corners.end()}, 0};
}

}  // namespace

size_t FrameCover::pixels() const {
    size_t columns = 0;
    for (const std::vector<PixelRun>& runs : bands_)
        for (const PixelRun& run : runs) columns += size_t(run.end - run.begin);
    return columns * band_rows;
}

void FrameCover::add_all(size_t number) {
    add({number, 0, std::vector<PixelRun>(bands_.size(), {0, rect_.width})});
}

void FrameCover::add(size_t number, const Hull& hull, double extent, const FrameView& frame) {
    std::optional<std::vector<Point>> points = projected(hull, extent, frame);
    if (!points) return add_all(number);
    add(filled(number, points->empty() ? *points : convex_outline(*points)));
}

void FrameCover::add_all_lights() {
    lights_ = {{0, 0, rect_.width, rect_.height}};
}

void FrameCover::add_light(const Hull& ball, double extent, const FrameView& frame) {
    const std::optional<std::vector<Point>> points = projected(ball, extent, frame);
    if (!points) return add_all_lights();
    if (points->empty()) return;
    double left = rect_.width, right = 0, top = rect_.height, bottom = 0;
    for (const Point& p : *points) {
        left = std::min(left, p.x - margin), right = std::max(right, p.x + margin);
        top = std::min(top, p.y - margin), bottom = std::max(bottom, p.y + margin);
    }
    const auto inside = [](double value, int size) { return std::clamp(value, 0.0, double(size)); };  // whatever fits no int
    const int x = int(std::floor(inside(left, rect_.width))), y = int(std::floor(inside(top, rect_.height)));
    const int width = int(std::ceil(inside(right, rect_.width))) - x, height = int(std::ceil(inside(bottom, rect_.height))) - y;
    if (width > 0 && height > 0) lights_.push_back({x, y, width, height});
}

/// The corners of what shows of a hull, and points between them; none where it is all behind the camera. Nothing where they
/// are in doubt.
std::optional<std::vector<FrameCover::Point>> FrameCover::projected(const Hull& hull, double extent, const FrameView& frame) const {
    const Camera& camera = frame.camera;
    const double distance = length(camera.position), tangent = camera.tan_half_width;
    const bool is_sure = distance <= farthest * extent && tangent * std::max(1.0, double(frame.height) / frame.width) <= widest_tangent;
    if (!is_sure) return {};
    const double growth = share_of_extent * extent + share_of_distance * distance;
    const double reach = hull.reach + growth, nearest = share_of_growth * growth;
    std::vector<Vec3<double>> ahead, behind;  // along right, up and forward; cubes instead of balls
    for (const Vec3<double>& point : hull.points) {
        const Vec3<double> there = point - camera.position;
        const Vec3<double> p(dot(there, camera.right), dot(there, camera.up), dot(there, camera.forward));
        for (const Vec3<double>& q : Box{p - reach, p + reach}.corners()) (q.z < nearest ? behind : ahead).push_back(q);
    }
    const double pixels = frame.width / (2 * tangent);  // to tangent 1
    std::vector<Point> points;
    const auto put = [&](const Vec3<double>& p) {
        points.push_back({frame.width / 2.0 + p.x / p.z * pixels - rect_.x, frame.height / 2.0 - p.y / p.z * pixels - rect_.y});
    };
    for (const Vec3<double>& a : ahead) {
        put(a);
        for (const Vec3<double>& b : behind) {
            const double s = (a.z - nearest) / (a.z - b.z);
            put({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), nearest});
        }
    }
    const bool is_known = std::all_of(points.begin(), points.end(), [](const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
    return is_known ? std::optional(points) : std::nullopt;
}

FrameCover::Outline FrameCover::filled(size_t number, const std::vector<Point>& corners) const {
    double highest = RealTraits<double>::infinity, lowest = -highest;  // rows count down
    for (const Point& p : corners) {
        highest = std::min(highest, p.y - margin);
        lowest = std::max(lowest, p.y + margin);
    }
    const double first_band = std::max(std::floor(highest / band_rows), 0.0);
    const double last_band = std::min(std::floor(lowest / band_rows), double(bands_.size()) - 1);
    Outline outline{number, 0, {}};
    if (!(first_band <= last_band)) return outline;
    struct Reach {
        double low = RealTraits<double>::infinity, high = -RealTraits<double>::infinity;
    };
    std::vector<Reach> reached(size_t(last_band - first_band) + 1);
    for (size_t i = 0; i < corners.size(); ++i) {
        const Point &a = corners[i], &b = corners[(i + 1) % corners.size()];
        const double top = std::min(a.y, b.y), bottom = std::max(a.y, b.y);
        const double first = std::max(std::floor((top - margin) / band_rows), first_band);
        const double last = std::min(std::floor((bottom + margin) / band_rows), last_band);
        for (double band = first; band <= last; ++band) {
            // The part of the side in the band's rows and a margin above and below.
            const auto x_at = [&](double y) {
                if (y <= top || y >= bottom) return (y <= top) == (a.y <= b.y) ? a.x : b.x;
                return a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
            };
            Reach& reach = reached[size_t(band - first_band)];
            for (const double x : {x_at(band * band_rows - margin), x_at((band + 1) * band_rows + margin)}) {
                reach.low = std::min(reach.low, x);
                reach.high = std::max(reach.high, x);
            }
            if (top == bottom) {
                reach.low = std::min({reach.low, a.x, b.x});
                reach.high = std::max({reach.high, a.x, b.x});
            }
        }
    }
    outline.first_band = int(first_band);
    for (const Reach& reach : reached) {
        const double low = std::floor(reach.low - margin), high = std::ceil(reach.high + margin);
        const bool any = low < rect_.width && high > 0;
        outline.runs.push_back(any ? PixelRun{int(std::max(low, 0.0)), int(std::min(high, double(rect_.width)))} : PixelRun());
    }
    return outline;
}

void FrameCover::add(Outline outline) {
    for (size_t i = 0; i < outline.runs.size(); ++i) {
        PixelRun run = outline.runs[i];
        if (run.begin == run.end) continue;
        std::vector<PixelRun>& runs = bands_[size_t(outline.first_band) + i];
        // Those that it meets become part of it.
        const auto begin = std::find_if(runs.begin(), runs.end(), [&](const PixelRun& r) { return r.end >= run.begin; });
        const auto end = std::find_if(begin, runs.end(), [&](const PixelRun& r) { return r.begin > run.end; });
        for (auto r = begin; r != end; ++r) run = {std::min(run.begin, r->begin), std::max(run.end, r->end)};
        runs.insert(runs.erase(begin, end), run);
    }
    outlines_.push_back(std::move(outline));
}

namespace {

template <class Real>
FrameCover frame_cover(const CompiledScene<Real>& scene, const FrameView& frame, const PixelRect& rect) {
    FrameCover cover(rect);
    const double extent = double(scene.extent);
    if (scene.hulls.size() > most_hulls)
        cover.add(FrameCover::Outline::all, box_around(scene.hulls), extent, frame);
    else
        for (size_t i = 0; i < scene.hulls.size(); ++i) cover.add(i, scene.hulls[i], extent, frame);
    if (scene.seen_lights.size() > most_lights)
        cover.add_all_lights();
    else
        for (const SeenLight<Real>& light : scene.seen_lights)
            cover.add_light({{Vec3<double>(light.center)}, double(light.radius)}, extent, frame);
    return cover;
}

template <class Real>
BackgroundPixel background_pixel(const CompiledScene<Real>& scene, const FrameView& frame, bool adaptive) {
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
        sample_adaptively(frame.lattice, record, [&](int, PixelRecord& taken) {
            begin_pixel(taken);
            add_sample(taken);
            return 0u;
        });
    } else {
        for (int sample = 0; sample < frame.supersample * frame.supersample; ++sample) add_sample(record);
        record.samples = pixel.work.rays.primary;
    }
    return pixel;
}

}  // namespace

template <class Real>
FrameContents frame_contents(const CompiledScene<Real>& scene, const FrameView& frame, const FrameSettings& settings) {
    return {frame_cover(scene, frame, settings.crop), background_pixel(scene, frame, settings.adaptive())};
}

template FrameContents frame_contents(const CompiledScene<float>&, const FrameView&, const FrameSettings&);
template FrameContents frame_contents(const CompiledScene<double>&, const FrameView&, const FrameSettings&);

}  // namespace cistula

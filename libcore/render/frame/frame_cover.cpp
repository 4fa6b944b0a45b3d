#include "render/frame/frame_cover.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "cistula/transport/pixel.h"

namespace cistula {
namespace {

// ---- margins by which projected outlines are enlarged, so that rounding moves nothing out of them

/// Margin around projected outlines in pixels, for the rounding of the projection in double.
constexpr double picture_margin = 0x1p-6;

/// Growth of projected bodies in the frame of reference: far above the rounding of rays and faces in either precision
/// (docs/rules.md, 1 and 2). `extent`: the scene's M.
double picture_growth(const FrameView& frame, double extent) {
    constexpr double share_of_extent = 0x1p-16;
    constexpr double share_of_distance = 0x1p-44;
    return share_of_extent * extent + share_of_distance * length(frame.camera.position);
}

/// Whether the margins suffice; they do not for cameras very far away or with very wide views.
bool margins_suffice(const FrameView& frame, double extent) {
    constexpr double farthest = 0x1p40;
    constexpr double widest_tangent = 256;
    return length(frame.camera.position) <= farthest * extent &&
           frame.camera.tan_half_width * std::max(1.0, double(frame.height) / frame.width) <= widest_tangent;
}

// ---- outlines

/// Distance of the near plane that clips hulls, as a share of their growth. Any part of a hull that is nearer, in a
/// view allowed by margins_suffice, is so near that the grown hull contains the camera and its outline is wider than
/// the view.
constexpr double share_of_growth = 0x1p-12;

/// Positive where the way from one step to the next turns to the left.
double turn(double ax, double ay, double bx, double by) {
    return ax * by - ay * bx;
}

/// The corners of the convex hull in order (Andrew's monotone chain, 1979). Reorders `points`.
template <class Point>
std::vector<Point> convex_outline(std::vector<Point>& points) {
    std::sort(points.begin(), points.end(),
              [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<Point> outline;
    const auto add = [&](const Point& p, size_t fewest) {
        while (outline.size() >= fewest + 2) {
            const Point &b = outline.back(), &a = outline[outline.size() - 2];
            if (turn(b.x - a.x, b.y - a.y, p.x - b.x, p.y - b.y) > 0) break;
            outline.pop_back();
        }
        outline.push_back(p);
    };
    for (const Point& p : points) add(p, 0);
    const size_t lower = outline.size() - 1;
    for (size_t i = points.size(); i-- > 0;) add(points[i], lower);
    return outline;
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
    std::optional<std::vector<Point>> points;
    if (hull.reach <= RealTraits<double>::largest) points = projected(hull, extent, frame);
    if (!points) return add_all(number);
    add(filled(number, points->empty() ? *points : convex_outline(*points)));
}

/// The projected corners of a hull, clipped in front of the camera, and points between them; no points if it is all
/// behind the camera. Nothing if they are in doubt.
std::optional<std::vector<FrameCover::Point>> FrameCover::projected(const Hull& hull, double extent,
                                                                    const FrameView& frame) const {
    const Camera& camera = frame.camera;
    if (!margins_suffice(frame, extent)) return {};
    const double growth = picture_growth(frame, extent);
    const double reach = hull.reach + growth;
    const double nearest = share_of_growth * growth;
    std::vector<Vec3<double>> ahead, behind;  // along right, up and forward; cubes instead of balls
    for (const Vec3<double>& point : hull.points) {
        const Vec3<double> there = point - camera.position;
        const Vec3<double> p(dot(there, camera.right), dot(there, camera.up), dot(there, camera.forward));
        for (const Vec3<double>& q : Box{p - reach, p + reach}.corners()) (q.z < nearest ? behind : ahead).push_back(q);
    }
    const double pixels = frame.width / (2 * camera.tan_half_width);  // of a tangent of 1
    std::vector<Point> points;
    const auto put = [&](const Vec3<double>& p) {
        points.push_back(
            {frame.width / 2.0 + p.x / p.z * pixels - rect_.x, frame.height / 2.0 - p.y / p.z * pixels - rect_.y});
    };
    for (const Vec3<double>& a : ahead) {
        put(a);
        for (const Vec3<double>& b : behind) {
            const double s = (a.z - nearest) / (a.z - b.z);
            put({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), nearest});
        }
    }
    const bool is_known = std::all_of(points.begin(), points.end(),
                                      [](const Point& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
    return is_known ? std::optional(points) : std::nullopt;
}

FrameCover::Outline FrameCover::filled(size_t number, const std::vector<Point>& corners) const {
    double highest = RealTraits<double>::infinity, lowest = -highest;  // rows are numbered downward
    for (const Point& p : corners) {
        highest = std::min(highest, p.y - picture_margin);
        lowest = std::max(lowest, p.y + picture_margin);
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
        const double top = std::min(a.y, b.y);
        const double bottom = std::max(a.y, b.y);
        const double first = std::max(std::floor((top - picture_margin) / band_rows), first_band);
        const double last = std::min(std::floor((bottom + picture_margin) / band_rows), last_band);
        for (double band = first; band <= last; ++band) {
            // The part of the side within the band's rows and a margin above and below.
            const auto x_at = [&](double y) {
                if (y <= top || y >= bottom) return (y <= top) == (a.y <= b.y) ? a.x : b.x;
                return a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
            };
            Reach& reach = reached[size_t(band - first_band)];
            for (const double x :
                 {x_at(band * band_rows - picture_margin), x_at((band + 1) * band_rows + picture_margin)}) {
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
        const double low = std::floor(reach.low - picture_margin);
        const double high = std::ceil(reach.high + picture_margin);
        const bool any = low < rect_.width && high > 0;
        outline.runs.push_back(any ? PixelRun{int(std::max(low, 0.0)), int(std::min(high, double(rect_.width)))}
                                   : PixelRun());
    }
    return outline;
}

void FrameCover::add(Outline outline) {
    for (size_t i = 0; i < outline.runs.size(); ++i) {
        PixelRun run = outline.runs[i];
        if (run.begin == run.end) continue;
        std::vector<PixelRun>& runs = bands_[size_t(outline.first_band) + i];
        // Runs that overlap the new one are merged with it.
        const auto begin =
            std::find_if(runs.begin(), runs.end(), [&](const PixelRun& r) { return r.end >= run.begin; });
        const auto end = std::find_if(begin, runs.end(), [&](const PixelRun& r) { return r.begin > run.end; });
        for (auto r = begin; r != end; ++r) run = {std::min(run.begin, r->begin), std::max(run.end, r->end)};
        runs.insert(runs.erase(begin, end), run);
    }
    outlines_.push_back(std::move(outline));
}

}  // namespace cistula

#include "compare/metrics/channel_statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image/color/srgb_codes.h"

namespace cistula {
namespace {

/// The weights of a window in one direction, of sum 1; a pixel's is the product of two. A region of fewer than 11
/// pixels has windows of its size.
std::vector<double> gaussian(int size) {
    constexpr double sigma = 1.5;
    std::vector<double> weights(static_cast<size_t>(std::min(size, 11)));
    const double middle = static_cast<double>(weights.size() - 1) / 2;
    double sum = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        const double away = static_cast<double>(i) - middle;
        sum += weights[i] = std::exp(-away * away / (2 * sigma * sigma));
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

bool is_shown(const StoredChannel& channel) {
    if (largest_code(channel.type) > 0) return true;
    if (channel.type == StoredType::uint) return false;
    const std::string& name = channel.name;
    const std::string last = name.substr(name.rfind('.') + 1);  // npos + 1 is 0
    return last == "R" || last == "G" || last == "B" || name == "Y";
}

/// A row of a region as shades from 0 to 1.
void read_row(const PlacedChannel& placed, const PixelRect& window, int row, std::vector<double>& shades) {
    const size_t first = placed.data.index(window.x, window.y + row);
    const double largest = largest_code(placed.channel.type);
    std::visit(
        [&](const auto& values) {
            for (size_t i = 0; i < shades.size(); ++i) {
                const auto value = values[first + i];
                shades[i] = largest > 0 ? static_cast<double>(value) / largest
                                        : srgb8_from_linear(static_cast<float>(value)) / 255.0;
            }
        },
        placed.channel.values);
}

/// Means over windows of one row: of both channels, of their squares, of their product.
struct Moments {
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    void add(double weight, const Moments& other) {
        a += weight * other.a;
        b += weight * other.b;
        aa += weight * other.aa;
        bb += weight * other.bb;
        ab += weight * other.ab;
    }
    double ssim() const {
        constexpr double c1 = 0.01 * 0.01;
        constexpr double c2 = 0.03 * 0.03;
        const double a_variance = aa - a * a;
        const double b_variance = bb - b * b;
        const double covariance = ab - a * b;
        return (2 * a * b + c1) * (2 * covariance + c2) / ((a * a + b * b + c1) * (a_variance + b_variance + c2));
    }
};

/// The last rows of a region, as many as a window has.
class Rows {
  public:
    Rows(const PlacedChannel& a, const PlacedChannel& b, const Region& region)
        : a_(a),
          b_(b),
          region_(region),
          width_(static_cast<size_t>(region.window.width)),
          a_shades_(width_),
          b_shades_(width_),
          across_(gaussian(region.window.width)),
          down_(gaussian(region.window.height)),
          moments_(down_.size(), std::vector<Moments>(windows())),
          missing_(down_.size(), std::vector<int>(windows())) {}

    size_t windows() const { return width_ - across_.size() + 1; }
    int height() const { return static_cast<int>(down_.size()); }

    void read(int row) {
        read_row(a_, region_.window, row, a_shades_);
        read_row(b_, region_.window, row, b_shades_);
        const size_t slot = static_cast<size_t>(row) % down_.size();
        const size_t start = static_cast<size_t>(row) * width_;
        for (size_t x = 0; x < windows(); ++x) {
            Moments sum;
            int missing = 0;
            for (size_t i = 0; i < across_.size(); ++i) {
                const double p = a_shades_[x + i];
                const double q = b_shades_[x + i];
                sum.add(across_[i], {p, q, p * p, q * q, p * q});
                missing += !region_.counts_at(start + x + i);
            }
            moments_[slot][x] = sum;
            missing_[slot][x] = missing;
        }
    }

    /// Whether all pixels of the window that ends in `row` count; its moments are added to `sum` then.
    bool window(int row, size_t x, Moments& sum) const {
        for (size_t i = 0; i < down_.size(); ++i) {
            const size_t slot = (static_cast<size_t>(row) + 1 + i) % down_.size();  // the first row of the window
            if (missing_[slot][x] > 0) return false;
            sum.add(down_[i], moments_[slot][x]);
        }
        return true;
    }

  private:
    const PlacedChannel &a_, &b_;
    const Region& region_;
    size_t width_;
    std::vector<double> a_shades_, b_shades_;
    const std::vector<double> across_, down_;  // weights
    std::vector<std::vector<Moments>> moments_;
    std::vector<std::vector<int>> missing_;
};

}  // namespace

std::optional<double> ssim_of(const PlacedChannel& a, const PlacedChannel& b, const Region& region) {
    const PixelRect& window = region.window;
    if (!is_shown(a.channel) || !is_shown(b.channel)) return std::nullopt;
    Rows rows(a, b, region);
    double sum = 0;
    size_t count = 0;
    for (int row = 0; row < window.height; ++row) {
        rows.read(row);
        if (row < rows.height() - 1) continue;
        for (size_t x = 0; x < rows.windows(); ++x) {
            Moments moments;
            if (!rows.window(row, x, moments)) continue;
            sum += moments.ssim();
            ++count;
        }
    }
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
}

}  // namespace cistula

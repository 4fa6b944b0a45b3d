#include "compare/metrics/channel_statistics.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

namespace cistula {
namespace {

using Doubles = std::vector<double>;

/// The values as numbers, codes as fractions of their largest.
Doubles numbers_of(const StoredChannel& channel) {
    const double largest = largest_code(channel.type);
    return std::visit(
        [&](const auto& values) {
            Doubles numbers(values.begin(), values.end());
            if (largest > 0)
                for (double& number : numbers) number /= largest;
            return numbers;
        },
        channel.values);
}

/// Calls `work` with the values of both channels, in one type.
template <class Work>
void with_values(const StoredChannel& a, const StoredChannel& b, Work work) {
    if (a.type != b.type &&
        (largest_code(a.type) > 0 || largest_code(b.type) > 0 || a.values.index() != b.values.index()))
        return work(numbers_of(a), numbers_of(b));
    std::visit([&](const auto& values) { work(values, std::get<std::decay_t<decltype(values)>>(b.values)); }, a.values);
}

template <class Value>
uint64_t bits_of(Value value) {
    if constexpr (std::is_same_v<Value, float>)
        return std::bit_cast<uint32_t>(value);
    else if constexpr (std::is_same_v<Value, double>)
        return std::bit_cast<uint64_t>(value);
    else
        return static_cast<uint64_t>(value);
}

/// Calls `visit(x, y, i)` for the pixels that count, i in the region's window.
template <class Visit>
void for_each_pixel(const Region& region, Visit visit) {
    const PixelRect& window = region.window;
    size_t i = 0;
    for (int y = window.y; y - window.y < window.height; ++y)
        for (int x = window.x; x - window.x < window.width; ++x, ++i)
            if (region.counts_at(i)) visit(x, y, i);
}

template <class Values>
void add_statistics(ChannelStatistics& result, const Values& first, const PlacedChannel& a, const Values& second,
                    const PlacedChannel& b, const Region& region, Doubles& worst_of_pixels) {
    const int x_step = std::min(a.channel.x_sampling, b.channel.x_sampling);
    const int y_step = std::min(a.channel.y_sampling, b.channel.y_sampling);
    // As integers, codes have the peak and the scale of their type.
    const double largest = result.unit() == DifferenceUnit::integer ? largest_code(result.first_type) : 0;
    const double scale = largest > 0 ? 1 / largest : 1;
    double sum = 0, squares = 0, relative = 0, peak = std::max(largest, 1.0);
    bool is_placed = false;
    for_each_pixel(region, [&](int x, int y, size_t i) {
        const auto p = first[a.data.index(x, y)];
        const auto q = second[b.data.index(x, y)];
        const auto p_value = static_cast<double>(p);
        const auto q_value = static_cast<double>(q);
        const bool is_equal = bits_of(p) == bits_of(q);
        const double d = is_equal ? 0 : difference(p_value, q_value);
        worst_of_pixels[i] = std::max(worst_of_pixels[i], d);
        if (x % x_step != 0 || y % y_step != 0) return;  // repeats a value
        ++result.values;
        for (const double value : {p_value, q_value})
            if (std::isfinite(value)) peak = std::max(peak, std::abs(value));
        if (!std::isfinite(p_value) || !std::isfinite(q_value)) {
            NonfiniteValues& found = d > 0 ? result.nonfinite_other : result.nonfinite_alike;
            if (found.count++ == 0) found = {1, x, y, p_value, q_value};
        }
        if (is_equal) return;
        ++result.differing;
        if (!is_placed || d > result.max) {
            is_placed = true;
            result.x = x;
            result.y = y;
            result.a = p_value;
            result.b = q_value;
            result.a_bits = bits_of(p);
            result.b_bits = bits_of(q);
        }
        result.max = std::max(result.max, d);
        if (std::isinf(d)) {
            ++result.infinite;
            return;
        }
        sum += d;
        squares += d * d;
        if (d > 0) relative += d * d * scale * scale / (p_value * p_value * scale * scale + 0.01);
    });
    if (const auto counted = static_cast<double>(result.values - result.infinite); counted > 0) {
        result.mean = sum / counted;
        result.rmse = std::sqrt(squares / counted);
        result.relative_mse = relative / counted;
    }
    if (result.rmse > 0) result.psnr = 20 * std::log10(peak / result.rmse);
}

}  // namespace

double difference(double a, double b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b) ? 0 : INFINITY;
    return a == b ? 0 : std::abs(a - b);
}

DifferenceUnit ChannelStatistics::unit() const {
    const bool codes = largest_code(first_type) > 0 || largest_code(second_type) > 0;
    if (first_type != second_type) return codes ? DifferenceUnit::fraction : DifferenceUnit::value;
    return codes || first_type == StoredType::uint ? DifferenceUnit::integer : DifferenceUnit::value;
}

ChannelStatistics statistics_of(const PlacedChannel& a, const PlacedChannel& b, const Region& region,
                                Doubles& worst_of_pixels) {
    ChannelStatistics result;
    result.name = a.channel.name;
    result.first_type = a.channel.type;
    result.second_type = b.channel.type;
    with_values(a.channel, b.channel, [&](const auto& first, const auto& second) {
        add_statistics(result, first, a, second, b, region, worst_of_pixels);
    });
    return result;
}

std::vector<float> differences_of(const PlacedChannel& a, const PlacedChannel& b, const Region& region) {
    std::vector<float> differences(region.window.pixels());
    with_values(a.channel, b.channel, [&](const auto& first, const auto& second) {
        for_each_pixel(region, [&](int x, int y, size_t i) {
            differences[i] = static_cast<float>(difference(static_cast<double>(first[a.data.index(x, y)]),
                                                           static_cast<double>(second[b.data.index(x, y)])));
        });
    });
    return differences;
}

}  // namespace cistula

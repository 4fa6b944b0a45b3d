#include "metrics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cistula::report {
namespace {

/// Every pixel's difference in the channel where it is largest.
std::vector<double> largest_differences(const Picture& picture, const Picture& reference) {
    if (picture.width != reference.width || picture.height != reference.height || picture.pixels.empty() ||
        picture.pixels.size() != reference.pixels.size())
        throw std::invalid_argument("two pictures of one size are compared");
    std::vector<double> largest(picture.pixels.size());
    for (size_t i = 0; i < largest.size(); ++i)
        for (size_t c = 0; c < 3; ++c)
            largest[i] = std::max(largest[i], std::abs(picture.pixels[i][c] - reference.pixels[i][c]));
    return largest;
}

}  // namespace

double Metrics::psnr() const {
    return rmse > 0 ? 20 * std::log10(peak / rmse) : INFINITY;
}

Picture resolve_picture(const Film& film) {
    const double unit = film.unit();
    Picture picture{film.rect.width, film.rect.height, {}};
    picture.pixels.reserve(film.pixels.size());
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelRadiance& pixel = film.pixels.radiance(i);
        picture.pixels.push_back({static_cast<double>(pixel.radiance[0]) * unit,
                                  static_cast<double>(pixel.radiance[1]) * unit,
                                  static_cast<double>(pixel.radiance[2]) * unit});
    }
    return picture;
}

Remainder remainder_of(const Film& film) {
    const double unit = film.unit();
    Remainder remainder;
    double sum = 0, squares = 0;
    for (const PixelRecord& pixel : film.pixels)
        for (int c = 0; c < 3; ++c) {
            const double value = (static_cast<double>(pixel.pruned[c]) + static_cast<double>(pixel.cut[c]) +
                                  static_cast<double>(film.units_lost(pixel))) *
                                 unit;
            sum += value;
            squares += value * value;
            remainder.max = std::max(remainder.max, value);
        }
    const double count = 3 * static_cast<double>(film.pixels.size());
    if (count > 0) remainder.mean = sum / count, remainder.rms = std::sqrt(squares / count);
    return remainder;
}

Metrics compare_with(const Picture& picture, const Picture& reference) {
    std::vector<double> largest = largest_differences(picture, reference);
    Metrics metrics;
    double squares = 0, relative = 0;
    size_t over = 0, worst = 0;
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        for (size_t c = 0; c < 3; ++c) {
            const double here = picture.pixels[i][c], there = reference.pixels[i][c];
            const double square = (here - there) * (here - there);
            squares += square;
            relative += square / (there * there + relative_epsilon);
            metrics.peak = std::max(metrics.peak, there);
        }
        if (largest[i] > half_code) ++over;
        if (largest[i] > metrics.max) metrics.max = largest[i], worst = i;
    }
    const double pixels = static_cast<double>(picture.pixels.size());
    metrics.rmse = std::sqrt(squares / (3 * pixels));
    metrics.relative_mse = relative / (3 * pixels);
    metrics.over_half_code = static_cast<double>(over) / pixels;
    metrics.worst_x = static_cast<int>(worst % static_cast<size_t>(picture.width));
    metrics.worst_y = static_cast<int>(worst / static_cast<size_t>(picture.width));
    metrics.worst_here = picture.pixels[worst];
    metrics.worst_reference = reference.pixels[worst];
    const size_t others = largest.size() / 1000;  // number of pixels above the 99.9th percentile
    const auto place = largest.end() - 1 - static_cast<std::ptrdiff_t>(others);
    std::nth_element(largest.begin(), place, largest.end());
    metrics.p999 = *place;
    return metrics;
}

double share_over(double error, const Picture& picture, const Picture& reference) {
    const std::vector<double> largest = largest_differences(picture, reference);
    const auto over = std::count_if(largest.begin(), largest.end(), [error](double one) { return one > error; });
    return static_cast<double>(over) / static_cast<double>(largest.size());
}

void to_json(Json& json, const Metrics& metrics) {
    json = {{"max", metrics.max},
            {"rmse", metrics.rmse},
            {"p999", metrics.p999},
            {"relative_mse", metrics.relative_mse},
            {"peak", metrics.peak},
            {"over_half_code", metrics.over_half_code},
            {"worst",
             {{"x", metrics.worst_x},
              {"y", metrics.worst_y},
              {"here", metrics.worst_here},
              {"reference", metrics.worst_reference}}}};
    if (metrics.rmse > 0)
        json["psnr"] = metrics.psnr();
    else
        json["psnr"] = "inf";  // JSON has no infinities
}

void from_json(const Json& json, Metrics& metrics) {
    json.at("max").get_to(metrics.max);
    json.at("rmse").get_to(metrics.rmse);
    json.at("p999").get_to(metrics.p999);
    json.at("relative_mse").get_to(metrics.relative_mse);
    json.at("peak").get_to(metrics.peak);
    json.at("over_half_code").get_to(metrics.over_half_code);
    const Json& worst = json.at("worst");
    worst.at("x").get_to(metrics.worst_x);
    worst.at("y").get_to(metrics.worst_y);
    worst.at("here").get_to(metrics.worst_here);
    worst.at("reference").get_to(metrics.worst_reference);
}

}  // namespace cistula::report

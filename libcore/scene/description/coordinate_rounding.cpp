#include "scene/description/coordinate_rounding.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace cistula {
namespace {

constexpr int as_floats = 24;
constexpr int fewest_digits = 6;
constexpr int most_digits = 12;
constexpr size_t most_looked_at = 4096;  // points

/// A number's shortest decimal form.
struct Written {
    int digits = 0;    // significant
    int exponent = 0;  // of ten, of the first digit
    int decimals() const { return std::max(0, digits - 1 - exponent); }
};

Written written(double number) {
    char text[40] = {};  // atoi reads on to a zero
    const auto end = std::to_chars(text, text + sizeof(text), std::abs(number), std::chars_format::scientific).ptr;
    const std::string_view all(text, size_t(end - text));
    const size_t e = all.find('e');
    return {int(e) - (e > 1 ? 1 : 0), std::atoi(text + e + 1)};
}

/// 10^exponent.
double power_of_ten(int exponent) {
    double power = 1;
    for (int i = 0; i < std::abs(exponent); ++i) power *= 10;
    return exponent < 0 ? 1 / power : power;
}

/// How some numbers are written.
struct Style {
    int digits = 0;     // as in CoordinateRounding
    int decimals = 0;   // the most
    bool exact = true;  // doubles that do not use their last bits: nothing was rounded
};

/// The exponent of a number's last bit that is 1.
int last_bit_of(double number) {
    int exponent;
    const double fraction = std::frexp(number, &exponent);
    return exponent - 53 + std::countr_zero(uint64_t(std::abs(std::ldexp(fraction, 53))));
}

/// Whether a double's last twelve bits are 0: rounding leaves that to one in 4,096.
bool ends_early(double number) {
    return std::bit_cast<uint64_t>(number) % 4096 == 0;
}

class StyleSearch {
  public:
    void look_at(double number) {
        if (number == 0 || !std::isfinite(number)) return;
        const Written form = written(number);
        floats_ = floats_ && double(float(number)) == number;
        if (form.digits > most_) most_ = form.digits, full_ = 0;
        full_ += form.digits == most_;
        ++count_;
        decimals_ = std::max(decimals_, form.decimals());
        early_ += ends_early(number);
        largest_ = std::max(largest_, std::abs(number));
        last_bit_ = std::min(last_bit_, last_bit_of(number));
    }
    Style style() const {
        const bool on_grid =
            count_ > 0 && last_bit_ >= std::ilogb(largest_) - 23;  // of single precision, for the largest number
        if (count_ > 0 && floats_ && most_ > fewest_digits && !on_grid) return {as_floats, 0, false};
        if (2 * early_ >= count_) return {};
        if (most_ < fewest_digits || most_ > most_digits || 2 * full_ < count_) return {0, 0, false};
        return {most_, decimals_, false};
    }

  private:
    bool floats_ = true;
    int most_ = 0;
    int decimals_ = 0;
    size_t full_ = 0;
    size_t count_ = 0;
    size_t early_ = 0;
    double largest_ = 0;
    int last_bit_ = 2000;  // the least
};

double half_unit(double number, const Style& style) {
    const double size = std::abs(number);
    if (size == 0 || style.exact) return 0;
    if (style.digits == 0) return size * 0x1p-53;
    if (style.digits == as_floats) return size * 0x1p-24;
    return std::max(power_of_ten(written(number).exponent + 1 - style.digits), power_of_ten(-style.decimals)) / 2;
}

}  // namespace

CoordinateRounding coordinate_rounding(std::span<const glm::dvec3> points) {
    const size_t step = std::max<size_t>(1, points.size() / most_looked_at);
    StyleSearch search;
    for (size_t i = 0; i < points.size(); i += step)
        for (int axis = 0; axis < 3; ++axis) search.look_at(points[i][axis]);
    const Style style = search.style();
    CoordinateRounding rounding;
    rounding.digits = style.digits;
    glm::dvec3 largest(0);
    for (const glm::dvec3& p : points)
        for (int axis = 0; axis < 3; ++axis)
            if (std::isfinite(p[axis])) largest[axis] = std::max(largest[axis], std::abs(p[axis]));
    for (int axis = 0; axis < 3; ++axis) rounding.half_unit[axis] = half_unit(largest[axis], style);
    return rounding;
}

double half_unit_of(double number) {
    StyleSearch search;
    search.look_at(number);
    return half_unit(number, search.style());
}

}  // namespace cistula

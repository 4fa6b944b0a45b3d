#include "show.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "id_colors.h"
#include "image/color/file_colors.h"
#include "image/color/srgb_codes.h"
#include "image/exr/exr_file.h"

namespace cistula {
namespace {

using Channels = std::vector<const ExrChannel*>;

constexpr float least_nothing = 1e10f;  // what depths and places have where there is nothing, or more

/// The smallest and the largest of some values.
struct Range {
    float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();

    void add(float value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    bool is_empty() const { return low > high; }
    /// Where the value lies in the range, from 0 to 1.
    double share(float value) const {
        const double length = static_cast<double>(high) - low;
        return length > 0 ? (static_cast<double>(value) - low) / length : 0;
    }
};

/// The linear value that is shown as a share of the codes of a PNG, from 0 to 1.
float linear_of_code(double share) {
    return srgb8_to_linear(static_cast<uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))));
}

/// What a part's header says of its colors.
FileColors colors_of(const ExrPart& part) {
    FileColors colors;
    const auto find = [&]<class Type>(const char* name, const Type&) {
        const auto found = part.attributes.find(name);
        return found == part.attributes.end() ? nullptr : std::get_if<Type>(&found->second);
    };
    if (const auto* id = find("colorInteropID", std::string())) colors.id = *id;
    const auto* const flag = find("acesImageContainerFlag", int());
    colors.is_aces = flag && *flag == 1;
    const auto* const xy = find("chromaticities", std::vector<float>());
    if (!xy || xy->size() != Chromaticities().size()) return colors;
    colors.chromaticities.emplace();
    std::copy_n(xy->begin(), xy->size(), colors.chromaticities->begin());
    return colors;
}

/// From the numbers of a part's colors to linear Rec. 709.
class ToRec709 {
  public:
    explicit ToRec709(const ExrPart& part) {
        const ColorSpace& target = color_spaces().front();
        try {
            const FileEncoding encoding = file_encoding("", colors_of(part), true);
            curve_ = encoding.curve;
            if (encoding.space.id != target.id) matrix_ = color_matrix(encoding.space, target);
        } catch (const std::runtime_error& problem) {
            const std::string_view text = problem.what();
            note_ = "numbers as they are, as " + std::string(text.substr(0, text.find(';')));
        }
        if (matrix_ || curve_ != &linear_curve) note_ = "from the file's color space to that of sRGB";
    }

    glm::vec3 operator()(const glm::vec3& color) const {
        if (curve_ == &linear_curve && !matrix_) return color;
        glm::dvec3 light;
        for (int c = 0; c < 3; ++c) light[c] = curve_(static_cast<double>(color[c]));
        return glm::vec3(matrix_ ? *matrix_ * light : light);
    }
    /// What it does, in words; empty: nothing.
    const std::string& note() const { return note_; }

  private:
    Curve curve_ = &linear_curve;
    std::optional<glm::dmat3> matrix_;
    std::string note_;
};

/// Fills the picture, one pixel after the other; those with a value that is not finite stay black.
template <class Texel>
void fill(ColorPicture& picture, const Channels& channels, const Texel& texel) {
    float values[4] = {};
    for (size_t i = 0; i < picture.texels.size(); ++i) {
        bool is_finite = true;
        for (size_t c = 0; c < channels.size(); ++c) is_finite &= std::isfinite(values[c] = channels[c]->values[i]);
        if (is_finite) picture.texels[i] = texel(values, i);
    }
}

Range range_of(const ExrChannel& channel, float end = std::numeric_limits<float>::infinity()) {
    Range range;
    for (const float value : channel.values)
        if (std::isfinite(value) && std::abs(value) < end) range.add(value);
    return range;
}

void show_color(ShownLayer& shown, const ExrPart& part, const Channels& channels) {
    const ToRec709 to_rec709(part);
    if (channels.size() == 1)
        fill(shown.picture, channels, [&](const float* v, size_t) { return to_rec709(glm::vec3(v[0])); });
    else
        fill(shown.picture, channels, [&](const float* v, size_t) { return to_rec709({v[0], v[1], v[2]}); });
    shown.values = to_rec709.note();
}

/// RY, Y and BY become R, G and B by the luminance of the file's primaries.
void show_chroma(ShownLayer& shown, const ExrPart& part, const Channels& channels) {
    fill(shown.picture, channels, [&](const float* v, size_t) { return glm::vec3(v[0], v[1], v[2]); });
    const FileColors colors = colors_of(part);
    ColorSpace space = color_spaces().front();
    try {
        if (colors.chromaticities) space = color_space_of(*colors.chromaticities);
    } catch (const std::runtime_error&) {  // those of no space: ToRec709 says so
    }
    const bool is_halved[] = {channels[0]->is_halved(), channels[1]->is_halved(), channels[2]->is_halved()};
    colors_from_chroma(shown.picture, is_halved, luminance_weights(space));
    const ToRec709 to_rec709(part);
    for (glm::vec3& texel : shown.picture.texels) texel = to_rec709(texel);
    shown.values = to_rec709.note();
}

void show_ids(ShownLayer& shown, const Channels& channels) {
    const std::vector<uint32_t>& numbers = channels[0]->numbers;  // none unless the channel is uint
    fill(shown.picture, channels,
         [&](const float* v, size_t i) { return id_color(numbers.empty() ? id_of(v[0]) : numbers[i]); });
}

void show_mattes(ShownLayer& shown, const Channels& channels) {
    fill(shown.picture, channels, [](const float* v, size_t) {
        const auto part = [](float id, float coverage) {
            return id_color(id_of(id)) * std::clamp(coverage, 0.0f, 1.0f);
        };
        return part(v[0], v[1]) + part(v[2], v[3]);
    });
}

void show_depth(ShownLayer& shown, const ExrPart& part, const Channels& channels) {
    float nothing = least_nothing;
    if (const auto far = part.attributes.find("cistula:zFar"); far != part.attributes.end())
        if (const auto* depth = std::get_if<double>(&far->second))
            nothing = std::min(nothing, static_cast<float>(*depth));
    const Range range = range_of(*channels[0], nothing);
    constexpr double darkest = 0.125;  // of the farthest: what is nothing is darker
    fill(shown.picture, channels, [&](const float* v, size_t) {
        return v[0] < nothing ? glm::vec3(linear_of_code(1 - (1 - darkest) * range.share(v[0]))) : glm::vec3(0);
    });
    shown.values = range.is_empty() ? "nothing" : fmt::format("{:.4g} bright to {:.4g} dark", range.low, range.high);
}

void show_normals(ShownLayer& shown, const Channels& channels) {
    fill(shown.picture, channels, [](const float* v, size_t) {
        glm::vec3 texel(0);
        if (v[0] == 0 && v[1] == 0 && v[2] == 0) return texel;
        for (int c = 0; c < 3; ++c) texel[c] = linear_of_code(0.5 + 0.5 * static_cast<double>(v[c]));
        return texel;
    });
}

void show_vectors(ShownLayer& shown, const Channels& channels) {
    std::vector<Range> ranges;
    for (const ExrChannel* channel : channels) {
        ranges.push_back(range_of(*channel, least_nothing));
        if (!ranges.back().is_empty())
            shown.values += fmt::format("{}{} {:.4g} to {:.4g}", shown.values.empty() ? "" : ", ",
                                        "XYZ"[ranges.size() - 1], ranges.back().low, ranges.back().high);
    }
    fill(shown.picture, channels, [&](const float* v, size_t) {
        glm::vec3 texel(0);
        for (size_t c = 0; c < ranges.size(); ++c) {
            if (std::abs(v[c]) >= least_nothing) return glm::vec3(0);
            texel[static_cast<int>(c)] = linear_of_code(ranges[c].share(v[c]));
        }
        return texel;
    });
}

void show_texture(ShownLayer& shown, const Channels& channels) {
    const auto place = [](float value) { return linear_of_code(static_cast<double>(value - std::floor(value))); };
    fill(shown.picture, channels, [&](const float* v, size_t) { return glm::vec3(place(v[0]), place(v[1]), 0); });
}

void show_scalar(ShownLayer& shown, const Channels& channels, bool exposed) {
    const Range range = range_of(*channels[0]);
    const double unit = exposed || !(range.high > 0) ? 1 : static_cast<double>(range.high);
    fill(shown.picture, channels, [&](const float* v, size_t) { return glm::vec3(static_cast<float>(v[0] / unit)); });
    if (!range.is_empty()) shown.values = fmt::format("{:.4g} to {:.4g}", range.low, range.high);
}

/// Colors what is not finite.
void mark(ShownLayer& shown, const Layer& layer, const Channels& channels) {
    const auto is_far = [&](float value) { return layer.kind == LayerKind::depth && value > 0; };
    for (size_t i = 0; i < shown.picture.texels.size(); ++i) {
        bool has_nan = false, has_infinity = false;
        for (const ExrChannel* channel : channels) {
            const float value = channel->values[i];
            has_nan |= std::isnan(value);
            has_infinity |= std::isinf(value) && !is_far(value);
        }
        shown.nans += has_nan;
        shown.infinities += has_infinity && !has_nan;
        if (has_nan || has_infinity) shown.picture.texels[i] = has_nan ? glm::vec3(1, 0, 1) : glm::vec3(0, 1, 1);
    }
}

}  // namespace

ShownLayer show_layer(const Layer& layer, const ExrPart& part, const Channels& channels, const PictureView& view,
                      bool exposed) {
    const auto width = static_cast<uint32_t>(part.width), height = static_cast<uint32_t>(part.height);
    ShownLayer shown{
        {width, height, std::vector<glm::vec3>(static_cast<size_t>(width) * height, glm::vec3(0))}, "", 0, 0};
    const auto full_height = static_cast<uint32_t>(part.full_height);
    switch (layer.kind) {
        case LayerKind::color:
        case LayerKind::luminance:
            show_color(shown, part, channels);
            shown.picture = viewed(std::move(shown.picture), view, full_height);
            break;
        case LayerKind::chroma:
            show_chroma(shown, part, channels);
            shown.picture = viewed(std::move(shown.picture), view, full_height);
            break;
        case LayerKind::ids:
            show_ids(shown, channels);
            break;
        case LayerKind::mattes:
            show_mattes(shown, channels);
            break;
        case LayerKind::depth:
            show_depth(shown, part, channels);
            break;
        case LayerKind::normals:
            show_normals(shown, channels);
            break;
        case LayerKind::vectors:
            show_vectors(shown, channels);
            break;
        case LayerKind::texture:
            show_texture(shown, channels);
            break;
        case LayerKind::scalar:
            show_scalar(shown, channels, exposed);
            if (exposed) shown.picture = viewed(std::move(shown.picture), view, full_height);
            break;
    }
    mark(shown, layer, channels);
    return shown;
}

}  // namespace cistula

#include "image/color/texel_decoder.h"

#include <cstring>

#include "cistula/numerics/real.h"

namespace cistula {

TexelDecoder::TexelDecoder(const FileEncoding& encoding, uint32_t sample_bytes, bool is_half,
                           const std::array<double, 3>& factors)
    : curve_(encoding.curve), sample_bytes_(sample_bytes), factors_(factors), rounding_(is_half ? 0x1p-11 : 0x1p-24) {
    const ColorSpace& own = color_spaces().front();
    converts_ = encoding.space.id != own.id;
    if (converts_) matrix_ = color_matrix(encoding.space, own);
    if (sample_bytes == 4) return;
    table_.resize(size_t{1} << (8 * sample_bytes));
    for (size_t i = 0; i < table_.size(); ++i)
        table_[i] = curve_(static_cast<double>(i) / static_cast<double>(table_.size() - 1));
}

glm::vec3 TexelDecoder::texel(const glm::dvec3& light) const {
    if (!converts_ || (light.x == light.y && light.y == light.z)) return glm::vec3(light);
    glm::vec3 texel;
    for (int c = 0; c < 3; ++c) {
        double value = 0, size = 0;
        for (int k = 0; k < 3; ++k) {
            value += matrix_[k][c] * light[k];
            size += magnitude(matrix_[k][c] * light[k]);
        }
        texel[c] = value < 0 && -value <= rounding_ * size ? 0 : static_cast<float>(value);
    }
    return texel;
}

template <class Sample, class Light>
void TexelDecoder::append_as(std::string_view bytes, uint32_t channels, std::vector<glm::vec3>& texels,
                             Light light) const {
    const auto sample = [&](size_t at, size_t channel) {
        at += channel;
        Sample value;
        std::memcpy(&value, bytes.data() + at * sizeof value, sizeof value);
        return light(value, channel);
    };
    for (size_t at = 0; at + channels <= bytes.size() / sizeof(Sample); at += channels)
        texels.push_back(channels < 3 ? glm::vec3(glm::dvec3(sample(at, 0)))
                                      : texel({sample(at, 0), sample(at, 1), sample(at, 2)}));
}

void TexelDecoder::append(std::string_view bytes, uint32_t channels, std::vector<glm::vec3>& texels) const {
    const auto coded = [&](auto code, size_t) { return table_[code]; };
    if (sample_bytes_ == 1)
        append_as<uint8_t>(bytes, channels, texels, coded);
    else if (sample_bytes_ == 2)
        append_as<uint16_t>(bytes, channels, texels, coded);
    else
        append_as<float>(bytes, channels, texels,
                         [&](float number, size_t c) { return curve_(static_cast<double>(number) / factors_[c]); });
}

}  // namespace cistula

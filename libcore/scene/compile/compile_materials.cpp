#include "scene/compile/compile_materials.h"

#include <cmath>

#include "cistula/numerics/transmittance.h"
#include "image/reader/picture_reader.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double largest_absorption = 0x1p20;  // of absorption * the size of a solid (docs/rules.md, 6)
constexpr double largest_integer_exponent = 1024;

/// 1 - kr - kt for the rounded shares, rounded down, so that the three never add up to more than 1.
template <class Real>
Real local_rounded_down(Real reflection, Real transmission) {
    const auto exact = static_cast<__float128>(1) - reflection - transmission;
    if (!(exact > 0)) return 0;
    const auto rounded = static_cast<Real>(exact);
    return rounded > exact ? std::nextafter(rounded, Real(0)) : rounded;
}

/// The transparency of a material whose shares are compiled.
template <class Real>
Transparency transparency_of(const Material<Real>& m, const MaterialDescription& material) {
    const Vec3<Real> passes = m.fresnel != 0 ? m.tint * (m.reflection + m.transmission) : m.filter;
    if (!(largest_component(passes) > 0)) return Transparency::opaque;
    const bool clear = material.reflection == 0 && material.transmission == 1 && material.tint == dvec3{1};
    return clear ? Transparency::clear : Transparency::partial;
}

ColorPicture checker_picture(const TextureDescription& texture) {
    ColorPicture picture;
    picture.width = picture.height = 2;
    const glm::vec3 a(texture.checker[0]), b(texture.checker[1]);
    picture.texels = {a, b, b, a};
    return picture;
}

/// The picture of a texture's file; warns of texels that were clamped.
ColorPicture read_file_texture(TextureReader& reader, const TextureDescription& texture, const SceneDescription& scene,
                               const std::string& place, std::vector<std::string>& warnings) {
    ClampedTexels clamped;
    ColorPicture picture;
    try {
        picture = reader.read(texture.file, texture.strict ? nullptr : &clamped, texture.colorspace);
    } catch (const Error& error) {
        throw Error(error.code(), scene_error(scene, place, error.what()).what());
    }
    if (clamped.count() > 0)
        warnings.push_back(scene_error(scene, place, texture.file + ": " + clamped.warning()).what());
    return picture;
}

/// Adds a texture, but for its place among all texels; the picture's texels are known to be radiances.
void append_texture(TextureSet& set, const TextureDescription& description, const ColorPicture& picture) {
    dvec3 largest{0};
    for (const glm::vec3& texel : picture.texels)
        for (int c = 0; c < 3; ++c) largest[c] = max_or_second(largest[c], static_cast<double>(texel[c]));
    Texture texture;
    texture.width = picture.width;
    texture.height = picture.height;
    texture.filter =
        description.bilinear && !description.file.empty() ? TextureFilter::bilinear : TextureFilter::nearest;
    texture.repeat[0] = description.repeat.x;
    texture.repeat[1] = description.repeat.y;
    set.textures.push_back(texture);
    set.largest.push_back(largest);
}

/// Joins the texels of all pictures, in their order, and frees each one that is copied.
void join_texels(std::vector<ColorPicture>& pictures, TextureSet& set) {
    size_t count = 0;
    for (size_t i = 0; i < pictures.size(); ++i) {
        set.textures[i].first_texel = static_cast<uint32_t>(count);
        count += pictures[i].texels.size();
    }
    if (pictures.size() == 1) {
        set.texels = std::move(pictures[0].texels);
        return;
    }
    set.texels.reserve(count);
    for (ColorPicture& picture : pictures) {
        set.texels.insert(set.texels.end(), picture.texels.begin(), picture.texels.end());
        picture = {};
    }
}

}  // namespace

double local_share(const MaterialDescription& material) {
    const double share = 1 - material.reflection - material.transmission;
    return share > 1e-12 ? share : 0;
}

TextureSet read_textures(const SceneSource& source) {
    const SceneDescription& scene = *source.description;
    TextureSet set;
    set.number.assign(scene.textures.size(), -1);
    TextureLimits limits;
    limits.bytes = scene.texture_bytes.value_or(limits.bytes);
    TextureReader reader(limits);
    std::vector<ColorPicture> pictures;
    for (const SourceSolid& solid : source.solids) {
        const int number = source.materials[solid.material].texture;
        if (number < 0 || set.number[static_cast<size_t>(number)] >= 0) continue;
        const TextureDescription& texture = scene.textures[static_cast<size_t>(number)];
        const std::string place = texture.place.empty() ? "/textures/" + std::to_string(number) : texture.place;
        if (!is_finite(texture.repeat.x) || !is_finite(texture.repeat.y))
            throw scene_error(scene, place, "the repeat must be finite");
        if (texture.file.empty()) {
            for (const dvec3& color : texture.checker)
                if (!is_finite(glm::vec3(color)) || color.x < 0 || color.y < 0 || color.z < 0)
                    throw scene_error(scene, place, "a color is negative or not finite");
            pictures.push_back(checker_picture(texture));
        } else {
            pictures.push_back(read_file_texture(reader, texture, scene, place, set.warnings));
        }
        set.number[static_cast<size_t>(number)] = static_cast<int>(set.textures.size());
        append_texture(set, texture, pictures.back());
    }
    join_texels(pictures, set);
    return set;
}

template <class Real>
Material<Real> compile_material(const MaterialDescription& material, const dvec3& ambient, int texture, double size,
                                const SceneNormalization& normalization, const SceneDescription& scene) {
    Material<Real> m;
    m.color = Vec3<Real>(material.color);
    m.ambient = Vec3<Real>(material.ambient * ambient);
    m.specular = Vec3<Real>(material.specular * material.specular_color);
    m.diffuse = static_cast<Real>(material.diffuse);
    m.exponent = static_cast<Real>(material.exponent);
    const bool integer =
        material.exponent <= largest_integer_exponent && material.exponent == floor_of(material.exponent);
    m.integer_exponent = integer ? static_cast<int32_t>(material.exponent) : -1;
    // Shares may add up to slightly more than 1; that excess must not grow from bounce to bounce.
    const double whole = max_or_second(material.reflection + material.transmission, 1.0);
    const double transmission = material.transmission / whole;
    m.reflection = static_cast<Real>(material.reflection / whole);
    m.transmission = static_cast<Real>(transmission);
    m.local = local_share(material) > 0 ? local_rounded_down(m.reflection, m.transmission) : 0;
    m.filter = Vec3<Real>(transmission * material.tint);
    m.tint = Vec3<Real>(material.tint);
    m.fresnel = material.fresnel ? 1 : 0;
    m.transparency = transparency_of(m, material);
    const dvec3 absorption =
        m.transparency == Transparency::opaque ? dvec3{0} : material.absorption / normalization.factor;
    if (largest_component(absorption) * size > largest_absorption)
        throw scene_error(scene, "",
                          "material " + material.name +
                              " has an absorption above 2^20 per size of a solid that is made " +
                              "of it; such a solid is opaque: give it transmission 0");
    m.absorption = Vec3<Real>(absorption);
    m.index = material.index;
    m.opaque = 0;
    for (int c = 0; c < 3; ++c) {
        const double share = transmission * material.tint[c];
        const bool opaque = !(m.filter[c] > 0);
        m.opaque |= static_cast<uint32_t>(opaque) << c;
        m.filter_loss[c] = opaque ? 0 : loss_of(share);
    }
    m.texture = texture;
    if (!is_finite(m.color) || !is_finite(m.ambient) || !is_finite(m.specular) || !is_finite(m.diffuse) ||
        !is_finite(m.exponent))
        throw scene_error(scene, "",
                          "material " + material.name + " has a value beyond the range of " + RealTraits<Real>::name);
    return m;
}

template Material<float> compile_material(const MaterialDescription&, const dvec3&, int, double,
                                          const SceneNormalization&, const SceneDescription&);
template Material<double> compile_material(const MaterialDescription&, const dvec3&, int, double,
                                           const SceneNormalization&, const SceneDescription&);

}  // namespace cistula

#include "scene/compile/materials/compile_materials.h"

#include <cmath>
#include <unordered_map>

#include "cistula/numerics/transmittance.h"
#include "scene/compile/scene_source.h"

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
    if (material.tint != dvec3{1}) return Transparency::partial;
    if (material.reflection == 0 && material.transmission == 1) return Transparency::clear;
    return material.fresnel && local_share(material) == 0 ? Transparency::whole : Transparency::partial;
}

/// Adds a texture, but for its place among all texels.
void append_texture(TextureSet& set, const TextureDescription& description, const ColorPicture& picture) {
    dvec3 largest{0};
    for (const glm::vec3& texel : picture.texels)
        for (int c = 0; c < 3; ++c) largest[c] = max_or_second(largest[c], static_cast<double>(texel[c]));
    Texture texture;
    texture.width = picture.width;
    texture.height = picture.height;
    texture.filter =
        description.bilinear && !description.is_checker() ? TextureFilter::bilinear : TextureFilter::nearest;
    for (int axis = 0; axis < 2; ++axis) {
        texture.repeat[axis] = description.repeat[axis];
        texture.wrap[axis] = description.wrap[static_cast<size_t>(axis)];
    }
    set.textures.push_back(texture);
    set.largest.push_back(largest);
}

/// Joins the texels of all pictures, in their order, each picture once, and gives those up that no one else holds.
void join_texels(std::vector<std::shared_ptr<const ColorPicture>>& pictures, TextureSet& set) {
    std::unordered_map<const ColorPicture*, uint32_t> first;
    size_t count = 0;
    for (size_t i = 0; i < pictures.size(); ++i) {
        const auto [known, is_new] = first.try_emplace(pictures[i].get(), static_cast<uint32_t>(count));
        set.textures[i].first_texel = known->second;
        if (is_new) count += pictures[i]->texels.size();
    }
    set.texels.reserve(count);
    for (size_t i = 0; i < pictures.size(); ++i) {
        const std::vector<glm::vec3>& texels = pictures[i]->texels;
        if (set.textures[i].first_texel == set.texels.size())
            set.texels.insert(set.texels.end(), texels.begin(), texels.end());
        pictures[i].reset();
    }
}

}  // namespace

double local_share(const MaterialDescription& material) {
    const double share = 1 - material.reflection - material.transmission;
    return share > 1e-12 ? share : 0;
}

TextureSet join_textures(SceneSource& source) {
    TextureSet set;
    set.number.assign(source.pictures.size(), -1);
    std::vector<std::shared_ptr<const ColorPicture>> pictures;
    const auto add = [&](int number) {
        if (number < 0 || set.number[static_cast<size_t>(number)] >= 0) return;
        pictures.push_back(std::move(source.pictures[static_cast<size_t>(number)]));
        set.number[static_cast<size_t>(number)] = static_cast<int>(set.textures.size());
        append_texture(set, source.description->textures[static_cast<size_t>(number)], *pictures.back());
    };
    for (const SourceSolid& solid : source.solids) add(source.materials[solid.material].texture);
    if (source.description->sky) add(source.description->sky->texture);
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
    m.integer_exponent = !(largest_component(m.specular) > Real(0)) ? 0
                         : integer                                  ? static_cast<int32_t>(material.exponent)
                                                                    : -1;
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
        throw scene_error(
            scene, "",
            "material " + material.name + " has an absorption above 2^20 per size of a solid that is made of it",
            "such a solid is opaque: give it transmission 0");
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

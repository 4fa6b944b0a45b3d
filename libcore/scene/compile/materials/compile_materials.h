// Conversion of materials and textures for the shading code. Private to libcore/scene.
#pragma once

#include <vector>

#include "cistula/model/scene_view.h"
#include "scene/compile/scene_normalization.h"

namespace cistula {

/// The share of local shading, 1 - kr - kt; 0 where only the rounding of kr and kt keeps their sum from 1.
double local_share(const MaterialDescription& material);

struct TextureSet {
    std::vector<Texture> textures;
    std::vector<Vec3<float>> texels;
    std::vector<glm::dvec3> largest;  // largest texel of each texture, per channel
    std::vector<int> number;          // by index in the description; -1: nothing uses it
};
/// Joins the pictures of the textures that objects and the sky use, and takes them from the source.
TextureSet join_textures(SceneSource& source);

/// A material for the shading code. `ambient` is scaled like all radiances; `texture` is an index in the compiled
/// scene; `size` is that of the largest solid of the material, in the scene's frame.
template <class Real>
Material<Real> compile_material(const MaterialDescription& material, const glm::dvec3& ambient, int texture,
                                double size, const SceneNormalization& normalization, const SceneDescription& scene);

}  // namespace cistula

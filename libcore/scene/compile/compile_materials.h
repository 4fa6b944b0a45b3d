// Materials and textures, ready for the shading code. Inside libcore/scene.
#pragma once

#include <vector>

#include "cistula/model/scene_view.h"
#include "scene/compile/frame.h"

namespace cistula {

/// 1 - kr - kt; 0 where only the rounding of kr and kt keeps their sum from 1.
double local_share(const MaterialDescription& material);

struct TextureSet {
    std::vector<Texture> textures;
    std::vector<Vec3<float>> texels;
    std::vector<glm::dvec3> largest;  // texel of each, per channel
    std::vector<int> number;          // by the description's number; -1: no object uses it
};
/// Reads those that some object uses. Throws Error.
TextureSet read_textures(const SceneSource& source);

/// `ambient` is scaled like all radiances; `texture` is the number in the compiled scene.
template <class Real>
Material<Real> compile_material(const MaterialDescription& material, const glm::dvec3& ambient, int texture,
                                const Frame& frame, const SceneDescription& scene);

}  // namespace cistula

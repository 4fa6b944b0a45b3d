#include "scene/compile/scene_hash.h"

namespace cistula {

void SceneHash::add(const MaterialDescription& m) {
    add(m.color);
    add(m.ambient);
    add(m.diffuse);
    add(m.specular);
    add(m.specular_color);
    add(m.exponent);
    add(m.reflection);
    add(m.transmission);
    add(m.tint);
    add(m.index);
    add(m.absorption);
    add(static_cast<uint32_t>(m.fresnel));
}

}  // namespace cistula

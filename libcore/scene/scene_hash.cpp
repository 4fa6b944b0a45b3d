#include "scene/scene_hash.h"

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

std::string SceneHash::hex() const {
    std::string text;
    for (int shift = 124; shift >= 0; shift -= 4) text += "0123456789abcdef"[static_cast<int>(state_ >> shift) & 15];
    return text;
}

}  // namespace cistula

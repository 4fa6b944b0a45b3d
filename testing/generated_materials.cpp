#include "testing/generated_parts.h"

namespace cistula::generated {

int Materials::texture() {
    TextureDescription t;
    t.name = "texture " + std::to_string(scene_.textures.size());
    t.checker = {random_.color(), random_.chance(0.3) ? dvec3(0) : random_.color()};
    t.repeat = {random_.of({1, 2, 5.5}), random_.of({1, 3, 0.7})};
    const bool picture = random_.chance(0.5), marble = random_.chance(0.5);
    t.bilinear = random_.chance(0.6);
    if (picture && !files_.empty()) t.file = files_ + (marble ? "/marble.data" : "/floor.data");
    scene_.textures.push_back(t);
    return static_cast<int>(scene_.textures.size()) - 1;
}

dvec3 Materials::tint() {
    dvec3 t = random_.color();
    for (int c = 0; c < 3; ++c)
        if (random_.chance(0.15)) t[c] = random_.chance(0.5) ? 0 : 1;
    return t;
}

void Materials::share_out(MaterialDescription& m, bool see_through) {
    const uint32_t kind = see_through && random_.chance(0.8) ? 3 + random_.below(6) : random_.below(9);
    switch (kind) {
        case 0:
            break;  // opaque
        case 1:
            m.reflection = random_.between(0.1, 0.9);
            break;
        case 2:
            m.reflection = 1;
            break;
        case 3:
            m.transmission = 1;  // clear
            break;
        case 4:
            m.transmission = 1;
            m.tint = tint();
            break;
        case 5:
            m.reflection = random_.of({0.25, 0.1, 0.3});
            m.transmission = 1 - m.reflection;
            m.tint = random_.chance(0.5) ? dvec3(1) : tint();
            break;
        case 6:
            m.reflection = 0.3;
            m.transmission = 0.7000005;  // a little above 1 is let pass
            break;
        case 7:
            m.transmission = random_.between(0.2, 0.9);
            m.tint = tint();
            break;
        default:
            m.reflection = random_.between(0.05, 0.3);
            m.transmission = random_.between(0.4, 0.7);
            m.tint = tint();
    }
}

int Materials::add(bool see_through, bool textured) {
    MaterialDescription m;
    m.name = "material " + std::to_string(scene_.materials.size());
    m.color = random_.color();
    m.ambient = random_.of({0, 0.3, 1, 1});
    m.diffuse = random_.of({0, 0.5, 0.8, 1});
    m.specular = random_.of({0, 0, 0.4, 1});
    if (random_.chance(0.3)) m.specular_color = random_.color();
    m.exponent = random_.of({0, 1, 2, 5, 50, 110, 1024, 1025, 0.5, 2.5, 37.3, 4000.25});
    if (textured && random_.chance(0.6)) m.texture = texture();
    if (palette_ != Palette::plain) share_out(m, see_through);
    if (palette_ == Palette::everything) {
        m.index = random_.of({1, 1, 1.000001, 1.33, 1.5, 1.5, 2.4, 0.75, 0.5});
        m.fresnel = random_.chance(0.4);
        const double strength = random_.of({0.2, 1, 10});
        if (random_.chance(0.4)) m.absorption = strength * tint();
    }
    scene_.materials.push_back(m);
    return static_cast<int>(scene_.materials.size()) - 1;
}

}  // namespace cistula::generated

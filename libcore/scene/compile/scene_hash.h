// Hash of everything in a scene that affects its image. Private to libcore/scene.
#pragma once

#include <type_traits>

#include <glm/vec3.hpp>

#include "base/fnv128.h"
#include "scene/compile/scene_source.h"
#include "scene/readers/scene_keys.h"

namespace cistula {

class SceneHash {
  public:
    void add_bytes(const void* data, size_t size) { hash_.add_bytes(data, size); }
    /// Adds a number's bits; -0 counts as 0.
    void add(double value) { hash_.add(value + 0.0); }
    void add(uint32_t value) { hash_.add(value); }
    void add(const glm::dvec3& v) { add(v.x), add(v.y), add(v.z); }
    void add(const MaterialDescription& material) {
        material_fields(material, [this](std::string_view, const auto& field) {
            if constexpr (std::is_same_v<decltype(field), const bool&>)
                add(static_cast<uint32_t>(field));
            else
                add(field);
        });
    }

    /// The hash as 32 lower-case hexadecimal digits.
    std::string hex() const { return hash_.hex(); }

  private:
    Fnv128 hash_;
};

}  // namespace cistula

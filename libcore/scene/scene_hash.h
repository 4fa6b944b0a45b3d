// 128-bit FNV-1a of what an image depends on. Inside libcore/scene.
#pragma once

#include <cstring>
#include <string>

#include <glm/vec3.hpp>

#include "scene/scene_source.h"

namespace cistula {

class SceneHash {
  public:
    void add_bytes(const void* data, size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (size_t i = 0; i < size; ++i) state_ = (state_ ^ bytes[i]) * prime;
    }
    /// -0 counts as 0.
    void add(double value) {
        value += 0.0;
        add_bytes(&value, sizeof(value));
    }
    void add(uint32_t value) { add_bytes(&value, sizeof(value)); }
    void add(const glm::dvec3& v) { add(v.x), add(v.y), add(v.z); }
    void add(const MaterialDescription& m);

    /// 32 lower-case digits.
    std::string hex() const;

  private:
    static constexpr unsigned __int128 prime = (static_cast<unsigned __int128>(1) << 88) + 0x13b;
    unsigned __int128 state_ = static_cast<unsigned __int128>(0x6c62272e07bb0142u) << 64 | 0x62b821756295c58du;
};

}  // namespace cistula

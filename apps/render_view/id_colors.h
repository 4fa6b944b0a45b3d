// Colors that tell ids apart.
#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

namespace cistula {

/// The linear color of an id, always the same one: black for 0, else a hue that is far from those of its neighbors, in
/// one of four degrees of brightness and saturation.
glm::vec3 id_color(uint32_t id);

/// The number that stands for an id that is stored as a float: itself where it is whole, else its bits (Cryptomatte's
/// ids are such).
uint32_t id_of(float value);

}  // namespace cistula

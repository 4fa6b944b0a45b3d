// What is said of an effect in a scene: needed or not, and because of what.
#pragma once

#include <cstdint>
#include <string>

namespace cistula {

/// Whether a scene needs one effect. `because` names the material, object or light that calls for it, or says that none
/// does.
struct EffectReason {
    uint32_t effect = 0;  // one bit of Effect
    bool needed = false;
    std::string because;
};

}  // namespace cistula

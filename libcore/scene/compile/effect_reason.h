// The reason why a scene needs an effect, or does not.
#pragma once

#include <cstdint>
#include <string>

namespace cistula {

/// Whether a scene needs one effect. `because` names the material, object or light that requires it, or says that none
/// does.
struct EffectReason {
    uint32_t effect = 0;  // one bit of Effect
    bool needed = false;
    std::string because;
};

}  // namespace cistula

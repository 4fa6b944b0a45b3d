// Descriptions of a film's flags in words.
#pragma once

#include <cstdint>
#include <string>

namespace cistula {

/// The reason why a film with these flags (RenderFlag bits) is unreliable, for a message; empty for 0.
std::string describe_flags(uint32_t flags);

}  // namespace cistula

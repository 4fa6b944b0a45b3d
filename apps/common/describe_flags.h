// What the flags of a film say, in words.
#pragma once

#include <cstdint>
#include <string>

namespace cistula {

/// Why a film with these flags cannot be trusted, for a message; empty for 0. The flags are RenderFlag's.
std::string describe_flags(uint32_t flags);

}  // namespace cistula

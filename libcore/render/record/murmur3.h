// MurmurHash3 and the ids that Cryptomatte makes of it.
#pragma once

#include <cstdint>
#include <string_view>

namespace cistula {

/// MurmurHash3_x86_32 with seed 0 (Appleby, public domain).
uint32_t murmur3(std::string_view text);

/// The id of a name as Cryptomatte 1.2.0 stores it: the hash's bits as a float; an exponent of all zeros or all ones,
/// which stands for no normal number, gets its lowest bit flipped.
float cryptomatte_id(std::string_view name);

}  // namespace cistula

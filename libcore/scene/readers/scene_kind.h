// What a file that is given as a scene is instead.
#pragma once

#include <string>
#include <string_view>

namespace cistula {

/// "is a PNG picture; ...", with what is wanted, for the start of a file without its byte order mark; empty where it is
/// none of the formats that are known here. Some hundred bytes are enough.
std::string no_scene_because(std::string_view start);

}  // namespace cistula

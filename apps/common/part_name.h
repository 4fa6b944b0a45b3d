// Names of what the parts of a picture file hold.
#pragma once

#include <string>

namespace cistula {

/// The name of a channel or a layer among those of all parts: PART.NAME, but NAME alone where it begins with its
/// part's, or the part has none.
inline std::string name_in_part(const std::string& part, const std::string& name) {
    const bool repeats = name == part || name.rfind(part + ".", 0) == 0;
    return part.empty() || repeats ? name : part + "." + name;
}

}  // namespace cistula

// Channels and attributes of a picture by their names.
#pragma once

#include <algorithm>
#include <string>

#include "scene/image/picture.h"

namespace cistula {

/// The channel of that name, or null.
inline const LayeredPicture::Channel* channel_of(const LayeredPicture& picture, const std::string& name) {
    const auto found = std::find_if(picture.channels.begin(), picture.channels.end(),
                                    [&](const LayeredPicture::Channel& channel) { return channel.name == name; });
    return found == picture.channels.end() ? nullptr : &*found;
}

/// The attribute of that name, or null if it is not there or of another type.
template <class T>
const T* attribute_of(const LayeredPicture& picture, const std::string& name) {
    const auto found = picture.attributes.find(name);
    return found == picture.attributes.end() ? nullptr : std::get_if<T>(&found->second);
}

}  // namespace cistula

// Reference pictures for errors: rendered once, then read from a cache.
#pragma once

#include <optional>
#include <string>

#include "frames.h"
#include "metrics.h"

namespace cistula::report {

struct ReferencePicture {
    Picture picture;
    ReferenceRecord record;
};

/// The cache folder: $XDG_CACHE_HOME/cistula, else ~/.cache/cistula; empty if neither is known.
std::string default_cache();

/// The picture with this setting: read from the folder `cache` (empty: none) if it holds a complete file of this
/// picture, else rendered, and stored if that took long. A damaged or unreadable file is ignored; failing to write one
/// is only a warning. Nothing if rendering exceeded the limit.
std::optional<ReferencePicture> reference_picture(Frames& frames, const std::string& scene_hash, const Setting& setting,
                                                  const FrameLimit& limit, const std::string& cache);

/// A reference file's bytes, and the reverse, which returns nothing if they are incomplete or of another key. For
/// reference_picture and tests.
std::string pack_reference(const ReferencePicture& reference, const std::string& key);
std::optional<ReferencePicture> unpack_reference(const std::string& bytes, const std::string& key);

}  // namespace cistula::report

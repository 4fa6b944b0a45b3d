// What errors are measured against: rendered once, then read back from the cache.
#pragma once

#include <optional>
#include <string>

#include "frames.h"
#include "metrics.h"

namespace cistula::report {

struct ReferencePicture {
    Picture picture;
    Yardstick yardstick;
};

/// $XDG_CACHE_HOME/cistula, else ~/.cache/cistula; empty where neither is known.
std::string default_cache();

/// The picture with this setting: from the folder `cache` (empty: none) if a whole file of this very picture is there,
/// else rendered, and stored if that took long. A file that is damaged or cannot be read counts as none; one that
/// cannot be written is a warning, as the report does not need it. Nothing where rendering passed the limit.
std::optional<ReferencePicture> reference_picture(Frames& frames, const std::string& scene_hash, const Setting& setting,
                                                  const FrameLimit& limit, const std::string& cache);

/// For reference_picture and tests: the file's bytes, and back. Nothing where they are not whole, or of another key.
std::string pack_reference(const ReferencePicture& reference, const std::string& key);
std::optional<ReferencePicture> unpack_reference(const std::string& bytes, const std::string& key);

}  // namespace cistula::report

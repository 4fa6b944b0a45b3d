// Page-locked memory of films: devices then copy into it themselves, and no thread of the host has to move pixels.
#pragma once

#include "scene/film.h"

namespace cistula {

/// Whether the film's pixels lie in locked pages. Locking takes longer than one copy, so that it is done only for memory
/// that comes by again, as in films of many frames; the lock goes when the memory does. False where the system refuses.
bool has_locked_pages(const Film& film);

}  // namespace cistula

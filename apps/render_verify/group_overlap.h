// Bodies in one another: an opaque one is seen wherever it is, of transparent ones the later in the file fills what
// they share.
#pragma once

#include "apps/render_verify/overlap/bodies.h"

namespace cistula::verify::overlap {

using Cases = CaseList<Sunk, Core, HalfOut, OpaqueInOpaque, Room, RoomStanding, RoomSunk, RoomOpaque, RoomTouched,
                       Later, BrokenCore, BrokenRoom>;

}  // namespace cistula::verify::overlap

// Closed meshes of several pieces: what is inside does not depend on how a file winds them.
#pragma once

#include "apps/render_verify/pieces/absorption.h"
#include "apps/render_verify/pieces/windings.h"

namespace cistula::verify::pieces {

using Cases = CaseList<Shell, Island, Pair, MirroredPair, OpaquePair, TrianglesAtRandom, Touching, Overlapping,
                       AbsorptionSeen, AbsorptionInShadow, BrokenShell, BrokenPair>;

}  // namespace cistula::verify::pieces

// What touches in the author's mind touches in the picture, however many digits a file has; what is apart stays apart.
#pragma once

#include "apps/render_verify/digits/contacts.h"
#include "apps/render_verify/digits/gaps.h"

namespace cistula::verify::digits {

using Cases = CaseList<OnFloor, SolidsOnFloor, Stack, SideBySide, InCorner, Decals, ContactKey, FloatOnFloor,
                       LightOnFace, CameraOnFloor, CameraOnGlass, Gaps, Hovering, BrokenContact, BrokenGap>;

}  // namespace cistula::verify::digits

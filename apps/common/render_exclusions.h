// Options of `render` that exclude or require one another.
#pragma once

#include "apps/common/render_option_texts.h"

namespace cistula {

/// Throws Error (usage) that says which of two options must be removed, or which one is missing.
void refuse_exclusions(const OptionTexts& texts);

}  // namespace cistula

// Options of `render` that have no meaning beside one another.
#pragma once

#include "option_texts.h"

namespace cistula {

/// Throws Error (usage) that says which of two options is to be left out, or which one is missing.
void refuse_exclusions(const OptionTexts& texts);

}  // namespace cistula

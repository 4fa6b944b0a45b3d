// The whole page, from records alone.
#pragma once

#include <string>
#include <vector>

#include "record.h"

namespace cistula::report {

/// One HTML file: nothing loaded, no script, light and dark.
std::string report_page(const std::vector<Record>& records);

extern const char* const page_style;

}  // namespace cistula::report

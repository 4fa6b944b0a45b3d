// The HTML page, made from records alone.
#pragma once

#include <string>
#include <vector>

#include "record.h"

namespace cistula::report {

/// The page as one self-contained HTML file, without scripts, for light and dark color schemes.
std::string report_page(const std::vector<Record>& records);

}  // namespace cistula::report

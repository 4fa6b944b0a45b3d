// Views of OpenColorIO configs, by the module for OpenImageIO, which is loaded only where one is asked for.
#pragma once

#include <string>
#include <vector>

#include "image/picture/picture.h"

namespace cistula {

struct OiioModule;
struct OiioView;

/// A view of the config that $OCIO names or, where it is not set, of the one that is part of OpenColorIO 2.2 and later.
class ConfigView {
  public:
    /// `name`: that of a view of the default display, or "VIEW (DISPLAY)". `own`: the views that need no config. Throws
    /// Error: usage where there is no such view, with those that there are; file where $OCIO's config cannot be used.
    ConfigView(const std::string& name, const std::vector<std::string>& own);
    ~ConfigView();
    ConfigView(const ConfigView&) = delete;
    ConfigView& operator=(const ConfigView&) = delete;

    /// Turns linear colors into those whose 8-bit sRGB codes are the view's. Any thread. Throws std::bad_alloc.
    void apply(ColorPicture& picture) const;

    /// A warning that the config does not say what linear Rec. 709 is, and what it is taken for; empty: it says so.
    std::string warning() const;

  private:
    const OiioModule* module_ = nullptr;
    OiioView* view_ = nullptr;
};

}  // namespace cistula

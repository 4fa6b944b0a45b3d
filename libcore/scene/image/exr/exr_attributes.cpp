#include "scene/image/exr/exr_attributes.h"

#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

namespace cistula {

ExrAttributes read_attributes(const Imf::Header& header) {
    ExrAttributes attributes;
    for (auto entry = header.begin(); entry != header.end(); ++entry) {
        const std::string name = entry.name();
        // Every file has these, and every part.
        if (name == "pixelAspectRatio" || (name == "screenWindowWidth" && header.screenWindowWidth() == 1)) continue;
        if (name == "name" || name == "type" || name == "chunkCount") continue;
        const Imf::Attribute& attribute = entry.attribute();
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
            attributes[name] = text->value();
        } else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
            attributes[name] = whole->value();
        } else if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) {
            attributes[name] = number->value();
        } else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
            attributes[name] = static_cast<double>(single->value());
        } else if (const auto* ratio = dynamic_cast<const Imf::RationalAttribute*>(&attribute)) {
            attributes[name] = Ratio{ratio->value().n, ratio->value().d};
        } else if (const auto* list = dynamic_cast<const Imf::FloatVectorAttribute*>(&attribute)) {
            attributes[name] = std::vector<float>(list->value());
        } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
            const float* first = matrix->value().getValue();
            attributes[name] = std::vector<float>(first, first + 16);
        } else if (const auto* colors = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&attribute)) {
            const Imf::Chromaticities& c = colors->value();
            attributes[name] =
                std::vector<float>{c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y, c.white.x, c.white.y};
        }
    }
    return attributes;
}

}  // namespace cistula

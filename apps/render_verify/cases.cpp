#include "apps/render_verify/case.h"

namespace cistula::verify {

void add_contact(Cases& cases);
void add_digits(Cases& cases);
void add_geometry(Cases& cases);
void add_metamorphic(Cases& cases);
void add_mirrors(Cases& cases);
void add_overlap(Cases& cases);
void add_pieces(Cases& cases);
void add_refraction(Cases& cases);
void add_shadows(Cases& cases);
void add_size(Cases& cases);
void add_sums(Cases& cases);

const std::vector<Case>& all_cases() {
    static const std::vector<Case> all = [] {
        Cases cases;
        for (const auto add : {add_contact, add_digits, add_geometry, add_metamorphic, add_mirrors, add_overlap,
                               add_pieces, add_refraction, add_shadows, add_size, add_sums})
            add(cases);
        return cases.all;
    }();
    return all;
}

}  // namespace cistula::verify

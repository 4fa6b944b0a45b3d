#include "verify/case.h"

namespace cistula::verify {

void add_balls(Cases& cases);
void add_bodies(Cases& cases);
void add_contact(Cases& cases);
void add_digits(Cases& cases);
void add_geometry(Cases& cases);
void add_metamorphic(Cases& cases);
void add_mirrors(Cases& cases);
void add_overlap(Cases& cases);
void add_pieces(Cases& cases);
void add_planes(Cases& cases);
void add_refraction(Cases& cases);
void add_shadows(Cases& cases);
void add_size(Cases& cases);
void add_sky(Cases& cases);
void add_smooth(Cases& cases);
void add_sums(Cases& cases);
void add_time(Cases& cases);

const std::vector<Case>& all_cases() {
    static const std::vector<Case> all = [] {
        Cases cases;
        const auto add = [&](const char* group, void (*cases_of)(Cases&)) {
            cases.group = group;
            cases_of(cases);
        };
        add("balls/", add_balls);
        add("bodies/", add_bodies);
        add("contact/", add_contact);
        add("digits/", add_digits);
        add("geometry/", add_geometry);
        add("metamorphic/", add_metamorphic);
        add("mirrors/", add_mirrors);
        add("overlap/", add_overlap);
        add("pieces/", add_pieces);
        add("planes/", add_planes);
        add("refraction/", add_refraction);
        add("shadows/", add_shadows);
        add("size/", add_size);
        add("sky/", add_sky);
        add("smooth/", add_smooth);
        add("sums/", add_sums);
        add("time/", add_time);
        return cases.all;
    }();
    return all;
}

}  // namespace cistula::verify

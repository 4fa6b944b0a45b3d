// Bodies that touch: what stands on a floor, lies on something, leans in a corner. Most pictures are those of something
// else: the paper alone, the body in one piece, bodies a hair larger.
#include <memory>
#include <numeric>

#include "verify/cases/contact/ideal.h"
#include "verify/cases/pictures.h"
#include "verify/draw.h"
#include "verify/reference_renderers.h"

namespace cistula::verify {
namespace contact {
namespace {

// ---- arrangements

/// What an arrangement is made of: materials of two kinds of body and of what they stand on; their form.
struct Parts {
    int one, other, ground;
    Shape shape = Shape::planes;
};

void on_floor(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.cube(-0.3, 0.1, 0, 0.9, 0, parts.one, parts.shape);
    site.cube(0.7, -0.5, 0, 0.5, 33, parts.other, parts.shape);
}
void on_tessellated_floor(Site& site, const Parts& parts) {
    site.tessellated_floor(parts.ground, 9);
    site.cube(-0.3, 0.1, 0, 0.9, 0, parts.one, parts.shape);
    site.cube(0.7, -0.5, 0, 0.5, 33, parts.other, parts.shape);
}
void on_solid(Site& site, const Parts& parts) {
    site.cube(-0.3, 0.1, 0, 0.9, 0, parts.one, parts.shape);
    site.cube(0.7, -0.5, 0, 0.5, 33, parts.other, parts.shape);
    site.cube(0, 0, -3, 3, 0, parts.ground);  // opaque bodies come later: they fill what they share with glass
}
void side_by_side(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.cube(-0.3, 0, 0, 0.6, 0, parts.one, parts.shape);
    site.cube(0.3, 0, 0, 0.6, 0, parts.other, parts.shape);
    site.cube(0.2, 0.5, 0, 0.4, 0, parts.one, parts.shape);  // on part of the second one's face
}
void over_the_edge(Site& site, const Parts& parts) {
    site.quad({-2, -2, 0}, {2.1, 0, 0}, {0, 4, 0}, parts.ground);
    site.cube(0, 0.1, 0, 0.9, 25, parts.one, parts.shape);
    site.cube(-0.15, -0.9, 0, 0.5, 0, parts.other, parts.shape);  // two edges in one place
}
void across_two_quads(Site& site, const Parts& parts) {
    site.quad({-2, -2, 0}, {2.1, 0, 0}, {0, 4, 0}, parts.ground);
    site.quad({-0.2, -2, 0}, {2.2, 0, 0}, {0, 4, 0}, parts.ground);
    site.cube(0, 0.1, 0, 0.9, 25, parts.one, parts.shape);
}
void in_a_corner(Site& site, const Parts& parts) {
    site.quad({-1, -1, 0}, {3, 0, 0}, {0, 3, 0}, parts.ground);
    site.quad({-1, -1, 0}, {0, 3, 0}, {0, 0, 2}, parts.ground);
    site.quad({-1, -1, 0}, {0, 0, 2}, {3, 0, 0}, parts.ground);
    site.cube(-0.6, -0.6, 0, 0.8, 0, parts.one, parts.shape);
    site.cube(-0.7, 0.1, 0, 0.6, 0, parts.other, parts.shape);  // at a wall and at the first one
}
void along_an_edge(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.cube(-0.3, 0, 0, 0.6, 0, parts.one, parts.shape);
    site.cube(0.3, 0, 0.6, 0.6, 0, parts.other, parts.shape);
}
void at_a_vertex(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.cube(-0.3, -0.3, 0, 0.6, 0, parts.one, parts.shape);
    site.cube(0.3, 0.3, 0.6, 0.6, 0, parts.other, parts.shape);
}
void stacked(Site& site, const Parts& parts) {
    site.floor(parts.ground);
    site.decal({-0.1, -0.1, 0}, {0.2, 0, 0}, {0, 0.2, 0}, parts.ground);
    site.cube(0, 0, 0, 0.8, 10, parts.one, parts.shape);
    site.cube(0.05, -0.02, 0.8, 0.5, 40, parts.other, parts.shape);
    site.cube(0, 0.02, 1.3, 0.3, -25, parts.one, parts.shape);
}

struct Arrangement {
    void (*build)(Site&, const Parts&);
    bool corner = false;  // seen and lit from within it
};
constexpr Arrangement floor_{on_floor}, mesh_floor{on_tessellated_floor}, solid{on_solid}, sides{side_by_side},
    edge{over_the_edge}, two_quads{across_two_quads}, corner{in_a_corner, true}, along_edge{along_an_edge},
    vertex{at_a_vertex}, stack{stacked};
using Arrangements = std::vector<Arrangement>;

/// A site with an arrangement of these materials, in view.
Site arranged(Site site, const Arrangement& arrangement, const Parts& parts) {
    arrangement.build(site, parts);
    if (arrangement.corner)
        site.look({2.6, 3.1, 2.3}, {-0.4, -0.3, 0.4}, 40);
    else
        site.look({1.4, -3.6, 2.1}, {0, 0, 0.45}, 40);
    return site;
}
/// The light of an arrangement, beside ambient light.
void light_it(Site& site, bool in_corner) {
    site.light(in_corner ? dvec3(1.5, 1.1, 1.8) : dvec3(1.8, -1.5, 3.2));
}
MaterialDescription wood() {
    return paper({0.8, 0.6, 0.3});
}

// ---- bodies that bend light by next to nothing: the picture is that of the paper alone. At each face a new line
// starts all the same, so that one that starts on the wrong side of a contact is seen.

/// Removes the objects of a material.
SceneDescription without(SceneDescription scene, int material) {
    std::erase_if(scene.objects, [&](const ObjectDescription& object) { return object.material == material; });
    return scene;
}

/// The index is 1 but for 2^-18: a line that crosses a face at a slope of 1/8 or more is turned by 2^-15 at most.
MaterialDescription next_to_nothing() {
    return glass(1 + 0x1p-18);
}

/// Lines are turned at up to eight faces, over ways of up to 2: what is seen is displaced by less than 2^-11, and
/// colors of the paper change by less than 1/2 per unit of length.
constexpr Bound bound_of_displaced = at_most(0x1p-12, "of 1");

Render invisible(const Arrangements& arrangements, Shape shape) {
    return [=](Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Arrangement& arrangement : arrangements)
            for (const Ground& ground : grounds) {
                Site site(ground);
                const int body = add_material(site.scene, next_to_nothing());
                const int floor = add_material(site.scene, wood());
                site = arranged(site, arrangement, {body, body, floor, shape});
                light_it(site, arrangement.corner);
                measure_difference(tally, stage.film(site.scene), stage.film(without(site.scene, body)),
                                   place_of_scene(number++));
            }
    };
}
/// Every Platonic solid on each kind of its faces, turned as it comes.
void invisible_solids(Stage& stage, Tally& tally) {
    uint64_t number = 0;
    for (const PlatonicSolid kind : platonic_solids)
        for (size_t face = 0; face < platonic_shape(kind).faces.size(); face += stage.quick ? 3 : 1) {
            const SolidObject body = solid_object(kind, {2.3, -1.7, 0.6}, 0.7, {20 + 7.0 * double(face), 35, 50});
            Site site(body, face);
            const int clear_one = add_material(site.scene, next_to_nothing());
            const int floor = add_material(site.scene, wood());
            const auto build = [](Site& to, const Parts& parts) { to.floor(parts.ground); };
            site = arranged(site, {build}, {clear_one, clear_one, floor});
            add_object(site.scene, body, clear_one);
            light_it(site, false);
            measure_difference(tally, stage.film(site.scene), stage.film(without(site.scene, clear_one)),
                               place_of_scene(number++));
        }
}

// ---- bodies of glass: the picture is never that of bodies a hair apart, whose gaps would reflect totally

constexpr double hair = 0x1p-12;

Render apart(const Arrangements& arrangements, Shape shape) {
    return [=](Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Arrangement& arrangement : arrangements)
            for (const Ground& ground : grounds) {
                const auto of_size = [&](double size) {
                    Site site(ground);
                    site.size = size;
                    site.lift = hair / 4;
                    site.scene.cutoff = 1e-4;
                    const int one = add_material(site.scene, glass(1.5, true, {0.1, 0.3, 0.6}));
                    const int other = add_material(site.scene, glass(1.33, true, {0.7, 0.2, 0.1}));
                    const int floor = add_material(site.scene, wood());
                    return arranged(site, arrangement, {one, other, floor, shape}).scene;
                };
                expect_same_picture(stage, tally, of_size(1), of_size(1 + hair), number++);
            }
    };
}

/// A cube on a floor, cut into `cut`^3, in an order that `seed` shuffles; 0: none.
SceneDescription cut_cube(const Ground& ground, int cut, uint64_t seed, Shape shape = Shape::planes) {
    Site site(ground);
    const int body = add_material(site.scene, glass(1.5, true, {0.1, 0.3, 0.6}));
    site.floor(add_material(site.scene, wood()));
    site.scene.depth = 64;
    site.scene.cutoff = 1e-4;
    std::vector<int> order(size_t(cut * cut * cut));
    std::iota(order.begin(), order.end(), 0);
    Draw draw(seed, 1);
    for (size_t i = order.size() - 1; i > 0 && seed != 0; --i)
        std::swap(order[i], order[size_t(draw.between(0, int(i)))]);
    const double side = 1.2 / cut;
    for (const int i : order) {
        const int across = i % cut;
        const int along = i / cut % cut;
        const int up = i / cut / cut;
        site.cube((across + 0.5) * side - 0.6, (along + 0.5) * side - 0.6, up * side, side, 0, body, shape);
    }
    site.look({1.4, -3.6, 2.1}, {0, 0, 0.45}, 35);
    return site.scene;
}

Render blocks(int cut, uint64_t orders, Shape shape = Shape::planes) {
    return [=](Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Ground& ground : grounds) {
            const Film whole = stage.film(cut_cube(ground, 1, 0));
            for (uint64_t order = 0; order < orders; ++order)
                expect_same_picture(stage, tally, cut_cube(ground, cut, order, shape), whole, number++);
        }
    };
}

void optical(Stage& stage, Tally& tally) {
    uint64_t number = 0;
    for (const Ground& ground : grounds)
        for (const dvec3& from : {dvec3(1.4, -3.6, 2.1), dvec3(0.3, 0.2, 5), dvec3(-3, -1, 0.4)}) {
            Site site(ground);
            site.floor(add_material(site.scene, wood()), IdealGlass::floor_half);
            site.cube(0, 0, 0, 2 * IdealGlass::half, 0, add_material(site.scene, glass(IdealGlass::index, true)));
            site.scene.depth = 64;
            site.scene.cutoff = 1e-4;
            site.look(from, {0, 0, 0.5}, 40);
            const Film film = stage.film(site.scene);
            const IdealGlass ideal{site.scene.ambient * site.scene.materials[1].color, site.scene.background};
            const ColorPicture found = to_color(film);
            ColorPicture expected = found;
            const dvec3 camera = site.own(camera_at(site.scene.camera, 0).camera.position);
            for_each_view(film, site.scene, [&](size_t i, const dvec3& direction) {
                expected.texels[i] = glm::vec3(ideal.seen(camera, site.own_direction(direction)));
            });
            for_each_pixel(film, [&](size_t i, int x, int y) {
                tally.place = place_of_scene(number) + i;
                tally.expect(film.flags == 0 && is_between(found.texels[i], expected, x, y));
            });
            ++number;
        }
}

// ---- what is far away: it changes neither a contact nor a gap between two others

/// Two cubes of glass that touch or have a gap of 2^-13 between them, under even light; a ball of the background's
/// color `far` away, which nothing tells from that. `contact`: the scene's, if it is above 0.
SceneDescription beside(const Ground& ground, bool gap, double far, double contact) {
    Site site(ground);
    site.scene.ambient = dvec3(1), site.scene.background = {0.2, 0.5, 0.8};
    site.scene.cutoff = 1e-4;
    if (contact > 0) site.scene.contact = contact;
    const int body = add_material(site.scene, glass(1.5, true, {0.1, 0.3, 0.6}));
    site.floor(add_material(site.scene, wood()));
    site.cube(-0.3, 0, 0, 0.6, 0, body);
    site.cube(gap ? 0.3 + 0x1p-13 : 0.3, 0.1, 0, 0.6, 0, body);
    site.look({1.4, -3.6, 2.1}, {0, 0, 0.3}, 25);
    const int sky = add_material(site.scene, paper(site.scene.background));
    if (far > 0) add_object(site.scene, SphereObject{site.place(dvec3(-0.5, -0.7, 0.6) * far), far / 8}, sky);
    return site.scene;
}

Render far_away(double contact = 0) {
    return [=](Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Ground& ground : grounds)
            for (const bool gap : {false, true})
                for (const double far : {8.0, 16.0, 1e3, 1e6})
                    if (far < 100 || stage.in_double())  // where the precision holds the gap
                        expect_same_picture(stage, tally, beside(ground, gap, far, contact), beside(ground, gap, 0, 0),
                                            number++);
    };
}

// ---- sheets that lie on sheets and on faces of solids: the one declared later is seen

/// What decals lie on.
enum class Under { floor, tessellated_floor, solid, mesh };

/// Overlapping decals on something, each `lift` above the one before. `first`: which of the two comes first.
SceneDescription with_decals(const Ground& ground, Under under, double lift, int first, bool lit) {
    Site site(ground);
    site.lift = lift;
    const int plain = add_material(site.scene, wood());
    const int red = add_material(site.scene, paper({0.9, 0.1, 0.1}));
    const int squares = add_material(site.scene, paper(dvec3(1)));
    add_checker(site.scene, {3, 3}, squares, {dvec3(0.9), dvec3(0.2, 0.2, 0.6)});
    MaterialDescription film = clear({0.5, 0.8, 1});
    film.transmission = 0.7;
    const int foil = add_material(site.scene, film);
    if (under == Under::floor) site.floor(plain);
    if (under == Under::tessellated_floor) site.tessellated_floor(plain, 9);
    if (under == Under::solid || under == Under::mesh)
        site.cube(0, 0, -2, 2, 0, plain, under == Under::solid ? Shape::planes : Shape::triangles);
    for (int i = 0; i < 2; ++i) {
        if ((first + i) % 2 == 0)
            site.decal({-0.7, -0.6, 0}, {1, 0.2, 0}, {-0.2, 1, 0}, red);
        else
            site.decal({-0.2, -0.3, 0}, {0.9, -0.3, 0}, {0.25, 0.75, 0}, squares);
    }
    if (!lit) site.decal({-0.9, -0.1, 0}, {1.9, 0, 0}, {0, 0.25, 0}, foil);  // ambient light alone: see the case
    if (under == Under::solid || under == Under::mesh)
        site.decal({-0.5, -1, -0.5}, {1, 0, 0}, {0, 0, 0.4}, squares);  // on its side
    site.look({0.8, -2.6, 2.1}, {0, 0, 0}, 45);
    if (lit) site.light({1.8, -1.5, 3.2});
    return site.scene;
}

/// A foil lets most of a light through and is itself no obstacle to the light of what it lies on: with lights it
/// differs from one that is raised, so it is there in ambient light alone.
Render decals(Under under) {
    return [=](Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Ground& ground : grounds)
            for (const int first : {0, 1})
                for (const bool lit : {false, true})
                    expect_same_picture(stage, tally, with_decals(ground, under, 0, first, lit),
                                        with_decals(ground, under, 0x1p-14, first, lit), number++);
    };
}
/// A label on the face of a glass cube, seen from without and through the glass.
SceneDescription with_label(const Ground& ground, double lift, bool on_top) {
    Site site(ground);
    site.lift = lift;
    site.cube(0, 0, -1, 2, 0, add_material(site.scene, glass(1.5, true)));
    const int red = add_material(site.scene, paper({0.9, 0.1, 0.1}));
    if (on_top)
        site.decal({-0.7, -0.6, 1}, {1, 0.2, 0}, {-0.2, 1, 0}, red);
    else
        site.decal({0.6, 1, -0.7}, {-1, 0, 0.2}, {0.2, 0, 1}, red);  // behind the glass
    site.look({1.2, -3.6, 3.1}, {0, 0, 0}, 45);
    site.light({1.8, -1.5, 3.2});
    site.scene.cutoff = 1e-4;
    return site.scene;
}
void label_on_glass(Stage& stage, Tally& tally) {
    uint64_t number = 0;
    for (const Ground& ground : grounds)
        for (const bool on_top : {true, false}) {
            const auto film = [&](double lift) { return stage.film(with_label(ground, lift, on_top)); };
            const Film raised = film(0x1p-14);
            const Film lowered = film(-0x1p-14);
            expect_one_of(tally, film(0), {&raised, &lowered}, place_of_scene(number++));
        }
}

// ---- shadows: none leaks light, none specks, and each has the color of the faces that the light crosses

/// Where a ray starts on paper is 32 u M from where it would start without bodies that touch it, and the scene may have
/// another center: colors, which are below 4 and smooth, differ by some 2^8 u.
constexpr Bound bound_of_colors = at_most(0x1p-16, "of 1");

/// Measures a film against the closed form, where that has an answer.
void measure_straight(Tally& tally, const Site& site, const Film& film, uint64_t place) {
    const StraightLight light(site);
    const ColorPicture picture = to_color(film);
    const dvec3 from = site.own(camera_at(site.scene.camera, 0).camera.position);
    for_each_view(film, site.scene, [&](size_t i, const dvec3& direction) {
        const std::optional<dvec3> expected = light.seen(from, site.own_direction(direction));
        if (!expected) return;
        tally.place = place + i;
        tally.measure(film.flags == 0 ? difference(picture.texels[i], glm::vec3(*expected)) : INFINITY);
    });
}

/// Lights from all sides, low and high.
void light_from_all_sides(Site& site, bool in_corner) {
    for (int i = 0; i < 3; ++i) {
        const double angle = in_corner ? 0.35 + 0.4 * i : 0.5 + 2.1 * i;
        site.light({2.2 * std::cos(angle), 2.2 * std::sin(angle), 0.4 + 0.9 * i}, dvec3(0.3));
    }
}

Render straight(const Arrangements& arrangements, const MaterialDescription& one, const MaterialDescription& other) {
    return [=](Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Arrangement& arrangement : arrangements)
            for (const Ground& ground : grounds)
                for (const bool near : {false, true}) {
                    Site site(ground);
                    const int first = add_material(site.scene, one);
                    const int second = add_material(site.scene, other);
                    const int floor = add_material(site.scene, wood());
                    site = arranged(site, arrangement, {first, second, floor});
                    light_from_all_sides(site, arrangement.corner);
                    if (near) site.scene.camera.field_of_view = 8;
                    measure_straight(tally, site, stage.film(site.scene), place_of_scene(number++));
                }
    };
}
Render tinted(const Arrangements& arrangements) {
    return straight(arrangements, clear({1, 0.5, 0.25}), clear({0.5, 0.75, 1}));
}
Render opaque(const Arrangements& arrangements) {
    return straight(arrangements, paper({0.3, 0.6, 0.8}), paper({0.8, 0.3, 0.5}));
}

// ---- without the contact rule: what it is for must be seen

/// A film of a scene in which no plane is shared.
template <class Real>
Film film_without_contacts(const SceneDescription& scene, const FrameSettings& settings) {
    std::shared_ptr<CompiledScene<Real>> compiled = compile_scene<Real>(scene);
    compiled->shared_planes.clear();
    for (auto* numbers :
         {&compiled->slab_planes, &compiled->triangle_planes, &compiled->near_planes, &compiled->plane_solids})
        numbers->clear();
    for (Solid& solid : compiled->solids) solid.near_count = 0;
    Film film;
    RenderProgress progress;
    make_host_renderer<Real>(compiled, HostIntersector::brute)
        ->render(camera_at(scene.camera, 0), settings, film, progress);
    return film;
}

/// A case on the plain loop, whatever the intersector.
Render broken(const Render& render) {
    return [=](Stage& stage, Tally& tally) {
        Stage without(true, stage.precision, stage.intersector,
                      stage.in_double() ? film_without_contacts<double> : film_without_contacts<float>);
        render(without, tally);
    };
}

}  // namespace
}  // namespace contact

void add_contact(Cases& cases) {
    using namespace contact;
    using Rows = std::vector<std::tuple<const char*, Arrangements, Shape>>;
    const auto add_all = [&](const std::string& prefix, const char* exact, const Bound& bound, const auto& make,
                             const Rows& rows) {
        for (const auto& [name, arrangements, shape] : rows)
            cases.images(prefix + name, exact, bound, make(arrangements, shape));
    };
    const auto bodies_and = [](const Rows& meshes) {
        Rows rows = {{"on-a-floor", {floor_}, Shape::planes},
                     {"on-a-tessellated-floor", {mesh_floor}, Shape::planes},
                     {"on-a-solid", {solid}, Shape::planes},
                     {"side-by-side", {sides}, Shape::planes},
                     {"over-the-edge", {edge, two_quads}, Shape::planes},
                     {"in-a-corner", {corner}, Shape::planes},
                     {"along-an-edge", {along_edge, vertex}, Shape::planes},
                     {"stack", {stack}, Shape::planes}};
        rows.insert(rows.end(), meshes.begin(), meshes.end());
        return rows;
    };
    add_all("invisible/", "the colors of the paper alone", bound_of_displaced, invisible,
            bodies_and({{"convex-meshes", {floor_, corner, stack}, Shape::convex_mesh},
                        {"meshes", {floor_, mesh_floor, edge}, Shape::triangles},
                        {"meshes/side-by-side", {sides, corner, stack}, Shape::triangles}}));
    cases.images("invisible/solids", "the colors of the paper alone, under every face of the Platonic solids",
                 bound_of_displaced, invisible_solids);
    add_all("apart/", "the picture of the bodies 2^-12 larger, with some of them within others", no_failures("pixels"),
            apart,
            bodies_and({{"convex-meshes", {floor_, sides, corner}, Shape::convex_mesh},
                        {"meshes", {floor_, mesh_floor, edge, sides}, Shape::triangles}}));
    cases.images("optical", "Fresnel products of a glass cube on a floor, in every pixel", no_failures("pixels"),
                 optical);

    const auto add = [&](const std::string& name, const char* exact, const Render& render) {
        cases.images(name, exact, no_failures("pixels"), render);
    };
    const char* in_one_piece = "the picture of the cube in one piece";
    add("blocks/eight", in_one_piece, blocks(2, 1));
    add("blocks/twenty-seven", in_one_piece, blocks(3, 1));
    add("blocks/in-any-order", in_one_piece, blocks(2, 4));
    add("blocks/convex-meshes", in_one_piece, blocks(3, 1, Shape::convex_mesh));
    add("blocks/meshes", in_one_piece, blocks(2, 2, Shape::triangles));
    const char* raised = "the picture with each decal raised by 2^-14";
    add("decals/on-a-floor", raised, decals(Under::floor));
    add("decals/on-a-tessellated-floor", raised, decals(Under::tessellated_floor));
    add("decals/on-a-solid", raised, decals(Under::solid));
    add("decals/on-a-mesh", raised, decals(Under::mesh));
    add("decals/on-glass", "each pixel is one of the label raised by 2^-14, or one of it lowered", label_on_glass);

    add("far", "the picture without what is far away, of bodies that touch and of bodies 2^-13 apart", far_away());

    const auto shadows = [&](const std::string& name, const Render& render) {
        cases.images("shadows/" + name, "every pixel that is not within 0.001 of an edge", bound_of_colors, render);
    };
    shadows("tinted", tinted({floor_, mesh_floor, edge, two_quads}));
    shadows("tinted/on-a-solid", tinted({solid}));
    shadows("no-leak", opaque({floor_, mesh_floor, solid}));
    shadows("neighbors", opaque({sides, along_edge, vertex, stack}));
    shadows("in-a-corner", opaque({corner}));
    shadows("over-the-edge", opaque({edge, two_quads}));

    // Cases that measure fail where a pixel is beyond their bound.
    const Bound fails = must_fail(5, "pixels"), is_off{Measure::worst, true, {0.01, 0.01}, "of 1"};
    const auto without = [&](const std::string& name, const Bound& bound, const Render& render) {
        cases.images("broken/" + name, "without shared planes the case fails", bound, broken(render));
    };
    without("invisible/on-a-floor", is_off, invisible({floor_}, Shape::planes));
    without("invisible/in-a-corner", is_off, invisible({corner}, Shape::planes));
    without("blocks", fails, blocks(2, 1));
    without("optical", fails, optical);
    without("decals", fails, decals(Under::floor));
    without("decals/on-a-solid", fails, decals(Under::solid));
    without("tinted-shadow", is_off, tinted({floor_, mesh_floor, edge, two_quads}));
    without("apart/on-a-floor", fails, apart({floor_}, Shape::planes));
    without("apart/stack", fails, apart({stack}, Shape::planes));
    cases.images("broken/far", "with a tolerance that a scene of 2^8 would have the case fails", fails,
                 far_away(0x1p-12));
}

}  // namespace cistula::verify

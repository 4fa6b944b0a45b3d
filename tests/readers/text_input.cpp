// The text input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <regex>

#include "scene/description/camera_path.h"
#include "scene/description/platonic.h"
#include "scene/readers/read_scene.h"
#include "scene/readers/scene_formats.h"
#include "testing/support/expect_error.h"
#include "testing/support/scene_dump.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

SceneDescription read_input(const std::string& text) {
    return read_scene_text(text, "input.txt", "");
}

/// The template with the first occurrence of `from` replaced.
std::string changed(const std::string& from, const std::string& to) {
    std::string text = text_input_template();
    const size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the template has no " + from);
    return text.replace(at, from.size(), to);
}

#define EXPECT_WRONG_INPUT(text, message) \
    EXPECT_ERROR(read_input(text), ExitCode::usage, std::string("input.txt:") + message)

TEST(TextInput, TemplateIsReadWhole) {
    const SceneDescription scene = read_input(text_input_template());
    EXPECT_TRUE(scene.from_text_input);
    EXPECT_EQ(scene.source, "input.txt");
    EXPECT_EQ(scene.film.frames, 300);
    EXPECT_EQ(scene.film.width, 1280);
    EXPECT_EQ(scene.film.height, 720);
    EXPECT_EQ(scene.film.supersample, 3);
    EXPECT_EQ(scene.film.output, "frames/frame%d.out");
    EXPECT_EQ(scene.depth, 4);
    EXPECT_EQ(scene.cutoff, 0);
    EXPECT_EQ(scene.ambient, glm::dvec3(0.5));
    EXPECT_EQ(scene.background, glm::dvec3(0));
    EXPECT_EQ(scene.camera.field_of_view, 120);
    EXPECT_EQ(scene.camera.time_step, 1);
    EXPECT_EQ(scene.camera.up, glm::dvec3(0, 0, 1));
    const auto numbers = [](const CylindricalPath& p) {
        return std::vector{p.r0, p.z0, p.phi0, p.Ar, p.Az, p.wr, p.wz, p.wphi, p.pr, p.pz};
    };
    EXPECT_EQ(numbers(scene.camera.position_path.value()),
              (std::vector{6.0, 5.0, 0.0, 2.0, 1.0, 0.05, 0.1, 0.05, 0.0, 0.0}));
    EXPECT_EQ(numbers(scene.camera.target_path.value()),
              (std::vector{3.0, 0.0, 3.1415926, 1.5, 0.5, 0.03, 0.07, 0.02, 0.0, 0.0}));
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_TRUE(scene.textures[0].is_checker());
    EXPECT_EQ(read_input(changed("checker", "./checker")).textures[0].file, "./checker");
    EXPECT_FALSE(scene.frame);
}

TEST(TextInput, TheExampleIsTheTemplateForTheRepository) {
    const SceneDescription scene = read_input(bytes_of((source_root() / "scenes/input.txt").string()));
    EXPECT_TRUE(std::filesystem::exists(source_root() / scene.textures.at(0).file));
    EXPECT_EQ(scene.film.output, "out/frames/frame%d.out");
    const std::string same = changed("checker\nframes/", "scenes/floor.data\nout/frames/");
    EXPECT_EQ(SceneDump::of(scene), SceneDump::of(read_input(same)));
}

TEST(TextInput, SolidsFloorAndLights) {
    const SceneDescription scene = read_input(text_input_template());
    ASSERT_EQ(scene.objects.size(), 4u);
    const auto& dodecahedron = std::get<SolidObject>(scene.objects[1].shape);
    EXPECT_EQ(dodecahedron.solid, PlatonicSolid::dodecahedron);
    EXPECT_EQ(dodecahedron.center, glm::dvec3(2.5, 2.5, 2));
    EXPECT_EQ(dodecahedron.radius, 1.732);
    EXPECT_EQ(dodecahedron.edge_lights.count, 0);
    EXPECT_EQ(scene.objects[1].place, "line 8");
    const MaterialDescription& glass = scene.materials.at(static_cast<size_t>(scene.objects[1].material));
    EXPECT_EQ(glass.color, glm::dvec3(0.49, 0.3216, 0.0078));
    EXPECT_EQ(glass.specular_color, glass.color);
    EXPECT_EQ(glass.tint, glm::dvec3(1));
    EXPECT_EQ((std::vector{glass.ambient, glass.diffuse, glass.specular, glass.exponent, glass.index, glass.reflection,
                           glass.transmission}),
              (std::vector{1.0, 1.0, 1.0, 110.0, 1.5, 0.1, 0.6}));
    const MaterialDescription& floor = scene.materials.at(static_cast<size_t>(scene.objects[3].material));
    EXPECT_EQ(floor.texture, 0);
    EXPECT_EQ(floor.color, glm::dvec3(1));
    EXPECT_EQ(floor.specular_color, glm::dvec3(1));
    EXPECT_EQ(floor.reflection, 0.5);
    EXPECT_EQ(floor.transmission, 0);
    const auto& quad = std::get<TrianglesObject>(scene.objects[3].shape);
    EXPECT_EQ(quad.vertices[1], glm::dvec3(5, -5, 0));
    EXPECT_EQ(quad.uvs[1], glm::dvec2(1, 0));
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[1].position, glm::dvec3(5, 0, 4));
    const LightDescription red = read_input(changed("-4 4 3 1 1 1", "-4 4 3 1 0 0")).lights.at(0);
    EXPECT_EQ(red.color, glm::dvec3(1, 0, 0));
    EXPECT_EQ(red.glow, glm::dvec3(1));
    EXPECT_EQ(red.radius, 0.1);
    EXPECT_FALSE(red.falloff);
}

TEST(TextInput, EqualsTheJsonSceneButForItsCamera) {
    SceneDescription json = read_scene((source_root() / "scenes/seed.json").string());
    EXPECT_EQ(std::filesystem::path(json.textures.at(0).file), source_root() / "scenes/floor.data");
    json.textures[0].file = "floor.data";
    const SceneDescription text = read_input(changed("checker", "floor.data"));
    json.camera = text.camera;
    EXPECT_EQ(SceneDump::of(text), SceneDump::of(json));
}

TEST(TextInput, TheFilmOfTheJsonSceneKeepsItsSolidsInThePicture) {
    const SceneDescription scene = read_scene((source_root() / "scenes/seed.json").string());
    ASSERT_EQ(scene.film.frames, 300);
    for (int frame = 0; frame < scene.film.frames; ++frame) {
        const Camera camera = camera_at(scene.camera, frame).camera;
        const double tan_half_height = camera.tan_half_width * scene.film.height / scene.film.width;
        for (size_t i = 0; i < 3; ++i) {
            const auto& solid = std::get<SolidObject>(scene.objects.at(i).shape);
            for (const glm::dvec3& vertex : platonic_shape(solid.solid).vertices) {
                const glm::dvec3 point = solid.center + solid.radius * vertex;
                const Vec3<double> to_point = Vec3<double>(point.x, point.y, point.z) - camera.position;
                const double depth = dot(to_point, camera.forward);
                EXPECT_GT(depth, 0) << frame;
                EXPECT_LT(std::abs(dot(to_point, camera.right)), depth * camera.tan_half_width) << frame;
                EXPECT_LT(std::abs(dot(to_point, camera.up)), depth * tan_half_height) << frame;
            }
        }
    }
}

TEST(TextInput, TenthNumberIsTheLightsOnEachEdge) {
    const std::string line = "1.732 0.1 0.6";
    const auto lights = [&](const std::string& more, size_t object = 1) {
        return std::get<SolidObject>(read_input(changed(line, line + more)).objects.at(object).shape).edge_lights;
    };
    EXPECT_EQ(lights("").count, 0);
    EXPECT_EQ(lights(" 6").count, 6);
    EXPECT_EQ(lights("\t6 \r").count, 6);
    EXPECT_EQ(lights(" 0").count, 0);
    EXPECT_EQ(lights(" 6", 0).count, 0);
    EXPECT_EQ(lights(" 6", 2).count, 0);
    EXPECT_EQ(lights(" 6").color, glm::dvec3(1));
    EXPECT_FALSE(lights(" 6").falloff);
    // An edge of a dodecahedron is 0.7136... of its radius.
    EXPECT_NEAR(lights(" 6").radius, 1.732 * 0.71364417954617986 / 7 / 4, 1e-15);
    EXPECT_EQ(lights(" 1").radius, 0.1);

    std::string all = std::regex_replace(text_input_template(), std::regex("0\\.6\n"), "0.6 2\n");
    EXPECT_EQ(std::get<SolidObject>(read_input(all).objects.at(2).shape).edge_lights.count, 2);
    EXPECT_EQ(read_input(all).lights.size(), 2u);
}

TEST(TextInput, AnyWhiteSpaceSeparates) {
    const std::string expected = SceneDump::of(read_input(text_input_template()));
    for (const char* white : {" ", "\t", "\r\n", "\n\n", "\n  "}) {
        const std::string text = std::regex_replace(text_input_template(), std::regex("\n"), white);
        EXPECT_EQ(SceneDump::of(read_input(text)), expected);
        const std::string every = std::regex_replace(text_input_template(), std::regex("[ \n]"), white);
        EXPECT_EQ(SceneDump::of(read_input(every)), expected);
    }
}

TEST(TextInput, NumbersAsPeopleWriteThem) {
    EXPECT_EQ(read_input(changed("1280 720 120", "+1280 720. 1.2e2")).film.height, 720);
    for (const char* wrong : {"nan", "inf", "0x10", "1e999", "1,5", "--1", "+-1", "12a", "1e", "."})
        EXPECT_WRONG_INPUT(changed("6.0", wrong),
                           "5: expected camera r0, a number from -1e30 to 1e30, found '" + std::string(wrong) + "'");
}

TEST(TextInput, WrongValuesNameWhatIsExpected) {
    EXPECT_WRONG_INPUT(changed("300", "many"),
                       "1: expected number of frames, a whole number from 1 to 1000000, found 'many'");
    EXPECT_WRONG_INPUT(changed("300", "0"),
                       "1: expected number of frames, a whole number from 1 to 1000000, found '0'");
    EXPECT_WRONG_INPUT(changed("300", "2.5"),
                       "1: expected number of frames, a whole number from 1 to 1000000, found '2.5'");
    EXPECT_WRONG_INPUT(changed("frame%d.out", "frame.out"),
                       "3: expected an output pattern with one %d, found 'frames/frame.out'");
    for (const char* pattern : {"%d%d", "%s%d", "%n", "%", "%4d", "%%d", "%00d", "%0d"})
        EXPECT_WRONG_INPUT(changed("frames/frame%d.out", pattern),
                           "3: expected an output pattern with one %d, found '" + std::string(pattern) + "'");
    EXPECT_EQ(read_input(changed("%d", "%04d")).film.output, "frames/frame%04d.out");
    EXPECT_WRONG_INPUT(changed("1280", "0"), "4: expected picture width, a whole number from 1 to 65536, found '0'");
    EXPECT_WRONG_INPUT(changed("720", "x"), "4: expected picture height, a whole number from 1 to 65536, found 'x'");
    EXPECT_WRONG_INPUT(changed("720 120", "720 180"),
                       "4: expected horizontal field of view, a number above 0, under 180, found '180'");
    EXPECT_WRONG_INPUT(changed("3.1415926", "pi"),
                       "6: expected target phi0, a number from -1000000 to 1000000, found 'pi'");
    EXPECT_WRONG_INPUT(changed("-2.5 2.5 2 ", "-2.5 2.5 high "),
                       "7: expected octahedron center z, a number from -1e30 to 1e30, found 'high'");
    EXPECT_WRONG_INPUT(changed("0.3216", "-0.3216"),
                       "8: expected dodecahedron color green, a number from 0 to 1e30, found '-0.3216'");
    EXPECT_WRONG_INPUT(changed("2.118", "0"), "9: expected icosahedron radius, a number from 1e-30 to 1e30, found '0'");
    EXPECT_WRONG_INPUT(changed("2.118 0.1", "2.118 1.1"),
                       "9: expected icosahedron reflection, a number from 0 to 1, found '1.1'");
    EXPECT_WRONG_INPUT(changed("2.118 0.1 0.6", "2.118 0.1 60%"),
                       "9: expected icosahedron transmission, a number from 0 to 1, found '60%'");
    EXPECT_WRONG_INPUT(changed("2.25 0.1 0.6", "2.25 0.5 0.6"),
                       "7: octahedron reflection + transmission is 1.1; expected at most 1");
    EXPECT_WRONG_INPUT(changed("2.25 0.1 0.6", "2.25 0.1 0.6 -1"),
                       "7: expected octahedron lights on each edge, a whole number from 0 to 1000, found '-1'");
    EXPECT_WRONG_INPUT(changed("2.25 0.1 0.6", "2.25 0.1 0.6 6 6"),
                       "7: expected 9 or 10 numbers for the octahedron, found 11");
    EXPECT_WRONG_INPUT(changed("5 -5 0\n", "5 y 0\n"),
                       "10: expected floor corner 1 y, a number from -1e30 to 1e30, found 'y'");
    EXPECT_WRONG_INPUT(
        changed("\n5 5 0", "\n5 5 1"),
        "13: floor: the quad is not planar: its diagonals pass at 0.035 of their length, at most 1e-06 is allowed");
    EXPECT_WRONG_INPUT(changed("\n2\n", "\n-2\n"),
                       "14: expected number of lights, a whole number from 0 to 100000, found '-2'");
    EXPECT_WRONG_INPUT(changed("-4 4 3 1", "-4 4 3 red"),
                       "15: expected light 1 color red, a number from 0 to 1e30, found 'red'");
    EXPECT_WRONG_INPUT(changed("5 0 4 1", "5 - 4 1"),
                       "16: expected light 2 position y, a number from -1e30 to 1e30, found '-'");
    EXPECT_WRONG_INPUT(changed("\n4 3", "\n0 3"), "17: expected depth, a whole number from 1 to 1024, found '0'");
    EXPECT_WRONG_INPUT(changed("\n4 3", "\n4 65"),
                       "17: expected supersampling k, a whole number from 1 to 64, found '65'");
}

TEST(TextInput, TrailingTextIsAnError) {
    EXPECT_WRONG_INPUT(text_input_template() + "\n1", "19: expected the end of the input, found '1'");
    EXPECT_WRONG_INPUT(text_input_template() + std::string(100, 'x'),
                       "18: expected the end of the input, found '" + std::string(40, 'x') + "...'");
}

TEST(TextInput, EveryShorterInputSaysWhatIsMissing) {
    const std::string text = text_input_template();
    size_t words = 0;
    std::string last;
    for (size_t end = text.find_last_not_of('\n'); end != std::string::npos && end > 0;) {
        const size_t start = text.find_last_of(" \n", end) + 1;  // npos + 1 is 0
        if (start == 0) break;
        try {
            read_input(text.substr(0, start));
            ADD_FAILURE() << "read without its last " << words + 1 << " words";
        } catch (const Error& error) {
            const std::string message = error.what();
            EXPECT_EQ(error.kind(), ErrorKind::scene);
            EXPECT_TRUE(message.ends_with("found the end of the input")) << message;
            EXPECT_NE(message, last);
            last = message;
        }
        ++words;
        end = text.find_last_not_of(" \n", start - 1);
    }
    EXPECT_EQ(words, 79u);  // all but the first
    EXPECT_WRONG_INPUT("300 ", "1: expected the floor's texture file, found the end of the input");
    EXPECT_WRONG_INPUT(text.substr(0, text.find("\n4 3") + 3),
                       "17: expected supersampling k, a whole number from 1 to 64, found the end of the input");
}

TEST(TextInput, MessagesAreOneLine) {
    EXPECT_WRONG_INPUT("300 a \x01%", "1: expected an output pattern with one %d, found '\\x01%'");
}

/// The order of the assignment, with another number on each place.
constexpr const char* in_order_of_assignment = R"(6
out/%d.data
64 48 90
5 3 0.1 1 0.5 2 3 1 0.2 0.4
1 0.25 0.3 0.5 0.125 1 4 2 0.6 0.8
2 0 1.5 1 0.2 0.1 1.2 0.4 0.5 5
0 2 1.5 0.1 0.9 0.3 1.1 0.3 0.6 4
-2 -1 1.5 0.2 0.5 0.9 1.3 0.2 0.7 3
-7 -5 0 -7 5 0 7 5 0 7 -5 0 wood.data 0.8 0.9 0.7 0.4
1
-8 1 9 0.9 0.8 0.7
6 2
)";

std::string changed_assignment(const std::string& from, const std::string& to) {
    std::string text = in_order_of_assignment;
    return text.replace(text.find(from), from.size(), to);
}

TEST(TextInput, TheOrderOfTheAssignmentIsToldByTheSecondLine) {
    const SceneDescription scene = read_scene_text(in_order_of_assignment, "in/a.txt", "in");
    EXPECT_TRUE(scene.from_text_input);
    EXPECT_EQ(scene.film.frames, 6);
    EXPECT_EQ(scene.film.output, "out/%d.data");
    EXPECT_EQ(scene.film.width, 64);
    EXPECT_EQ(scene.film.height, 48);
    EXPECT_EQ(scene.camera.field_of_view, 90);
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].file, "in/wood.data");
    EXPECT_TRUE(scene.textures[0].bilinear);
    ASSERT_EQ(scene.objects.size(), 4u);
    EXPECT_EQ(std::get<SolidObject>(scene.objects[0].shape).edge_lights.count, 5);
    EXPECT_EQ(std::get<SolidObject>(scene.objects[2].shape).edge_lights.count, 3);
    const auto& floor = std::get<TrianglesObject>(scene.objects[3].shape);
    EXPECT_EQ(floor.vertices, (std::vector<glm::dvec3>{{-7, -5, 0}, {-7, 5, 0}, {7, 5, 0}, {7, -5, 0}}));
    const MaterialDescription& material = scene.materials[static_cast<size_t>(scene.objects[3].material)];
    EXPECT_EQ(material.texture, 0);
    EXPECT_EQ(material.color, glm::dvec3(0.8, 0.9, 0.7));
    EXPECT_EQ(material.specular_color, glm::dvec3(1));
    EXPECT_EQ(material.reflection, 0.4);
    EXPECT_EQ(material.transmission, 0);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].color, glm::dvec3(0.9, 0.8, 0.7));
    EXPECT_EQ(scene.depth, 6);
    EXPECT_EQ(scene.film.supersample, 2);
    // A place for the number that is written wrongly tells the order too.
    EXPECT_WRONG_INPUT(changed_assignment("%d", "%5d"),
                       "2: expected an output pattern with one %d, found 'out/%5d.data'");
    EXPECT_WRONG_INPUT(changed_assignment("%d", "%d%d"),
                       "2: expected an output pattern with one %d, found 'out/%d%d.data'");
    EXPECT_WRONG_INPUT(changed_assignment("%d", "100%"), "3: expected an output pattern with one %d, found '64'");
    EXPECT_EQ(read_input(changed("checker", "100%.data")).textures[0].file, "100%.data");
}

TEST(TextInput, InTheOrderOfTheAssignmentTimeRunsOnceAround) {
    const SceneDescription scene = read_input(in_order_of_assignment);
    for (int frame = 0; frame <= 6; ++frame) {
        const double t = 2 * 3.14159265358979323846 * frame / 6;
        const CameraFrame at = camera_at(scene.camera, frame);
        EXPECT_NEAR(at.time, t, 1e-15 * 8);
        const double r = 5 + 1 * std::sin(2 * t + 0.2), z = 3 + 0.5 * std::sin(3 * t + 0.4), phi = 0.1 + t;
        EXPECT_NEAR(at.camera.position.x, r * std::cos(phi), 1e-13);
        EXPECT_NEAR(at.camera.position.y, r * std::sin(phi), 1e-13);
        EXPECT_NEAR(at.camera.position.z, z, 1e-13);
        const double rn = 1 + 0.5 * std::sin(t + 0.6), zn = 0.25 + 0.125 * std::sin(4 * t + 0.8), phin = 0.3 + 2 * t;
        const glm::dvec3 target{rn * std::cos(phin), rn * std::sin(phin), zn};
        const glm::dvec3 view = target - glm::dvec3{at.camera.position.x, at.camera.position.y, at.camera.position.z};
        const glm::dvec3 forward{at.camera.forward.x, at.camera.forward.y, at.camera.forward.z};
        EXPECT_NEAR(glm::length(view / glm::length(view) - forward), 0, 1e-13);
    }
}

TEST(TextInput, InTheOrderOfTheAssignmentErrorsNameTheFloorsParts) {
    EXPECT_WRONG_INPUT(changed_assignment(" wood.data", ""), "9: expected the floor's texture file, found '0.8'");
    EXPECT_WRONG_INPUT(changed_assignment("0.8 0.9 0.7 0.4", "0.8 0.9 0.7 1.4"),
                       "9: expected floor reflection, a number from 0 to 1, found '1.4'");
    EXPECT_WRONG_INPUT(changed_assignment("0.8 0.9", "0.8 blue"),
                       "9: expected floor tint green, a number from 0 to 1e30, found 'blue'");
}

}  // namespace
}  // namespace cistula

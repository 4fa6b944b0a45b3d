// A scene as people write it, after parsing: names resolved to indices, files not yet opened (but for meshes and
// textures, see their fields), lengths in scene units, angles in degrees unless said otherwise, colours linear RGB.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace cistula {

struct MaterialDescription {
    std::string name;
    glm::dvec3 color{0.8};
    int texture = -1;  // index into SceneDescription::textures; multiplies color
    double ambient = 1, diffuse = 1, specular = 0;
    glm::dvec3 specular_color{1};
    double exponent = 50;
    double reflection = 0, transmission = 0;  // kr + kt <= 1
    glm::dvec3 tint{1};
    double index = 1;
    glm::dvec3 absorption{0};  // per unit of length
    bool fresnel = false;
};

struct TextureDescription {
    std::string name;
    std::string file;  // absolute or relative to the working directory; empty: a checker
    std::array<glm::dvec3, 2> checker{glm::dvec3{1}, glm::dvec3{0}};
    bool bilinear = true;  // a checker is always nearest
    glm::dvec2 repeat{1};  // uv are multiplied by this; a checker's period is one unit of uv, two cells
};

enum class PlatonicSolid { tetrahedron, cube, octahedron, dodecahedron, icosahedron };

struct EdgeLights {
    int count = 0;  // on every edge, at (i + 1) / (count + 1) of it
    glm::dvec3 color{1};
    std::optional<glm::dvec3> glow;  // radiance of the seen sphere; default: color
    double radius = 0;               // 0: not seen
    bool falloff = false;
};

struct SolidObject {
    PlatonicSolid solid = PlatonicSolid::octahedron;
    glm::dvec3 center{0};
    double radius = 1;       // of the circumscribed sphere
    glm::dvec3 rotation{0};  // degrees about x, then y, then z
    EdgeLights edge_lights;
};

/// Quads and triangle lists. Closed ones become solids with an inside, others are sheets seen from both sides.
struct TrianglesObject {
    std::vector<glm::dvec3> vertices;
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<glm::dvec2> uvs;  // one a vertex, or none
};

struct MeshObject {
    std::string file;      // PLY or OBJ
    glm::dvec3 center{0};  // added last
    double scale = 1;
    glm::dvec3 rotation{0};
};

struct ObjectDescription {
    std::string name;
    int material = -1;  // -1 only for a mesh that brings its own
    std::variant<SolidObject, TrianglesObject, MeshObject> shape;
    std::string place;  // where it stands in the file, for messages: "/objects/2"
};

struct LightDescription {
    glm::dvec3 position{0};
    glm::dvec3 color{1};  // intensity; 0: lights nothing, may still be seen
    std::optional<glm::dvec3> glow;
    double radius = 0;     // 0: not seen
    bool falloff = false;  // 1/r^2, clamped at radius, which must then be above 0
    std::string place;
};

/// c(t) = r, phi, z by the seed's sinusoids: r = r0 + Ar sin(wr t + pr), z alike, phi = phi0 + wphi t; radians.
struct CylindricalPath {
    double r0 = 0, z0 = 0, phi0 = 0, Ar = 0, Az = 0, wr = 0, wz = 0, wphi = 0, pr = 0, pz = 0;
};

struct CameraDescription {
    glm::dvec3 position{0, -5, 2}, target{0};
    std::optional<CylindricalPath> position_path, target_path;  // replace position and target
    glm::dvec3 up{0, 0, 1};
    double field_of_view = 60;  // horizontal, degrees
    double time_step = 1;       // t advances by this a frame
};

struct FilmDescription {
    int width = 640, height = 480;
    int frames = 1;
    int supersample = 1;
    std::string output;  // the seed's output pattern; empty: none given
};

struct FrameOfReference {
    glm::dvec3 center{0};
    int scale = 0;                // coordinates are multiplied by 2^scale
    std::optional<double> bound;  // pins the radiance bound
};

struct SceneDescription {
    std::string source;  // file name, for messages; "-" for standard input
    FilmDescription film;
    CameraDescription camera;
    int depth = 4;
    double cutoff = 0;
    glm::dvec3 ambient{0.1}, background{0};
    std::vector<TextureDescription> textures;
    std::vector<MaterialDescription> materials;
    std::vector<ObjectDescription> objects;  // file order is the priority of their media
    std::vector<LightDescription> lights;
    std::optional<FrameOfReference> frame;
    bool seed_format = false;  // came from the seed's text input
};

}  // namespace cistula

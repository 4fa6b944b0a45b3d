// A scene as its author writes it, after parsing: names are resolved to indices; files are not opened yet
// (assets/assets.h). Lengths in scene units, angles in degrees unless said otherwise, colours linear RGB.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "cistula/model/scene_view.h"

namespace cistula {

/// The numbers that rays are traced with.
enum class Precision { single_, double_ };
constexpr const char* precision_name(Precision precision) {
    return precision == Precision::double_ ? "double" : "float";
}

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
    std::string map;  // of an OBJ's material: the picture that its library names for the color; renders do without
};

struct MeshData;    // readers/meshes/polygon_mesh.h
struct TexelArray;  // image/reader/picture_reader.h

/// A file, an array instead, or a checkerboard where there is neither.
struct TextureDescription {
    std::string name;
    std::string file;                          // absolute or relative to the working directory
    std::shared_ptr<const TexelArray> texels;  // of a program that has no file
    std::array<glm::dvec3, 2> checker{glm::dvec3{1}, glm::dvec3{0}};
    bool bilinear = true;               // ignored by a checkerboard, which is always nearest
    glm::dvec2 repeat{1};               // factor on uv; a checkerboard's period is 1 in uv: two cells
    std::array<TextureWrap, 2> wrap{};  // beyond the edges, along u, v
    std::string colorspace;  // one of color_encoding_names (image/color/color_encoding.h); empty: what the file says
    bool strict = false;     // texels that are negative or not finite are an error, and not clamped
    std::string place;       // "/textures/tiles", "line 3"

    bool is_checker() const { return file.empty() && !texels; }
};

enum class PlatonicSolid { tetrahedron, cube, octahedron, dodecahedron, icosahedron };

struct EdgeLights {
    int count = 0;  // lights on every edge, at (i + 1) / (count + 1) of its length
    glm::dvec3 color{1};
    std::optional<glm::dvec3> glow;  // radiance of the visible sphere; default: color
    double radius = 0;               // 0: not visible
    bool visible = true;             // false: the radius is of the falloff alone
    bool falloff = false;
    std::string group;  // the light layer that they are part of; empty: one of their own

    bool shown() const { return visible && radius > 0; }
};

struct Polyhedron;  // polyhedron.h

/// A convex body given by its planes: a Platonic solid, or any.
struct SolidObject {
    PlatonicSolid solid = PlatonicSolid::octahedron;
    std::shared_ptr<const Polyhedron> body;  // in place of the Platonic solid
    glm::dvec3 center{0};
    double radius = 1;       // factor of the body; of a Platonic solid, of the circumscribed sphere
    glm::dvec3 rotation{0};  // degrees about x, then y, then z
    EdgeLights edge_lights;
};

/// A solid sphere. A texture's longitudes run about its z axis, which `rotation` turns.
struct SphereObject {
    glm::dvec3 center{0};
    double radius = 1;
    glm::dvec3 rotation{0};  // degrees about x, then y, then z
};

/// How a mesh is shaded: without a value by the normals that it has, else by the means of those faces around a corner
/// that meet at angles less than this, in degrees; 0: by its faces.
using Smoothing = std::optional<double>;
/// A sheet: a disk, or a plane without end.
struct DiskObject {
    glm::dvec3 center{0};  // of a plane: its point nearest to the origin
    glm::dvec3 normal{0, 0, 1};
    double radius = 1;  // infinite for a plane

    bool is_endless() const { return radius > std::numeric_limits<double>::max(); }
    /// The plane normal.x = offset.
    static DiskObject plane(const glm::dvec3& normal, double offset) {
        return {offset / dot(normal, normal) * normal, normal, std::numeric_limits<double>::infinity()};
    }
};

/// A mesh given in the scene file. Closed meshes become solids with an inside, others are sheets seen from both sides.
/// Convex solids with flat faces are given by planes, unless they keep their triangles.
struct TrianglesObject {
    std::vector<glm::dvec3> vertices;
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<glm::dvec2> uvs;      // one per vertex, or none
    std::vector<glm::dvec3> normals;  // one per vertex, or none; of any length
    bool keep_triangles = false;
    Smoothing smooth;
};

/// A mesh that may have polygons, groups and materials of its own, and is placed.
struct MeshObject {
    std::string file;                      // PLY or OBJ
    std::shared_ptr<const MeshData> data;  // instead of the file, of a program that has none
    glm::dvec3 center{0};                  // translation, applied last
    double scale = 1;
    glm::dvec3 rotation{0};
    bool keep_triangles = false;
    Smoothing smooth;
};

struct ObjectDescription {
    std::string name;
    int material = -1;  // -1 only for a mesh that brings its own
    std::variant<SolidObject, SphereObject, DiskObject, TrianglesObject, MeshObject> shape;
    std::string place;  // JSON pointer of the object in the file, for messages: "/objects/2"
};

struct LightDescription {
    glm::dvec3 position{0};
    glm::dvec3 color{1};  // intensity; 0: gives no light, may still be visible
    std::optional<glm::dvec3> glow;
    double radius = 0;     // 0: not visible
    bool visible = true;   // false: the radius is of the falloff alone
    bool falloff = false;  // 1 / distance^2, clamped at radius, which must then be positive
    std::string group;     // the light layer that it is part of; empty: one of its own
    std::string place;

    bool shown() const { return visible && radius > 0; }
};

/// A path of the camera in cylindrical coordinates, in the text input's sinusoids of time: r = r0 + Ar sin(wr t + pr),
/// z likewise, phi = phi0 + wphi t. Angles in radians.
struct CylindricalPath {
    double r0 = 0, z0 = 0, phi0 = 0, Ar = 0, Az = 0, wr = 0, wz = 0, wphi = 0, pr = 0, pz = 0;
};

struct CameraDescription {
    glm::dvec3 position{0, -5, 2}, target{0};
    std::optional<CylindricalPath> position_path, target_path;  // replace position and target
    glm::dvec3 up{0, 0, 1};
    double field_of_view = 60;     // horizontal, degrees
    double time_step = 1;          // increase of t per frame
    std::string place = "camera";  // what moves it, for messages: "scene.json: /camera/path", "input.txt:5"
    /// What it is at a frame, or between two, where keys move it; empty: they do not. Throws Error.
    std::function<CameraDescription(double frame)> at;
};

struct FilmDescription {
    int width = 640;
    int height = 480;
    int frames = 1;
    int supersample = 1;
    int rate = 0, rate_divisor = 1;  // frames per second are their quotient; 0: none given
    std::string owner, comments;     // for the headers of files; empty: none given
    std::string output;              // the seed's pattern for output files; empty: none given
};

/// A color of a gradient, at an angle to its axis in degrees.
struct SkyColor {
    double degrees = 0;
    glm::dvec3 color{0};
};

/// What is around a scene in place of a background of one color: a gradient, or a picture by longitude and latitude.
struct SkyDescription {
    glm::dvec3 axis{0, 0, 1};
    std::vector<SkyColor> stops;  // of a gradient, by ascending angles; two of one angle are an edge
    int texture = -1;             // of a picture: index into SceneDescription::textures
    glm::dvec3 rotation{0};       // of a picture: degrees about x, then y, then z
    double scale = 1;             // of a picture's texels
};

struct FrameOfReference {
    glm::dvec3 center{0};
    int scale = 0;                // coordinates are multiplied by 2^scale
    std::optional<double> bound;  // the radiance bound, instead of the computed one
};

struct SceneDescription;

/// What keys change from frame to frame, but for the camera.
struct Motion {
    std::vector<int> frames;              // those at keys, or around them, ascending; nothing changes outside of them
    std::vector<size_t> objects, lights;  // that change
    std::function<void(SceneDescription&, int frame)> set;  // gives a description a frame's values; throws Error
};

struct SceneDescription {
    std::string source;  // file name, for messages; "-" for standard input
    FilmDescription film;
    CameraDescription camera;
    int depth = 4;
    double cutoff = 0;
    std::optional<double> contact;  // faces that are no farther apart touch; none: 2^-20 of the scene's extent
    glm::dvec3 ambient{0.1}, background{0};
    std::optional<SkyDescription> sky;  // in place of the background, which is then 0
    std::vector<TextureDescription> textures;
    std::vector<MaterialDescription> materials;
    std::vector<ObjectDescription> objects;  // in file order, which is the priority order of their media
    std::vector<LightDescription> lights;
    std::optional<FrameOfReference> frame;
    bool from_text_input = false;            // read from the text input
    std::optional<uint64_t> texture_bytes;   // that all texels may take; none: default_texture_bytes()
    std::shared_ptr<const Motion> motion;    // null: no keys change it
    int shown = 0;                           // the frame that its values are of
    bool still = false;                      // it stays as that frame has it
    std::vector<std::string> warnings = {};  // of its reader, on all frames
};

/// A description that stays as a frame has it. Throws Error.
inline SceneDescription at_frame(SceneDescription description, int frame) {
    if (description.motion) description.motion->set(description, frame);
    description.still = true;
    return description;
}

}  // namespace cistula

#include "scene/readers/meshes/mesh_formats.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/decimal.h"
#include "base/error.h"
#include "base/suggest.h"
#include "cistula/numerics/vec.h"
#include "scene/readers/meshes/mesh_text.h"
#include "scene/readers/scene_keys.h"

namespace cistula {
namespace {

using glm::dvec3;

/// What a library says of one material.
struct Statements {
    dvec3 Kd{0.6}, Ks{0};
    double Ns = 0, Ni = 1;
    std::optional<double> d, Tr;
    dvec3 Tf{1};
    int illum = 1;
    std::string map_Kd;
};

/// Whether a Tf is a color to filter by: black and white are what exporters write where they have nothing to say.
bool is_filter(const dvec3& Tf) {
    return Tf != dvec3{0} && !(Tf.x >= 1 && Tf.y >= 1 && Tf.z >= 1);
}

/// What transmitted light is multiplied by.
dvec3 tint_of(const Statements& from) {
    dvec3 tint = is_filter(from.Tf) ? from.Tf : from.Kd;
    if (from.Kd == dvec3{0} && from.Tf != dvec3{0} && !is_filter(from.Tf)) tint = dvec3{1};
    for (int c = 0; c < 3; ++c) tint[c] = std::min(tint[c], 1.0);
    return tint;
}

MaterialDescription material_of(const std::string& name, const Statements& from) {
    MaterialDescription m;
    m.name = name;
    m.color = from.Kd;
    m.map = from.map_Kd;
    m.exponent = from.Ns;
    if (from.Ni > 0) m.index = from.Ni;
    m.transmission = from.d ? 1 - *from.d : from.Tr.value_or(0);
    const dvec3 specular = from.illum >= 2 ? from.Ks : dvec3{0};
    const double strongest = std::max({specular.x, specular.y, specular.z});
    if (strongest > 0) {
        m.specular = strongest;
        m.specular_color = specular / strongest;
    }
    if (from.illum == 0) m.diffuse = 0;  // constant color, independent of the lights
    const bool reflects = from.illum >= 3 && from.illum <= 9;
    if (reflects) m.reflection = std::min(strongest, 1.0);
    m.fresnel = from.illum == 5 || from.illum == 7;
    if (m.transmission > 0) m.tint = tint_of(from);
    // Transmitted light cannot be reflected as well.
    if (m.reflection + m.transmission > 1) m.reflection = 1 - m.transmission;
    return m;
}

/// Options of maps, with the greatest number of values that follow them.
struct MapOption {
    std::string_view name;
    int most_values;
};
constexpr MapOption map_options[] = {{"-blendu", 1}, {"-blendv", 1},  {"-boost", 1}, {"-bm", 1}, {"-cc", 1},
                                     {"-clamp", 1},  {"-imfchan", 1}, {"-mm", 2},    {"-o", 3},  {"-s", 3},
                                     {"-t", 3},      {"-texres", 1},  {"-type", 1}};

class MtlReader {
  public:
    MtlReader(std::string_view text, const std::string& label, const std::function<bool(const std::string&)>& has_map,
              MaterialLibrary& library)
        : lines_(text), label_(label), has_map_(has_map), library_(library) {}

    void read() {
        while (lines_.next()) {
            if (lines_.words()[0] != "newmtl") {
                read_statement(lines_.words()[0]);
                continue;
            }
            material_ = &all_[utf8_name(lines_.rest(1))];  // some exporters give none
        }
        for (const auto& [name, statements] : all_) {
            const MaterialDescription material = material_of(name, statements);
            if (material.transmission == 0 && is_filter(statements.Tf)) library_.ignored.add("Tf");
            library_.materials.insert_or_assign(name, material);
        }
    }

  private:
    [[noreturn]] void fail(const std::string& problem, const char* remedy = "") const {
        throw Error(ErrorKind::file, problem, remedy).at(fmt::format("{}:{}", label_, lines_.line()));
    }

    void read_statement(std::string_view key) {
        const bool map = key.starts_with("map_") || key == "bump" || key == "disp" || key == "decal" || key == "refl" ||
                         key == "norm";
        constexpr std::string_view others[] = {"Kd", "Ks", "Ka", "Ke", "Tf", "Ns", "Ni", "d", "Tr", "illum"};
        const bool known = map || std::find(std::begin(others), std::end(others), key) != std::end(others);
        if (known && !material_)
            fail(fmt::format("{} before the first newmtl", quoted(key)), "a material begins with newmtl");
        if (map) return read_map(key);
        if (!known) return library_.ignored.add(key);
        if (key == "Kd") read_color(key, material_->Kd);
        if (key == "Ks") read_color(key, material_->Ks);
        if (key == "Ke") ignore_unless(key, 0);
        if (key == "Tf") read_color(key, material_->Tf);
        if (key == "Ns") material_->Ns = number(key, 1, most_of("exponent"));
        if (key == "Ni") material_->Ni = number(key, 1, most_of("index"));
        if (key == "Tr") material_->Tr = number(key, 1, 1);
        if (key == "d") {
            const bool halo = lines_.words().size() > 1 && lines_.words()[1] == "-halo";
            if (halo) library_.ignored.add("-halo");
            material_->d = number(key, halo ? 2 : 1, 1);
        }
        if (key == "illum") material_->illum = static_cast<int>(std::floor(number(key, 1, 1000)));
    }

    /// The largest number that a scene's material may have under a key of its own.
    static double most_of(std::string_view scene_key) { return material_keys.find(scene_key)->range.high; }

    /// Word `i` as a number from 0 to `most`.
    double number(std::string_view key, size_t i, double most) const {
        const std::string range = "from 0 to " + number_text(most);
        if (i >= lines_.words().size()) fail(fmt::format("{} needs a number {}", key, range));
        const auto value = decimal<double>(lines_.words()[i]);
        if (!value || !(*value >= 0 && *value <= most))
            fail(fmt::format("{}: expected a number {}, found {}", key, range, quoted(lines_.words()[i])));
        return *value;
    }

    /// One number stands for all three.
    void read_color(std::string_view key, dvec3& color) {
        const auto& words = lines_.words();
        if (words.size() > 1 && (words[1] == "spectral" || words[1] == "xyz"))
            return library_.ignored.add(fmt::format("{} {}", key, words[1]));
        for (int c = 0; c < 3; ++c)
            color[c] = number(key, words.size() == 2 ? 1 : static_cast<size_t>(c) + 1, most_of("color"));
    }

    /// Notes a key without meaning here, unless its value is the one that changes nothing.
    void ignore_unless(std::string_view key, double neutral) {
        for (size_t i = 1; i < lines_.words().size(); ++i)
            if (decimal<double>(lines_.words()[i]) != neutral) return library_.ignored.add(key);
    }

    /// The file's name comes behind the options.
    void read_map(std::string_view key) {
        library_.ignored.add(key);
        const auto& words = lines_.words();
        size_t i = 1;
        while (i < words.size() && words[i].starts_with('-')) {
            const auto option = std::find_if(std::begin(map_options), std::end(map_options),
                                             [&](const MapOption& o) { return o.name == words[i]; });
            library_.ignored.add(words[i]);
            ++i;
            if (option == std::end(map_options)) {
                while (i < words.size() && decimal<double>(words[i])) ++i;
            } else {
                const size_t last = i + static_cast<size_t>(option->most_values);
                for (bool first = true; i < words.size() && i < last && (first || decimal<double>(words[i])); ++i)
                    first = false;
            }
        }
        const std::string file(lines_.rest(i));
        if (key == "map_Kd") material_->map_Kd = file;
        if (!file.empty() && key != "map_aat" && !has_map_(file)) library_.missing_maps.add(file);
    }

    MeshTextLines lines_;
    const std::string& label_;
    const std::function<bool(const std::string&)>& has_map_;
    MaterialLibrary& library_;
    std::map<std::string, Statements> all_;  // by name
    Statements* material_ = nullptr;         // the one that statements are about
};

}  // namespace

MaterialDescription default_obj_material(const std::string& name) {
    return material_of(name, {});
}

void read_mtl(std::string_view text, const std::string& label, const std::function<bool(const std::string&)>& has_map,
              MaterialLibrary& library) {
    MtlReader(text, label, has_map, library).read();
}

}  // namespace cistula

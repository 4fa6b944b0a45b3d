#include "scene/readers/meshes/mesh_formats.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "base/decimal.h"
#include "base/error.h"
#include "base/suggest.h"
#include "scene/readers/meshes/mesh_text.h"

namespace cistula {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr uint32_t no_index = std::numeric_limits<uint32_t>::max();

/// Faces of one object, group and material.
struct Group {
    std::string name, material;
    std::vector<uint32_t> vertices, uvs, normals;  // numbers of each corner's, from 0
    std::vector<size_t> ends;                      // of each face, in these
    bool has_uvs = false;
    bool has_normals = false;
};

/// A `vt` or a `vn` that no face may use, and what it was expected to be.
struct UnusableRow {
    uint32_t number;  // from 0, among all
    int line;
    const char* fault;
};

/// The largest index from 1 that faces have named, and where: what it names may come later.
struct LargestIndex {
    uint64_t index = 0;
    int line = 0;
};

class ObjReader {
  public:
    ObjReader(std::string_view text, const std::string& label, const ObjSurroundings& surroundings,
              std::vector<std::string>& warnings, StopSignal stop)
        : lines_(text), label_(label), surroundings_(surroundings), warnings_(warnings), stop_(stop) {}

    std::vector<PolygonMesh> read() {
        for (uint32_t statement = 0; lines_.next(); ++statement) {
            if (statement % rows_between_stops == 0) stop_.check();
            read_statement(lines_.words()[0]);
        }
        check_largest(largest_vertex_, positions_.size(), "vertex");
        check_largest(largest_uv_, uvs_.size(), "texture coordinate");
        check_largest(largest_normal_, normals_.size(), "normal");
        read_libraries();
        std::vector<PolygonMesh> meshes;
        bool has_normals = false;
        for (Group& group : groups_) {
            has_normals |= group.has_normals;
            meshes.push_back(mesh_of(group));
        }
        if (has_smoothing_groups_ && !has_normals) library_.ignored.add("s");
        warn();
        return meshes;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { fail_at(lines_.line(), what); }
    [[noreturn]] void fail_at(int line, const std::string& what) const {
        throw Error(ErrorKind::file, what).at(fmt::format("{}:{}", label_, line));
    }

    void read_statement(std::string_view key) {
        constexpr std::string_view unused[] = {"vp", "p", "l"};
        if (key == "v") {
            positions_.push_back({number(1), number(2), number(3)});
            for (size_t i = 4; i < lines_.words().size(); ++i) number(i);  // a weight, a color
        } else if (key == "vt") {
            const bool has_v = lines_.words().size() > 2;
            note_unless(has_numbers(has_v ? 2 : 1), uvs_.size(), unusable_uvs_,
                        "expected one number or more, of a texture coordinate that a face uses");
            uvs_.push_back({number_or_nan(1), has_v ? number_or_nan(2) : 0});
            note_unless(std::isfinite(uvs_.back().x) && std::isfinite(uvs_.back().y), uvs_.size() - 1, unusable_uvs_,
                        "a texture coordinate is not finite");
        } else if (key == "vn") {
            note_unless(has_numbers(3), normals_.size(), unusable_normals_,
                        "expected three numbers, of a normal that a face uses");
            normals_.push_back({number_or_nan(1), number_or_nan(2), number_or_nan(3)});
        } else if (key == "s") {
            has_smoothing_groups_ |= lines_.rest(1) != "off" && lines_.rest(1) != "0";
        } else if (key == "f") {
            read_face();
        } else if (key == "o" || key == "g") {
            change(name_, utf8_name(lines_.rest(1)));
            starts_with_name_ = true;
        } else if (key == "usemtl") {
            change(material_, utf8_name(lines_.rest(1)));
        } else if (key == "mtllib") {
            library_lines_.emplace_back(lines_.rest(1));
        } else if (std::find(std::begin(unused), std::end(unused), key) == std::end(unused)) {
            library_.ignored.add(key);
        }
    }

    /// Word `i` as a number.
    double number(size_t i) const {
        const auto& words = lines_.words();
        if (i >= words.size()) fail(fmt::format("{} needs more numbers than {}", words[0], i - 1));
        const auto value = decimal<double>(words[i]);
        if (!value) fail(fmt::format("expected a number, found {}", quoted(words[i])));
        return *value;
    }

    bool has_numbers(size_t count) const {
        for (size_t i = 1; i <= count; ++i)
            if (i >= lines_.words().size() || !decimal<double>(lines_.words()[i])) return false;
        return true;
    }

    double number_or_nan(size_t i) const {
        return i < lines_.words().size() ? decimal<double>(lines_.words()[i]).value_or(NAN) : NAN;
    }

    /// Notes that a face must not use the line, unless it may.
    void note_unless(bool is_usable, size_t number, std::vector<UnusableRow>& rows, const char* fault) const {
        if (!is_usable) rows.push_back({static_cast<uint32_t>(number), lines_.line(), fault});
    }

    /// Throws if corners use what must not be used.
    void check_used(const std::vector<uint32_t>& corners, const std::vector<UnusableRow>& rows) const {
        if (rows.empty()) return;
        for (const uint32_t number : corners) {
            const auto row = std::lower_bound(rows.begin(), rows.end(), number,
                                              [](const UnusableRow& a, uint32_t b) { return a.number < b; });
            if (row != rows.end() && row->number == number) fail_at(row->line, row->fault);
        }
    }

    void change(std::string& current, std::string to) {
        if (current == to) return;
        current = std::move(to);
        in_group_ = false;
    }

    void read_face() {
        const auto& words = lines_.words();
        if (words.size() < 4) fail(fmt::format("a face needs at least 3 corners, found {}", words.size() - 1));
        if (!in_group_) {
            groups_.push_back({starts_with_name_ && !name_.empty() ? name_ : material_, material_, {}, {}, {}, {}});
            in_group_ = true;
            starts_with_name_ = false;
        }
        Group& group = groups_.back();
        for (size_t i = 1; i < words.size(); ++i) read_corner(words[i], group);
        group.ends.push_back(group.vertices.size());
    }

    /// Reads "v", "v/t", "v//n" or "v/t/n".
    void read_corner(std::string_view word, Group& group) {
        const size_t slash = std::min(word.find('/'), word.size());
        const size_t second = slash == word.size() ? slash : std::min(word.find('/', slash + 1), word.size());
        group.vertices.push_back(index(word.substr(0, slash), positions_.size(), largest_vertex_, "vertex"));
        const std::string_view uv = slash == word.size() ? "" : word.substr(slash + 1, second - slash - 1);
        group.uvs.push_back(uv.empty() ? no_index : index(uv, uvs_.size(), largest_uv_, "texture coordinate"));
        group.has_uvs |= !uv.empty();
        const std::string_view normal = second < word.size() ? word.substr(second + 1) : "";
        group.normals.push_back(normal.empty() ? no_index : index(normal, normals_.size(), largest_normal_, "normal"));
        group.has_normals |= !normal.empty();
    }

    /// An index from 0, of one from 1, or from -1 backward.
    uint32_t index(std::string_view word, size_t count, LargestIndex& largest, std::string_view what) const {
        const auto number = decimal<int64_t>(word);
        if (!number || *number == 0)
            fail(fmt::format("expected the number of a {}, from 1 or from -1 backward, found {}", what, quoted(word)));
        const auto size = static_cast<int64_t>(count);
        if (*number < -size) fail(fmt::format("a face names {} {}, but only {} came before", what, *number, size));
        if (*number < 0) return static_cast<uint32_t>(size + *number);
        const auto from_one = static_cast<uint64_t>(*number);
        if (from_one > largest.index) largest = {from_one, lines_.line()};
        return static_cast<uint32_t>(from_one - 1);
    }

    void check_largest(const LargestIndex& largest, size_t count, std::string_view what) const {
        if (largest.index > count)
            fail_at(largest.line, fmt::format("a face names {} {}, but there are {}", what, largest.index, count));
    }

    /// A library's name may have blanks, or the line several names.
    void read_libraries() {
        std::vector<std::string_view> names;
        for (const std::string& line : library_lines_) {
            names = {line};
            if (!surroundings_.has(line)) split_words(line, names);
            for (const std::string_view name : names) read_library(std::string(name));
        }
        const std::string& other = surroundings_.default_library;
        if (!missing_libraries_.empty() && surroundings_.has(other)) read_library(other);
        const auto nameless = library_.materials.find("");
        if (nameless == library_.materials.end()) return;
        std::string& name = nameless->second.name = "unnamed";  // for mattes
        while (library_.materials.contains(name)) name += '_';
    }

    void read_library(const std::string& name) {
        if (!seen_libraries_.insert(name).second) return;
        if (!surroundings_.has(name)) return missing_libraries_.add(name);
        const std::string text = utf8_of(surroundings_.bytes(name));
        const std::string folder = name.substr(0, name.find_last_of("/\\") + 1);
        read_mtl(
            text, surroundings_.label(name), [&](const std::string& map) { return surroundings_.has(folder + map); },
            library_);
    }

    PolygonMesh mesh_of(Group& group) {
        check_used(group.uvs, unusable_uvs_);
        check_used(group.normals, unusable_normals_);
        PolygonMesh mesh;
        mesh.name = group.name;
        const auto known = library_.materials.find(group.material);
        if (known != library_.materials.end()) {
            mesh.material = known->second;
        } else if (!group.material.empty()) {
            missing_materials_.add(group.material);
            mesh.material = default_obj_material(group.material);
        }
        mesh.vertices.reserve(group.vertices.size());
        for (const uint32_t v : group.vertices) mesh.vertices.push_back(positions_[v]);
        if (group.has_uvs)
            for (const uint32_t t : group.uvs) mesh.uvs.push_back(t == no_index ? dvec2{0} : uvs_[t]);
        if (group.has_normals)
            for (const uint32_t n : group.normals) mesh.normals.push_back(n == no_index ? dvec3{0} : normals_[n]);
        mesh.corners = std::move(group.vertices);
        for (uint32_t i = 0; i < mesh.corners.size(); ++i) mesh.corners[i] = i;
        mesh.ends = std::move(group.ends);
        return mesh;
    }

    void warn() {
        const auto add = [this](const char* what, const NameList& names) {
            if (!names.empty()) warnings_.push_back(fmt::format("{}: {}: {}", label_, what, names.text()));
        };
        if (!library_.ignored.empty()) warnings_.push_back(ignored_warning(label_, library_.ignored));
        add("there are no such material libraries", missing_libraries_);
        add("there are no files of these maps", library_.missing_maps);
        add("no library has these materials", missing_materials_);
    }

    MeshTextLines lines_;
    const std::string& label_;
    const ObjSurroundings& surroundings_;
    std::vector<std::string>& warnings_;
    const StopSignal stop_;
    std::vector<dvec3> positions_, normals_;
    std::vector<dvec2> uvs_;
    std::vector<UnusableRow> unusable_uvs_, unusable_normals_;
    LargestIndex largest_vertex_, largest_uv_, largest_normal_;
    bool has_smoothing_groups_ = false;
    std::string name_, material_;  // of the faces that follow
    bool in_group_ = false;
    bool starts_with_name_ = false;
    std::vector<Group> groups_;
    std::vector<std::string> library_lines_;
    std::set<std::string> seen_libraries_;
    MaterialLibrary library_;
    NameList missing_libraries_, missing_materials_;
};

}  // namespace

std::vector<PolygonMesh> read_obj(std::string_view text, const std::string& label, const ObjSurroundings& surroundings,
                                  std::vector<std::string>& warnings, StopSignal stop) {
    return ObjReader(text, label, surroundings, warnings, stop).read();
}

}  // namespace cistula

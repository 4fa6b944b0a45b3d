#include "scene/readers/meshes/mesh_formats.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include <fmt/format.h>

#include "base/decimal.h"
#include "base/error.h"
#include "base/suggest.h"
#include "scene/readers/meshes/mesh_text.h"

namespace cistula {
namespace {

template <class T>
double load(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return static_cast<double>(value);
}

struct Type {
    std::string_view name, other_name;
    size_t size;
    double (*load)(const char* bytes);
    double least = 0, most = 0;  // of an integer type
    bool is_integer() const { return most > 0; }
};
constexpr Type types[] = {{"char", "int8", 1, load<int8_t>, -128, 127},
                          {"uchar", "uint8", 1, load<uint8_t>, 0, 255},
                          {"short", "int16", 2, load<int16_t>, -32768, 32767},
                          {"ushort", "uint16", 2, load<uint16_t>, 0, 65535},
                          {"int", "int32", 4, load<int32_t>, -2147483648.0, 2147483647},
                          {"uint", "uint32", 4, load<uint32_t>, 0, 4294967295},
                          {"float", "float32", 4, load<float>},
                          {"double", "float64", 8, load<double>}};

struct Property {
    std::string name;
    const Type* type = nullptr;
    const Type* size_type = nullptr;  // of a list
};

struct Element {
    std::string name;
    uint64_t count = 0;
    int line = 0;
    std::vector<Property> properties;

    /// Number of the first property of these names; that of none where there is none.
    size_t find(std::initializer_list<std::string_view> names, bool list) const {
        const auto fits = [&](const Property& p) {
            return (p.size_type != nullptr) == list && std::find(names.begin(), names.end(), p.name) != names.end();
        };
        return static_cast<size_t>(std::find_if(properties.begin(), properties.end(), fits) - properties.begin());
    }
};

class PlyReader {
  public:
    PlyReader(std::string_view bytes, const std::string& label, StopSignal stop = {})
        : bytes_(bytes), label_(label), stop_(stop) {
        // Where a CR alone ends the first line, it ends all; else a LF does, with a CR before it or without.
        const size_t end = bytes.find_first_of("\r\n");
        if (end != std::string_view::npos && bytes[end] == '\r' && bytes.substr(end + 1, 1) != "\n") line_end_ = '\r';
    }

    void read_first_line() {
        require(next_line() && words_.size() == 1 && words_[0] == "ply", "is not PLY: its first line must be \"ply\"");
    }

    PolygonMesh read(std::vector<std::string>& warnings) {
        read_header();
        check_sizes();
        for (const Element& element : elements_) {
            element_ = &element;
            if (element.name == "vertex")
                read_vertices();
            else if (element.name == "face" || element.name == "tristrips")
                read_polygons();
            else
                read_rows([](size_t, double) {}, [](size_t, auto&) {}, [] {});
        }
        if (!ignored_.empty()) warnings.push_back(ignored_warning(label_, ignored_));
        return std::move(mesh_);
    }

  private:
    /// Throws Error with the line, or in binary data the byte, that was read last.
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy = {}) const {
        if (ascii_) fail_at(line_, problem, remedy);
        throw Error(ErrorKind::file, problem, remedy).at(fmt::format("{}: byte {}", label_, value_at_));
    }
    [[noreturn]] void fail_at(int line, const std::string& problem, const std::string& remedy = {}) const {
        throw Error(ErrorKind::file, problem, remedy).at(fmt::format("{}:{}", label_, line));
    }

    /// Goes to the words of the next line; false at the end of the file.
    bool next_line() {
        if (at_ >= bytes_.size()) return false;
        ++line_;
        const size_t end = std::min(bytes_.find(line_end_, at_), bytes_.size());
        split_words(bytes_.substr(at_, end - at_), words_);
        at_ = end + 1;
        word_ = 0;
        return true;
    }

    void require(bool holds, const std::string& otherwise) const {
        if (!holds) fail(otherwise);
    }

    void read_header() {
        constexpr std::string_view formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        read_first_line();
        size_t format = 3;
        while (true) {
            require(next_line() && at_ <= bytes_.size(), "the file ends in its header, before an end_header line");
            if (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info") continue;
            if (words_[0] == "end_header") break;
            if (words_[0] == "element") {
                read_element();
            } else if (words_[0] == "property") {
                read_property();
            } else {
                require(words_[0] == "format", quoted(words_[0]) + " is not PLY; a header has format, comment, " +
                                                   "obj_info, element, property and end_header lines");
                require(format == 3 && words_.size() == 3 && words_[2] == "1.0",
                        "expected one line \"format TYPE 1.0\"");
                format = static_cast<size_t>(std::find(formats, formats + 3, words_[1]) - formats);
                require(format < 3,
                        "expected ascii, binary_little_endian or binary_big_endian, found " + quoted(words_[1]));
            }
        }
        require(format < 3, "the header has no format line, as \"format ascii 1.0\"");
        words_.clear();
        ascii_ = format == 0;
        big_endian_ = format == 2;
    }

    void read_element() {
        const auto count = words_.size() == 3 ? decimal<uint64_t>(words_[2]) : std::nullopt;
        require(count.has_value(), "expected \"element\", a name and how many there are");
        require(element_names_.insert(words_[1]).second, "a second element " + quoted(words_[1]) + "; give one");
        elements_.push_back({std::string(words_[1]), *count, line_, {}});
        property_names_.clear();
    }

    void read_property() {
        const bool list = words_.size() == 5 && words_[1] == "list";
        require(!elements_.empty(), "a property before the first element");
        require(list || words_.size() == 3, "expected \"property\", a type and a name; a list has two types");
        require(property_names_.insert(words_.back()).second,
                "a second property " + quoted(words_.back()) + "; give one");
        const Type* const size_type = list ? type_of(words_[2]) : nullptr;
        require(!list || size_type->is_integer(), "the size of a list must have an integer type");
        elements_.back().properties.push_back({std::string(words_.back()), type_of(words_[list ? 3 : 1]), size_type});
    }

    const Type* type_of(std::string_view name) const {
        for (const Type& type : types)
            if (name == type.name || name == type.other_name) return &type;
        fail(quoted(name) + " is not a type; types are char, uchar, short, ushort, int, uint, float, double, and " +
             "int8, uint8, int16, uint16, int32, uint32, float32, float64");
    }

    /// Throws unless the rest can hold what the header counts. A list may be empty, a number of text takes two bytes.
    void check_sizes() {
        uint64_t left = bytes_.size() - at_ + (ascii_ ? 1 : 0);  // the last blank may lack
        for (const Element& element : elements_) {
            if (element.name == "vertex") vertices_ = element.count;
            uint64_t row = 0;
            for (const Property& p : element.properties) row += ascii_ ? 2 : (p.size_type ? p.size_type : p.type)->size;
            if (row > 0 && element.count > left / row)
                fail_at(element.line, fmt::format("{} of these take at least {} bytes each, but {} bytes are left: the "
                                                  "file is cut short, or its header wrong",
                                                  element.count, row, left));
            left -= row * element.count;
        }
    }

    double value(const Type& type) {
        if (ascii_) return value_of_word(type);
        value_at_ = at_;
        if (bytes_.size() - at_ < type.size)
            fail("the file ends in element " + quoted(element_->name) + ": it is cut short");
        const char* const from = bytes_.data() + at_;
        at_ += type.size;
        if (!big_endian_) return type.load(from);
        char bytes[8];
        for (size_t i = 0; i < type.size; ++i) bytes[i] = from[type.size - 1 - i];
        return type.load(bytes);
    }

    /// A float is rounded once, from the text to the float.
    double value_of_word(const Type& type) {
        if (word_ == words_.size())
            fail(fmt::format("element {} needs more than the {} values of its line", quoted(element_->name), word_));
        const std::string_view word = words_[word_++];
        const bool is_float = type.name == "float";
        if (is_float)
            if (const auto number = decimal<float>(word)) return static_cast<double>(*number);
        const auto number = decimal<double>(word);
        if (!number) fail("expected a number, found " + quoted(word));
        if (type.is_integer() && !(*number >= type.least && *number <= type.most && *number == std::floor(*number)))
            fail(fmt::format("expected a whole number from {} to {}, found {}", type.least, type.most, quoted(word)));
        if (is_float) fail(quoted(word) + " is more than a float holds", "declare the property as double");
        return *number;
    }

    size_t list_size(const Property& list) {
        const double size = value(*list.size_type);
        const size_t left = ascii_ ? words_.size() - word_ : (bytes_.size() - at_) / list.type->size;
        if (!(size >= 0 && size <= static_cast<double>(left)))
            fail(fmt::format("the list {} says that it has {} values, but {} are left{}", quoted(list.name), size, left,
                             ascii_ ? " on its line" : " in the file: it is cut short"));
        return static_cast<size_t>(size);
    }

    /// Reads the element's rows: `scalar(property, value)`, `list(property, values)`, then `end()` for each row.
    template <class Scalar, class List, class End>
    void read_rows(const Scalar& scalar, const List& list, const End& end) {
        const std::vector<Property>& properties = element_->properties;
        std::vector<double> values;
        for (uint64_t row = 0; row < element_->count && !properties.empty(); ++row) {
            if (row % rows_between_stops == 0) stop_.check();
            while (ascii_ && word_ == words_.size())
                if (!next_line()) fail("the file ends before the element does: it is cut short");
            for (size_t p = 0; p < properties.size(); ++p) {
                if (!properties[p].size_type) {
                    scalar(p, value(*properties[p].type));
                    continue;
                }
                values.resize(list_size(properties[p]));
                for (double& v : values) v = value(*properties[p].type);
                list(p, values);
            }
            if (ascii_ && word_ < words_.size())
                fail(fmt::format("found {} values", words_.size()), fmt::format("expected {}", word_));
            end();
        }
    }

    void read_vertices() {
        const auto find = [this](auto... names) { return element_->find({names...}, false); };
        const size_t place[8] = {
            find("x"),  find("y"),  find("z"), find("u", "s", "tx", "texture_u"), find("v", "t", "ty", "texture_v"),
            find("nx"), find("ny"), find("nz")};
        const size_t none = element_->properties.size();
        for (int axis = 0; axis < 3; ++axis)
            if (place[axis] == none) fail_at(element_->line, "element vertex lacks one of the properties x, y and z");
        const bool has_uvs = place[3] < none && place[4] < none;
        const bool has_normals = place[5] < none && place[6] < none && place[7] < none;
        for (const std::string_view normal : {"nx", "ny", "nz"})
            if (!has_normals && find(normal) < none) ignored_.add(normal);
        double row[8] = {};
        const auto keep = [&](size_t property, double value) {
            for (int i = 0; i < 8; ++i)
                if (place[i] == property) row[i] = value;
        };
        mesh_.vertices.reserve(element_->count);
        read_rows(
            keep, [](size_t, auto&) {},
            [&] {
                mesh_.vertices.push_back({row[0], row[1], row[2]});
                if (has_uvs) add_uv(mesh_.uvs, row[3], row[4]);
                if (has_normals) mesh_.normals.push_back({row[5], row[6], row[7]});
            });
    }

    void add_uv(std::vector<glm::dvec2>& uvs, double u, double v) const {
        if (!std::isfinite(u) || !std::isfinite(v)) fail("a texture coordinate is not finite");
        uvs.push_back({u, v});
    }

    void read_polygons() {
        const size_t list = element_->find({"vertex_indices", "vertex_index"}, true);
        const size_t uv_list = element_->find({"texcoord"}, true);
        if (element_->count == 0) return;
        if (list == element_->properties.size() || !element_->properties[list].type->is_integer())
            fail_at(element_->line, "element " + element_->name + " has no list vertex_indices of an integer type");
        std::vector<double> corners, uvs;
        const auto keep = [&](size_t property, const std::vector<double>& values) {
            if (property == list) corners = values;
            if (property == uv_list) uvs = values;
        };
        read_rows([](size_t, double) {}, keep, [&] { add_polygon(corners, uvs); });
    }

    void add_polygon(const std::vector<double>& corners, const std::vector<double>& uvs) {
        const bool strips = element_->name == "tristrips";
        for (const double corner : corners)
            if (!(corner >= (strips ? -1 : 0) && corner < static_cast<double>(vertices_)))
                fail(fmt::format("names vertex {}, but there are {}, numbered from 0", corner, vertices_));
        if (strips) return add_strips(corners);
        if (!uvs.empty() && uvs.size() != 2 * corners.size())
            fail(fmt::format("{} values of texcoord for {} corners", uvs.size(), corners.size()), "give two a corner");
        if (!uvs.empty()) mesh_.corner_uvs.resize(mesh_.corners.size());
        for (size_t i = 0; i < uvs.size(); i += 2) add_uv(mesh_.corner_uvs, uvs[i], uvs[i + 1]);
        mesh_.corners.insert(mesh_.corners.end(), corners.begin(), corners.end());
        mesh_.ends.push_back(mesh_.corners.size());
    }

    /// Strips of triangles, which -1 parts. Triangles that repeat a vertex only join strips.
    void add_strips(const std::vector<double>& corners) {
        size_t first = 0;
        for (size_t i = 0; i < corners.size(); ++i) {
            if (corners[i] < 0) first = i + 1;
            if (i < first + 2) continue;
            const bool turned = (i - first) % 2 == 1;
            const double a = corners[i - (turned ? 1 : 2)];
            const double b = corners[i - (turned ? 2 : 1)];
            const double c = corners[i];
            if (a == b || b == c || c == a) continue;
            for (const double corner : {a, b, c}) mesh_.corners.push_back(static_cast<uint32_t>(corner));
            mesh_.ends.push_back(mesh_.corners.size());
        }
    }

    std::string_view bytes_;
    const std::string& label_;
    const StopSignal stop_;
    char line_end_ = '\n';
    bool ascii_ = true;
    bool big_endian_ = false;
    // the next byte, and the first of the value read last
    size_t at_ = 0;
    size_t value_at_ = 0;
    int line_ = 0;
    std::vector<std::string_view> words_;
    size_t word_ = 0;                                            // the next of `words_`
    std::set<std::string_view> element_names_, property_names_;  // the latter of the last element
    std::vector<Element> elements_;
    const Element* element_ = nullptr;
    uint64_t vertices_ = 0;
    NameList ignored_;
    PolygonMesh mesh_;
};

}  // namespace

void check_ply_start(std::string_view start, const std::string& label) {
    PlyReader(start, label).read_first_line();
}

PolygonMesh read_ply(std::string_view bytes, const std::string& label, std::vector<std::string>& warnings,
                     StopSignal stop) {
    return PlyReader(bytes, label, stop).read(warnings);
}

}  // namespace cistula

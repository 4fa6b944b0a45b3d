// A pixel's ray trees as JSON.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "render/pixel_report.h"

namespace cistula {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    return value;
}

/// A float as the shortest decimal that reads back as the same float.
Json number(float value) {
    if (!std::isfinite(value)) return number(static_cast<double>(value));
    return Json::parse(fmt::format("{}", value));
}

Json vector(const glm::dvec3& v) {
    return {number(v.x), number(v.y), number(v.z)};
}

class PixelJson {
  public:
    explicit PixelJson(const PixelReport& report) : report_(report) {}

    Json all() const {
        const FrameSettings& settings = report_.settings;
        const Film& film = report_.tree.film;
        Json samples = Json::array();
        for (const SampleTree& sample : report_.tree.samples) samples.push_back(sample_entry(sample));
        Json json = {
            {"scene", report_.scene},
            {"scene_hash", report_.scene_hash},
            {"cistula_version", CISTULA_VERSION},
            {"frame", report_.camera.frame},
            {"time", report_.camera.time},
            {"pixel", {report_.x, report_.y}},
            {"resolution", {settings.full_width, settings.full_height}},
            {"supersample", settings.supersample},
            {"depth", settings.depth},
            {"cutoff", settings.cutoff},
            {"precision", precision_name(report_.precision)},
            {"sum_unit", number(radiance_of({1, 1, 1}, film).x)},
            {"samples", std::move(samples)},
            {"totals", totals()},
        };
        if (!report_.flaws.empty()) json["cannot_be_trusted"] = report_.flaws;
        return json;
    }

  private:
    Json sum(const FixedColor& units) const {
        return {{"sum", units}, {"radiance", vector(radiance_of(units, report_.tree.film))}};
    }
    Json sum(const int64_t (&units)[3]) const { return sum(FixedColor{units[0], units[1], units[2]}); }

    static Json rays(const RayCounts& counts) {
        return {{"primary", counts.primary},
                {"reflected", counts.reflected},
                {"transmitted", counts.transmitted},
                {"shadow", counts.shadow},
                {"total", counts.total()}};
    }

    Json totals() const {
        const PixelRecord& pixel = report_.tree.film.pixels.at(0);
        const auto channels = [&](const char* a, const char* b, const char* c) {
            return Json{number(shown(report_, a)), number(shown(report_, b)), number(shown(report_, c))};
        };
        return {
            {"radiance", channels("R", "G", "B")},
            {"error", channels("error.R", "error.G", "error.B")},
            {"sums",
             {{"radiance", pixel.radiance},
              {"pruned", pixel.pruned},
              {"cut", pixel.cut},
              {"units", report_.tree.film.units_lost(pixel)}}},
            {"coverage", number(shown(report_, "coverage"))},
            {"id", pixel.id},
            {"Z", number(shown(report_, "Z"))},
            {"N", channels("N.X", "N.Y", "N.Z")},
            {"rays", rays(rays_of(report_.tree))},
        };
    }

    Json sample_entry(const SampleTree& sample) const {
        RayCounts counts;
        counts.add(sample.rays);
        return {{"column", sample.column},
                {"row", sample.row},
                {"radiance", sum(sample.record.radiance)},
                {"pruned", sum(sample.record.pruned)},
                {"cut", sum(sample.record.cut)},
                {"rays", rays(counts)},
                {"tree", branch_entry(sample, 0)}};
    }

    Json branch_entry(const SampleTree& sample, uint32_t number_of_branch) const {
        const PixelBranch& branch = sample.branches[number_of_branch];
        Json json = {{"kind", name_of(branch.kind)},
                     {"end", name_of(branch.end)},
                     {"depth", branch.depth},
                     {"weight", vector(branch.weight)}};
        if (branch.end == BranchEnd::pruned || branch.end == BranchEnd::cut || branch.end == BranchEnd::dropped) {
            json["ledger"] = sum(branch.ledger);
            return json;
        }
        json["weight_arriving"] = vector(branch.arriving);
        json["origin"] = vector(branch.origin);
        json["direction"] = vector(branch.direction);
        json["distance"] = number(branch.distance);
        json["passed"] = Json::array();
        for (const FacePassed& passed : branch.passed) {
            Json face = face_entry(passed);
            face["because"] = passed.inside ? "precedence" : "clear";
            json["passed"].push_back(std::move(face));
        }
        if (branch.end == BranchEnd::light) {
            json["light"] = named(report_.names.visible_lights[branch.visible_light]);
            json["light"]["id"] = report_.names.solids.size() + branch.visible_light + 1;
        }
        if (branch.end == BranchEnd::surface) json["surface"] = surface_entry(branch.surface);
        json["adds"] = sum(branch.adds);
        if (branch.end != BranchEnd::surface) return json;
        json["adds_below"] = sum(branch.adds_below);
        json["ledger_below"] = sum(branch.ledger_below);
        json["children"] = Json::array();
        for (const uint32_t child : branch.children) json["children"].push_back(branch_entry(sample, child));
        return json;
    }

    static Json named(const SceneNames::Named& named) {
        Json json = {{"name", named.name}};
        if (!named.place.empty()) json["place"] = named.place;
        return json;
    }

    Json solid_names(const std::vector<uint32_t>& solids) const {
        Json list = Json::array();
        for (const uint32_t solid : solids) list.push_back(report_.names.solids[solid].name);
        return list;
    }

    Json face_entry(const FaceMet& face) const {
        return {{"object", named(report_.names.solids[face.solid])},
                {"id", face.solid + 1},
                {"crossing", name_of(face.crossing)},
                {face.triangle ? "triangle" : "face", face.face},
                {"distance", number(face.distance)}};
    }

    Json surface_entry(const PixelSurface& s) const {
        Json json = face_entry(s);
        json["t"] = number(s.t);
        if (!s.also.empty()) {
            json["also"] = Json::array();
            for (const FaceMet& also : s.also) json["also"].push_back(face_entry(also));
        }
        json["point"] = vector(s.point);
        json["normal"] = vector(s.normal);
        if (s.face_normal) json["face_normal"] = vector(*s.face_normal);
        json["angle"] = number(degrees_of(s.cosine));
        json["material"] = report_.names.materials[s.material].name;
        json["color"] = vector(s.color);
        json["media"] = {{"before", solid_names(s.before)},
                         {"beyond", solid_names(s.beyond)},
                         {"index_before", s.index_before},
                         {"index_beyond", s.index_beyond}};
        json["bends"] = s.bends;
        json["total_reflection"] = s.total;
        if (s.bends && !s.total) json["angle_beyond"] = number(degrees_of(s.bent_cosine));
        if (s.fresnel >= 0) json["fresnel"] = number(s.fresnel);
        json["shares"] = {
            {"local", number(s.local)}, {"mirrored", number(s.mirrored)}, {"transmitted", vector(s.through)}};
        json["ambient"] = {{"local", vector(s.ambient)}, {"adds", sum(s.ambient_adds)}};
        json["lights"] = Json::array();
        for (const LightContribution& light : s.lights) json["lights"].push_back(light_entry(light));
        return json;
    }

    Json light_entry(const LightContribution& contribution) const {
        Json json = named(report_.names.lights[contribution.light]);
        json["fate"] = name_of(contribution.fate);
        json["N.L"] = number(contribution.cosine);
        json["distance"] = number(contribution.distance);
        if (contribution.fate == LightFate::behind || contribution.fate == LightFate::nothing) return json;
        json["unshadowed"] = vector(contribution.unshadowed);
        json["transmittance"] = vector(contribution.arrives);
        json["through"] = solid_names(contribution.through);
        json["adds"] = sum(contribution.adds);
        return json;
    }

    const PixelReport& report_;
};

}  // namespace

std::string pixel_json(const PixelReport& report) {
    return PixelJson(report).all().dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace cistula

// A pixel's ray trees as indented text.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/shown_text.h"
#include "render/pixel_report.h"

namespace cistula {
namespace {

/// Least weight of a branch that is printed unfolded: half a step of an 8-bit picture.
constexpr double least_weight = 1.0 / 512;
constexpr size_t most_lights = 6;    // of light lines at one surface, unless all are asked for
constexpr size_t most_samples = 64;  // of sample lines, unless all are asked for

std::string short_number(double value) {
    return fmt::format("{:.4g}", value == 0 ? 0.0 : value);  // avoids -0
}

/// A color as text: a single number if all channels are equal.
std::string color(const glm::dvec3& c) {
    if (c.x == c.y && c.y == c.z) return short_number(c.x);
    return fmt::format("{} {} {}", short_number(c.x), short_number(c.y), short_number(c.z));
}

std::string point(const glm::dvec3& p) {
    return fmt::format("({}, {}, {})", short_number(p.x), short_number(p.y), short_number(p.z));
}

double largest(const glm::dvec3& c) {
    return std::max({c.x, c.y, c.z});
}

std::string called(const SceneNames::Named& named) {
    return named.place.empty() ? named.name : fmt::format("{} ({})", named.name, named.place);
}

FixedColor sum_of(const FixedColor& a, const FixedColor& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// Prints one sample's tree.
class TreeText {
  public:
    TreeText(const PixelReport& report, const SampleTree& sample, bool verbose, std::string& text)
        : report_(report), sample_(sample), verbose_(verbose), text_(text) {}

    void write(uint32_t number_of_branch) {
        const PixelBranch& branch = sample_.branches[number_of_branch];
        std::string head = branch.kind == BranchKind::primary
                               ? fmt::format("primary ray from the camera at {} along {}", point(branch.origin),
                                             point(branch.direction))
                               : fmt::format("{} ray, weight {}", name_of(branch.kind), color(branch.weight));
        if (branch.end == BranchEnd::surface && is_folded(branch)) {
            const size_t rays = rays_in(number_of_branch);
            line(branch.depth,
                 fmt::format("{}: folded, {} from here on {} {}", head,
                             rays == 1 ? "1 ray" : fmt::format("{} rays", rays), rays == 1 ? "adds" : "add",
                             radiance(sum_of(branch.adds, branch.adds_below))));
            folded_ = true;
            return;
        }
        if (branch.end != BranchEnd::surface) {
            if (branch.passed.empty()) return line(branch.depth, head + ": " + ending(branch));
            line(branch.depth, head);
            write_way(branch);
            return line(branch.depth + 1, ending(branch));
        }
        line(branch.depth, head);
        write_way(branch);
        write_surface(branch);
        for (const uint32_t child : branch.children) write(child);
    }

    bool folded() const { return folded_; }

  private:
    void line(int depth, const std::string& what) {
        text_.append(static_cast<size_t>(depth) * 2, ' ');
        text_ += what;
        text_ += '\n';
    }

    bool is_folded(const PixelBranch& branch) const { return !verbose_ && largest(branch.weight) < least_weight; }

    std::string radiance(const FixedColor& sum) const { return color(radiance_of(sum, report_.tree.film)); }

    size_t rays_in(uint32_t first) const {
        const PixelBranch& branch = sample_.branches[first];
        size_t count = branch.end == BranchEnd::pruned || branch.end == BranchEnd::cut ? 0 : 1;
        for (const uint32_t child : branch.children) count += rays_in(child);
        return count;
    }

    std::string ending(const PixelBranch& branch) const {
        const std::string absorbed =
            branch.arriving == branch.weight
                ? ""
                : fmt::format("arrives with weight {} for absorption, ", color(branch.arriving));
        switch (branch.end) {
            case BranchEnd::background:
                return fmt::format("{}sees the background, adds {}", absorbed, radiance(branch.adds));
            case BranchEnd::light:
                return fmt::format("{}sees {}, distance {}, adds {}", absorbed,
                                   called(report_.names.visible_lights[branch.visible_light]),
                                   short_number(branch.distance), radiance(branch.adds));
            case BranchEnd::pruned:
                return fmt::format("too faint to follow, could add {} at most", radiance(branch.ledger));
            case BranchEnd::cut:
                return fmt::format("beyond the depth of {}, could add {} at most", report_.settings.depth,
                                   radiance(branch.ledger));
            case BranchEnd::dropped:
                return "lost for want of room";
            case BranchEnd::surface:
                break;
        }
        return "";
    }

    /// A solid's face, or triangle for meshes, as a phrase: "gem (/objects/2), face 4"; of a sphere, the
    /// solid alone.
    std::string face(const FaceMet& met) const {
        if (met.round) return called(report_.names.solids[met.solid]);
        return fmt::format("{}, {} {}", called(report_.names.solids[met.solid]), met.triangle ? "triangle" : "face",
                           met.face);
    }
    static const char* passes(const FaceMet& met) {
        return met.crossing == CrossingKind::sheet ? "passes" : name_of(met.crossing);
    }
    static const char* side(const FaceMet& met) {
        constexpr const char* sides[] = {"", ", from outside", ", from inside"};
        return sides[static_cast<size_t>(met.crossing)];
    }

    std::string media(const std::vector<uint32_t>& solids) const {
        if (solids.empty()) return "outside";
        std::string list;
        for (const uint32_t solid : solids) list += (list.empty() ? "" : " within ") + report_.names.solids[solid].name;
        return list;
    }

    void write_way(const PixelBranch& branch) {
        const size_t shown_faces = verbose_ ? branch.passed.size() : std::min<size_t>(branch.passed.size(), 8);
        for (size_t i = 0; i < shown_faces; ++i) {
            const FacePassed& passed = branch.passed[i];
            line(branch.depth + 1, fmt::format("{} {}, distance {}: nothing to shade, {}", passes(passed), face(passed),
                                               short_number(passed.distance),
                                               passed.inside ? "inside what takes precedence" : "being clear"));
        }
        if (shown_faces < branch.passed.size())
            line(branch.depth + 1,
                 fmt::format("and {} faces more with nothing to shade", branch.passed.size() - shown_faces));
        if (branch.end == BranchEnd::surface && branch.arriving != branch.weight)
            line(branch.depth + 1, fmt::format("weight {} arrives, the rest is absorbed", color(branch.arriving)));
    }

    void write_surface(const PixelBranch& branch) {
        const PixelSurface& s = branch.surface;
        const int depth = branch.depth + 1;
        line(depth, fmt::format("meets {}{}, at {}, distance {}", face(s), side(s), point(s.point),
                                short_number(branch.distance)));
        for (const FaceMet& also : s.also)
            line(depth, fmt::format("in the same place {} {}", passes(also), face(also)));
        line(depth,
             fmt::format("normal {}, {:.1f} degrees from the ray{}; material {}, color {}", point(s.normal),
                         degrees_of(s.cosine), s.face_normal ? ", where the face's is " + point(*s.face_normal) : "",
                         called(report_.names.materials[s.material]), color(s.color)));
        write_media(depth, s);
        std::vector<std::string> shares;
        if (s.local > 0) shares.push_back("local " + short_number(s.local));
        if (s.mirrored > 0) shares.push_back("mirrored " + short_number(s.mirrored));
        if (largest(s.through) > 0) shares.push_back("transmitted " + color(s.through));
        line(depth, fmt::format("shares: {}", shares.empty() ? "none" : fmt::format("{}", fmt::join(shares, ", "))));
        if (s.local > 0) write_lights(depth, s);
        std::vector<std::string> adds;
        if (s.local > 0 || branch.children.empty()) adds.push_back("adds " + radiance(branch.adds));
        if (!branch.children.empty())
            adds.push_back(fmt::format("{} {}", branch.children.size() == 1 ? "its child adds" : "its children add",
                                       radiance(branch.adds_below)));
        line(depth, fmt::format("{}", fmt::join(adds, "; ")));
    }

    void write_media(int depth, const PixelSurface& s) {
        if (s.before.empty() && !s.bends && !(largest(s.through) > 0)) return;  // an opaque solid, seen from outside
        if (s.before == s.beyond) {
            if (!s.before.empty()) line(depth, "within " + media(s.before));
            return;
        }
        std::string text = fmt::format("{} -> {}", media(s.before), media(s.beyond));
        if (s.index_before != s.index_beyond)
            text += fmt::format(", index {} -> {}", short_number(s.index_before), short_number(s.index_beyond));
        if (s.total)
            text += ": total reflection";
        else if (s.bends)
            text += fmt::format(": bends to {:.1f} degrees", degrees_of(s.bent_cosine));
        if (s.fresnel > 0 && !s.total) text += fmt::format("; Fresnel mirrors {}", short_number(s.fresnel));
        line(depth, text);
    }

    void write_lights(int depth, const PixelSurface& s) {
        // The lights that contribute most, in scene order; the rest are only counted.
        std::vector<size_t> order(s.lights.size());
        for (size_t i = 0; i < order.size(); ++i) order[i] = i;
        if (!verbose_ && order.size() > most_lights) {
            std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
                return largest(radiance_of(s.lights[a].adds, report_.tree.film)) >
                       largest(radiance_of(s.lights[b].adds, report_.tree.film));
            });
            size_t kept = 0;
            while (kept < most_lights && s.lights[order[kept]].fate == LightFate::adds) ++kept;
            std::sort(order.begin(), order.begin() + static_cast<ptrdiff_t>(kept));
            write_light_lines(depth, s, {order.begin(), order.begin() + static_cast<ptrdiff_t>(kept)});
            write_light_counts(depth, s, {order.begin() + static_cast<ptrdiff_t>(kept), order.end()});
        } else {
            write_light_lines(depth, s, order);
        }
    }

    void write_light_lines(int depth, const PixelSurface& s, const std::vector<size_t>& shown_lights) {
        std::vector<std::string> names;
        size_t width = 7;
        for (const size_t i : shown_lights) {
            names.push_back(called(report_.names.lights[s.lights[i].light]));
            width = std::max(width, names.back().size());
        }
        line(depth, fmt::format("  {:<{}}  adds {}", "ambient", width, radiance(s.ambient_adds)));
        for (size_t n = 0; n < shown_lights.size(); ++n)
            line(depth, fmt::format("  {:<{}}  {}", names[n], width, light(s.lights[shown_lights[n]])));
    }

    std::string light(const LightContribution& contribution) const {
        if (contribution.fate == LightFate::behind) return "behind the face";
        const std::string cosine = fmt::format("N.L {:.3f}", contribution.cosine);
        if (contribution.fate == LightFate::nothing) return cosine + ", lights nothing here";
        const std::string through = solids(contribution.through);
        if (contribution.fate == LightFate::shadow)
            return fmt::format("{}, in shadow{}", cosine, through.empty() ? "" : " of " + through);
        return fmt::format("{}, arrives {}{}, adds {}", cosine, color(contribution.arrives),
                           through.empty() ? "" : " through " + through, radiance(contribution.adds));
    }

    std::string solids(const std::vector<uint32_t>& numbers) const {
        std::string list;
        for (const uint32_t solid : numbers) list += (list.empty() ? "" : ", ") + report_.names.solids[solid].name;
        return list;
    }

    void write_light_counts(int depth, const PixelSurface& s, const std::vector<size_t>& rest) {
        size_t counts[4] = {};
        FixedColor adds{};
        std::vector<uint32_t> shadows;  // solids in the way of these lights
        for (const size_t i : rest) {
            const LightContribution& contribution = s.lights[i];
            ++counts[static_cast<size_t>(contribution.fate)];
            adds = sum_of(adds, contribution.adds);
            if (contribution.fate != LightFate::shadow) continue;
            for (const uint32_t solid : contribution.through)
                if (std::find(shadows.begin(), shadows.end(), solid) == shadows.end()) shadows.push_back(solid);
        }
        std::vector<std::string> parts;
        const auto count = [&](LightFate fate) { return counts[static_cast<size_t>(fate)]; };
        if (count(LightFate::adds) > 0)
            parts.push_back(fmt::format("{} add {}", count(LightFate::adds), radiance(adds)));
        if (count(LightFate::behind) > 0) parts.push_back(fmt::format("{} behind the face", count(LightFate::behind)));
        if (count(LightFate::shadow) > 0)
            parts.push_back(fmt::format(
                "{} in shadow of {}", count(LightFate::shadow),
                shadows.empty() || shadows.size() > 3 ? fmt::format("{} objects", shadows.size()) : solids(shadows)));
        if (count(LightFate::nothing) > 0)
            parts.push_back(fmt::format("{} light nothing here", count(LightFate::nothing)));
        line(depth, fmt::format("  {} {}lights: {}", rest.size(), rest.size() < s.lights.size() ? "more " : "",
                                fmt::join(parts, ", ")));
        folded_ = true;
    }

    const PixelReport& report_;
    const SampleTree& sample_;
    const bool verbose_;
    std::string& text_;
    bool folded_ = false;
};

/// A phrase for the first hit of a sample's primary ray.
std::string first_met(const PixelReport& report, const SampleTree& sample) {
    const PixelBranch& primary = sample.branches.front();
    switch (primary.end) {
        case BranchEnd::surface:
            return report.names.solids[primary.surface.solid].name;
        case BranchEnd::light:
            return report.names.visible_lights[primary.visible_light].name;
        default:
            return "the background";
    }
}

FixedColor radiance_sum(const SampleTree& sample) {
    return {sample.record.radiance[0], sample.record.radiance[1], sample.record.radiance[2]};
}

std::string sample_place(const SampleTree& sample, int k) {
    return fmt::format("column {} of {}, row {} of {}", sample.column + 1, k, sample.row + 1, k);
}

void write_sample_table(const PixelReport& report, bool verbose, std::string& text) {
    const auto& samples = report.tree.samples;
    text += "\ncolumn row  rays  sees first                 radiance\n";
    const size_t lines = verbose ? samples.size() : std::min(samples.size(), most_samples);
    for (size_t i = 0; i < lines; ++i) {
        const SampleTree& sample = samples[i];
        text += fmt::format("{:>6} {:>3} {:>5}  {:<25}  {}\n", sample.column + 1, sample.row + 1, sample.rays.total(),
                            first_met(report, sample), color(radiance_of(radiance_sum(sample), report.tree.film)));
    }
    if (lines < samples.size()) text += fmt::format("and {} samples more; -v lists them\n", samples.size() - lines);
}

void write_totals(const PixelReport& report, std::string& text) {
    const PixelRecord& pixel = report.tree.film.pixels.at(0);
    const RayCounts rays = rays_of(report.tree);
    const auto three = [&](const char* r, const char* g, const char* b) {
        return fmt::format("{} {} {}", shown(report, r), shown(report, g), shown(report, b));
    };
    const auto mean = [&](const int64_t(&sum)[3]) {
        return color(radiance_of({sum[0], sum[1], sum[2]}, report.tree.film) / double(report.tree.film.samples));
    };
    text += fmt::format("\nradiance  {}\n", three("R", "G", "B"));
    const std::string ledger = three("error.R", "error.G", "error.B");
    const Film& film = report.tree.film;
    text += fmt::format(
        "ledger    {} at most is missing: {} pruned by the cutoff, {} cut at the depth, {:.2g} in whole units\n",
        ledger, mean(pixel.pruned), mean(pixel.cut), static_cast<double>(film.units_lost(pixel)) * film.unit());
    text += fmt::format("rays      {}: {} primary, {} mirrored, {} transmitted, {} shadow\n", rays.total(),
                        rays.primary, rays.reflected, rays.transmitted, rays.shadow);
}

}  // namespace

std::string pixel_text(PixelReport report, bool verbose) {
    for (auto* list :
         {&report.names.solids, &report.names.materials, &report.names.lights, &report.names.visible_lights})
        for (SceneNames::Named& named : *list) named.name = one_line(named.name);
    const FrameSettings& settings = report.settings;
    const int k = settings.supersample;
    std::string text =
        fmt::format("{}, frame {}: pixel {},{} of {}x{}; depth {}, cutoff {}, {}, {}\n\n", one_line(report.scene),
                    report.camera.frame, report.x, report.y, settings.full_width, settings.full_height, settings.depth,
                    settings.cutoff, precision_name(report.precision),
                    k == 1 ? std::string("one sample") : fmt::format("{} samples", k * k));
    const size_t middle = middle_sample(k);
    bool folded = false;
    for (size_t i = 0; i < report.tree.samples.size(); ++i) {
        if (!verbose && i != middle) continue;
        const SampleTree& sample = report.tree.samples[i];
        if (k > 1)
            text += fmt::format("the sample in {}{}\n", sample_place(sample, k),
                                verbose ? "" : ", the nearest to the pixel's center");
        TreeText tree(report, sample, verbose, text);
        tree.write(0);
        folded |= tree.folded();
        if (verbose && k > 1) text += '\n';
    }
    if (folded) text += "\n-v shows what is folded.\n";
    if (k > 1) write_sample_table(report, verbose, text);
    write_totals(report, text);
    return text;
}

}  // namespace cistula

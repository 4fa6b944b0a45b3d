// Image: a finished frame, its layers as arrays.
#include "image.h"

#include <fmt/format.h>

#include <algorithm>

#include "backend_embree/embree/embree_renderer.h"
#include "base/atomic_file.h"
#include "base/file_bytes.h"
#include "base/suggest.h"
#include "image/exr/exr.h"
#include "image/picture/picture_io.h"
#include "image/view/picture_view.h"
#include "render/explorer/explorer.h"
#include "render/record/film_picture.h"
#include "render/record/target_report.h"
#include "sequence/frame_writer.h"

namespace cistula::python {
namespace {

using Self = nb::handle_t<Image>;
Image& image_of(Self self) {
    return nb::cast<Image&>(self);
}

/// A member of every pixel's record, in place. `needs`: a layer with which films keep it.
template <class T, ssize_t... more, class Record>
View<T, -1, -1, more...> field(Self self, const Record* first, const T* member, const char* needs) {
    const Image& image = image_of(self);
    if (!first)
        throw Error(ErrorKind::usage, fmt::format("this image does not have it; render it with layers=\"{}\"", needs));
    constexpr auto step = static_cast<int64_t>(sizeof(Record) / sizeof(T));
    const auto row = step * static_cast<int64_t>(image.width());
    if constexpr (sizeof...(more) == 0)
        return {member, {image.height(), image.width()}, self, {row, step}};
    else
        return {member, {image.height(), image.width(), static_cast<size_t>(more)...}, self, {row, step, 1}};
}

const PixelSight* sights(const Image& image) {
    return image.film.pixels.parts().sights ? &image.film.pixels.sight(0) : nullptr;
}

nb::object header_value(const Attributes::mapped_type& value) {
    return std::visit(
        [](const auto& one) -> nb::object {
            if constexpr (std::is_same_v<std::decay_t<decltype(one)>, Ratio>)
                return nb::make_tuple(one.numerator, one.denominator);
            else
                return nb::cast(one);
        },
        value);
}

nb::object target_of(const Image& image) {
    if (!image.settings.adaptive()) return nb::none();
    const TargetReport report = target_report(image.film, image.settings);
    nb::dict told;
    told["proven"] = report.proven();
    told["missed"] = report.missed;
    told["truncated"] = report.truncated;
    told["undersampled"] = report.undersampled;
    told["rounded"] = report.rounded;
    told["checked"] = report.checked;
    told["off"] = report.off;
    told["samples"] = report.samples;
    told["worst_truncation"] = report.worst_truncation;
    return told;
}

/// The name of a file to be written. Throws ArgumentError for one that no file has.
std::string written_name(const nb::object& path) {
    const nb::object text = nb::module_::import_("cistula.scene").attr("path_text")("path", path, "surrogateescape");
    return nb::cast<std::filesystem::path>(text).string();
}

/// The name of a file to be written. Throws Error (usage) for another suffix.
std::string named(const nb::object& given, const char* suffix) {
    std::string path = written_name(given);
    if (lower_extension(path) != suffix)
        throw Error(ErrorKind::usage, fmt::format("`path`={}: must be named *{}", path, suffix));
    return path;
}

void save(Image& image, const nb::object& given) {
    const std::string path = named(given, ".exr");
    {
        const WithoutGil free;
        image.clamped = 0;
        write_exr(path, image.picture);
    }
    if (image.clamped == 0) return;
    const std::string warning = fmt::format("{}: clamped: {}", path, over_largest_half(image.clamped));
    warn(warning, 1);
}

/// The PNG that render's --preview is.
std::string png_of(const Image& image, const Keywords& view) {
    Keywords keywords = view;
    keywords.emplace_back("preview", "-");
    RenderRequest request = request_of(keywords, {"preview", "exposure", "view", "bloom"});
    open_config_view(request.view);
    const bool transparent = image.picture.attributes.count("cistula:background") != 0;
    return encode_png(
        viewed(to_color(image.film, transparent), request.view, static_cast<uint32_t>(image.film.full_height)));
}

Explorer explorer_of(const Image& image, StopSignal stop) {
    const SceneHandle& scene = *image.scene;
    return {scene.scene().at(image.frame, stop), camera_at(scene.description().camera, image.frame), image.settings};
}

nb::object explore(Self self, const nb::object& given, double mb) {
    const Image& image = image_of(self);
    if (image.film.rect.width != image.film.full_width || image.film.rect.height != image.film.full_height)
        throw Error(ErrorKind::usage, "the explorer shows whole frames, and this is a crop; render it without `crop`");
    const std::string path = given.is_none() ? "" : written_name(given);
    std::string text;
    std::atomic<bool> stop{false};
    run_interruptibly(stop, [&] {
        const SceneDescription description = at_frame(image.scene->description(), image.frame);
        const Explorer explorer = explorer_of(image, stop);
        text = explorer.start(description.source, wireframes(gather_scene(description, stop)), image.film);
        const Scene scene = image.scene->scene().at(image.frame, stop);
        const auto make = [&] { return make_embree_renderer(scene); };
        if (!given.is_none()) write_file_atomically(path, explorer.page(text, mb, make, stop).html);
    });
    if (!given.is_none()) return nb::none();
    return nb::module_::import_("cistula.explorer").attr("widget")(self, text);
}

std::string explorer_rays(const Image& image, int x, int y) {
    std::string text;
    std::atomic<bool> stop{false};
    run_interruptibly(stop, [&] {
        text = explorer_of(image, stop).pixel(*LentRenderer(image.scene, Backend::embree, {}), x, y, stop);
    });
    return text;
}

}  // namespace

const std::vector<float>& Image::channel(const std::string& name) {
    const auto found = values.find(name);
    if (found != values.end()) return found->second;
    const LayeredPicture::Channel* const one = channel_of(picture, name);
    if (!one) {
        std::vector<std::string_view> names;
        for (const LayeredPicture::Channel& other : picture.channels) names.push_back(other.name);
        throw nb::key_error(
            fmt::format("there is no channel '{}'; {}", name, nearest_first(name, names, "channels")).c_str());
    }
    std::vector<float> made(width() * height());
    one->put(0, made.size(), made.data());
    return values.emplace(name, std::move(made)).first->second;
}

void bind_image(nb::module_& m) {
    m.attr("explorer_script") = std::string(explorer_script);
    m.attr("explorer_style") = std::string(explorer_style);
    nb::class_<Image>(
        m, "Image", nb::is_weak_referenceable(),
        "A finished frame: channels by name as arrays (`image[\"R\"]`), its sums, its header.\n\n"
        "Arrays are read-only, H x W, row by row from the top left, and look into the image, which they "
        "keep alive. Radiances are linear, in the scene's units. The picture is of the crop, where there is one.")
        .def(
            "__getitem__",
            [](Self self, const std::string& channel) -> View<float, -1, -1> {
                Image& image = image_of(self);
                return {image.channel(channel).data(), {image.height(), image.width()}, self};
            },
            "channel"_a, "A channel as render's EXR has it: float32, H x W. KeyError: the channels that there are.")
        .def_prop_ro(
            "channels",
            [](const Image& image) {
                std::vector<std::string> names;
                for (const auto& one : image.picture.channels) names.push_back(one.name);
                return names;
            },
            "The names of all channels.")
        .def(
            "rgb",
            [](Image& image) {
                auto* const colors = new std::vector<float>(image.width() * image.height() * 3);
                const nb::capsule owner(colors, [](void* p) noexcept { delete static_cast<std::vector<float>*>(p); });
                const char* const names[] = {"R", "G", "B"};
                for (size_t c = 0; c < 3; ++c) {
                    const std::vector<float>& from = image.channel(names[c]);
                    for (size_t i = 0; i < from.size(); ++i) (*colors)[3 * i + c] = from[i];
                }
                return nb::ndarray<nb::numpy, float, nb::shape<-1, -1, 3>>(colors->data(),
                                                                           {image.height(), image.width(), 3}, owner);
            },
            "R, G and B beside each other: a copy, float32, H x W x 3, linear.")
        .def_prop_ro(
            "sums",
            [](Self self) {
                const PixelRadiance* const first = &image_of(self).film.pixels.radiance(0);
                return field<int64_t, 3>(self, first, first->radiance, "");
            },
            "The integer sums of every pixel: int64, H x W x 3. Times `unit` they are mean radiances.")
        .def_prop_ro(
            "unit", [](const Image& image) { return image.film.unit(); },
            "What one unit of `sums` adds to a pixel's mean radiance.")
        .def_prop_ro(
            "id",
            [](Self self) {
                const PixelSight* const first = sights(image_of(self));
                return field<int32_t>(self, first, first ? &first->id : nullptr, "id");
            },
            "What lies under each pixel's center: int32, H x W; 1 + number of the object, beyond them visible lights; "
            "0: nothing. Needs a "
            "layer of data, such as \"id\".")
        .def_prop_ro(
            "z",
            [](Self self) {
                const PixelSight* const first = sights(image_of(self));
                return field<float>(self, first, first ? &first->z : nullptr, "Z");
            },
            "Distance along the view axis in scene units: float32, H x W; infinity: nothing. Needs a layer of data, "
            "such as \"Z\".")
        .def_prop_ro(
            "normal",
            [](Self self) {
                const PixelSight* const first = sights(image_of(self));
                return field<float, 3>(self, first, first ? first->normal : nullptr, "N");
            },
            "Unit normals in world axes: float32, H x W x 3; 0: nothing. Needs a layer of data, such as \"N\".")
        .def_prop_ro(
            "hash",
            [](Image& image) {
                if (image.hash.empty()) image.hash = film_hash(image.film);
                return image.hash;
            },
            "The hash that `render --verbose` and its stats tell: equal hashes are equal pictures.")
        .def_prop_ro(
            "frame", [](const Image& image) { return image.frame; }, "The number of the frame.")
        .def_prop_ro(
            "rays", [](const Image& image) { return image.film.rays.total(); }, "Rays of all kinds that were traced.")
        .def_prop_ro(
            "ray_counts",
            [](const Image& image) {
                const RayCounts& rays = image.film.rays;
                return std::map<std::string, uint64_t>{{"primary", rays.primary},
                                                       {"reflected", rays.reflected},
                                                       {"transmitted", rays.transmitted},
                                                       {"shadow", rays.shadow}};
            },
            "Rays that were traced, by kind.")
        .def_prop_ro(
            "seconds", [](const Image& image) { return image.seconds; }, "How long it rendered.")
        .def_prop_ro(
            "times",
            [](const Image& image) {
                const RenderTimes& times = image.times;
                if (times.kernel <= 0 && times.transfer <= 0) return std::map<std::string, double>{};
                return std::map<std::string, double>{{"kernel", times.kernel}, {"transfer", times.transfer}};
            },
            "On GPUs the parts of `seconds`: \"kernel\", computing pixels, and \"transfer\", from then until the image "
            "is "
            "there.")
        .def_prop_ro("target", target_of, nb::sig("def target(self) -> dict[str, int | float | bool] | None"),
                     "With a target error what is proven and estimated of it, in pixels; else None.")
        .def_prop_ro(
            "header",
            [](const Image& image) {
                nb::dict header;
                for (const auto& [name, value] : image.picture.attributes) header[name.c_str()] = header_value(value);
                return header;
            },
            nb::sig("def header(self) -> dict[str, str | int | float | list[float] | tuple[int, int]]"),
            "What the header of its EXR says: the scene's hash, camera, depth and so on.")
        .def("save", save, "path"_a, nb::sig("def save(self, path: str | os.PathLike[str]) -> None"),
             "Writes the EXR that render writes, byte for byte; whole or not at all.")
        .def(
            "preview",
            [](const Image& image, const nb::object& given, double exposure, const std::string& view, double bloom) {
                const std::string path = named(given, ".png");
                const WithoutGil free;
                write_file_atomically(path, png_of(image, {{"exposure", fmt::format("{}", exposure)},
                                                           {"view", view},
                                                           {"bloom", fmt::format("{}", bloom)}}));
            },
            "path"_a, "exposure"_a = 0.0, "view"_a = "srgb", "bloom"_a = 0.0,
            nb::sig("def preview(self, path: str | os.PathLike[str], exposure: float = 0.0, view: str = 'srgb', bloom: "
                    "float = 0.0) -> None"),
            "Writes the PNG that `render --preview` writes: 8 bits, sRGB; exposure in stops, view \"srgb\", \"filmic\" "
            "or one of $OCIO.")
        .def("explore", explore, "path"_a.none() = nb::none(), nb::kw_only(), "mb"_a = 5.0,
             nb::sig("def explore(self, path: str | os.PathLike[str] | None = None, *, mb: float = 5.0) -> typing.Any"),
             "Writes the page that `render --explore` writes, of at most `mb` megabytes: a click on a pixel shows its "
             "rays. "
             "Without a path, in a notebook: a widget that does, which asks for any pixel.")
        .def("_explorer_rays", explorer_rays, "x"_a, "y"_a, "A pixel's rays for the widget's script. Internal.")
        .def(
            "_repr_png_",
            [](const Image& image) {
                const std::string png = png_of(image, {});
                return nb::bytes(png.data(), png.size());
            },
            "The picture in a notebook: an 8-bit sRGB PNG.")
        .def("__repr__", [](const Image& image) {
            return fmt::format("<cistula.Image {}x{}, frame {}, channels {}>", image.width(), image.height(),
                               image.frame, image.picture.channels.size());
        });
}

}  // namespace cistula::python

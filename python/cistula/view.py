"""`cistula view`: layers of an EXR of any program as a PNG, one or several side by side."""
import importlib.util
import os
import re
import struct
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn, cast

import numpy as np
import numpy.typing as npt

from .command import Parser, Refused, nearest_first, number, shown, write_whole

Array = npt.NDArray[Any]

GAP, BORDER = 8, 48  # pixels between pictures, and the code of what has no data
NOTHING = 1e10       # what depths and places have where there is nothing, or more

LONG = {"red": "r", "green": "g", "blue": "b", "alpha": "a"}
BEAUTY = ("combined", "beauty", "rgba", "rgb")
MOTION = ("forward", "backward", "motion", "velocity", "vector", "vectors", "motionvector", "motionvectors")
SETS = {"rgb": "color", "xyz": "vectors", "xy": "vectors", "uv": "texture coordinates"}


@dataclass
class Part:
    number: int
    name: str
    spec: Any  # OpenImageIO's

    def __post_init__(self) -> None:
        s = self.spec
        self.attribute = s.getattribute
        self.display = s.full_width, s.full_height
        self.data = s.x - s.full_x, s.y - s.full_y, s.width, s.height  # x and y from the upper left of the display window
        self.types = dict(zip(s.channelnames, map(str, s.channelformats or [s.format] * s.nchannels)))


@dataclass
class Layer:
    name: str
    kind: str
    part: Part
    channels: list[str]
    rank: int = 2                 # how far from being the picture itself
    family: tuple[str, ...] = ()  # names that choose it with others: those of its Cryptomatte


Look = Callable[[Array, int], Array]  # codes of linear light; the int is the full frame's height


def component(channel: str) -> str:
    """What follows the last dot, in lower case, in short."""
    last = channel.rpartition(".")[2].lower()
    return LONG.get(last, last)


def kind_of_one(name: str, channel: str, is_whole: bool) -> str:
    """How a channel that stands alone is shown. `name`: its layer's, without a view."""
    word = name.rpartition(".")[2].lower()
    if is_whole or word in ("id", "indexob", "indexma") or name.endswith(("_id", "Id", "_ID")):
        return "ids"
    if word != "mist" and (component(channel) == "z" or word == "z" or word.startswith("depth")):
        return "depth"
    return "luminance" if component(channel) == "y" else "scalar"


def layers_of_group(part: Part, prefix: str, channels: list[str], views: set[str], mattes: set[str]) -> list[Layer]:
    """The layers of the channels that have one name before the last dot; what is no set is a layer for each channel."""
    words = prefix.split(".") if prefix else []
    view = words.pop() if words and words[-1].lower() in views else ""
    base, word = ".".join(words), words[-1].lower() if words else ""
    own = [w.lower() for w in part.name.split(".") + words if w and w.lower() not in views]
    rank = 0 if not own else 1 if own[-1] in BEAUTY else 2
    rest, layers = sorted(channels), []
    of = {component(channel): channel for channel in rest}

    def add(name: str, kind: str, components: str, family: tuple[str, ...] = ()) -> None:
        layers.append(Layer(name, kind, part, [of[c] for c in components], rank, family))
        rest[:] = [channel for channel in rest if channel not in layers[-1].channels]

    type_name = base[:-2] if base[-2:].isdigit() else ""
    if type_name and ("crypto" in word or type_name in mattes) and of.keys() >= set("rgba"):
        add(prefix, "mattes", "rgba", (type_name, f"{type_name}.{view}"))
    elif base and of.keys() >= set("xyzw"):  # Blender's Vector: to the frame before, and to the next
        add(prefix, "vectors", "xy")
        add(prefix + ".ZW", "vectors", "zw")
    else:
        for components, kind in SETS.items():
            if of.keys() >= set(components) and (base or kind == "color"):  # Z without a dot is a depth
                if len(components) == 3 and (word in ("n", "normal", "normals") or kind == "vectors" and "normal" in word):
                    kind = "normals"
                elif kind == "texture coordinates" and word in MOTION:
                    kind = "vectors"
                add(prefix or "RGB", kind, components)
                break
    for channel in list(rest):
        alone = len(channels) == 1 and prefix
        kind = kind_of_one((base if alone else "") or channel, channel, part.types[channel].startswith("uint"))
        layers.append(Layer(prefix if alone else channel, kind, part, [channel], rank))
    return layers


def layers_of(parts: list[Part]) -> list[Layer]:
    """All layers, those of a part together, colors without a name first, no two with one name. In a file of several parts
    a layer is PART.NAME, unless NAME begins with the part's own."""
    views = {"left", "right"}
    mattes: set[str] = set()
    for part in parts:
        stated = part.attribute("multiView") or part.attribute("view") or ()
        views.update(view.lower() for view in ((stated,) if isinstance(stated, str) else stated))
        mattes.update(a.value for a in part.spec.extra_attribs if re.fullmatch("cryptomatte/[^/]*/name", a.name))
    layers: list[Layer] = []
    names: set[str] = set()
    for part in parts:
        groups: dict[str, list[str]] = {}
        for channel in part.spec.channelnames:
            groups.setdefault(channel.rpartition(".")[0], []).append(channel)
        for prefix in sorted(groups):
            for layer in layers_of_group(part, prefix, groups[prefix], views, mattes):
                if len(parts) > 1 and not (layer.name + ".").startswith(part.name + "."):
                    layer.name = f"{part.name}.{layer.name}"
                while layer.name in names:
                    layer.name += " (2)"
                names.add(layer.name)
                layers.append(layer)
    return layers


def chosen_layers(layers: list[Layer], texts: list[str], file: str) -> list[Layer]:
    """The layers that --layer names, each once. A channel's name is a layer of it, the name of a Cryptomatte all its ranks.
    Without names the picture itself: the first of colors that is no pass, else of colors, else of luminance."""
    if not texts:
        colors = [layer for layer in layers if layer.kind == "color"] or [la for la in layers if la.kind == "luminance"]
        return [min(colors or layers[:1], key=lambda layer: layer.rank)]
    found: dict[str, Layer] = {}
    for text in texts:
        for name in [text] if any(layer.name == text for layer in layers) else text.split(","):
            hits = [layer for layer in layers if layer.name == name] or [la for la in layers if name in la.family]
            hits = hits or [Layer(name, "scalar", la.part, [name]) for la in layers if name in la.channels][:1]
            if not hits:
                raise Refused(f"--layer {text}: {file} has no layer '{shown(name)}'; "
                              f"the layers are: {nearest_first(name, [layer.name for layer in layers])}")
            found.update((layer.name, layer) for layer in hits)
    return list(found.values())


def table(layers: list[Layer]) -> str:
    rows = [("layer", "shown as", "size", "channels")]
    for la in layers:
        channels = " ".join(map(shown, (la.part.types[la.channels[0]], *la.channels)))
        rows.append((shown(la.name), la.kind, f"{la.part.data[2]}x{la.part.data[3]}", channels))
    width = max(len(name) for name, *_ in rows)
    return "\n".join(f"{name:{width}}  {kind:19}  {size:11}  {channels}" for name, kind, size, channels in rows)


PRIMARIES = {  # red, green, blue, white
    "rec709": (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329),
    "ap1": (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767),
    "ap0": (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767),
    "rec2020": (0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329),
    "p3d65": (0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.329),
    "adobergb": (0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.329),
}
LINEAR = ("lin_rec709_scene", "lin_rec709", "Linear Rec.709 (sRGB)", "Linear Rec.709")  # Rec. 709, in configs
BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])


def linear(codes: Array) -> Array:
    """sRGB from 0 to 1 as linear light."""
    return np.asarray(np.where(codes <= 0.04045, codes / 12.92, ((np.maximum(codes, 0) + 0.055) / 1.055) ** 2.4))


def codes_of(light: Array) -> Array:
    """The 8-bit sRGB codes of linear light."""
    x = np.clip(light, 0, 1)
    return np.asarray(np.rint(255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)).astype(np.uint8))


def xyz_from(xy: Sequence[float]) -> Array:
    """RGB to XYZ for red, green, blue and white."""
    if not xy[7] > 0:
        raise ValueError
    points = np.array([[x, y, 1 - x - y] for x, y in zip(xy[::2], xy[1::2])]).T
    amounts = np.linalg.solve(points[:, :3], points[:, 3] / points[1, 3])
    if not (amounts > 0).all():
        raise ValueError
    return points[:, :3] * amounts


def to_rec709(part: Part) -> tuple[Callable[[Array], Array], str]:
    """From the numbers of a part's colors to linear Rec. 709, and what that does, in words."""
    name = str(part.attribute("colorInteropID") or "unknown")
    if name == "unknown" and part.attribute("acesImageContainerFlag") == 1:
        name = "lin_ap0_scene"
    stated = re.fullmatch(r"(lin|srgb|g\d\d)_(\w+)_scene", name)
    if name not in ("data", "unknown") and not (stated and stated[2] in PRIMARIES):
        return np.asarray, f"numbers as they are, as its colorInteropID '{shown(name)}' is not known"
    xy = PRIMARIES[stated[2]] if stated else None if name == "data" else part.attribute("chromaticities")
    power = 1.0 if not stated or stated[1] == "lin" else 0 if stated[1] == "srgb" else int(stated[1][1:]) / 10
    matrix: Array = np.eye(3)
    if xy is not None and (len(xy) != 8 or not np.allclose(xy, PRIMARIES["rec709"], rtol=0, atol=0.001)):
        try:
            source, target = xyz_from(xy), xyz_from(PRIMARIES["rec709"])
            gains = BRADFORD @ target.sum(1) / (BRADFORD @ source.sum(1))
            matrix = np.linalg.inv(target) @ np.linalg.inv(BRADFORD) @ np.diag(gains) @ BRADFORD @ source
        except (ValueError, IndexError):  # LinAlgError is one
            return np.asarray, "numbers as they are, as its chromaticities are no color space"
    elif power == 1:
        return np.asarray, ""

    curve = linear if power == 0 else lambda v: np.copysign(np.abs(v.astype(float)) ** power, v)
    return lambda values: np.asarray(curve(values) @ matrix.T), "from the file's color space to that of sRGB"


def bloomed(light: Array, amount: float, full_height: int) -> Array:
    """With the light above white spread by three boxes in each direction; what falls outside is lost."""
    radius, above = max(full_height // 64, 1), np.clip(light, 0, 65504)
    most = above.max(2, keepdims=True)
    above = np.where(most > 1, above * (1 - 1 / np.maximum(most, 1)), 0)
    for axis in (0, 1) * 3:
        pad = [(radius + 1, radius) if a == axis else (0, 0) for a in range(3)]
        sums = np.cumsum(np.pad(above, pad), axis)
        size, width = above.shape[axis], 2 * radius + 1
        above = (np.take(sums, range(width, width + size), axis) - np.take(sums, range(size), axis)) / width
    return light + amount * above


def filmic(light: Array) -> Array:
    """docs/programs/views.md has the formula."""
    light = np.maximum(light, 0)
    most = light.max(2, keepdims=True)
    tone = most ** 1.2 / (most ** 1.2 + 0.18 ** 1.2 * 0.82 / 0.18)
    return np.asarray(tone * ((1 - tone ** 6) * light / np.where(most > 0, most, 1) + tone ** 6))


def config_view(name: str) -> Callable[[Array], Array]:
    """A view of the OpenColorIO config that $OCIO names, or of the one that is built in: codes of linear Rec. 709."""
    import OpenImageIO as oiio
    path = os.environ.get("OCIO") or "ocio://default"
    config = oiio.ColorConfig(path)
    first = config.getDefaultDisplayName()
    displays = sorted(config.getDisplayNames(), key=lambda display: display != first)
    views = {view if d == first else f"{view} ({d})": (d, view) for d in displays for view in config.getViewNames(d)}
    spaces = [space for space in LINEAR if config.getColorSpaceIndex(space) >= 0]
    if config.geterror() or not spaces or not views:
        raise Refused(f"--view {name}: $OCIO, {path}: is no config with views and one of the spaces {', '.join(LINEAR)}", 3)
    if name not in views:
        known = nearest_first(name, ["srgb", "filmic", *views])
        raise Refused(f"--view {name}: there is no such view; the views are: {known}")

    def apply(light: Array) -> Array:
        result = oiio.ImageBufAlgo.ociodisplay(oiio.ImageBuf(np.ascontiguousarray(light, np.float32)), *views[name], spaces[0],
                                               unpremult=False, colorconfig=path)
        if result.has_error:
            raise Refused(f"--view {name}: $OCIO, {path}: {result.geterror()}", 3)
        return np.asarray(255 * np.clip(np.nan_to_num(cast(Array, result.get_pixels(oiio.FLOAT))), 0, 1) + 0.5).astype(np.uint8)
    return apply


def id_colors(ids: Array) -> Array:
    """The sRGB codes of ids: black for 0, else a hue far from those of its neighbors, of four degrees of brightness."""
    ids = ids.astype(np.uint64)
    hue = (ids * np.uint64(2654435769) % np.uint64(1 << 32)).astype(float) * 2.0 ** -32 * 6  # 2^32 / the golden ratio
    low, high = np.array([[30, 235], [120, 255], [0, 150], [85, 190]])[(ids ^ ids >> 8 ^ ids >> 16 ^ ids >> 24) % 4].T
    around = np.abs((hue[..., None] + 6 - 2 * np.arange(3)) % 6 - 3)
    codes = low.T[..., None] + np.rint(np.clip(around - 1, 0, 1) * (high - low).T[..., None])
    return np.where(ids[..., None] == 0, 0, codes).astype(np.uint8)


def ids_of(values: Array) -> Array:
    """The numbers that stand for ids stored as floats: themselves where they are whole, else their bits."""
    whole = (values >= 0) & (values < 2.0 ** 32) & (np.floor(values) == values)
    return np.where(whole, np.where(whole, values, 0).astype(np.uint64), values.view(np.uint32))


def spread(values: Array, within: Array) -> tuple[Array, str]:
    """Values as shares of the range of those `within`, and that range, in words."""
    if not within.any():
        return np.zeros(values.shape), ""
    low, high = float(values[within].min()), float(values[within].max())
    return (values.astype(float) - low) / ((high - low) or 1), f"{low:.4g} to {high:.4g}"


def picture_of(layer: Layer, values: Array, look: Look, exposed: bool) -> tuple[Array, str]:
    """A layer's values (height, width, channels) as codes (height, width, 3), and what is shown how, in words."""
    part, kind, words = layer.part, layer.kind, ""
    finite: Array = np.isfinite(values)
    infinite = np.asarray((np.isneginf(values) if kind == "depth" else np.isinf(values)).any(2))
    nan = np.asarray(np.isnan(values).any(2))
    v = np.where(finite.all(2, keepdims=True), values, 0)
    if kind in ("color", "luminance"):
        convert, words = to_rec709(part)
        codes = look(convert(np.broadcast_to(v, v.shape[:2] + (3,))), part.display[1])
    elif kind == "ids":
        codes = id_colors(v[..., 0] if v.dtype == np.uint32 else ids_of(v[..., 0]))
    elif kind == "mattes":
        colors = linear(id_colors(ids_of(np.ascontiguousarray(v[..., ::2]))) / 255)
        codes = codes_of((colors * np.clip(v[..., 1::2], 0, 1)[..., None]).sum(2))
    elif kind == "depth":
        far = part.attribute("cistula:zFar")
        near = finite & (values < min(NOTHING, far if isinstance(far, float) else NOTHING))
        share, words = spread(v, near)
        codes = np.rint(255 * np.where(near, 1 - 0.875 * share, 0))  # what is nothing is darker than the farthest
        words = words.replace(" to ", " bright to ") + " dark" if words else "nothing"
    elif kind == "normals":
        codes = np.rint(255 * np.clip(0.5 + 0.5 * v, 0, 1)) * v.any(2, keepdims=True)
    elif kind == "vectors":
        here = np.asarray((np.abs(v) < NOTHING).all(2))
        shares = [spread(v[..., c], here & finite.all(2)) for c in range(v.shape[2])]
        words = ", ".join(f"{component(name).upper()} {text}" for name, (_, text) in zip(layer.channels, shares) if text)
        codes = np.rint(255 * np.clip(np.stack([share for share, _ in shares], 2), 0, 1)) * here[..., None]
    elif kind == "texture coordinates":
        codes = np.rint(255 * (v - np.floor(v)))
    else:
        words = spread(v, finite)[1]
        most = float(v[finite].max(initial=0)) or 1
        codes = look(np.broadcast_to(v, v.shape[:2] + (3,)), part.display[1]) if exposed else codes_of(v / most)
    codes = np.repeat(codes, 3, 2) if codes.shape[2] == 1 else np.pad(codes, ((0, 0), (0, 0), (0, 3 - codes.shape[2])))
    codes = codes.astype(np.uint8)
    codes[infinite], codes[nan] = (0, 255, 255), (255, 0, 255)
    for mask, what in ((nan, "not a number (magenta)"), (infinite & ~nan, "infinite (cyan)")):
        if count := int(mask.sum()):
            words += (", " if words else "") + f"{count} {'pixel is' if count == 1 else 'pixels are'} {what}"
    return codes, words


def png(codes: Array) -> bytes:
    """An 8-bit PNG of sRGB codes, rows as their differences from those above."""
    flat = codes.reshape(codes.shape[0], -1)
    rows = np.pad(np.diff(flat, axis=0, prepend=np.zeros_like(flat[:1])), ((0, 0), (1, 0)), constant_values=2).tobytes()
    head = struct.pack(">2I5B", codes.shape[1], codes.shape[0], 8, 2, 0, 0, 0)
    chunks = (b"IHDR" + head, b"sRGB\0", b"IDAT" + zlib.compress(rows, 6), b"IEND")
    return b"\x89PNG\r\n\x1a\n" + b"".join(struct.pack(">I", len(c) - 4) + c + struct.pack(">I", zlib.crc32(c)) for c in chunks)


def sheet(layers: list[Layer], show: Callable[[Layer], tuple[Array, str]], columns: int, data_window: bool) -> tuple[Array, str]:
    """Layers in rows from the upper left, and a line for each: where it is and how it is shown."""
    sizes = [la.part.data[2:] if data_window else la.part.display for la in layers]
    width, height = max(w for w, _ in sizes), max(h for _, h in sizes)
    columns = min(columns, len(layers))
    whole = -(-len(layers) // columns) * (height + GAP) - GAP, columns * (width + GAP) - GAP
    if whole[0] * whole[1] > min(1 << 30, (1 << 24) + 16 * sum(la.part.data[2] * la.part.data[3] for la in layers)):
        raise Refused(f"{len(layers)} layers would be a picture of {whole[1]}x{whole[0]} pixels: too large, or mostly "
                      "borders; name fewer, or give --data-window")
    canvas, lines = np.full(whole + (3,), BORDER, np.uint8), []
    for i, (layer, size) in enumerate(zip(layers, sizes)):
        codes, words = show(layer)
        x, y, w, h = layer.part.data
        text = ", ".join(filter(None, (layer.kind, words)))
        if (x, y, w, h) != (0, 0, *layer.part.display):
            text += f", data window {w}x{h}{x:+d}{y:+d} of {'x'.join(map(str, layer.part.display))}"
        if data_window:
            x = y = 0
        row, column = divmod(i, columns)
        cell = canvas[row * (height + GAP):, column * (width + GAP):][:size[1], :size[0]]
        codes = codes[max(-y, 0):, max(-x, 0):][:max(size[1] - max(y, 0), 0), :max(size[0] - max(x, 0), 0)]
        cell[max(y, 0):, max(x, 0):][:codes.shape[0], :codes.shape[1]] = codes
        lines.append(f"row {row + 1}, column {column + 1}: " * (len(layers) > 1) + f"{shown(layer.name)}: {text}")
    return canvas, "\n".join(lines)


class Reader:
    """An EXR: its parts, and the values of its layers."""

    def __init__(self, path: str) -> None:
        if not importlib.util.find_spec("OpenImageIO"):
            raise Refused("OpenImageIO is not installed; python3 -m pip install openimageio")
        import OpenImageIO as oiio
        with open(path, "rb"):
            pass  # its errors are clearer
        self.path, self.file, reason = shown(path), cast(Any, None), "it is no EXR"
        for core in (1, 0) if path.isprintable() else ():  # the second reader takes luminance and chroma
            oiio.attribute("openexr:core", core)
            self.file = self.file or oiio.ImageInput.open(path)
            reason = oiio.geterror() or reason
        if not self.file or self.file.format_name() != "openexr":
            self.refuse(reason)
        self.parts: list[Part] = []
        while self.file.seek_subimage(len(self.parts), 0):
            spec = self.file.spec()
            if spec.deep or not spec.nchannels:
                self.refuse(f"part {len(self.parts)} " + ("is deep" if spec.deep else "has no channels"))
            self.parts.append(Part(len(self.parts), spec.getattribute("name") or "", spec))
        self.keeps, self.kept = False, (-1, np.empty(0))  # of a part: number, all values

    def refuse(self, reason: str) -> NoReturn:
        raise Refused(f"{self.path}: cannot be read: {reason.strip().splitlines()[-1]}", 3)

    def values(self, layer: Layer) -> Array:
        """The values of a layer (height, width, channels). `keeps`: read all of a part at once, but for large ones."""
        spec, number = layer.part.spec, layer.part.number
        places = [spec.channelnames.index(channel) for channel in layer.channels]
        of_ids = layer.part.types[layer.channels[0]].startswith("uint")
        if self.kept[0] == number and not of_ids:
            return self.kept[1][..., places]
        keep = self.keeps and not of_ids and spec.width * spec.height * spec.nchannels <= 1 << 28
        first, end = (0, spec.nchannels) if keep else (min(places), max(places) + 1)
        values = self.file.read_image(number, 0, first, end, "uint32" if of_ids else "float")
        if values is None:
            self.refuse(self.file.geterror() or "it may be cut off")
        if keep:
            self.kept = number, np.asarray(values)
        return np.asarray(values)[..., [place - first for place in places]]


def main(arguments: Sequence[str]) -> int:
    parser = Parser("view", description=__doc__, epilog="""examples:
  cistula view film.exr --list
  cistula view film.exr --exposure 2 --view filmic -o film.png
  cistula view film.exr --layer RGB,Z,N,id --columns 3 -o sheet.png

Pixels that are not a number are magenta, infinite ones cyan; standard output says how many, and what values were mapped.

exit codes: 0 done, 2 command line or no such layer, 3 file""")
    add = parser.add_argument
    add("file", metavar="FILE.exr", help="the image")
    add("-o", "--output", metavar="FILE", help="the PNG; FILE.view.png in the working directory")
    add("--layer", action="append", metavar="NAME", default=[],
        help="a layer, or several with commas between; may be given several times; the picture itself")
    add("--all", action="store_true", help="all layers")
    add("--list", action="store_true", help="print the layers and how each is shown, and exit")
    add("--columns", type=number(1, 1000, int), default=4, metavar="N", help="of several layers: so many in a row; 4")
    add("--data-window", action="store_true", help="all pixels that there are, overscan too, not the display window")
    add("--exposure", type=number(-64, 64), metavar="EV", help="stops by which colors and scalars are brighter; 0")
    add("--view", default="srgb", metavar="NAME", help="of colors: srgb cuts off above white, filmic tells bright "
        "colors apart, or a view of $OCIO; srgb")
    add("--bloom", type=number(0, 100), default=0.0, metavar="AMOUNT",
        help="of colors: how much light above white glows around; 0")
    add("-q", "--quiet", action="store_true", help="errors only")
    options = parser.parse(arguments)
    if options.all and options.layer:
        raise Refused(f"--layer {options.layer[0]}: has no place beside --all, which shows every layer; leave one out")
    if options.list and options.output:
        raise Refused(f"-o {options.output}: --list writes no picture; leave it out")
    output = Path(options.output or Path(options.file).stem + ".view.png")
    if output.suffix.lower() != ".png":
        raise Refused(f"-o {output}: what is seen is written as a PNG; name it *.png")
    reader = Reader(options.file)
    layers = layers_of(reader.parts)
    if options.list:
        print(table(layers))
        return 0
    if output.exists() and output.samefile(options.file):
        raise Refused(f"{output}: would be both the image and -o; give each a file of its own")
    layers = layers if options.all else chosen_layers(layers, options.layer, options.file)
    reader.keeps = len(layers) > 1
    curves = {"srgb": codes_of, "filmic": lambda light: codes_of(filmic(light))}
    curve = curves[options.view] if options.view in curves else config_view(options.view)

    def look(light: Array, full_height: int) -> Array:
        light = light.astype(np.float64) * 2.0 ** (options.exposure or 0)
        return curve(bloomed(light, options.bloom, full_height) if options.bloom else light)
    canvas, legend = sheet(layers, lambda la: picture_of(la, reader.values(la), look, options.exposure is not None),
                           options.columns, options.data_window)
    write_whole({output: png(canvas)})
    if not options.quiet:
        print(f"{shown(str(output))}: {canvas.shape[1]}x{canvas.shape[0]}\n{legend}")
    return 0

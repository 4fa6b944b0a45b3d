"""`cistula view`: which layers files of several programs have, what each looks like, contact sheets, errors."""
import base64
import contextlib
import io
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from cistula.__main__ import main

pytest.importorskip("OpenImageIO")
OpenEXR = pytest.importorskip("OpenEXR")

Array = npt.NDArray[Any]
MAGENTA, CYAN, BORDER = (255, 0, 255), (0, 255, 255), (48, 48, 48)


def view(folder: Path, *arguments: str, **more: Any) -> subprocess.CompletedProcess[str]:
    """`cistula view` as a program."""
    return subprocess.run([sys.executable, "-m", "cistula", "view", *arguments], cwd=folder, text=True, check=False,
                          **{"capture_output": True, **more})


def quick(folder: Path, *arguments: str) -> tuple[int, str, str]:
    """The same in this process: exit code, standard output, standard error."""
    out, error = io.StringIO(), io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        code = main(["view", *arguments])
    return code, out.getvalue(), error.getvalue()


def done(folder: Path, *arguments: str) -> str:
    code, out, error = quick(folder, *arguments)
    assert (code, error) == (0, "")
    return out


def refused(folder: Path, code: int, message: str, *arguments: str) -> None:
    before = sorted(os.listdir(folder))
    found, out, error = quick(folder, *arguments)
    assert (found, out, error.count("\n")) == (code, "", 1), error
    assert error.startswith("cistula view: ") and message in error
    assert sorted(os.listdir(folder)) == before


def box(x: int, y: int, width: int, height: int) -> tuple[Array, Array]:
    return np.array([x, y], np.int32), np.array([x + width - 1, y + height - 1], np.int32)


def write(path: Path, channels: dict[str, Any], **header: Any) -> None:
    """An EXR of rows of pixels: a list of one row, an array, or the number that all pixels of one row have."""
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header},
                 {n: np.atleast_2d(v if isinstance(v, np.ndarray) else np.float32(v)) for n, v in channels.items()}).write(str(path))


def pixels(path: Path) -> Array:
    picture = Image.open(path)
    assert picture.mode == "RGB"
    return np.asarray(picture)


def row(folder: Path, channels: dict[str, Any], *arguments: str, **header: Any) -> list[tuple[int, ...]]:
    """The codes of the first row of a file of one row of pixels."""
    write(folder / "row.exr", channels, **header)
    done(folder, "row.exr", "-o", "row.png", *arguments)
    return [tuple(map(int, pixel)) for pixel in pixels(folder / "row.png")[0]]


def code(linear: float) -> int:
    return round(255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055))


def layers(folder: Path, *channels: str, **header: Any) -> list[str]:
    """Each layer of a file with these channels as "NAME KIND CHANNELS"; names that begin with # are whole numbers."""
    write(folder / "l.exr", {c.lstrip("#"): np.zeros((1, 1), np.uint32 if c[0] == "#" else np.float32) for c in channels}, **header)
    lines = [line.split("  ") for line in done(folder, "l.exr", "--list").splitlines()[1:]]
    words = [[word.strip() for word in line if word.strip()] for line in lines]
    return [f"{name} {kind} {channels.partition(' ')[2]}" for name, kind, _, channels in words]


def shown_layer(folder: Path, *channels: str) -> str:
    layers(folder, *channels)
    return done(folder, "l.exr", "-o", "l.png").splitlines()[1].partition(":")[0]


def test_channels_belong_to_what_is_before_their_last_dot(tmp_path: Path) -> None:
    assert layers(tmp_path, "A", "B", "G", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "R", "Z", "a.b.B", "a.b.G", "a.b.R", "cost",
                  "depth_ray", "id", "material_id", "uv.U", "uv.V", "#count", "s.a", "s.b", "v.X") == [
        "RGB color R G B", "A scalar A", "Z depth Z", "cost scalar cost", "count ids count", "depth_ray depth depth_ray", "id ids id",
        "material_id ids material_id", "N normals N.X N.Y N.Z", "P vectors P.X P.Y P.Z", "a.b color a.b.R a.b.G a.b.B",
        "s.a scalar s.a", "s.b scalar s.b", "uv texture coordinates uv.U uv.V", "v scalar v.X"]
    assert layers(tmp_path, "R", "G", "width", "x.r", "x.R") == [
        "G scalar G", "R scalar R", "width scalar width", "x.R scalar x.R", "x.r scalar x.r"]


BLENDER = ["AO.R", "AO.G", "AO.B", "Combined.R", "Combined.G", "Combined.B", "Combined.A", "Depth.Z", "Mist.Z", "IndexOB.X", "Normal.X",
           "Normal.Y", "Normal.Z", "UV.U", "UV.V", "UV.A", "Vector.X", "Vector.Y", "Vector.Z", "Vector.W"]


def test_layers_of_blender(tmp_path: Path) -> None:
    assert [line.partition("View.")[2].rsplit(" View")[0].split(" View")[0] for line in layers(tmp_path, *("View." + c for c in BLENDER))] == [
        "AO color", "Combined color", "Combined.A scalar", "Depth depth", "IndexOB ids", "Mist scalar", "Normal normals",
        "UV texture coordinates", "UV.A scalar", "Vector vectors", "Vector.ZW vectors"]
    assert done(tmp_path, "l.exr", "-o", "l.png") == "l.png: 1x1\nView.Combined: color\n"


def test_views_stand_after_a_layers_name(tmp_path: Path) -> None:
    stereo = [f"View.{layer}.{eye}.{c}" for eye in ("left", "right") for layer, components in (
        ("Combined", "RGBA"), ("AO", "RGB"), ("CryptoObject00", "rgba"), ("Normal", "XYZ"), ("Depth", "Z")) for c in components]
    found = layers(tmp_path, *stereo)
    assert [" ".join(line.split()[:2]) for line in found if "left" in line] == [
        "View.AO.left color", "View.Combined.left color", "View.Combined.left.A scalar", "View.CryptoObject00.left mattes",
        "View.Depth.left depth", "View.Normal.left normals"]
    assert len(found) == 12
    assert "View.Combined.left: color" in done(tmp_path, "l.exr", "-o", "l.png")
    text = done(tmp_path, "l.exr", "--layer", "View.CryptoObject", "-o", "l.png")
    assert "column 1: View.CryptoObject00.left: mattes" in text and "column 2: View.CryptoObject00.right: mattes" in text
    assert layers(tmp_path, "R", "G", "B", "east.R", "east.G", "east.B", "east.Z", "depth.east.Z", multiView=["west", "east"]) == [
        "RGB color R G B", "depth.east depth depth.east.Z", "east color east.R east.G east.B", "east.Z depth east.Z"]


def test_layers_of_nuke_and_long_names(tmp_path: Path) -> None:
    assert layers(tmp_path, "red", "green", "blue", "alpha", "forward.u", "forward.v", "uv.u", "uv.v", "other.red", "other.green",
                  "other.blue", "mask.a") == [
        "RGB color red green blue", "alpha scalar alpha", "forward vectors forward.u forward.v", "mask scalar mask.a",
        "other color other.red other.green other.blue", "uv texture coordinates uv.u uv.v"]
    assert row(tmp_path, {"red": [1, 0], "green": [0, 1], "blue": [0, 0]}) == [(255, 0, 0), (0, 255, 0)]


def test_cryptomattes_are_known_by_name_and_by_header(tmp_path: Path) -> None:
    rgba = "rgba"
    assert layers(tmp_path, *(f"CryptoAsset01.{c}" for c in rgba), *(f"CryptoAsset.{c}" for c in "RGB"), *(f"things00.{c}" for c in rgba),
                  *(f"other00.{c}" for c in rgba), **{"cryptomatte/1234567/name": "things"}) == [
        "CryptoAsset color CryptoAsset.R CryptoAsset.G CryptoAsset.B",
        "CryptoAsset01 mattes CryptoAsset01.r CryptoAsset01.g CryptoAsset01.b CryptoAsset01.a",
        "other00 color other00.r other00.g other00.b", "other00.a scalar other00.a",
        "things00 mattes things00.r things00.g things00.b things00.a"]


def test_the_picture_itself_is_shown(tmp_path: Path) -> None:
    assert shown_layer(tmp_path, "R", "G", "B", "a.R", "a.G", "a.B") == "RGB"
    assert shown_layer(tmp_path, "A", "Y", "a.R", "a.G", "a.B") == "a"
    assert shown_layer(tmp_path, "a.R", "a.G", "a.B", "beauty.R", "beauty.G", "beauty.B") == "beauty"
    assert shown_layer(tmp_path, "A", "Y") == "Y"
    assert shown_layer(tmp_path, "A", "Z") == "A"


def test_parts_stand_before_their_layers(tmp_path: Path) -> None:
    def part(name: str, channels: str, width: int = 2, height: int = 1) -> Any:
        window = {"displayWindow": box(0, 0, 2, 3), "dataWindow": box(0, 0, width, height)}
        return OpenEXR.Part({"type": OpenEXR.scanlineimage, **window},
                            {c: np.ones((height, width), np.float32) for c in channels.split()}, name)
    OpenEXR.File([part("View.AO", "R G B"), part("View.Combined", "R G B", 1, 3), part("gloss", "gloss.R gloss.G gloss.B"),
                  part("depth", "Z")]).write(str(tmp_path / "p.exr"))
    text = done(tmp_path, "p.exr", "--all", "--data-window", "--columns", "2", "-o", "p.png")
    assert [line.split(": ")[1] for line in text.splitlines()[1:]] == ["View.AO.RGB", "View.Combined.RGB", "gloss", "depth.Z"]
    assert pixels(tmp_path / "p.png").shape == (3 + 8 + 3, 2 + 8 + 2, 3)
    assert tuple(pixels(tmp_path / "p.png")[1, 0]) == BORDER
    assert "View.Combined.RGB: color" in done(tmp_path, "p.exr", "-o", "p.png")


def test_layers_are_chosen_by_name_each_once(tmp_path: Path) -> None:
    def chosen(*names: str) -> list[str]:
        lines = done(tmp_path, "l.exr", "-o", "l.png", *(w for name in names for w in ("--layer", name))).splitlines()[1:]
        return [line.split(": ")[len(lines) > 1] for line in lines]
    layers(tmp_path, "A", "Z", "a,b", "id", "d.R", "d.G", "d.B")
    assert chosen("Z,A", "id", "A") == ["Z", "A", "id"]
    assert chosen("a,b") == ["a,b"]
    assert chosen("d.G") == ["d.G"]
    refused(tmp_path, 2, "--layer A,z: l.exr has no layer 'z'; the layers are: Z, ", "l.exr", "--layer", "A,z")


def test_colors_by_exposure_view_and_bloom(tmp_path: Path) -> None:
    rgb = {"R": [0, 0.5, -1], "G": [1, 0.25, 9], "B": [0.1, 0.125, 0]}
    assert row(tmp_path, rgb) == [(0, 255, code(0.1)), (code(0.5), code(0.25), code(0.125)), (0, 255, 0)]
    assert row(tmp_path, rgb, "--exposure", "-1")[1] == (code(0.25), code(0.125), code(0.0625))
    assert row(tmp_path, {"Y": [0.18, 4]}, "--view", "filmic") == [(code(0.18),) * 3, (code(0.9007),) * 3]
    assert row(tmp_path, {"Y": [0.0] * 9 + [2.0]}, "--bloom", "1")[8][0] > 10
    assert row(tmp_path, {"Y": [0.0] * 9 + [1.0]}, "--bloom", "1")[8][0] == 0


def test_the_png_is_the_preview_of_render(tmp_path: Path, programs: Path, source: Path) -> None:
    for look in ((), ("--view", "filmic", "--exposure", "1", "--bloom", "0.5")):
        subprocess.run([programs / "render", source / "scenes/platonic.json", "-q", "--res", "96x54", "-o", tmp_path / "p.exr",
                        "--preview", tmp_path / "p.png", *look], check=True)
        done(tmp_path, "p.exr", "-o", "v.png", *look)
        assert (pixels(tmp_path / "p.png") == pixels(tmp_path / "v.png")).all()


AP0 = (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767)


def test_colors_of_other_spaces_are_those_of_srgb(tmp_path: Path) -> None:
    white = {"R": 1, "G": 1, "B": 1}
    red = {"R": 0.4396, "G": 0.0898, "B": 0.0175}  # of linear Rec. 709 in ACES2065-1
    for header in ({"chromaticities": AP0}, {"colorInteropID": "lin_ap0_scene"}, {"acesImageContainerFlag": 1}):
        assert row(tmp_path, white, **header) == [(255, 255, 255)]
        assert np.abs(np.array(row(tmp_path, red, **header)[0]) - (255, 0, 0)).max() <= 3, header
    assert done(tmp_path, "row.exr", "-o", "r.png").endswith("color, from the file's color space to that of sRGB\n")
    half = {"R": 0.5, "G": 0.25, "B": 1}
    assert row(tmp_path, half, colorInteropID="srgb_rec709_scene") == [(128, 64, 255)]
    assert row(tmp_path, half, colorInteropID="g22_rec709_scene") == [(code(0.5 ** 2.2), code(0.25 ** 2.2), 255)]
    plain = row(tmp_path, half)
    for strange in ({"colorInteropID": "acme"}, {"colorInteropID": "data", "chromaticities": AP0},
                    {"chromaticities": (0.0,) * 8}, {"chromaticities": (float("nan"),) * 8}):
        assert row(tmp_path, half, **strange) == plain


CHROMA = """di8xAQIAAABjaGFubmVscwBjaGxpc3QAOQAAAEJZAAEAAAABAAAAAgAAAAIAAABSWQABAAAAAQAAAAIAAAACAAAAWQABAAAAAAAAAAEAAAABAAAAAGNvbXByZXNz
aW9uAGNvbXByZXNzaW9uAAEAAAAEZGF0YVdpbmRvdwBib3gyaQAQAAAAAAAAAAAAAAAHAAAABwAAAGRpc3BsYXlXaW5kb3cAYm94MmkAEAAAAAAAAAAAAAAABwAA
AAcAAABsaW5lT3JkZXIAbGluZU9yZGVyAAEAAAAAcGl4ZWxBc3BlY3RSYXRpbwBmbG9hdAAEAAAAAACAP3NjcmVlbldpbmRvd0NlbnRlcgB2MmYACAAAAAAAAAAA
AAAAc2NyZWVuV2luZG93V2lkdGgAZmxvYXQABAAAAAAAgD8AQwEAAAAAAAAAAAAAwAAAAKC4oLiguKC4oDmgOaA5oDm4NLg0uDS4NLg0uDS4NLg0uDS4NLg0uDS4
NLg0uDS4NKC4oLiguKC4oDmgOaA5oDm4NLg0uDS4NLg0uDS4NLg0uDS4NLg0uDS4NLg0uDS4NKC4oLiguKC4oDmgOaA5oDm4NLg0uDS4NLg0uDS4NLg0uDS4NLg0
uDS4NLg0uDS4NKC4oLiguKC4oDmgOaA5oDm4NLg0uDS4NLg0uDS4NLg0uDS4NLg0uDS4NLg0uDS4NA=="""  # RgbaOutputFile, WRITE_YC, 0.5 0.25 0.125


def test_luminance_and_chroma_are_colors(tmp_path: Path) -> None:
    (tmp_path / "yc.exr").write_bytes(base64.b64decode(CHROMA))
    assert done(tmp_path, "yc.exr", "-o", "yc.png") == "yc.png: 8x8\nRGB: color\n"
    assert np.abs(pixels(tmp_path / "yc.png").astype(int) - (code(0.5), code(0.25), code(0.125))).max() <= 1


def test_ids_have_colors_of_their_own(tmp_path: Path) -> None:
    numbers = np.arange(1, 201, dtype=np.uint32)[None]
    colors = row(tmp_path, {"id": numbers})
    assert len(set(colors)) == 200 and row(tmp_path, {"id": np.float32(numbers)}) == colors
    for a in range(40):
        assert all(max(abs(p - q) for p, q in zip(colors[a], colors[b])) >= 16 for b in range(a))
    assert row(tmp_path, {"id": np.array([[0, (1 << 24) + 1, 1 << 24]], np.uint32)})[0] == (0, 0, 0)
    ids = row(tmp_path, {"id": np.array([[(1 << 24) + 1, 1 << 24, 2654435769]], np.uint32)})
    assert len(set(ids)) == 3  # floats do not tell the first two apart
    assert len(set(row(tmp_path, {"id": [0.5, 0.25, 0, 1]}))) == 4


def test_mattes_are_the_colors_of_ids_by_coverage(tmp_path: Path) -> None:
    (color,) = row(tmp_path, {"id": 1.5})
    full, part, none = row(tmp_path, {"CryptoX00.r": [1.5, 1.5, 0], "CryptoX00.g": [1, 0.25, 0], "CryptoX00.b": [0, 0, 0], "CryptoX00.a": 3 * [0.]})
    assert full == color and none == (0, 0, 0)
    linear = [0.25 * (c / 255 / 12.92 if c <= 10 else ((c / 255 + 0.055) / 1.055) ** 2.4) for c in color]
    assert part == tuple(map(code, linear))


def test_depths_normals_vectors_and_texture_coordinates(tmp_path: Path) -> None:
    inf, nan = float("inf"), float("nan")
    gray = [(c,) * 3 for c in (255, 32, 143, 0, 0, 0)]
    assert row(tmp_path, {"Z": [2, 4, 3, 1e10, inf, 2e10, nan, -inf]}) == [*gray, MAGENTA, CYAN]
    assert done(tmp_path, "row.exr", "-o", "r.png").splitlines()[1] == (
        "Z: depth, 2 bright to 4 dark, 1 pixel is not a number (magenta), 1 pixel is infinite (cyan)")
    assert row(tmp_path, {"Z": [2, 4, 3]}, **{"cistula:zFar": 4.0})[1] == (0, 0, 0)
    assert row(tmp_path, {"Z": [5, 5]}) == [(255,) * 3] * 2 and row(tmp_path, {"Z": [inf, 1e10]}) == [(0,) * 3] * 2
    assert row(tmp_path, {"N.X": [0, 1, -1, 0, 0], "N.Y": [0, 0, 0, -1, 0], "N.Z": [1, 0, 0, 0, 0]}) == [
        (128, 128, 255), (255, 128, 128), (0, 128, 128), (128, 0, 128), (0, 0, 0)]
    assert row(tmp_path, {"P.X": [-10, 10, 0, 1e10], "P.Y": [3, 3, 3, 3], "P.Z": [0, 5, 1, 0]}) == [(0, 0, 0), (255, 0, 255), (128, 0, 51), (0, 0, 0)]
    assert done(tmp_path, "row.exr", "-o", "r.png").splitlines()[1] == "P: vectors, X -10 to 10, Y 3 to 3, Z 0 to 5"
    assert row(tmp_path, {"uv.U": [0.2, 3.2, -0.8], "uv.V": [0.6, 0, 1.4]}) == [(51, 153, 0), (51, 0, 0), (51, 102, 0)]


def test_scalars_by_their_largest_or_by_the_exposure(tmp_path: Path) -> None:
    assert row(tmp_path, {"cost": [0, 50, 100, -3]}) == [(c,) * 3 for c in (0, 188, 255, 0)]
    assert done(tmp_path, "row.exr", "-o", "r.png").splitlines()[1] == "cost: scalar, -3 to 100"
    assert row(tmp_path, {"cost": [0, 50, 100]}, "--exposure", "-8")[2] == (code(100 / 256),) * 3
    assert row(tmp_path, {"cost": [0, -2]}) == [(0,) * 3] * 2


@pytest.mark.parametrize("channels", ["R G B", "Y", "id", "m.crypto00.r m.crypto00.g m.crypto00.b m.crypto00.a", "Z", "N.X N.Y N.Z",
                                      "P.X P.Y P.Z", "v.X v.Y", "uv.U uv.V", "cost"])
def test_what_is_not_finite_is_visible_and_harmless(tmp_path: Path, channels: str) -> None:
    values: dict[str, Any] = {name: [0.25, 0.75, 0.5, 0.5] for name in channels.split()}
    finite = row(tmp_path, values, "--bloom", "1", "--view", "filmic")
    values[channels.split()[-1]] = [0.25, 0.75, float("nan"), float("-inf")]
    assert row(tmp_path, values, "--bloom", "1", "--view", "filmic") == [*finite[:2], MAGENTA, CYAN]


def test_sheets(tmp_path: Path) -> None:
    write(tmp_path / "a.exr", {"R": [0, 1], "G": [0, 1], "B": [0, 1], "Z": [3, 5], "gloss.R": [0.5, 0], "gloss.G": [0, 0], "gloss.B": [0, 0]})
    assert done(tmp_path, "a.exr", "--layer", "Z,RGB", "--layer", "gloss", "--columns", "2", "-o", "new/s.png") == (
        "new/s.png: 12x10\nrow 1, column 1: Z: depth, 3 bright to 5 dark\nrow 1, column 2: RGB: color\nrow 2, column 1: gloss: color\n")
    sheet = pixels(tmp_path / "new/s.png")
    for place, wanted in {(0, 0): (255,) * 3, (1, 0): (32,) * 3, (2, 0): BORDER, (10, 0): (0, 0, 0), (11, 0): (255,) * 3, (0, 1): BORDER,
                          (0, 9): (188, 0, 0), (11, 9): BORDER}.items():
        assert tuple(sheet[place[1], place[0]]) == wanted, place
    done(tmp_path, "a.exr", "--all", "-q", "-o", "all.png")
    assert pixels(tmp_path / "all.png").shape == (1, 3 * 2 + 2 * 8, 3)
    assert done(tmp_path, "a.exr") == "a.view.png: 2x1\nRGB: color\n"


def test_the_display_window_is_shown(tmp_path: Path) -> None:
    """A crop lies where it is in the frame; overscan is cut off, but for --data-window."""
    ramp = np.linspace(0, 1, 48, dtype=np.float32).reshape(6, 8)
    write(tmp_path / "over.exr", {"Y": ramp}, dataWindow=box(8, 19, 8, 6), displayWindow=box(10, 20, 4, 3))
    whole = np.vectorize(code)(ramp)
    assert done(tmp_path, "over.exr").splitlines()[1] == "Y: luminance, data window 8x6-2-1 of 4x3"
    assert (pixels(tmp_path / "over.view.png")[..., 0] == whole[1:4, 2:6]).all()
    done(tmp_path, "over.exr", "--data-window")
    assert (pixels(tmp_path / "over.view.png")[..., 0] == whole).all()
    write(tmp_path / "crop.exr", {"Y": ramp}, dataWindow=box(3, 1, 8, 6), displayWindow=box(0, 0, 9, 9))
    done(tmp_path, "crop.exr")
    shown = pixels(tmp_path / "crop.view.png")
    assert shown.shape == (9, 9, 3) and (shown[1:7, 3:, 0] == whole[:, :6]).all()
    assert (shown[0] == BORDER).all() and (shown[:, :3] == BORDER).all() and (shown[7:] == BORDER).all()
    write(tmp_path / "far.exr", {"Y": ramp}, dataWindow=box(100, 1, 8, 6), displayWindow=box(0, 0, 9, 9))
    done(tmp_path, "far.exr")
    assert (pixels(tmp_path / "far.view.png") == BORDER).all()


def test_a_small_file_cannot_ask_for_gigabytes(tmp_path: Path) -> None:
    write(tmp_path / "huge.exr", {"Y": [1, 1]}, displayWindow=box(0, 0, 1 << 15, 1 << 15))
    refused(tmp_path, 2, "would be a picture of 32768x32768 pixels: too large, or mostly borders", "huge.exr")
    assert done(tmp_path, "huge.exr", "--data-window").startswith("huge.view.png: 2x1")


def test_views_of_a_config(tmp_path: Path) -> None:
    write(tmp_path / "a.exr", {"R": [0.18, 1], "G": [0.5, 0.25], "B": [0, 0.125]})
    done(tmp_path, "a.exr", "-o", "srgb.png")
    done(tmp_path, "a.exr", "--view", "Un-tone-mapped", "-o", "ocio.png")
    assert np.abs(pixels(tmp_path / "srgb.png").astype(int) - pixels(tmp_path / "ocio.png")).max() <= 1
    refused(tmp_path, 2, "--view filmik: there is no such view; the views are: filmic, ", "a.exr", "--view", "filmik")
    result = view(tmp_path, "a.exr", "--view", "x", env={**os.environ, "OCIO": "none.ocio"})
    assert result.returncode == 3 and result.stderr.count("\n") == 1 and "none.ocio" in result.stderr


def test_errors_are_one_line(tmp_path: Path) -> None:
    write(tmp_path / "a.exr", {"Y": [1, 1]})
    refused(tmp_path, 3, "b.exr: No such file or directory", "b.exr")
    refused(tmp_path, 2, "b.exr: one file at a time", "a.exr", "b.exr")
    refused(tmp_path, 2, "name it *.png", "a.exr", "-o", "b.jpg")
    refused(tmp_path, 2, "--columns: 0 must be a whole number from 1 to 1000", "a.exr", "--columns", "0")
    refused(tmp_path, 2, "--exposure: x must be a number from -64 to 64", "a.exr", "--exposure", "x")
    refused(tmp_path, 2, "--layer Z: has no place beside --all", "a.exr", "--all", "--layer", "Z")
    refused(tmp_path, 2, "--list writes no picture", "a.exr", "--list", "-o", "b.png")
    refused(tmp_path, 2, "--layr: no such option; did you mean --layer?", "a.exr", "--layr", "Z")
    refused(tmp_path, 3, "cannot be written", "a.exr", "-o", "a.exr/b.png")
    (tmp_path / "c.exr").write_text("no picture")
    refused(tmp_path, 3, "c.exr: cannot be read: ", "c.exr")
    Image.new("RGB", (2, 2)).save(tmp_path / "d.png")
    refused(tmp_path, 3, "d.png: cannot be read: ", "d.png")


def test_what_was_shown_before_stays_where_the_next_is_not(tmp_path: Path) -> None:
    write(tmp_path / "a.exr", {"Y": np.random.default_rng(1).random((50, 50), np.float32)})
    done(tmp_path, "a.exr", "-o", "v.png")
    before, data = (tmp_path / "v.png").read_bytes(), (tmp_path / "a.exr").read_bytes()
    (tmp_path / "a.exr").write_bytes(data[:-3000])
    refused(tmp_path, 3, "a.exr: cannot be read: ", "a.exr", "-o", "v.png")
    assert (tmp_path / "v.png").read_bytes() == before


def test_the_image_is_never_written_over(tmp_path: Path) -> None:
    write(tmp_path / "a.exr", {"Y": [1, 1]})
    (tmp_path / "link.png").symlink_to("a.exr")
    os.link(tmp_path / "a.exr", tmp_path / "a.view.png")
    refused(tmp_path, 2, "link.png: would be both the image and -o", "a.exr", "-o", "link.png")
    refused(tmp_path, 2, "a.view.png: would be both the image and -o", "a.exr")


def test_standard_output_that_is_full_is_an_error(tmp_path: Path) -> None:
    write(tmp_path / "a.exr", {"Y": [1, 1]})
    with open("/dev/full", "w", encoding="utf-8") as full:
        result = view(tmp_path, "a.exr", "--list", capture_output=False, stdout=full, stderr=subprocess.PIPE)
    assert (result.returncode, result.stderr) == (3, "cistula view: standard output: No space left on device\n")

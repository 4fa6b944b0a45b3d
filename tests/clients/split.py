"""split.py ONE PARTS FILES: OpenEXR's Python and OpenImageIO read a frame's layers in parts or files of their own as in one part. FILES is
the main file of several; the others lie beside it."""
import pathlib
import sys

import numpy as np
import OpenEXR
import OpenImageIO as oiio

import clients


def parts_by_openexr(path):
    return {part.name(): {name: channel.pixels for name, channel in part.channels.items()} for part in OpenEXR.File(str(path), separate_channels=True).parts}


def parts_by_oiio(path):
    """Name of each part, its color space, and its channels."""
    image = oiio.ImageInput.open(str(path))
    while image.seek_subimage(image.current_subimage(), 0):
        spec = image.spec()
        pixels = image.read_image(image.current_subimage(), 0, 0, spec.nchannels, oiio.FLOAT)
        yield spec.get_string_attribute("name"), spec.get_string_attribute("oiio:ColorSpace"), {n: pixels[..., i] for i, n in enumerate(spec.channelnames)}
        if not image.seek_subimage(image.current_subimage() + 1, 0):
            return


def same(channels, one):
    return all(np.array_equal(pixels, one[name]) for name, pixels in channels.items())


def main():
    one_path, parts_path, main_path = map(pathlib.Path, sys.argv[1:])
    _, one = clients.read(one_path)
    checks = clients.Checks("OpenEXR")
    parts = parts_by_openexr(parts_path)
    together = {name for channels in parts.values() for name in channels}
    checks.holds(together == set(one) and all(same(channels, one) for channels in parts.values()), f"{len(parts)} parts hold {len(one)} channels of one, bit by bit")
    checks.holds(all((n.rpartition(".")[0] or n) == name for name, channels in parts.items() if name != "Combined" for n in channels), "parts are named after their layers")

    oiio_checks = clients.Checks("OpenImageIO")
    for name, space, channels in parts_by_oiio(parts_path):
        is_color = name == "Combined" or any(channel.endswith(".R") for channel in channels)
        oiio_checks.holds(space == ("lin_rec709_scene" if is_color else "data") and same(channels, one), f"part {name}: {len(channels)} channels, {space}")

    stem = main_path.name.removesuffix(".exr")
    own = {path.name.removeprefix(stem + ".").removesuffix(".exr"): path for path in main_path.parent.glob(f"{stem}.*.exr")}
    dotted = {name.rpartition(".")[0] for name in one if "." in name}
    layers = {name.rstrip("0123456789") if name.startswith("Crypto") else name for name in dotted}
    checks.holds(set(own) == layers, f"{len(own)} layers have files of their own")
    for name in ("diffuse", "reflection"):
        _, colors = clients.read(own[name])
        checks.holds(set(colors) == set("RGB") and np.array_equal(clients.layer(colors, ""), clients.layer(one, name)), f"file {own[name].name}: R G B are the layer's")
    oiio_checks.failed += checks.failed
    oiio_checks.finish()


main()

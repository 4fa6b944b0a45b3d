"""openexr_layers.py FILE...: OpenEXR's Python reads every layer of frames with --layers path,light,data,cryptomatte."""
import json
import pathlib
import sys

import numpy as np

import clients

PATH = ["emission", "background", "ambient", "diffuse", "specular", "reflection", "transmission"]
CRYPTO = ["CryptoObject", "CryptoMaterial", "CryptoLight"]
COLORS = {"R", "G", "B", "A", "coverage"} | {f"{name}.{c}" for name in PATH + ["error", "albedo"] for c in "RGB"} | {f"N.{c}" for c in "XYZ"}
ALWAYS_FLOAT = (
    {"id", "samples", "cost", "Z", "depth_ray", "material_id", "uv.U", "uv.V"}
    | {f"P.{c}" for c in "XYZ"}
    | {f"{kind}{i:02}.{c}" for kind in CRYPTO for i in range(3) for c in "rgba"}
)


def check_channels(checks, name, channels):
    lights = {channel for channel in channels if channel.startswith("Combined_")}
    names = set(channels) - lights
    checks.holds(names == COLORS | ALWAYS_FLOAT, f"{name}: {len(names)} layers, {len(lights)} of lights; differing: {sorted(names ^ (COLORS | ALWAYS_FLOAT))}")
    colors = channels["R"].dtype
    wrong = [n for n, pixels in channels.items() if pixels.dtype != (np.float32 if n in ALWAYS_FLOAT else colors)]
    checks.holds(not wrong, f"{name}: colors are {colors}, the rest float32; others: {wrong}")


def check_sums(checks, name, channels):
    whole = clients.layer(channels, "")
    lights = sorted({channel[:-2] for channel in channels if channel.startswith("Combined_")})
    for division, layers in (("path", PATH), ("light", lights)):
        parts = [clients.layer(channels, layer) for layer in layers]
        # Every value in the file is the nearest of its type: half a unit in the last place off at most.
        most = sum(np.spacing(np.abs(part)).astype(np.float64) / 2 for part in parts + [whole])
        checks.near(sum(part.astype(np.float64) for part in parts), whole, most, f"{name}: {len(parts)} layers by {division} add up to R G B")


def check_mattes(checks, name, header, channels):
    samples = channels["samples"]
    for kind in CRYPTO:
        place = f"cryptomatte/{clients.mmh3.hash(kind, signed=False):08x}"[: len("cryptomatte/") + 7]
        manifest = json.loads(header[place + "/manifest"])
        wrong = [n for n, bits in manifest.items() if int(bits, 16) != clients.cryptomatte_id(n)]
        checks.holds(header[place + "/name"] == kind and not wrong, f"{name}: {kind}: hashes of {len(manifest)} names; wrong: {wrong}")
        ids, coverages = clients.ranks(channels, kind)
        known = np.isin(ids, [int(bits, 16) for bits in manifest.values()])
        checks.holds(bool(np.all(known == (coverages > 0)) and np.all(ids[~known] == 0)), f"{name}: {kind}: where an id is, it is of the manifest")
        checks.holds(bool(np.all(np.diff(coverages) <= 0)), f"{name}: {kind}: ranks in order")
        if "cistula:targetError" in header:
            continue  # samples have weights
        counts = coverages * samples[..., None]
        checks.near(counts, np.round(counts), 1e-5, f"{name}: {kind}: coverages are numbers of samples")
    covered = {kind: clients.ranks(channels, kind)[1] for kind in CRYPTO}
    kept = np.maximum(covered["CryptoObject"][..., -1], covered["CryptoLight"][..., -1]) == 0  # no seventh object
    whole = sum(covered[kind].sum(axis=-1, dtype=np.float64) for kind in ("CryptoObject", "CryptoLight"))
    rounding = 6 * 2**-25  # of ranks
    half_unit = float(np.spacing(channels["coverage"].max())) / 2
    checks.holds(bool(whole.max() <= 1 + rounding), f"{name}: mattes of objects and lights cover {whole.max():.9g} of a pixel at most")
    checks.near(whole[kept], channels["coverage"][kept], half_unit + rounding, f"{name}: in {kept.mean():.1%} of the pixels they add up to coverage")
    checks.near(covered["CryptoMaterial"].sum(axis=-1), covered["CryptoObject"].sum(axis=-1), np.where(kept, 2 * rounding, 1), f"{name}: materials cover what objects do")


def check_positions(checks, name, header, channels):
    seen = channels["id"] > 0
    height, width = seen.shape
    points = np.concatenate([clients.layer(channels, "P", "XYZ"), np.ones((height, width, 1))], axis=-1)
    ndc = points @ np.asarray(header["worldToNDC"], np.float64)
    # An even grid has no sample in the very middle; the one after it counts.
    side = header["cistula:supersample"]
    middle = 0.5 if side % 2 else 0.5 + 0.5 / side
    (left, top), (right, bottom) = header["displayWindow"]
    (first_column, first_row), _ = header["dataWindow"]
    columns, rows = np.meshgrid(np.arange(width) + first_column - left, np.arange(height) + first_row - top)
    checks.near((ndc[..., 0] / ndc[..., 3] * (right - left + 1) - columns)[seen], middle, 1e-3, f"{name}: worldToNDC takes P to its pixel's column")
    checks.near((ndc[..., 1] / ndc[..., 3] * (bottom - top + 1) - rows)[seen], middle, 1e-3, f"{name}: and to its row")
    depth = (points @ np.asarray(header["worldToCamera"], np.float64))[..., 2]
    checks.near(depth[seen] / channels["Z"][seen], 1, 1e-5, f"{name}: worldToCamera takes P to Z")


checks = clients.Checks("OpenEXR")
for path in map(pathlib.Path, sys.argv[1:]):
    header, channels = clients.read(path)
    check_channels(checks, path.name, channels)
    check_sums(checks, path.name, channels)
    check_mattes(checks, path.name, header, channels)
    check_positions(checks, path.name, header, channels)
checks.finish()

"""What the scripts of this folder share: layers of an EXR as arrays, Cryptomatte's ids, and a list of what holds."""
import sys

import mmh3
import numpy as np
import OpenEXR


class Checks:
    """Prints what holds and what does not; finish() ends the program with 1 where anything does not."""

    def __init__(self, client):
        self.client = client
        self.failed = 0

    def holds(self, is_so, what):
        print(f"{self.client}: {'holds' if is_so else 'FAILS'}: {what}")
        self.failed += not is_so

    def near(self, found, wanted, most, what):
        """Largest difference of two arrays; `most` is a number, or an array of them."""
        off = np.abs(np.asarray(found, np.float64) - np.asarray(wanted, np.float64))
        self.holds(bool(np.all(off <= most)), f"{what}: off by {off.max():.3g} at most, {np.max(most):.3g} allowed")

    def finish(self):
        sys.exit(1 if self.failed else 0)


def read(path):
    """Header, and channels by their full names, of an EXR of one part."""
    part = OpenEXR.File(str(path), separate_channels=True).parts[0]
    return part.header, {name: channel.pixels for name, channel in part.channels.items()}


def layer(channels, name, letters="RGB"):
    """Channels of a layer, beside each other; the colors of the whole for ""."""
    return np.stack([channels[f"{name}.{c}" if name else c] for c in letters], axis=-1)


def cryptomatte_id(name):
    """Bits of a name's id by Cryptomatte 1.2.0: its hash, but for exponents of numbers that are not normal."""
    bits = mmh3.hash(name, signed=False)
    return bits ^ (1 << 23) if (bits >> 23) & 255 in (0, 255) else bits


def ranks(channels, kind):
    """Ids, as bits, and coverages of a kind of matte, each (height, width, ranks)."""
    layers = [f"{kind}{i:02}" for i in range(3)]
    ids = np.concatenate([layer(channels, name, "rb") for name in layers], axis=-1)
    return ids.view(np.uint32), np.concatenate([layer(channels, name, "ga") for name in layers], axis=-1)


def matte(channels, kind, name):
    """How much of each pixel an object covers, by the ranks of the file."""
    ids, coverages = ranks(channels, kind)
    return np.where(ids == cryptomatte_id(name), coverages, 0).sum(axis=-1, dtype=np.float64)

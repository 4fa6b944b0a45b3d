"""film.py FOLDER: ffmpeg makes a film of FOLDER/film.0000.exr and those after it, which looks as the previews beside them, film.0000.png.

The film is FOLDER/film.mp4; FOLDER/film.lossless.mp4 has all colors.
"""
import pathlib
import subprocess
import sys

import numpy as np

import clients

folder = pathlib.Path(sys.argv[1])
_, channels = clients.read(folder / "film.0000.exr")
height, width = channels["R"].shape
count = len(list(folder.glob("film.*.exr")))
LINEAR = "zscale=tin=linear:pin=709:min=gbr:t=iec61966-2-1:p=709"


def ffmpeg(*arguments):
    return subprocess.run(["ffmpeg", "-v", "error", "-y", *arguments], check=True, stdout=subprocess.PIPE).stdout


def codes(*source, filters="null"):
    raw = ffmpeg(*source, "-vf", filters, "-f", "rawvideo", "-pix_fmt", "rgb24", "-")
    return np.frombuffer(raw, np.uint8).reshape(-1, height, width, 3).astype(np.float64)


def means(frames):
    return frames.mean(axis=(1, 2))


checks = clients.Checks("ffmpeg")
frames = ["-framerate", "25", "-i", str(folder / "film.%04d.exr")]
previews = codes("-i", str(folder / "film.%04d.png"))
checks.holds(len(previews) == count == 10, f"{count} frames, {len(previews)} previews")

# Rounding goes either way at most, and evens out over a frame.
direct = codes(*frames, filters=f"{LINEAR}:m=gbr,format=gbrp")
checks.near(direct, previews, 1, "codes of the frames and of their previews")
checks.near(means(direct), means(previews), 0.05, "means of the frames, in codes")

by_decoder = codes("-apply_trc", "iec61966_2_1", *frames)
checks.near(by_decoder, previews, 1, "codes of the frames by the decoder's own curve")
checks.near(means(by_decoder), means(previews), 0.5, "and their means, in codes")

# Without losses H.264 keeps these means. The usual film takes the colors of four pixels together, and colors that are no longer within
# 0 and 255 are cut off: strong ones at edges become a little brighter.
for name, pixel_format, quality, most in (("film.lossless.mp4", "yuv444p", "0", 0.05), ("film.mp4", "yuv420p", "16", 1.5)):
    film = str(folder / name)
    ffmpeg(*frames, "-vf", f"{LINEAR}:m=709:r=limited,format={pixel_format}", "-c:v", "libx264", "-crf", quality, "-movflags", "+faststart", film)
    decoded = codes("-i", film, filters="zscale=min=709:m=gbr:rin=limited:r=full,format=gbrp")
    checks.holds(len(decoded) == count, f"{name} has {len(decoded)} frames")
    checks.near(means(decoded), means(previews), most, f"{name}: means of the frames, in codes")
linear = means(codes(*frames))
checks.holds(np.abs(linear - means(previews)).min() > 5, f"linear light taken for codes is off by {np.abs(linear - means(previews)).min():.3g} at least")
checks.finish()

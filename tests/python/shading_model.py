"""A tracer written from docs/shading-model.md alone, which shows that the page says all: many rays at once, in NumPy, without trees.
Its scenes have Platonic solids, closed convex triangle lists and quads, no two faces of which lie in one plane."""
# mypy: ignore-errors
# It is read beside the page, whose formulas have no types.
import json
import math
from itertools import product
from pathlib import Path

import numpy as np

PHI = (1 + math.sqrt(5)) / 2
AHEAD, INSIDE, BEHIND = 0, 1, 2  # what a body is to a line
MATERIAL = {"color": 0.8, "ambient": 1, "diffuse": 1, "specular": 0, "specular_color": 1, "exponent": 50, "reflection": 0,
            "transmission": 0, "tint": 1, "index": 1, "absorption": 0, "fresnel": False, "texture": None}


def dot(a, b):
    return np.sum(a * b, axis=-1)


def unit(a):
    return a / np.linalg.norm(a, axis=-1, keepdims=True)


def color(value):
    return np.broadcast_to(np.array(value, float), 3)


def cyclic(*point):
    signed = {tuple(s * c for s, c in zip(signs, point)) for signs in product((1, -1), repeat=3)}
    return np.array([np.roll(p, turn) for p in sorted(signed) for turn in range(3)], float)


CUBE, AXES = np.array(list(product((1, -1), repeat=3)), float), cyclic(0, 0, 1)
TETRAHEDRON = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], float)
SOLIDS = {  # corners, outward normals
    "tetrahedron": (TETRAHEDRON, -TETRAHEDRON), "cube": (CUBE, AXES), "octahedron": (AXES, CUBE),
    "dodecahedron": (np.concatenate([CUBE, cyclic(0, 1 / PHI, PHI)]), cyclic(0, PHI, 1)),
    "icosahedron": (cyclic(0, 1, PHI), np.concatenate([CUBE, cyclic(0, PHI, 1 / PHI)]))}


class Body:
    def __init__(self, o, material, lights):
        self.__dict__ |= MATERIAL | material
        for key in ("color", "specular_color", "tint", "absorption"):
            setattr(self, key, color(getattr(self, key)))
        self.both = min(self.reflection + self.transmission, 1)
        self.kr, self.kt = (share / max(self.reflection + self.transmission, 1) for share in (self.reflection, self.transmission))
        self.opaque = not np.any((self.both if self.fresnel else self.kt) * self.tint)
        self.clear = self.kr == 0 and self.kt == 1 and bool(np.all(self.tint == 1))
        self.absorption = self.absorption * (not self.opaque)
        self.closed = "quad" not in o
        self.whole = self.closed and self.fresnel and self.both > 1 - 1e-12 and bool(np.all(self.tint == 1))
        if "quad" in o:
            self.corners = np.array(o["quad"], float)
            self.normal = unit(np.cross(self.corners[1] - self.corners[0], self.corners[2] - self.corners[0]))
        elif "triangles" in o:
            v, i = np.array(o["triangles"]["vertices"], float), np.array(o["triangles"]["indices"])
            self.normals = unit(np.cross(v[i[:, 1]] - v[i[:, 0]], v[i[:, 2]] - v[i[:, 0]]))
            self.h = dot(self.normals, v[i[:, 0]])
        else:
            corners, normals = (unit(points) for points in SOLIDS[o["solid"]])
            center, radius, turn = np.array(o.get("center", [0, 0, 0]), float), o.get("radius", 1), np.eye(3)
            for axis, angle in enumerate(np.radians(o.get("rotate", [0, 0, 0]))):
                j, k, step = (axis + 1) % 3, (axis + 2) % 3, np.eye(3)
                step[[j, j, k, k], [j, k, j, k]] = math.cos(angle), -math.sin(angle), math.sin(angle), math.cos(angle)
                turn = step @ turn
            self.normals = normals @ turn.T
            self.h = self.normals @ center + radius * np.max(corners @ normals[0])
            if "edge_lights" in o:
                edges, corners = o["edge_lights"], center + radius * corners @ turn.T
                far = np.linalg.norm(corners[:, None] - corners, axis=-1) + 9 * radius * np.eye(len(corners))
                lights += [{**edges, "position": corners[i] + n / (edges["count"] + 1) * (corners[j] - corners[i])}
                           for i, j in np.argwhere(far < 1.001 * far.min()) if i < j for n in range(1, edges["count"] + 1)]

    def interval(self, o, d):
        """The t at which lines enter and leave the planes, and the normals there."""
        with np.errstate(all="ignore"):
            nd, over = d @ self.normals.T, self.h - o @ self.normals.T
            enter = np.where(nd < 0, over / nd, np.where((nd == 0) & (over <= 0), np.inf, -np.inf))
            leave = np.where(nd > 0, over / nd, np.inf)
        return enter.max(axis=1), leave.min(axis=1), self.normals[enter.argmax(axis=1)], self.normals[leave.argmin(axis=1)]

    def meet(self, o, d, state, after):
        """The t of the next crossing, infinite where there is none, and the normal toward the ray's start."""
        if self.closed:
            enter, leave, first, last = self.interval(o, d)
            enters = (state == AHEAD) & (enter <= leave) & (leave > 0)
            t = np.where(state == INSIDE, np.maximum(leave, 0), np.where(enters, np.maximum(enter, 0), np.inf))
            return t, np.where(enters[:, None], first, -last)
        with np.errstate(all="ignore"):
            t = (self.normal @ self.corners[0] - o @ self.normal) / (d @ self.normal)
        p = o + np.where(np.isfinite(t), t, 0)[:, None] * d
        within = [np.cross(b - a, p - a) @ self.normal >= 0 for a, b in zip(self.corners, np.roll(self.corners, -1, axis=0))]
        hits = np.all(within, axis=0) & (t > after) & (t > 0) & (state != BEHIND)
        return np.where(hits, t, np.inf), np.where((d @ self.normal > 0)[:, None], -self.normal, self.normal)

    def uv(self, p):
        c, corner = self.corners, np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
        second = (np.cross(c[2] - c[0], p - c[0]) @ self.normal > 0)[:, None]  # of the triangles 0 1 2 and 0 2 3
        e1, e2 = np.where(second, c[2], c[1]) - c[0], np.where(second, c[3], c[2]) - c[0]
        area = np.cross(e1, e2)
        s, t = (dot(x, area)[:, None] / dot(area, area)[:, None] for x in (np.cross(p - c[0], e2), np.cross(e1, p - c[0])))
        return s * np.where(second, corner[2], corner[1]) + t * np.where(second, corner[3], corner[2])

    def filtered(self, o, d, state, distance, light):
        """The share of a light's light that passes the body on its way to o."""
        if not self.closed:
            faces, length = (self.meet(o, d, state, 0)[0] < distance) * 1, np.zeros(len(o))
        else:
            enter, leave, _, _ = self.interval(o, d)
            inside = state == INSIDE
            crosses = inside | (state == AHEAD) & (enter <= leave) & (leave > 0) & (enter < distance)
            enter, leave = np.where(inside, 0, np.maximum(enter, 0)), np.maximum(leave, 0)
            depth = self.h - self.normals @ light
            if np.abs(depth.min()) < 1e-9:  # it lies on these faces
                on = depth < 1e-9
                behind = np.all(o @ self.normals[on].T <= self.h[on], axis=1)
                crosses, enter, leave = behind & (state != BEHIND), np.minimum(enter, distance), distance
            faces = crosses * ((leave < distance) * 1 + ~inside)
            length = crosses * np.maximum(np.minimum(leave, distance) - enter, 0)
        return (self.kt * self.tint) ** faces[:, None] * np.exp(-self.absorption * length[:, None])

    def span(self, o, d, state):
        """The t at which lines are inside, from and to."""
        if not self.closed:
            return np.full(len(o), np.inf), np.full(len(o), np.inf)
        enter, leave, _, _ = self.interval(o, d)
        crosses = (state == INSIDE) | (state == AHEAD) & (enter <= leave) & (leave > 0)
        enter = np.where(state == INSIDE, -np.inf, np.maximum(enter, 0))
        return np.where(crosses, enter, np.inf), np.where(crosses, np.maximum(leave, 0), np.inf)

    def split(self, d, n, n1, n2):
        """Shares of the mirrored and the transmitted ray, whether that bends, and where to."""
        kr, kt = np.full(len(d), self.kr), np.full(len(d), self.kt)
        if not self.closed:
            return kr, kt[:, None] * self.tint, np.zeros(len(d), bool), d
        if self.fresnel and self.opaque:
            n2 = np.full(len(d), float(self.index))
        ratio, c, bends = n2 / n1, np.maximum(-dot(d, n), 0), (n1 != n2) & (self.kt > 0 or self.fresnel)
        excess = (ratio - 1) * (ratio + 1)
        total, h = bends & (excess + c * c <= 0), np.sqrt(np.maximum(excess + c * c, 0)) + c
        with np.errstate(all="ignore"):
            through = unit((d - (excess / h)[:, None] * n) / ratio[:, None])
            a, b = excess / h ** 2, (c * h - 1) / (c * excess / h + 1)
        if self.fresnel:
            kr = self.both * np.where(n1 == n2, 0, np.clip(a * a * (1 + b * b) / 2, 0, 1))
            kt = self.both - kr
        return np.where(total, self.both, kr), np.where(total, 0, kt)[:, None] * self.tint, bends, through


class Scene:
    def __init__(self, path):
        self.file = json.loads(Path(path).read_text())
        self.textures = {name: self.texture(t, Path(path).parent) for name, t in self.file.get("textures", {}).items()}
        lights = list(self.file.get("lights", []))
        self.bodies = [Body(o, self.file["materials"][o["material"]], lights) for o in self.file["objects"]]
        self.lights = []  # position, intensity, glow, radius of what is seen, least distance of the falloff
        for light in lights:
            radius, intensity = light.get("radius", 0), color(light.get("color", 1))
            falls = light.get("falloff", "none") != "none"
            self.lights.append((np.array(light["position"], float), intensity, color(light.get("glow", intensity)),
                                radius * light.get("visible", True), radius * falls))

    def texture(self, t, folder):
        if "checker" in t:
            a, b = (color(c) for c in t["checker"])
            texels = np.array([[a, b], [b, a]])
        else:
            data = (folder / t["file"]).read_bytes()
            width, height = np.frombuffer(data, "<i4", 2)
            c = np.frombuffer(data, np.uint8, offset=8).reshape(height, width, 4)[..., :3] / 255
            texels = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
        return texels.astype(np.float32).astype(float), t.get("repeat", [1, 1]), "checker" in t or t.get("filter") == "nearest"

    def texel(self, name, uv):
        texels, repeat, nearest = self.textures[name]
        size = np.array(texels.shape[1::-1])
        x = uv * repeat * size - (0 if nearest else 0.5)
        first = np.floor(x)
        def at(*step):
            column, row = ((first + step).astype(int) % size).T
            return texels[row, column]
        (u, v) = (x - first).T[..., None]
        return at(0, 0) if nearest else (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v

    def camera(self, frame):
        c = self.file.get("camera", {})
        t = frame * c.get("time_step", 1)
        def place(name, default):
            if name not in c.get("path", {}):
                return np.array(c.get(name, default), float)
            p = dict.fromkeys(("r0", "z0", "phi0", "Ar", "Az", "wr", "wz", "wphi", "pr", "pz"), 0) | c["path"][name]
            r, phi = p["r0"] + p["Ar"] * math.sin(p["wr"] * t + p["pr"]), p["phi0"] + p["wphi"] * t
            return np.array([r * math.cos(phi), r * math.sin(phi), p["z0"] + p["Az"] * math.sin(p["wz"] * t + p["pz"])])
        position, target = place("position", [0, -5, 2]), place("target", [0, 0, 0])
        forward = unit(target - position)
        right = unit(np.cross(forward, np.array(c.get("up", [0, 0, 1]), float)))
        return position, forward, right, np.cross(right, forward), math.tan(math.radians(c.get("fov", 60) / 2))

    def local(self, b, base, p, n, view, state):
        light_of = base * b.ambient * color(self.file.get("ambient", 0.1))
        for position, intensity, _, _, least in self.lights:
            to = position - p
            lit = np.flatnonzero(dot(n, to) > 1e-9)  # not where it lies in the plane
            if not len(lit) or not intensity.any():
                continue
            r, to = np.linalg.norm(to[lit], axis=1), unit(to[lit])
            cosine = dot(n[lit], to)
            shine = np.maximum(2 * cosine * dot(n[lit], view[lit]) - dot(to, view[lit]), 0) ** b.exponent
            adds = base[lit] * b.diffuse * cosine[:, None] + b.specular * b.specular_color * shine[:, None]
            adds *= intensity / (np.maximum(r, least)[:, None] ** 2 if least else 1)
            for s, other in enumerate(self.bodies):
                adds *= other.filtered(p[lit], to, state[lit, s], r, position)
            light_of[lit] += adds * self.unseen(p[lit], to, state[lit], r)[:, None]
        return light_of

    def unseen(self, o, d, state, distance):
        """1 / kt of the faces of whole bodies between equal indices, which do not count."""
        gain, index = np.ones(len(o)), np.array([b.index for b in self.bodies] + [1.0])
        whole = [s for s, b in enumerate(self.bodies) if b.whole and 0 < b.kt < 1]
        spans = [b.span(o, d, state[:, s]) for s, b in enumerate(self.bodies)] if whole else []
        for s in whole:
            for t in spans[s]:
                there = np.stack([np.where((enter < t) & (t < leave), INSIDE, AHEAD) for enter, leave in spans], axis=1)
                there[:, s] = AHEAD
                before = index[self.medium(there)]
                there[:, s] = INSIDE
                same = (t >= 0) & (t < distance) & (before == index[self.medium(there)])
                gain[same] /= self.bodies[s].kt
        return gain

    def medium(self, state):
        media = np.array([s for s, b in enumerate(self.bodies) if b.closed and not b.opaque], int)
        return np.max(np.where(state[:, media] == INSIDE, media, -1), axis=1, initial=-1)

    def step(self, rays, depth, add):
        """Follows rays to their next faces and lights, and returns those that go on from there."""
        pixel, o, d, after, w, level, state = rays
        t, hit, normal = np.full(len(o), np.inf), np.full(len(o), -1), np.zeros_like(o)
        for s, b in enumerate(self.bodies):
            ts, ns = b.meet(o, d, state[:, s], after)
            t, hit, normal = np.where(ts < t, ts, t), np.where(ts < t, s, hit), np.where((ts < t)[:, None], ns, normal)
        seen, ends = np.tile(color(self.file.get("background", 0)), (len(o), 1)), hit < 0
        for position, _, glow, radius, _ in self.lights:
            if radius > 0:
                to = position - o
                b, c = dot(to, d), dot(to, to) - radius ** 2
                rest = radius ** 2 - np.sum((to - b[:, None] * d) ** 2, axis=1)
                ts = np.where((rest > 0) & (c > 0) & (b > 0), c / (b + np.sqrt(np.maximum(rest, 0))), np.inf)
                first = (ts <= t) & (ts >= after) & np.isfinite(ts)
                t, seen, ends = np.where(first, ts, t), np.where(first[:, None], glow, seen), ends | first
        sigma = sum((state[:, s] == INSIDE)[:, None] * b.absorption for s, b in enumerate(self.bodies))
        w = w * np.exp(-sigma * np.where(np.isfinite(t), t - after, 0)[:, None])
        add(pixel[ends], (w * seen)[ends])
        index, children = np.array([b.index for b in self.bodies] + [1.0]), []
        for s, b in enumerate(self.bodies):
            i = np.flatnonzero(~ends & (hit == s))
            beyond = state[i] + (np.arange(len(self.bodies)) == s) * b.closed
            around = self.medium(state[i])
            n1, n2 = index[around], index[self.medium(beyond)]
            passes = b.closed and not b.opaque and around > s
            passes = passes | ((b.clear or b.whole) & (n1 == n2))
            children.append((pixel[i], o[i], d[i], t[i], w[i], level[i], beyond, passes))
            i, beyond, n1, n2 = (a[~passes] for a in (i, beyond, n1, n2))
            p, n, here, wi = o[i] + t[i, None] * d[i], normal[i], d[i], w[i]
            near, far = (np.where(a == BEHIND, AHEAD, a) for a in (state[i], beyond))  # for new lines
            near[:, s], far[:, s] = np.where(state[i, s] == INSIDE, INSIDE, BEHIND), beyond[:, s]
            base = np.tile(b.color, (len(i), 1)) * (self.texel(b.texture, b.uv(p)) if b.texture else 1)
            if 1 - b.both > 1e-12:
                add(pixel[i], wi * (1 - b.both) * self.local(b, base, p, n, -here, near))
            kr, kt, bends, through = b.split(here, n, n1, n2)
            deeper, bent = level[i] + 1, bends[:, None]
            mirrored = unit(here - 2 * dot(here, n)[:, None] * n)
            children.append((pixel[i], p, mirrored, 0 * t[i], wi * kr[:, None], deeper, near, deeper < depth))
            children.append((pixel[i], np.where(bent, p, o[i]), np.where(bent, through, here), np.where(bends, 0, t[i]),
                             wi * kt, deeper, np.where(bent, far, beyond), deeper < depth))
        return [tuple(a[go & (c[4].max(axis=1, initial=0) > 1e-12)] for a in c) for *c, go in children]


def render(path, width, height, samples, depth, frame=0, chunk=100_000):
    """The colors of a frame, (height, width, 3)."""
    scene = Scene(path)
    position, forward, right, up, tangent = scene.camera(frame)
    row, column = np.divmod(np.arange(height * samples * width * samples), width * samples)
    across, down = ((2 * a + 1 - size * samples) / (width * samples) for a, size in ((column, width), (row, height)))
    d = unit(forward + tangent * (across[:, None] * right - down[:, None] * up))
    sums, n = np.zeros((height * width, 3)), len(d)
    around = [INSIDE if b.closed and np.all(b.normals @ position < b.h) else AHEAD for b in scene.bodies]
    rays = (row // samples * width + column // samples, np.tile(position, (n, 1)), d, np.zeros(n), np.ones((n, 3)),
            np.zeros(n, int), np.tile(around, (n, 1)))
    while len(rays[0]):
        parts = [child for start in range(0, len(rays[0]), chunk) for child in
                 scene.step([a[start:start + chunk] for a in rays], depth, lambda i, color: np.add.at(sums, i, color))]
        rays = [np.concatenate(a) for a in zip(*parts)]
    return sums.reshape(height, width, 3) / samples ** 2

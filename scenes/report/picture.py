#!/usr/bin/env python3
"""A picture of OBJ and binary PLY meshes, headless and with the standard library only.

picture.py -o OUT.png [--size 900x1200] [--azimuth DEG] [--elevation DEG] [--distance M] [--no-floor]
           [--field NAME [--range LOW HIGH]] MESH.obj|MESH.ply[=RRGGBB] ...

The camera looks at the centre of everything; azimuth 0 looks at the side that faces +z, positive goes to the subject's left.
--field colours meshes by a property of their vertices (frames with output.fields) from LOW to HIGH, without --range from the
smallest value to what 99 % do not exceed, and prints that range; a bar at the right shows the colours, LOW below.
"""
import argparse, array, math, struct, sys, zlib

RAMP = ["2c3e8f", "3f88c5", "8fd0c3", "f4e285", "f08a4b", "b3202c"]  # from low to high
PALETTE = ["c9b8a8", "b5403a", "3f6f9f", "7f9a5a"]
BACKGROUND = ((0.965, 0.968, 0.972), (0.86, 0.875, 0.895))  # top, bottom; linear light is not claimed


def subtract(a, b): return (a[0] - b[0], a[1] - b[1], a[2] - b[2])
def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b): return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a)) or 1.0
    return (a[0] / length, a[1] / length, a[2] / length)


def read_obj(file):
    """Vertices, triangles; an OBJ has no fields."""
    vertices, triangles = [], []
    with open(file) as lines:
        for line in lines:
            words = line.split()
            if words and words[0] == "v":
                vertices.append(tuple(map(float, words[1:4])))
            elif words and words[0] == "f":
                face = [int(word.split("/")[0]) for word in words[1:]]
                face = [i - 1 if i > 0 else len(vertices) + i for i in face]
                triangles += [(face[0], face[k], face[k + 1]) for k in range(1, len(face) - 1)]
    return vertices, triangles, {}


PLY_TYPES = {"char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h", "ushort": "H", "uint16": "H",
             "int": "i", "int32": "i", "uint": "I", "uint32": "I", "float": "f", "float32": "f", "double": "d", "float64": "d"}


def read_ply(file):
    """Vertices, triangles, fields of vertices by name, of a binary little-endian PLY whose faces are triangles."""
    with open(file, "rb") as source:
        data = source.read()
    at = data.index(b"end_header\n") + len(b"end_header\n")
    elements = []  # name, count, properties
    for words in (line.split() for line in data[:at].decode().splitlines()):
        if words[0] == "format" and words[1] != "binary_little_endian":
            sys.exit(f"picture.py: {file}: only binary little-endian PLY is read")
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[0] == "property":
            elements[-1][2].append(words[1:])
    vertices, triangles, fields = [], [], {}
    for name, count, properties in elements:
        item = struct.Struct("<" + "".join(PLY_TYPES[p[1]] + 3 * PLY_TYPES[p[2]] if p[0] == "list" else PLY_TYPES[p[0]]
                                           for p in properties))
        rows = list(item.iter_unpack(data[at:at + count * item.size]))
        at += count * item.size
        if name == "vertex":
            column = {p[-1]: k for k, p in enumerate(properties)}
            vertices = [tuple(row[column[axis]] for axis in "xyz") for row in rows]
            fields = {key: [row[k] for row in rows] for key, k in column.items() if key not in ("x", "y", "z")}
        if name == "face":
            first = [p[0] for p in properties].index("list") + 1
            triangles = [row[first:first + 3] for row in rows]
    return vertices, triangles, fields


def ramp_colour(share):
    """Between the colours of the ramp, share 0 ... 1."""
    place = min(max(share, 0.0), 1.0) * (len(RAMP) - 1)
    k = min(int(place), len(RAMP) - 2)
    low, high = (tuple(int(c[i:i + 2], 16) / 255.0 for i in (0, 2, 4)) for c in RAMP[k:k + 2])
    return tuple(a + (b - a) * (place - k) for a, b in zip(low, high))


def vertex_normals(vertices, triangles):
    """Area-weighted: the cross products are summed as they are."""
    sums = [[0.0, 0.0, 0.0] for _ in vertices]
    for t in triangles:
        n = cross(subtract(vertices[t[1]], vertices[t[0]]), subtract(vertices[t[2]], vertices[t[0]]))
        for i in t:
            for axis in range(3):
                sums[i][axis] += n[axis]
    return [unit(n) for n in sums]


class View:
    """An orthonormal frame; perspective with a focal length in units of the image height, or parallel if it is None."""

    def __init__(self, target, towards, distance, width, height, scale, focal=None):
        self.back = unit(towards)
        self.right = unit(cross((0.0, 1.0, 0.0), self.back))
        self.up = cross(self.back, self.right)
        self.eye = tuple(target[k] + distance * self.back[k] for k in range(3))
        self.width, self.height, self.scale, self.focal = width, height, scale, focal

    def project(self, x):
        d = subtract(x, self.eye)
        depth = -dot(d, self.back)
        f = self.scale if self.focal is None else self.focal * self.height / depth
        return (0.5 * self.width + f * dot(d, self.right), 0.5 * self.height - f * dot(d, self.up), depth)


def rasterise(view, corners, triangles):
    """Nearest triangle (index + 1), depth and two barycentric weights of every pixel. Perspective is corrected by 1/depth."""
    width, size = view.width, view.width * view.height
    depth = array.array("d", [math.inf]) * size
    owner = array.array("i", [0]) * size
    w1s, w2s = array.array("f", [0.0]) * size, array.array("f", [0.0]) * size
    for number, t in enumerate(triangles):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners[t[0]], corners[t[1]], corners[t[2]]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0.0 or min(az, bz, cz) <= 0.0:
            continue
        ia, ib, ic = 1.0 / az, 1.0 / bz, 1.0 / cz
        for row in range(max(0, math.ceil(min(ay, by, cy) - 0.5)), min(view.height, math.ceil(max(ay, by, cy) - 0.5))):
            y = row + 0.5
            cuts = [px + (y - py) * (qx - px) / (qy - py)
                    for px, py, qx, qy in ((ax, ay, bx, by), (bx, by, cx, cy), (cx, cy, ax, ay)) if (py <= y) != (qy <= y)]
            if not cuts:
                continue
            first, end = max(0, math.ceil(min(cuts) - 0.5)), min(width, math.ceil(max(cuts) - 0.5))
            for column in range(first, end):
                x = column + 0.5
                u = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
                v = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
                inverse = (1.0 - u - v) * ia + u * ib + v * ic
                z = 1.0 / inverse
                at = row * width + column
                if z < depth[at]:
                    depth[at], owner[at] = z, number + 1
                    w1s[at], w2s[at] = u * ib * z, v * ic * z
    return depth, owner, w1s, w2s


class Shadow:
    """Depths seen from the light; `share` is the lit part of a soft kernel."""
    TAPS = [[(i + 0.2 * j + a, j - 0.2 * i + b) for i in (-1.5, 0.5) for j in (-1.5, 0.5)] for a in (0, 1) for b in (0, 1)]

    def __init__(self, centre, radius, light, vertices, triangles, size=700):
        self.view = View(centre, light, 4.0 * radius, size, size, size / (2.1 * radius))
        self.depth = rasterise(self.view, [self.view.project(x) for x in vertices], triangles)[0]
        self.slack, self.size, self.step = 0.012 * radius, size, 0.004 * size

    def share(self, x, sample, spread=1.0):
        """Four taps; the four samples of a pixel take different ones."""
        px, py, z = self.view.project(x)
        lit = 0
        for i, j in self.TAPS[sample]:
            column, row = int(px + i * spread * self.step), int(py + j * spread * self.step)
            inside = 0 <= column < self.size and 0 <= row < self.size
            lit += not inside or self.depth[row * self.size + column] > z - self.slack
        return lit / 4.0


def shade(colour, normal, light, towards_eye, lit):
    """Sky and ground light, a soft key light (half wrapped around), a weak fill from the eye, a faint rim."""
    key = max(0.0, (dot(normal, light) + 0.15) / 1.15) * lit
    facing = max(0.0, dot(normal, towards_eye))
    ambient = 0.34 + 0.12 * normal[1]
    gain = ambient + 0.62 * key + 0.10 * facing
    rim = 0.10 * (1.0 - facing) ** 3
    return tuple(min(1.0, c * gain + rim) for c in colour)


def write_png(file, width, height, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    raw = b"".join(b"\0" + row for row in rows)
    with open(file, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                  chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def load(arguments, field):
    """Everything as one mesh; of each vertex its value of the field, None where its mesh has no such field."""
    vertices, triangles, normals, colours, values = [], [], [], [], []
    known = set()
    for number, argument in enumerate(arguments):
        file, _, colour = argument.partition("=")
        colour = colour or PALETTE[number % len(PALETTE)]
        part, faces, fields = read_ply(file) if file.endswith(".ply") else read_obj(file)
        known.update(fields)
        normals += vertex_normals(part, faces)
        triangles += [tuple(i + len(vertices) for i in t) for t in faces]
        vertices += part
        colours += [tuple(int(colour[k:k + 2], 16) / 255.0 for k in (0, 2, 4))] * len(faces)
        values += fields.get(field, [None] * len(part))
    if field and all(value is None for value in values):
        sys.exit(f"picture.py: no mesh has a field {field}; they have: {', '.join(sorted(known)) or 'none'}")
    return vertices, triangles, normals, colours, values


def field_range(values):
    there = sorted(value for value in values if value is not None and math.isfinite(value))
    return there[0], max(there[(99 * len(there)) // 100], there[0] + 1e-12)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", nargs="+", metavar="MESH[=RRGGBB]")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--size", default="900x1200")
    parser.add_argument("--azimuth", type=float, default=28.0)
    parser.add_argument("--elevation", type=float, default=12.0)
    parser.add_argument("--distance", type=float, help="m from the centre; default: everything fits")
    parser.add_argument("--no-floor", action="store_true")
    parser.add_argument("--field", default="")
    parser.add_argument("--range", type=float, nargs=2, metavar=("LOW", "HIGH"))
    given = parser.parse_args()

    vertices, triangles, normals, colours, values = load(given.meshes, given.field)
    if given.field:
        least, most = given.range or field_range(values)
        print(f"{given.field}: {least:.4g} ... {most:.4g}")
    low, high = [min(c) for c in zip(*vertices)], [max(c) for c in zip(*vertices)]
    centre = tuple(0.5 * (a + b) for a, b in zip(low, high))
    radius = max(math.dist(x, centre) for x in vertices)
    azimuth, elevation = math.radians(given.azimuth), math.radians(given.elevation)
    towards = (math.sin(azimuth) * math.cos(elevation), math.sin(elevation), math.cos(azimuth) * math.cos(elevation))
    width, height = (2 * int(n) for n in given.size.split("x"))
    focal = 2.0
    view = View(centre, towards, 1.0, width, height, 1.0, focal)
    offsets = [subtract(x, centre) for x in vertices]
    fit = max(max(abs(dot(d, view.up)) * 2.16 * focal, abs(dot(d, view.right)) * 2.16 * focal * height / width) +
              dot(d, view.back) for d in offsets)
    view = View(centre, towards, given.distance or fit, width, height, 1.0, focal)
    light = unit(tuple(0.55 * b - 0.60 * r + 0.75 * u for b, r, u in zip(view.back, view.right, (0.0, 1.0, 0.0))))
    shadow = Shadow(centre, radius, light, vertices, triangles)
    _, owner, w1s, w2s = rasterise(view, [view.project(x) for x in vertices], triangles)

    def background(row, column, sample):
        t = row / height
        plain = tuple(a + (b - a) * t for a, b in zip(*BACKGROUND))
        ray = tuple((column + 0.5 - 0.5 * width) * r - (row + 0.5 - 0.5 * height) * u - focal * height * b
                    for r, u, b in zip(view.right, view.up, view.back))
        if given.no_floor or ray[1] >= 0.0:
            return plain
        s = (low[1] - view.eye[1]) / ray[1]
        x = tuple(e + s * d for e, d in zip(view.eye, ray))
        if math.dist(x, centre) > 2.2 * radius:
            return plain
        return tuple(c * (0.72 + 0.28 * shadow.share(x, sample, 2.2)) for c in plain)

    def surface(at, sample):
        t = triangles[owner[at] - 1]
        w = (1.0 - w1s[at] - w2s[at], w1s[at], w2s[at])
        x = tuple(sum(w[k] * vertices[t[k]][axis] for k in range(3)) for axis in range(3))
        normal = unit(tuple(sum(w[k] * normals[t[k]][axis] for k in range(3)) for axis in range(3)))
        eye = unit(subtract(view.eye, x))
        if dot(normal, eye) < 0.0:
            normal = tuple(-c for c in normal)
        lifted = tuple(c + 0.01 * radius * n for c, n in zip(x, normal))
        colour = colours[owner[at] - 1]
        if given.field and values[t[0]] is not None:
            colour = ramp_colour((sum(w[k] * values[t[k]] for k in range(3)) - least) / (most - least))
        return shade(colour, normal, light, eye, shadow.share(lifted, sample))

    def pixel(row, column):
        if given.field and 0.94 * width <= column < 0.96 * width and 0.3 * height <= row < 0.7 * height:
            return bytes(int(255.0 * c + 0.5) for c in ramp_colour((0.7 * height - row) / (0.4 * height)))
        parts = []
        for sample in range(4):
            r, c = row + sample // 2, column + sample % 2
            at = r * width + c
            parts.append(surface(at, sample) if owner[at] else background(r, c, sample))
        return bytes(int(255.0 * sum(p[k] for p in parts) / 4.0 + 0.5) for k in range(3))

    rows = (b"".join(pixel(row, column) for column in range(0, width, 2)) for row in range(0, height, 2))
    write_png(given.output, width // 2, height // 2, rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes the meshes, pictures and maps of the scenes, and the long scene forest.xml.

    python3 scenes/data/make.py [NAME...]

A NAME is that of one of the functions at the end; without any, all is made, in two minutes.
Needs nothing but Python's standard library. Everything here is computed; each function says what
from. The files are kept beside the script, so that nobody needs to run it to draw the scenes."""

import math
import os
import struct
import sys
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))


def path(name):
    return os.path.join(HERE, name)


# ---------------------------------------------------------------- vectors

def add(a, b): return tuple(x + y for x, y in zip(a, b))
def sub(a, b): return tuple(x - y for x, y in zip(a, b))
def mul(a, k): return tuple(x * k for x in a)
def dot(a, b): return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return mul(a, 1 / math.sqrt(dot(a, a)))


# ---------------------------------------------------------------- files

def number(x):
    text = '%.4f' % x
    text = text.rstrip('0').rstrip('.')
    return '0' if text == '-0' else text


def write_obj(name, comment, points, normals, faces):
    """Faces are lists of indices from 0; with normals, one for each point."""
    with open(path(name), 'w', newline='\n') as out:
        out.write('# %s\n' % comment)
        for p in points:
            out.write('v %s %s %s\n' % tuple(map(number, p)))
        for n in normals or []:
            out.write('vn %s %s %s\n' % tuple(map(number, n)))
        for face in faces:
            corner = '%d//%d' if normals else '%d'
            corners = [corner % ((i + 1, i + 1) if normals else (i + 1)) for i in face]
            out.write('f %s\n' % ' '.join(corners))


def write_ply(name, comment, points, normals, faces):
    """Binary; faces are quads."""
    header = ['ply', 'format binary_little_endian 1.0', 'comment ' + comment,
              'element vertex %d' % len(points)]
    header += ['property float ' + x for x in ('x', 'y', 'z', 'nx', 'ny', 'nz')]
    header += ['element face %d' % len(faces), 'property list uchar ushort vertex_indices',
               'end_header']
    with open(path(name), 'wb') as out:
        out.write(('\n'.join(header) + '\n').encode())
        for p, n in zip(points, normals):
            out.write(struct.pack('<6f', *p, *n))
        for face in faces:
            out.write(struct.pack('<B4H', 4, *face))


def write_png(name, width, height, palette, pixels):
    """Pixels are indices into the palette, rows from the top down."""
    def chunk(kind, data):
        return (struct.pack('>I', len(data)) + kind + data +
                struct.pack('>I', zlib.crc32(kind + data)))
    rows = b''.join(b'\0' + bytes(pixels[y * width:(y + 1) * width]) for y in range(height))
    with open(path(name), 'wb') as out:
        out.write(b'\x89PNG\r\n\x1a\n')
        out.write(chunk(b'IHDR', struct.pack('>2I5B', width, height, 8, 3, 0, 0, 0)))
        out.write(chunk(b'PLTE', b''.join(bytes(c) for c in palette)))
        out.write(chunk(b'IDAT', zlib.compress(rows, 9)))
        out.write(chunk(b'IEND', b''))


# ---------------------------------------------------------------- noise

def lattice(x, y, z, seed):
    """A number from 0 to 1 for each whole point, by mixing bits."""
    h = (x * 0x8da6b343 ^ y * 0xd8163841 ^ z * 0xcb1ab31f ^ seed * 0x9e3779b1) & 0xffffffff
    for factor in (0x85ebca6b, 0xc2b2ae35):
        h = (h ^ h >> 15) * factor & 0xffffffff
    return (h ^ h >> 16) / 0xffffffff


def noise(x, y, z, seed=0):
    """Lattice values, blended smoothly."""
    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    u, v, w = ((t * t * (3 - 2 * t)) for t in (x - i, y - j, z - k))
    total = 0
    for corner in range(8):
        a, b, c = corner & 1, corner >> 1 & 1, corner >> 2
        weight = (u if a else 1 - u) * (v if b else 1 - v) * (w if c else 1 - w)
        total += weight * lattice(i + a, j + b, k + c, seed)
    return total


def clouds(x, y, z, octaves, seed=0):
    """Noise of several sizes; 0 to 1."""
    total = scale = 0
    for octave in range(octaves):
        f = 2.03 ** octave
        total += noise(x * f, y * f, z * f, seed + octave) / 2 ** octave
        scale += 1 / 2 ** octave
    return total / scale


class Numbers:
    """Random numbers that are the same everywhere."""

    def __init__(self, seed):
        self.count, self.seed = 0, seed

    def __call__(self, low=0.0, high=1.0):
        self.count += 1
        return low + (high - low) * lattice(self.count, 1, 2, self.seed)


# ---------------------------------------------------------------- Cornell box

def cornell():
    """The corners that Cornell University measured, in millimetres, y up. Faces are wound so that
    their normals point into the room, those of the blocks outward."""
    def boxed(name, comment, quads):
        points = [p for quad in quads for p in quad]
        faces = [[4 * i + k for k in range(4)] for i in range(len(quads))]
        write_obj(name, comment, points, None, faces)

    def facing(quad, inside):
        n = cross(sub(quad[1], quad[0]), sub(quad[2], quad[0]))
        return quad if dot(n, sub(inside, quad[0])) > 0 else quad[::-1]

    def outward(quads):
        points = [p for quad in quads for p in quad]
        middle = tuple(sum(p[i] for p in points) / len(points) for i in range(3))
        return [facing(quad, middle)[::-1] for quad in quads]

    def block(top, height):
        """The four corners of the top, in order, give the sides as well."""
        upper = [(x, height, z) for x, z in top]
        lower = [(x, 0, z) for x, z in top]
        sides = [[lower[i], upper[i], upper[(i + 1) % 4], lower[(i + 1) % 4]] for i in range(4)]
        return outward([upper] + sides + [lower])

    room = (278, 274, 280)
    white = [
        [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)],
        [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)],
        [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]]
    white = [facing(q, room) for q in white]
    short = [(130, 65), (82, 225), (240, 272), (290, 114)]
    tall = [(423, 247), (265, 296), (314, 456), (472, 406)]
    right = [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]
    left = [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]
    boxed('cornell-white.obj', 'Floor, ceiling, back wall and both blocks of the Cornell box',
          white + block(short, 165) + block(tall, 330))
    boxed('cornell-red.obj', 'Left wall of the Cornell box', [facing(left, room)])
    boxed('cornell-green.obj', 'Right wall of the Cornell box', [facing(right, room)])


# ---------------------------------------------------------------- surfaces of two parameters

def grid_faces(rows, columns, around, closed):
    """Quads between rows x columns points; `around`: the last column meets the first; `closed`:
    the last row the first."""
    faces = []
    for i in range(rows if closed else rows - 1):
        for j in range(columns if around else columns - 1):
            a, b = i * columns, (i + 1) % rows * columns
            k = (j + 1) % columns
            faces.append([a + j, b + j, b + k, a + k])
    return faces


def knot():
    """A tube along the torus knot that runs five times round the axis while it turns twice through
    the hole. Its frame turns as little as possible from place to place (double reflection, Wang et
    al. 2008); what is left at the end is spread over the whole length."""
    rows, columns, radius = 640, 22, 0.31

    def at(t):
        r = 2 + 0.85 * math.cos(5 * t)
        return (r * math.cos(2 * t), r * math.sin(2 * t), 0.85 * math.sin(5 * t))

    def tangent(t):
        return unit(sub(at(t + 1e-5), at(t - 1e-5)))

    times = [2 * math.pi * i / rows for i in range(rows + 1)]
    frame = unit(cross(tangent(0), (0, 0, 1)))
    frames = [frame]
    for t0, t1 in zip(times, times[1:]):
        v = sub(at(t1), at(t0))
        k = 2 / dot(v, v)
        r, s = sub(frame, mul(v, k * dot(v, frame))), tangent(t0)
        s = sub(s, mul(v, k * dot(v, s)))
        w = sub(tangent(t1), s)
        frame = unit(sub(r, mul(w, 2 / dot(w, w) * dot(w, r))))
        frames.append(frame)
    first, last, t = frames[0], frames[-1], tangent(0)
    twist = math.atan2(dot(cross(last, first), t), dot(last, first))
    points, normals = [], []
    for i in range(rows):
        side = frames[i]
        other = cross(tangent(times[i]), side)
        for j in range(columns):
            a = 2 * math.pi * j / columns + twist * i / rows
            n = add(mul(side, math.cos(a)), mul(other, math.sin(a)))
            points.append(add(at(times[i]), mul(n, radius)))
            normals.append(n)
    write_ply('knot.ply', 'A torus knot, made by make.py', points, normals,
              [face[::-1] for face in grid_faces(rows, columns, True, True)])


def goblet():
    """A wine glass: an outline turned about z. The outline is a closed curve through the points
    below (Catmull and Rom), up the outside and down the inside."""
    outline = [(0, 0), (0.35, 0.0), (0.7, 0.0), (0.8, 0.03), (0.7, 0.07), (0.4, 0.12),
               (0.16, 0.24), (0.09, 0.5), (0.08, 0.85), (0.1, 1.15), (0.24, 1.34), (0.5, 1.55),
               (0.7, 1.9), (0.74, 2.3), (0.67, 2.7), (0.6, 3.0), (0.58, 3.03), (0.555, 3.0),
               (0.62, 2.7), (0.685, 2.3), (0.645, 1.93), (0.46, 1.63), (0.22, 1.46), (0, 1.4)]
    steps, columns = 5, 72
    curve = []
    for i in range(len(outline) - 1):
        # The outline goes on beyond the axis as its own mirror image.
        before = outline[i - 1] if i > 0 else (-outline[1][0], outline[1][1])
        after = outline[i + 2] if i + 2 < len(outline) else (-outline[-2][0], outline[-2][1])
        p = (before, outline[i], outline[i + 1], after)
        for s in range(steps):
            t = s / steps
            w = (-t + 2 * t * t - t ** 3, 2 - 5 * t * t + 3 * t ** 3,
                 t + 4 * t * t - 3 * t ** 3, t ** 3 - t * t)
            d = (-1 + 4 * t - 3 * t * t, -10 * t + 9 * t * t, 1 + 8 * t - 9 * t * t,
                 3 * t * t - 2 * t)
            curve.append(tuple(sum(w[k] * p[k][c] for k in range(4)) / 2 for c in (0, 1)) +
                         tuple(sum(d[k] * p[k][c] for k in range(4)) / 2 for c in (0, 1)))
    curve.append(outline[-1] + (-1, 0))
    points, normals = [], []
    for r, z, dr, dz in curve:
        length = math.hypot(dr, dz)
        for j in range(columns):
            a = 2 * math.pi * j / columns
            c, s = math.cos(a), math.sin(a)
            points.append((max(r, 0) * c, max(r, 0) * s, z))
            normals.append((dz / length * c, dz / length * s, -dr / length))
    write_ply('goblet.ply', 'A wine glass, made by make.py', points, normals,
              [face[::-1] for face in grid_faces(len(curve), columns, True, False)])


def shell():
    """A sea shell: a circle that grows as it winds around and down its axis, with ribs along the
    growth lines. At the mouth the surface turns back and goes on inside, a little smaller.
    Normals are those of the surface, by differences."""
    outside, inside, columns, turns, growth = 480, 130, 40, 6.5, 0.52

    def at(s, a, part=1.0):
        t = 2 * math.pi * turns * s
        size = math.exp(growth * (t / (2 * math.pi) - turns))
        rib = 1 + 0.05 * math.sin(t * 12) + 0.012 * math.sin(9 * a)
        r = (1.0 + 0.78 * part * rib * math.cos(a)) * size
        z = (0.98 * part * rib * math.sin(a) - 2.55) * size
        return (r * math.cos(t), r * math.sin(t), z + 2.55)

    rows = [(i / (outside - 1), 1.0) for i in range(outside)]
    rows += [(1 - 0.3 * i / (inside - 1), 0.94) for i in range(inside)]
    points, normals = [], []
    for s, part in rows:
        for j in range(columns):
            a = 2 * math.pi * j / columns
            along = sub(at(s + 1e-6, a, part), at(s - 1e-6, a, part))
            across = sub(at(s, a + 1e-5, part), at(s, a - 1e-5, part))
            n = unit(cross(along, across))
            points.append(at(s, a, part))
            normals.append(n if part == 1 else mul(n, -1))
    # The lip, between the two, has normals of its own.
    lip = [unit(sub(at(1, a), at(1 - 1e-5, a)))
           for a in (2 * math.pi * j / columns for j in range(columns))]
    k = outside * columns
    points[k:k] = points[k - columns:k + columns]
    normals[k:k] = lip + lip
    rows += [None, None]
    write_ply('shell.ply', 'A sea shell, made by make.py', points, normals,
              grid_faces(len(rows), columns, True, False))


# ---------------------------------------------------------------- checkerboard

def board():
    """A square with texture coordinates, so that the pattern of two by two pixels repeats; and a
    rectangle for a map on a wall."""
    with open(path('map.obj'), 'w', newline='\n') as out:
        out.write('# Two by one across x and z, with a whole texture\n')
        out.write('v -1 0 -0.5\nv 1 0 -0.5\nv 1 0 0.5\nv -1 0 0.5\n')
        out.write('vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n')
    with open(path('board.obj'), 'w', newline='\n') as out:
        out.write('# A square of 16 x 16, eight times across a texture\n')
        out.write('v -8 -8 0\nv 8 -8 0\nv 8 8 0\nv -8 8 0\n')
        out.write('vt 0 0\nvt 8 0\nvt 8 8\nvt 0 8\nf 1/1 2/2 3/3 4/4\n')
    write_png('board.png', 2, 2, [(196, 188, 172), (58, 52, 50)], [0, 1, 1, 0])


# ---------------------------------------------------------------- planet

def globe():
    """A map of a world that does not exist, with meridians and parallels every 15 degrees. Values
    are linear, as textures are read."""
    width, height = 1200, 600
    deep, sea, shore = (38, 76, 92), (64, 112, 118), (92, 142, 136)
    land = [(196, 170, 104), (168, 156, 84), (126, 138, 70), (104, 112, 62), (142, 104, 66),
            (176, 140, 102), (224, 214, 196)]
    line, ink = (34, 30, 24), (70, 48, 28)
    palette = [deep, sea, shore] + land + [line, ink]
    heights = []
    for y in range(height):
        v = math.pi * (0.5 - (y + 0.5) / height)
        row = []
        for x in range(width):
            u = 2 * math.pi * (x + 0.5) / width
            p = (math.cos(v) * math.cos(u), math.cos(v) * math.sin(u), math.sin(v))
            base = clouds(1.6 * p[0] + 5, 1.6 * p[1] + 5, 1.6 * p[2] + 5, 7, 11)
            row.append(base)
        heights.append(row)
    level = sorted(h for row in heights for h in row[::7])
    coast = level[int(0.6 * len(level))]
    top = level[-1]
    pixels = bytearray()
    for y in range(height):
        latitude = 90 - 180 * (y + 0.5) / height
        for x in range(width):
            h = heights[y][x]
            near = [heights[y][(x + 1) % width], heights[min(y + 1, height - 1)][x]]
            meridian = min(x % 50, 50 - x % 50) < 0.6 / max(math.cos(math.radians(latitude)), 0.1)
            parallel = y % 50 == 0 and y > 0
            tropic = y in (222, 378) and x % 8 < 5
            if any((h < coast) != (n < coast) for n in near):
                color = 11
            elif (meridian and abs(latitude) < 75) or parallel or tropic:
                color = 10
            elif h < coast:
                depth = (coast - h) / coast
                color = 2 if depth < 0.045 else 1 if depth < 0.14 else 0
            else:
                rise = (h - coast) / (top - coast)
                cold = max(0, abs(latitude) - 56) / 20
                color = 3 + min(6, int(6.2 * rise ** 0.8 + 3.5 * cold))
            pixels.append(color)
    write_png('globe.png', width, height, palette, pixels)


# ---------------------------------------------------------------- sky

def sky():
    """An evening sky with a low sun: a cross of cube faces, y up, as docs/scene-format.md has it."""
    side = 32
    sun = unit((0.8, 0.34, -0.12))

    def radiance(d):
        up = d[1]
        if up < 0:
            return (0.16, 0.13, 0.11)
        low = (1 - up) ** 4
        toward = max(0, dot(d, sun))
        color = add(mul((0.12, 0.28, 0.66), 1 - low), mul((0.95, 0.6, 0.38), low))
        color = add(color, mul((1.3, 0.7, 0.3), 0.5 * toward ** 6))
        return add(color, mul((56, 38, 22), toward ** 420))

    picture = [[(0.0, 0.0, 0.0)] * (3 * side) for _ in range(4 * side)]
    squares = {'+x': (2, 2), '-x': (0, 2), '+y': (1, 3), '-y': (1, 1), '+z': (1, 0), '-z': (1, 2)}
    for face, (column, row) in squares.items():
        s = 1 if face[0] == '+' else -1
        for j in range(side):
            for i in range(side):
                total = (0, 0, 0)
                for part in range(16):  # the mean over the texel
                    u = 2 * (i + (part % 4 + 0.5) / 4) / side - 1
                    v = 2 * (j + (part // 4 + 0.5) / 4) / side - 1
                    d = {'x': (s, v, u * s), 'y': (u, s, v * s), 'z': (u, -v * s, s)}[face[1]]
                    total = add(total, radiance(unit(d)))
                picture[row * side + j][column * side + i] = mul(total, 1 / 16)
    with open(path('sky.pfm'), 'wb') as out:
        out.write(b'PF\n%d %d\n-1.0\n' % (3 * side, 4 * side))
        for row in picture:
            for color in row:
                out.write(struct.pack('<3f', *color))


# ---------------------------------------------------------------- forest

def height_of(x, y):
    """Of the land: hills, and a valley with a lake around the origin, cut off at the shore."""
    h = 3.4 * (clouds(x * 0.055 + 40, y * 0.055 + 40, 0.5, 5, 3) - 0.42)
    far = y / 40
    h -= 3.2 * math.exp(-(x / 13) ** 2 - ((y + 6) / 7.5) ** 2)
    return h + 5.5 * max(0, far - 0.25) ** 1.6 * clouds(x * 0.045 + 9, y * 0.045 + 7, 3.5, 5, 8)


def forest():
    """The land as a mesh, and the scene with its trees on it."""
    columns, rows, step = 92, 88, 0.95
    x0, y0 = -0.5 * (columns - 1) * step, -16.0
    points, normals = [], []
    for i in range(rows):
        for j in range(columns):
            x, y = x0 + j * step, y0 + i * step
            points.append((x, y, height_of(x, y)))
            normals.append(unit((height_of(x - 0.4, y) - height_of(x + 0.4, y),
                                 height_of(x, y - 0.4) - height_of(x, y + 0.4), 0.8)))
    write_obj('land.obj', 'Hills, made by make.py', points, normals,
              [face[::-1] for face in grid_faces(rows, columns, False, False)])
    random = Numbers(5)
    trees = []
    while len(trees) < 2400:
        x, y = random(-42, 42), random(-15, 66)
        z = height_of(x, y)
        size = random(0.7, 1.25)
        kind = 'fir' if clouds(x * 0.12, y * 0.12, 7.5, 2, 21) + random(-0.12, 0.12) > 0.44 else \
            'birch'
        if z < -0.1 or clouds(x * 0.1 + 3, y * 0.1, 2.5, 2, 33) < 0.36:
            continue
        if y < -6 and abs(x) < 7:
            continue
        if any((x - a) ** 2 + (y - b) ** 2 < (0.55 * (size + s)) ** 2 for a, b, _, s, _, _ in trees):
            continue
        trees.append((x, y, z, size, kind, random(0, 360)))
    with open(path('forest.part'), encoding='utf-8') as part:
        text = part.read()
    fir = []
    for level in range(6):
        fir.append('      <surface type="Cone"><shader ref="needles"/><center>0 0 %s</center><radius>%s'
                   '</radius><height>0.42</height><tipz>%s</tipz></surface>' % (
                       number(0.62 + 0.27 * level), number(0.27 - 0.042 * level),
                       number(0.84 + 0.27 * level)))
    birch = []
    for i in range(26):
        a, h = 2.4 * i, 0.75 + 0.045 * i
        r = 0.3 * math.sin(math.pi * (i + 2) / 30) * math.sqrt(random(0.3, 1))
        birch.append('      <surface type="Sphere"><shader ref="leaves"/><center>%s %s %s</center>'
                     '<radius>%s</radius></surface>' % (
                         number(round(r * math.cos(a), 3)), number(round(r * math.sin(a), 3)),
                         number(round(h, 3)), number(round(random(0.1, 0.17), 3))))
    text = text.replace('FIR\n', '\n'.join(fir) + '\n').replace('BIRCH\n', '\n'.join(birch) + '\n')
    lines = []
    for x, y, z, size, kind, turn in trees:
        lines.append('  <surface type="Group"><translate>%s %s %s</translate><rotate>0 0 %d</rotate>'
                     '<scale>%.2f %.2f %.2f</scale><surface ref="%s"/></surface>' % (
                         number(round(x, 2)), number(round(y, 2)), number(round(z - 0.06, 2)),
                         turn, size, size, size * (0.9 + 0.3 * lattice(int(turn), 3, 4, 5)), kind))
    with open(os.path.join(HERE, '..', 'forest.xml'), 'w', newline='\n') as out:
        out.write(text.replace('  <!-- TREES -->\n', '\n'.join(lines) + '\n'))


if __name__ == '__main__':
    makers = [cornell, knot, goblet, shell, board, globe, sky, forest]
    for maker in makers:
        if len(sys.argv) == 1 or maker.__name__ in sys.argv[1:]:
            maker()

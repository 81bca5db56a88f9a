# SPDX-License-Identifier: GPL-3.0-or-later
# Writes an office room with twelve curved pieces of furniture, tessellated into about as many polygons as asked for.
"""The same furniture, coarse or fine: how time and interactions grow with the number of polygons.

    python3 tests/bench/make_furniture.py N [FOLDER]     N: 2,000 to 500,000; FOLDER: the working directory
    clerestory study FOLDER/furniture-N.obj --no-pictures --accuracy draft

The room is 8 m (x) by 6 m (y) by 3 m (z) with a window of 3 m by 1.6 m to the south, glass in the middle of a
reveal of 0.3 m. Everything else is turned or swept and curved both ways, in triangles of about one size; the
shapes converge with N. Hardly two facets lie in one plane: of 5,000 the program joins next to none, of 500,000 one
in seven, where a shape turns by less than the tolerance of a facet of 12 mm.
"""

import math
import sys

from meshes import Model, box, circle, cross, matt, minus, plus, skin, unit

WIDTH_M, DEPTH_M, HEIGHT_M = 8.0, 6.0, 3.0
WINDOW_M = (2.5, 5.5, 0.9, 2.5)  # x from, to, z from, to
REVEAL_M = 0.3
OFF_FLOOR_M = 0.005

MATERIALS = {
    "floor": matt(0.2),
    "wall": matt(0.5),
    "ceiling": matt(0.8),
    "wood": matt(0.35),
    "fabric": matt(0.25),
    "shell": matt(0.7),
    "ceramic": matt(0.6),
    "glazing": ["Kd 0 0 0", "Tf 0.65 0.65 0.65", "Ni 1.52", "d 0.3", "illum 4"],
}


def draw_room(model):
    x0, x1, z0, z1 = WINDOW_M
    w, d, h = WIDTH_M, DEPTH_M, HEIGHT_M
    model.polygon("floor", "floor", [(0, 0, 0), (w, 0, 0), (w, d, 0), (0, d, 0)])
    model.polygon("ceiling", "ceiling", [(0, 0, h), (0, d, h), (w, d, h), (w, 0, h)])
    model.polygon("west wall", "wall", [(0, 0, 0), (0, d, 0), (0, d, h), (0, 0, h)])
    model.polygon("east wall", "wall", [(w, 0, 0), (w, 0, h), (w, d, h), (w, d, 0)])
    model.polygon("north wall", "wall", [(0, d, 0), (w, d, 0), (w, d, h), (0, d, h)])
    for a0, a1, b0, b1 in ((0, w, 0, z0), (0, w, z1, h), (0, x0, z0, z1), (x1, w, z0, z1)):
        model.polygon("south wall", "wall", [(a0, 0, b0), (a0, 0, b1), (a1, 0, b1), (a1, 0, b0)])
    low, high = (x0, -REVEAL_M, z0), (x1, 0.0, z1)
    inward = Model()
    box(inward, "reveal", "wall", low, high, "-x+x-z+z")
    places = list(inward.points)
    for face in inward.objects[("reveal", "wall")]:
        model.polygon("reveal", "wall", [places[n - 1] for n in reversed(face)])
    y = -0.5 * REVEAL_M
    model.polygon("window", "glazing", [(x0, y, z0), (x0, y, z1), (x1, y, z1), (x1, y, z0)])


def along(curve, step_m):
    """Points on a curve (0 … 1 -> point) at equal distances of about a step; both ends are among them."""
    fine = [curve(i / 4000) for i in range(4001)]
    way = [0.0]
    for a, b in zip(fine, fine[1:]):
        way.append(way[-1] + math.dist(a, b))
    count = max(3, round(way[-1] / step_m))
    result, k = [], 0
    for i in range(count + 1):
        target = way[-1] * i / count
        while k < len(way) - 2 and way[k + 1] < target:
            k += 1
        result.append(fine[k if target - way[k] < way[k + 1] - target else k + 1])
    result[0], result[-1] = fine[0], fine[-1]
    return result


def around(length_m, step_m):
    """How many points a ring has; a pole has one."""
    return 0 if length_m == 0.0 else max(6, round(length_m / step_m))


def turn(model, name, material, curve, place, step_m, tilt=0.0, facing=0.0, closed=False):
    """Turns a curve of (radius, height) about its axis, which leans by `tilt` towards `facing` [rad]."""
    lean = (math.sin(tilt) * math.cos(facing), math.sin(tilt) * math.sin(facing), math.cos(tilt))
    u = unit(cross((-math.sin(facing), math.cos(facing), 0.0), lean))
    v = cross(lean, u)
    rings = []
    for r, z in along(curve, 0.87 * step_m):
        r = 0.0 if r < 1e-9 else r
        rings.append(circle(plus(place, lean, z), r, around(2.0 * math.pi * r, step_m), u, v, 0.5 * (len(rings) % 2)))
    if closed:
        rings.pop()
    skin(model, name, material, rings, closed=closed)


def ellipse(radius, half_height, middle):
    """From the lower pole to the upper."""
    return lambda t: (radius * math.sin(math.pi * t), middle - half_height * math.cos(math.pi * t))


def egg_shell(t):
    """Out along the shell, round its rim and back inside, for an opening of 100 degrees."""
    end = math.pi * 0.72
    if t < 0.5:
        a, out = end * t / 0.5, 0.03
    else:
        a, out = end * (1.0 - t) / 0.5, -0.03
    out *= min(1.0, math.sqrt(max(0.0, (end - a) / 0.15)))
    return ((0.48 + out) * math.sin(a), -(0.56 + out) * math.cos(a))


def vase(t):
    """A bulb with a narrow neck, out and back inside."""
    outer = t < 0.6
    s = t / 0.6 if outer else (1.0 - t) / 0.4
    z = 0.9 * s
    r = 0.13 + 0.09 * math.sin(2.0 * math.pi * s - 0.6) * (1.0 - 0.3 * s)
    r *= math.sqrt(min(1.0, s / 0.12)) if s < 0.12 else 1.0
    lip = min(1.0, math.sqrt(max(0.0, 1.0 - s) / 0.05))
    return (max(0.0, r + (0.0 if outer else -0.02 * lip) * min(1.0, s / 0.12)), z + (0.0 if outer else 0.02 * (1.0 - s)))


def foot(radius, waist, height):
    """A trumpet on a rounded plate, up to a rounded end."""

    def curve(t):
        z = height * (0.5 - 0.5 * math.cos(math.pi * t))
        s = z / height
        r = waist + (radius - waist) * (1.0 - s) ** 6 + 0.25 * waist * math.sin(3.0 * s)
        return (r * math.sqrt(max(0.0, math.sin(math.pi * t))) ** 0.7 if 0.0 < t < 1.0 else 0.0, z)

    return curve


def shade(t):
    """A bell, closed to a ring: outer face up, inner face down."""
    a = 2.0 * math.pi * t
    s = 0.5 - 0.5 * math.cos(a)  # 0 at the lower rim, 1 at the upper
    thick = 0.012 * math.sin(a)
    return (0.26 - 0.16 * s + 0.05 * math.sin(math.pi * s) + thick, 0.34 * s - 0.4 * thick)


def sofa(model, place, step_m):
    """A rounded bar that winds through the room, thinner to its ends."""
    length_m, wave_m, half_depth_m, half_height_m = 2.6, 0.35, 0.34, 0.25

    def spine(t):
        x = length_m * (t - 0.5)
        return (x, wave_m * math.sin(2.0 * math.pi * t), 0.0)

    rings = []
    for i, p in enumerate(points := along(lambda t: (*spine(t)[:2], t), 0.87 * step_m)):
        t = p[2]
        size = (1.0 - abs(2.0 * t - 1.0) ** 5) ** 0.5 if 0.0 < t < 1.0 else 0.0
        size *= 0.94 - 0.06 * math.cos(6.0 * math.pi * t)  # three seats
        way = unit(minus(points[min(i + 1, len(points) - 1)][:2] + (0.0,), points[max(i - 1, 0)][:2] + (0.0,)))
        side = cross(way, (0.0, 0.0, 1.0))
        centre = plus(place, (p[0], p[1], half_height_m))
        count = around(1.6 * math.pi * size * half_depth_m, step_m)
        if count == 0:
            rings.append([centre])
            continue
        angles = [2.0 * math.pi * (k + 0.5 * (i % 2)) / count for k in range(count)]
        rings.append(
            [
                plus(plus(centre, side, size * half_depth_m * math.cos(a)), (0, 0, 1), size * half_height_m * math.sin(a))
                for a in angles
            ]
        )
    skin(model, "sofa", "fabric", rings)


def draw_furniture(model, step_m):
    z = OFF_FLOOR_M
    for i, (x, y, facing) in enumerate(((1.6, 2.4, 0.3), (3.0, 4.4, -1.2), (6.6, 3.8, -2.2)), 1):
        turn(model, f"egg chair {i}", "shell", egg_shell, (x, y, z + 0.82), step_m, 0.9, facing)
        turn(model, f"egg chair {i}", "wood", foot(0.3, 0.04, 0.2), (x, y, z), step_m)
    for i, (x, y, r, h) in enumerate(((2.9, 2.9, 0.48, 0.62), (5.2, 3.6, 0.38, 0.52)), 1):
        turn(model, f"table {i}", "wood", ellipse(r, 0.24, h), (x, y, z), step_m)
        turn(model, f"table {i}", "wood", foot(0.26, 0.06, h - 0.27), (x, y, z), step_m)
    for i, (x, y) in enumerate(((0.6, 5.4), (7.4, 0.7)), 1):
        turn(model, f"vase {i}", "ceramic", vase, (x, y, z), step_m)
    for i, (x, y) in enumerate(((0.7, 0.8), (4.6, 5.3)), 1):
        turn(model, f"lamp {i}", "wood", foot(0.24, 0.025, 1.25), (x, y, z), step_m)
        turn(model, f"lamp {i}", "shell", shade, (x, y, z + 1.3), step_m, closed=True)
    for i, (x, y) in enumerate(((4.3, 1.6), (6.9, 5.2)), 1):
        turn(model, f"cushion {i}", "fabric", ellipse(0.33, 0.21, 0.21), (x, y, z), step_m)
    sofa(model, (5.4, 2.3, z), step_m)


def draw(step_m):
    model = Model()
    draw_room(model)
    draw_furniture(model, step_m)
    return model


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    wanted = int(sys.argv[1])
    if not 2000 <= wanted <= 500000:
        sys.exit("N is 2,000 to 500,000")
    step_m = 0.05  # the number of triangles goes with the inverse square of their size
    for _ in range(4):
        model = draw(step_m)
        step_m *= math.sqrt(model.size() / wanted)
    model.write(sys.argv[2] if len(sys.argv) > 2 else ".", f"furniture-{wanted}", MATERIALS)
    print(f"{model.size()} polygons, facets of about {1000.0 * step_m:.0f} mm")


if __name__ == "__main__":
    main()

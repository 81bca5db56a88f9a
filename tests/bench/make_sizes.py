#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes models of a size that must not frighten a reader: make_sizes.py FOLDER [POLYGONS]

district.obj, district.glb  plain houses of two furnished rooms each, a million polygons (GLB: two million triangles)
mesh.obj                    one mesh of a million triangles, a wavy sheet
polygon.obj                 one polygon of 100,000 corners, a comb
objects.obj                 100,000 objects of one triangle
materials.obj               10,000 materials, each on one square
deep.gltf                   a scene graph of 1,000 levels
"""
import json
import math
import os
import struct
import sys

FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def box(x0, y0, z0, x1, y1, z1):
    return [(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0),
            (x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)]


def table(x, y, w, d, h, t=0.05):
    legs = [box(x + i * (w - t), y + j * (d - t), 0.01, x + i * (w - t) + t, y + j * (d - t) + t, h - t - 0.002)
            for i in (0, 1) for j in (0, 1)]
    return legs + [box(x, y, h - t, x + w, y + d, h)]


def room(x, y, size):
    """Boxes of the furniture in a room of 4 x 5 m that begins at (x, y)."""
    boxes = table(x + 1.2, y + 1.5, 1.6, 0.9, 0.74)
    for cx, cy in ((0.6, 1.6), (3.0, 1.6), (1.4, 0.9), (2.2, 2.6)):
        boxes += table(x + cx, y + cy, 0.45, 0.45, 0.45, 0.04)
        boxes.append(box(x + cx, y + cy + 0.41, 0.452, x + cx + 0.45, y + cy + 0.45, 0.9))
    boxes += [box(x + 0.3, y + 4.2, 0.1 + 0.3 * i, x + 2.3, y + 4.6, 0.13 + 0.3 * i) for i in range(6)]
    boxes += [box(x + 0.35 + 0.1 * i, y + 4.25, 0.135 + 0.3 * (i % 5), x + 0.43 + 0.1 * i, y + 4.5,
                  0.135 + 0.3 * (i % 5) + 0.22) for i in range(size)]
    return boxes


def house(x, y):
    """(material, points, faces) of a house of 8 x 5 x 2.7 m with a partition and two windows."""
    parts = []
    w, d, h = 8.0, 5.0, 2.7
    shell = [(x, y, 0), (x + w, y, 0), (x + w, y + d, 0), (x, y + d, 0),
             (x, y, h), (x + w, y, h), (x + w, y + d, h), (x, y + d, h)]
    panes = []
    for wx in (1.0, 5.0):
        panes += [(x + wx, y, 0.9), (x + wx + 2.0, y, 0.9), (x + wx + 2.0, y, 2.2), (x + wx, y, 2.2)]
    points = shell + panes
    a, b = 8, 12
    front = [(0, 1, b + 1, b, a + 1, a), (1, 5, b + 2, b + 1), (5, 4, a + 3, a + 2, b + 3, b + 2), (4, 0, a, a + 3),
             (a + 1, b, b + 3, a + 2)]
    parts.append(("plaster", points, front + [(1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]))
    parts.append(("wood", points, [(0, 3, 2, 1)]))
    parts.append(("glass", points, [(a, a + 1, a + 2, a + 3), (b, b + 1, b + 2, b + 3)]))
    parts.append(("plaster", box(x + 3.95, y, 0, x + 4.05, y + d, h), FACES))
    for corner in (x, x + 4.0):
        for number, piece in enumerate(room(corner, y, 14)):
            parts.append((("wood", "cloth", "paint")[number % 3], piece, FACES))
    return parts


def district(polygons):
    per_house = sum(len(faces) for _, _, faces in house(0, 0))
    count = max(1, polygons // per_house)
    side = math.ceil(math.sqrt(count))
    for i in range(count):
        yield i, house(12.0 * (i % side), 9.0 * (i // side))


MATERIALS = {"plaster": (0.7, 0.7, 0.7), "wood": (0.4, 0.3, 0.2), "cloth": (0.2, 0.3, 0.5), "paint": (0.6, 0.5, 0.3)}


def write_mtl(folder):
    with open(os.path.join(folder, "district.mtl"), "w") as out:
        for name, color in MATERIALS.items():
            out.write("newmtl %s\nKd %g %g %g\n" % (name, *color))
        out.write("newmtl glass\nKd 0 0 0\nTf 0.7 0.7 0.7\nd 0.3\n")


def write_district_obj(folder, polygons):
    write_mtl(folder)
    total = 0
    with open(os.path.join(folder, "district.obj"), "w") as out:
        out.write("mtllib district.mtl\n")
        first = 1
        for number, parts in district(polygons):
            out.write("o house %d\n" % number)
            shared = None
            for material, points, faces in parts:
                if points is not shared:
                    if shared is not None:
                        first += len(shared)
                    out.write("".join("v %.4f %.4f %.4f\n" % p for p in points))
                    shared = points
                out.write("usemtl %s\n" % material)
                out.write("".join("f %s\n" % " ".join(str(first + c) for c in face) for face in faces))
                total += len(faces)
            first += len(shared)
    return total


def write_district_glb(folder, polygons):
    """One mesh for each house, y up, triangles by material."""
    names = list(MATERIALS) + ["glass"]
    binary = bytearray()
    views, accessors, meshes, nodes = [], [], [], []

    def view(data, accessor):
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, **accessor})
        binary.extend(data)
        binary.extend(b"\0" * (-len(binary) % 4))
        return len(accessors) - 1

    for number, parts in district(polygons):
        primitives = []
        for name in names:
            points, corners = [], []
            for material, part_points, faces in parts:
                if material != name:
                    continue
                base = len(points)
                points += part_points
                for face in faces:
                    for i in range(1, len(face) - 1):
                        corners += [base + face[0], base + face[i], base + face[i + 1]]
            flat = [v for x, y, z in points for v in (x, z, -y)]
            position = view(struct.pack("<%df" % len(flat), *flat),
                            {"componentType": 5126, "count": len(points), "type": "VEC3"})
            index = view(struct.pack("<%dH" % len(corners), *corners),
                         {"componentType": 5123, "count": len(corners), "type": "SCALAR"})
            primitives.append({"attributes": {"POSITION": position}, "indices": index, "material": names.index(name)})
        meshes.append({"primitives": primitives})
        nodes.append({"mesh": number, "name": "house %d" % number})
    materials = [{"name": n, "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [*MATERIALS[n], 1]}}
                 for n in MATERIALS]
    materials.append({"name": "glass", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.7}}})
    text = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}],
                       "nodes": nodes, "meshes": meshes, "materials": materials, "accessors": accessors,
                       "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}).encode()
    text += b" " * (-len(text) % 4)
    with open(os.path.join(folder, "district.glb"), "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
        out.write(struct.pack("<I4s", len(text), b"JSON") + text)
        out.write(struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def write_mesh(folder, triangles):
    n = round(math.sqrt(triangles / 2))
    with open(os.path.join(folder, "mesh.obj"), "w") as out:
        for j in range(n + 1):
            out.write("".join("v %.4f %.4f %.4f\n" % (0.03 * i, 0.03 * j, 0.5 * math.sin(0.05 * i) * math.cos(0.07 * j))
                              for i in range(n + 1)))
        for j in range(n):
            row = []
            for i in range(n):
                a = j * (n + 1) + i + 1
                row.append("f %d %d %d\nf %d %d %d\n" % (a, a + 1, a + n + 2, a, a + n + 2, a + n + 1))
            out.write("".join(row))


def write_polygon(folder, corners):
    teeth = corners // 4
    with open(os.path.join(folder, "polygon.obj"), "w") as out:
        for i in range(teeth):
            out.write("v %.4f 1 0\nv %.4f 9 0\nv %.4f 9 0\nv %.4f 1 0\n" %
                      (0.002 * i, 0.002 * i, 0.002 * i + 0.001, 0.002 * i + 0.001))
        out.write("v %.4f 0 0\nv 0 0 0\n" % (0.002 * teeth))
        out.write("f " + " ".join(str(i + 1) for i in range(4 * teeth + 2)) + "\n")


def write_objects(folder, count):
    with open(os.path.join(folder, "objects.obj"), "w") as out:
        for i in range(count):
            x, y = 0.1 * (i % 300), 0.1 * (i // 300)
            out.write("o thing %d\nv %.3f %.3f 0\nv %.3f %.3f 0\nv %.3f %.3f 0.05\nf -3 -2 -1\n" %
                      (i, x, y, x + 0.05, y, x, y + 0.05))


def write_materials(folder, count):
    with open(os.path.join(folder, "materials.mtl"), "w") as out:
        for i in range(count):
            out.write("newmtl paint %d\nKd %.4f 0.5 0.5\n" % (i, 0.2 + 0.5 * i / count))
    with open(os.path.join(folder, "materials.obj"), "w") as out:
        out.write("mtllib materials.mtl\n")
        for i in range(count):
            x, y = 0.2 * (i % 100), 0.2 * (i // 100)
            out.write("v %.3f %.3f 0\nv %.3f %.3f 0\nv %.3f %.3f 0\nv %.3f %.3f 0\nusemtl paint %d\nf -4 -3 -2 -1\n" %
                      (x, y, x + 0.1, y, x + 0.1, y + 0.1, x, y + 0.1, i))


def write_deep(folder, levels):
    data = struct.pack("<9f", 0, 0, 0, 4, 0, 0, 0, 0, -3)
    nodes = [{"children": [i + 1], "translation": [0, 0.001, 0]} for i in range(levels - 1)] + [{"mesh": 0}]
    with open(os.path.join(folder, "deep.bin"), "wb") as out:
        out.write(data)
    with open(os.path.join(folder, "deep.gltf"), "w") as out:
        json.dump({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": nodes,
                   "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                   "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
                   "bufferViews": [{"buffer": 0, "byteLength": 36}],
                   "buffers": [{"byteLength": 36, "uri": "deep.bin"}]}, out)


def main():
    folder = sys.argv[1]
    polygons = int(sys.argv[2]) if len(sys.argv) > 2 else 1000000
    os.makedirs(folder, exist_ok=True)
    print("district: %d polygons" % write_district_obj(folder, polygons))
    write_district_glb(folder, polygons)
    write_mesh(folder, polygons)
    write_polygon(folder, polygons // 10)
    write_objects(folder, polygons // 10)
    write_materials(folder, polygons // 100)
    write_deep(folder, 1000)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Writes character.glb: a figure of tubes with a skin of eleven joints, a morph target that fills its
coat with wind, and a walk of one second. It needs nothing but Python's standard library.

The figure stands on the plane y = 0, is 1.8 units high and walks toward +z.
"""
import json
import math
import pathlib
import struct

# Each joint: name, parent, position in the bind pose.
JOINTS = [
    ("hips", None, (0.0, 0.95, 0.0)),
    ("chest", 0, (0.0, 1.2, 0.0)),
    ("head", 1, (0.0, 1.52, 0.0)),
    ("upper arm, left", 1, (0.22, 1.42, 0.0)),
    ("lower arm, left", 3, (0.27, 1.13, 0.0)),
    ("upper arm, right", 1, (-0.22, 1.42, 0.0)),
    ("lower arm, right", 5, (-0.27, 1.13, 0.0)),
    ("thigh, left", 0, (0.1, 0.9, 0.0)),
    ("shin, left", 7, (0.1, 0.48, 0.0)),
    ("thigh, right", 0, (-0.1, 0.9, 0.0)),
    ("shin, right", 9, (-0.1, 0.48, 0.0)),
]
SIDES = 12

positions, normals, joints, weights, wind, indices = [], [], [], [], [], []


def ring(center, radii, first, second, blend, wind_reach=0.0):
    """Adds a ring of vertices around a vertical axis, moved by two joints."""
    for side in range(SIDES + 1):
        angle = 2.0 * math.pi * side / SIDES
        x, z = math.cos(angle), math.sin(angle)
        positions.append((center[0] + radii[0] * x, center[1], center[2] + radii[1] * z))
        length = math.hypot(x / radii[0], z / radii[1])
        normals.append((x / radii[0] / length, 0.0, z / radii[1] / length))
        joints.append((first, second, 0, 0))
        weights.append((1.0 - blend, blend, 0.0, 0.0))
        # The wind blows from the front.
        wind.append((wind_reach * 0.5 * x, 0.0, -wind_reach * (1.0 - 0.6 * z)))


def tube(rings):
    """Connects rings from top to bottom, and closes both ends."""
    first = len(positions)
    for number, values in enumerate(rings):
        ring(*values)
        if number == 0:
            continue
        for side in range(SIDES):
            a = first + (number - 1) * (SIDES + 1) + side
            b = a + SIDES + 1
            indices.extend([a, a + 1, b, b, a + 1, b + 1])
    for number, up in [(0, 1.0), (len(rings) - 1, -1.0)]:
        center, _, joint_a, joint_b, blend, *rest = rings[number]
        middle = len(positions)
        # The cap has vertices of its own, since its normals differ.
        ring(*rings[number])
        for index in range(middle, len(positions)):
            normals[index] = (0.0, up, 0.0)
        positions.append(center)
        normals.append((0.0, up, 0.0))
        joints.append((joint_a, joint_b, 0, 0))
        weights.append((1.0 - blend, blend, 0.0, 0.0))
        wind.append((0.0, 0.0, -(rest[0] if rest else 0.0)))
        for side in range(SIDES):
            rim = (middle + side, middle + side + 1)
            indices.extend([len(positions) - 1, *(reversed(rim) if up > 0.0 else rim)])


def limb(top, bottom, radius, upper, lower):
    """Adds an arm or a leg, which bends in its middle."""
    rings = []
    for step in range(9):
        along = step / 8
        center = tuple(a + (b - a) * along for a, b in zip(top, bottom))
        blend = min(max((along - 0.5) * 4.0 + 0.5, 0.0), 1.0)
        width = radius * (1.0 - 0.35 * along)
        rings.append((center, (width, width), upper, lower, blend))
    tube(rings)


def body():
    coat = []
    for step in range(11):
        along = step / 10
        height = 1.46 - 0.86 * along
        blend = min(max((along - 0.25) * 2.5, 0.0), 1.0)
        wide = 0.14 + 0.07 * math.sin(math.pi * min(1.0, along * 1.3)) + 0.1 * max(0.0, along - 0.6)
        reach = 0.55 * max(0.0, along - 0.35) ** 1.5
        coat.append(((0.0, height, 0.0), (wide, 0.7 * wide), 1, 0, blend, reach))
    tube(coat)
    head = []
    for step in range(9):
        angle = math.pi * (step + 0.35) / 8.7
        radius = 0.13 * math.sin(angle)
        head.append(((0.0, 1.66 + 0.14 * math.cos(angle), 0.0), (radius, radius), 2, 2, 0.0))
    tube(head)
    for side, arm, leg in [(1.0, 3, 7), (-1.0, 5, 9)]:
        limb((0.22 * side, 1.42, 0.0), (0.31 * side, 0.85, 0.0), 0.06, arm, arm + 1)
        limb((0.1 * side, 0.9, 0.0), (0.1 * side, 0.0, 0.0), 0.1, leg, leg + 1)


def rotation_x(angle):
    return (math.sin(angle / 2.0), 0.0, 0.0, math.cos(angle / 2.0))


class Buffer:
    """Collects the bytes of a glTF file, with accessors for them."""

    def __init__(self):
        self.bytes, self.views, self.accessors = bytearray(), [], []

    def add(self, rows, component, kind, target=None):
        rows = [row if isinstance(row, tuple) else (row,) for row in rows]
        code = {5126: "f", 5121: "B", 5123: "H"}[component]
        while len(self.bytes) % 4:
            self.bytes.append(0)
        view = {"buffer": 0, "byteOffset": len(self.bytes)}
        for row in rows:
            self.bytes += struct.pack(f"<{len(row)}{code}", *row)
        view["byteLength"] = len(self.bytes) - view["byteOffset"]
        if target:
            view["target"] = target
        self.views.append(view)
        accessor = {
            "bufferView": len(self.views) - 1,
            "componentType": component,
            "count": len(rows),
            "type": kind,
        }
        if component == 5126 and kind in ("VEC3", "SCALAR"):
            # As f32 has them, since readers compare these with the data.
            single = [struct.unpack(f"<{len(row)}f", struct.pack(f"<{len(row)}f", *row)) for row in rows]
            accessor["min"] = [min(column) for column in zip(*single)]
            accessor["max"] = [max(column) for column in zip(*single)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def walk(buffer):
    """Returns the animation: one step of each leg in a second."""
    times = [step / 16.0 for step in range(17)]
    phase = [2.0 * math.pi * time for time in times]
    swing = [math.sin(angle) for angle in phase]
    turns = {
        3: [-0.5 * s for s in swing],
        5: [0.5 * s for s in swing],
        4: [-0.35 - 0.25 * max(0.0, s) for s in swing],
        6: [-0.35 - 0.25 * max(0.0, -s) for s in swing],
        7: [0.55 * s for s in swing],
        9: [-0.55 * s for s in swing],
        8: [0.15 + 0.7 * max(0.0, math.cos(angle)) for angle in phase],
        10: [0.15 + 0.7 * max(0.0, -math.cos(angle)) for angle in phase],
        1: [0.06 + 0.03 * math.cos(2.0 * angle) for angle in phase],
    }
    time = buffer.add(times, 5126, "SCALAR")
    samplers, channels = [], []

    def channel(node, path, output):
        samplers.append({"input": time, "output": output, "interpolation": "LINEAR"})
        target = {"node": node, "path": path}
        channels.append({"sampler": len(samplers) - 1, "target": target})

    for joint, angles in turns.items():
        channel(joint, "rotation", buffer.add([rotation_x(angle) for angle in angles], 5126, "VEC4"))
    bob = [(0.0, 0.93 + 0.025 * math.cos(2.0 * angle), 0.0) for angle in phase]
    channel(0, "translation", buffer.add(bob, 5126, "VEC3"))
    gusts = [0.55 + 0.45 * math.sin(angle + 0.7) for angle in phase]
    channel(len(JOINTS), "weights", buffer.add(gusts, 5126, "SCALAR"))
    return {"name": "walk", "samplers": samplers, "channels": channels}


def main():
    body()
    buffer = Buffer()
    attributes = {
        "POSITION": buffer.add(positions, 5126, "VEC3", 34962),
        "NORMAL": buffer.add(normals, 5126, "VEC3", 34962),
        "JOINTS_0": buffer.add(joints, 5121, "VEC4", 34962),
        "WEIGHTS_0": buffer.add(weights, 5126, "VEC4", 34962),
    }
    primitive = {
        "attributes": attributes,
        "indices": buffer.add(indices, 5123, "SCALAR", 34963),
        "targets": [{"POSITION": buffer.add(wind, 5126, "VEC3", 34962)}],
    }
    inverse = [
        (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, *(-c for c in place), 1.0)
        for _, _, place in JOINTS
    ]
    nodes = []
    for index, (name, parent, place) in enumerate(JOINTS):
        origin = JOINTS[parent][2] if parent is not None else (0.0, 0.0, 0.0)
        node = {"name": name, "translation": [a - b for a, b in zip(place, origin)]}
        children = [child for child, joint in enumerate(JOINTS) if joint[1] == index]
        if children:
            node["children"] = children
        nodes.append(node)
    nodes.append({"name": "figure", "mesh": 0, "skin": 0})
    skin = {"joints": list(range(len(JOINTS))), "inverseBindMatrices": buffer.add(inverse, 5126, "MAT4")}
    document = {
        "asset": {"version": "2.0", "generator": "character.py"},
        "scene": 0,
        "scenes": [{"nodes": [0, len(JOINTS)]}],
        "nodes": nodes,
        "meshes": [{"primitives": [primitive], "weights": [0.0]}],
        "skins": [skin],
        "animations": [walk(buffer)],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    }
    while len(buffer.bytes) % 4:
        buffer.bytes.append(0)
    document["buffers"] = [{"byteLength": len(buffer.bytes)}]
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + len(buffer.bytes)
    with open(pathlib.Path(__file__).with_name("character.glb"), "wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, size))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(buffer.bytes), 0x004E4942) + buffer.bytes)


if __name__ == "__main__":
    main()

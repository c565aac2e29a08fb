"""Binary glTF, as much of it as goes to limber and comes back: positions, triangles, joints, weights, motions."""
import json
import struct

import numpy as np

COMPONENTS = {np.dtype("float32"): 5126, np.dtype("uint32"): 5125, np.dtype("uint16"): 5123, np.dtype("uint8"): 5121}
TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
SHAPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Writer:
    """A document with one scene; arrays are added one by one."""

    def __init__(self):
        self.document = {"asset": {"version": "2.0", "generator": "limber for Blender"}, "scene": 0, "scenes": [{"nodes": []}],
                         "nodes": [], "accessors": [], "bufferViews": []}
        self.binary = bytearray()

    def add(self, name, entry):
        """Into one of the document's lists; its index there."""
        entries = self.document.setdefault(name, [])
        entries.append(entry)
        return len(entries) - 1

    def add_array(self, values, **more):
        """(N,), (N, 3), (N, 4, 4), ...: the index of the accessor. Matrices are given row by row, and kept column by column."""
        values = np.ascontiguousarray(values if values.ndim < 3 else values.transpose(0, 2, 1))
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.binary), "byteLength": values.nbytes})
        self.binary += values.tobytes()
        return self.add("accessors", {"bufferView": view, "componentType": COMPONENTS[values.dtype], "count": len(values),
                                      "type": SHAPES[values.shape[1:]], **more})

    def write(self, path):
        self.document["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.document).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.binary) + b"\0" * (-len(self.binary) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


class Reader:
    """What limber wrote."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        length = struct.unpack_from("<I", data, 12)[0]
        self.document = json.loads(data[20:20 + length])
        self.binary = data[28 + length:]

    def array(self, accessor):
        """(N,) or (N, width); matrices as (N, 4, 4), row by row."""
        accessor = self.document["accessors"][accessor]
        view = self.document["bufferViews"][accessor["bufferView"]]
        kind, width = np.dtype(TYPES[accessor["componentType"]]), WIDTHS[accessor["type"]]
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", kind.itemsize * width)
        values = np.ndarray((accessor["count"], width), kind, self.binary, begin, (stride, kind.itemsize))
        if accessor.get("normalized"):
            values = values.astype(np.float32) / np.iinfo(kind).max
        if accessor["type"] == "MAT4":
            return values.reshape(-1, 4, 4).transpose(0, 2, 1)
        return values[:, 0] if width == 1 else values

    def skin(self):
        """Of the first skin: names of joints, parents (-1: none), and (J, 4, 4) where they are bound."""
        document = self.document
        skin = document["skins"][0]
        joints = skin["joints"]
        above = {child: parent for parent, node in enumerate(document["nodes"]) for child in node.get("children", [])}
        parents = [joints.index(above[joint]) if above.get(joint) in joints else -1 for joint in joints]
        bound = np.linalg.inv(self.array(skin["inverseBindMatrices"]).astype(float))
        return [document["nodes"][joint]["name"] for joint in joints], parents, bound

    def weights(self, mesh):
        """Of a mesh's one primitive: (V, K) indices of the skin's joints, (V, K) weights."""
        attributes = self.document["meshes"][mesh]["primitives"][0]["attributes"]
        joints, weights, n = [], [], 0
        while f"JOINTS_{n}" in attributes:
            joints.append(self.array(attributes[f"JOINTS_{n}"]))
            weights.append(self.array(attributes[f"WEIGHTS_{n}"]))
            n += 1
        return np.hstack(joints).astype(int), np.hstack(weights).astype(float)

    def mesh(self, mesh):
        """Of a mesh's one primitive: (V, 3) positions, (F, 3) triangles."""
        primitive = self.document["meshes"][mesh]["primitives"][0]
        return self.array(primitive["attributes"]["POSITION"]), self.array(primitive["indices"]).reshape(-1, 3)

    def clips(self):
        """(name, {node: {"translation" | "rotation" | "scale": (times, values)}}) of each animation."""
        for animation in self.document.get("animations", []):
            nodes = {}
            for channel in animation["channels"]:
                sampler = animation["samplers"][channel["sampler"]]
                target = channel["target"]
                nodes.setdefault(target["node"], {})[target["path"]] = (self.array(sampler["input"]), self.array(sampler["output"]))
            yield animation.get("name", "motion"), nodes

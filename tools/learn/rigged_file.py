"""A rigged model flattened: surface, weights and joints in the stored pose. GLB and glTF here, all else by limber.

What this reader does not know (FBX, VRM's extensions, compression) `limber convert` writes as plain GLB first.
"""
import base64
import json
import os
import struct
import subprocess
import tempfile
import urllib.parse
from dataclasses import dataclass

import numpy as np

_COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass
class RiggedModel:
    vertices: np.ndarray  # (n, 3), in the pose in which the nodes stand
    triangles: np.ndarray  # (m, 3)
    weights: np.ndarray  # (n, joints), rows sum to what the file says
    names: list  # of joints, as the file has them
    parents: np.ndarray  # of joints; -1: none
    joints: np.ndarray  # (joints, 3)


class _Gltf:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        self.chunk = b""
        if data[:4] == b"glTF":
            at, document = 12, None
            while at + 8 <= len(data):
                size, kind = struct.unpack_from("<II", data, at)
                if kind == 0x4E4F534A:
                    document = data[at + 8 : at + 8 + size]
                elif kind == 0x004E4942:
                    self.chunk = data[at + 8 : at + 8 + size]
                at += 8 + size
            data = document
        self.json = json.loads(data)
        self.buffers = [self._buffer(entry, path) for entry in self.json.get("buffers", [])]
        self.nodes = self.json.get("nodes", [])
        self.parents = [-1] * len(self.nodes)
        for index, node in enumerate(self.nodes):
            for child in node.get("children", []):
                self.parents[child] = index
        self.world = [None] * len(self.nodes)
        for index in range(len(self.nodes)):
            self._world(index)

    def _buffer(self, entry, path):
        uri = entry.get("uri")
        if uri is None:
            return self.chunk
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        with open(os.path.join(os.path.dirname(path), os.path.basename(urllib.parse.unquote(uri))), "rb") as file:
            return file.read()

    def _world(self, index):
        chain = []
        while index >= 0 and self.world[index] is None:
            chain.append(index)
            index = self.parents[index]
        for node in reversed(chain):
            local, parent = _local_matrix(self.nodes[node]), self.parents[node]
            self.world[node] = local if parent < 0 else self.world[parent] @ local

    def accessor(self, index):
        """(count, width) floats; whole numbers stay whole unless they are normalised."""
        entry = self.json["accessors"][index]
        width, kind = _WIDTHS[entry["type"]], np.dtype(_COMPONENTS[entry["componentType"]])
        view = self.json["bufferViews"][entry["bufferView"]]
        start = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
        stride = view.get("byteStride", kind.itemsize * width)
        data = np.ndarray((entry["count"], width), kind, self.buffers[view["buffer"]], start, (stride, kind.itemsize))
        if kind.kind == "f":
            return data.astype(float)
        if entry.get("normalized"):
            return np.maximum(data / float(np.iinfo(kind).max), -1.0)
        return data.astype(np.int64)

    def is_plain(self):
        sparse = any("sparse" in entry or "bufferView" not in entry for entry in self.json.get("accessors", []))
        compressed = any("compression" in name for name in self.json.get("extensionsRequired", []))
        return not sparse and not compressed


def _local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1]), float)
    length = max(x * x + y * y + z * z + w * w, 1e-30)
    s = 2 / length
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([
        [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
    ]) * np.array(node.get("scale", [1, 1, 1]), float)
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


def _plain(path, limber):
    if path.lower().endswith((".glb", ".gltf", ".vrm")):
        gltf = _Gltf(path)
        if gltf.is_plain():
            return gltf
    with tempfile.TemporaryDirectory() as folder:
        converted = os.path.join(folder, "plain.glb")
        subprocess.run([limber, "convert", path, "-o", converted, "-q"], check=True, capture_output=True, timeout=300)
        return _Gltf(converted)


def _triangles(gltf, primitive, vertex_count):
    index = gltf.accessor(primitive["indices"])[:, 0] if "indices" in primitive else np.arange(vertex_count)
    mode = primitive.get("mode", 4)
    if mode == 4:
        return index[: len(index) // 3 * 3].reshape(-1, 3)
    if mode == 5:
        strip = np.stack([index[:-2], index[1:-1], index[2:]], 1)
        strip[1::2] = strip[1::2, [1, 0, 2]]
        return strip
    if mode == 6:
        return np.stack([np.full(len(index) - 2, index[0]), index[1:-1], index[2:]], 1)
    return np.zeros((0, 3), np.int64)


def read_rigged(path, limber):
    """The model of a file that has a skin; raises ValueError where it has none."""
    gltf = _plain(path, limber)
    skins = gltf.json.get("skins", [])
    nodes = list(dict.fromkeys(joint for skin in skins for joint in skin["joints"]))
    if not nodes:
        raise ValueError("has no skin")
    column = {node: k for k, node in enumerate(nodes)}

    def joint_above(node):
        while node >= 0 and node not in column:
            node = gltf.parents[node]
        return column[node] if node >= 0 else -1

    vertices, triangles, weights, start = [], [], [], 0
    for index, node in enumerate(gltf.nodes):
        if "mesh" not in node:
            continue
        first_of = {}
        for primitive in gltf.json["meshes"][node["mesh"]]["primitives"]:
            attributes = primitive["attributes"]
            key = attributes["POSITION"]
            if key not in first_of:
                points = gltf.accessor(key)
                weight, matrices = _binding(gltf, index, node, attributes, len(points), column, joint_above)
                if weight is None:
                    continue
                blended = np.einsum("nj,jab->nab", weight / np.maximum(weight.sum(1, keepdims=True), 1e-12), matrices)
                points = np.einsum("nab,nb->na", blended[:, :3, :3], points) + blended[:, :3, 3]
                first_of[key] = start
                vertices.append(points)
                weights.append(weight)
                start += len(points)
            triangles.append(_triangles(gltf, primitive, gltf.json["accessors"][key]["count"]) + first_of[key])
    if not vertices:
        raise ValueError("has no skinned surface")
    return RiggedModel(
        np.concatenate(vertices), np.concatenate(triangles).astype(np.int64), np.concatenate(weights),
        [gltf.nodes[node].get("name", f"node{node}") for node in nodes],
        np.array([joint_above(gltf.parents[node]) for node in nodes]),
        np.array([gltf.world[node][:3, 3] for node in nodes]),
    )


def _binding(gltf, index, node, attributes, count, column, joint_above):
    """Weights (count, joints), and for each joint the matrix from the mesh as stored to the world; None: not bound."""
    weight, matrices = np.zeros((count, len(column))), np.zeros((len(column), 4, 4))
    if "skin" not in node:
        joint = joint_above(index)
        if joint < 0:
            return None, None
        weight[:, joint] = 1
        matrices[joint] = gltf.world[index]
        return weight, matrices
    skin = gltf.json["skins"][node["skin"]]
    joints = skin["joints"]
    inverse = np.tile(np.eye(4), (len(joints), 1, 1))
    if "inverseBindMatrices" in skin:
        inverse = gltf.accessor(skin["inverseBindMatrices"])[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1)
    columns = np.array([column[joint] for joint in joints])
    for joint, matrix in zip(joints, inverse):
        matrices[column[joint]] = gltf.world[joint] @ matrix
    rows, group = np.arange(count), 0
    while f"JOINTS_{group}" in attributes:
        index_of, value = gltf.accessor(attributes[f"JOINTS_{group}"]), gltf.accessor(attributes[f"WEIGHTS_{group}"])
        value = np.where(np.isfinite(value), value, 0)
        for k in range(4):
            np.add.at(weight, (rows, columns[np.clip(index_of[:, k], 0, len(joints) - 1)]), value[:, k])
        group += 1
    return weight, matrices

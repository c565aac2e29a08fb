"""A prepared body in memory: its points, what moves them, and what is to be said of it."""
import glob
import os
from functools import cached_property

import numpy as np

import samples
import vocabulary as words

STIFF_PARTS = ("other", "prop", "head")  # whose joints have no rotation of their own, unless they have a role
# Names of arrays in files of bodies made by code, and ours.
OTHER_NAMES = {"P": "points", "N": "normals", "wi": "weight_joint", "wv": "weight", "J": "joints",
               "label": "joint_part", "count": "counted", "rj": "role_joints", "rt": "role_fraction", "piece": "pieces"}


class Body:
    """Points (n, 3) with normals, pieces, part (n,) and bone (n,); active joints, which rotate in a pose, parents
    first; each point's weights over them; roles, joints and bones, each attached to an active joint."""

    def __init__(self, arrays):
        a = _complete(arrays)
        self.name, self.maker, self.source = str(a["name"]), str(a["maker"]), str(a["source"])
        self.licence, self.report_only = str(a["licence"]), bool(a["report_only"])
        self.plan, self.fingers = int(a["plan"]), a["fingers"].astype(int)
        self.side, self.height = float(a["side"]), float(a["height"])
        self.all_points, self.all_normals, self.all_pieces = a["points"], a["normals"], a["pieces"]
        pool = slice(0, len(a["weight"]))
        self.points, self.normals, self.pieces = a["points"][pool], a["normals"][pool], a["pieces"][pool]
        self.joints, self.bone_ends, self.counted = a["joints"], a["bone_ends"], a["counted"].astype(bool)
        role_joints, fraction = a["role_joints"].astype(int), a["role_fraction"][:, None]
        self.has = role_joints[:, 0] >= 0
        self.roles = (1 - fraction) * self.joints[role_joints[:, 0]] + fraction * self.joints[role_joints[:, 1]]
        self.roles[~self.has] = 0
        self._find_fingers(a["parents"].astype(int), role_joints)
        self._choose_active(a["parents"].astype(int), a["joint_part"].astype(int), role_joints)
        self.role_fraction = fraction
        self.role_first, self.role_second = self.of[role_joints].T
        self._spread_weights(a["weight_joint"].astype(int), a["weight"], a["joint_part"].astype(int))

    def _find_fingers(self, parents, role_joints):
        """side -> (joints,) whether the joint is one of a finger."""
        self.finger = {side: np.zeros(len(parents), bool) for side in words.SIDES}
        for role, joint in zip(words.ROLES, role_joints[:, 0]):
            if role.startswith("finger") and joint >= 0:
                self.finger[role[-2:]][joint] = True
        for is_finger in self.finger.values():
            for joint in range(len(parents)):
                above = joint
                while above >= 0 and not is_finger[above]:
                    above = parents[above]
                is_finger[joint] = above >= 0

    def _choose_active(self, parents, joint_part, role_joints):
        stiff = np.isin(joint_part, [words.PART[part] for part in STIFF_PARTS])
        active = ~stiff | (parents < 0)
        active[role_joints[role_joints >= 0]] = True
        children = [[] for _ in parents]
        for joint, parent in enumerate(parents):
            if parent >= 0:
                children[parent].append(joint)
        order, stack, nearest = [], list(np.flatnonzero(parents < 0)[::-1]), np.zeros(len(parents), int)
        while stack:
            joint = stack.pop()
            nearest[joint] = joint if active[joint] else nearest[parents[joint]]
            if active[joint]:
                order.append(joint)
            stack += children[joint]
        index = {joint: k for k, joint in enumerate(order)}
        self.of = np.array([index[joint] for joint in nearest])  # the active joint that moves each joint
        self.active = self.joints[order]
        self.active_parent = np.array([self.of[parents[joint]] if parents[joint] >= 0 else -1 for joint in order])
        self.active_part = [words.PARTS[joint_part[joint]] for joint in order]
        direction = self.bone_ends[order] - self.active
        self.direction = direction / np.maximum(np.linalg.norm(direction, axis=1, keepdims=True), 1e-9)
        hands = {}
        for role, joint in zip(words.ROLES, role_joints[:, 0]):
            if role.startswith("finger") and joint >= 0:
                hands.setdefault(role[-2:], []).append((role, joint))
        self.curl_axis = np.zeros_like(self.active)  # of finger joints: across the hand
        for entries in hands.values():
            bases = sorted((role, joint) for role, joint in entries if "_0." in role)
            across = self.joints[bases[-1][1]] - self.joints[bases[0][1]] if len(bases) > 1 else np.zeros(3)
            for _, joint in entries:
                self.curl_axis[index[joint]] = across / max(np.linalg.norm(across), 1e-9)

    def _spread_weights(self, joint, weight, joint_part):
        rows = np.arange(len(weight))
        self.weights = np.zeros((len(weight), len(self.active)), "f4")
        part = np.zeros((len(weight), len(words.PARTS)), "f4")
        for k in range(weight.shape[1]):
            np.add.at(self.weights, (rows, self.of[joint[:, k]]), weight[:, k])
            np.add.at(part, (rows, joint_part[joint[:, k]]), weight[:, k])
        self.part = part.argmax(1)
        self.bone = joint[:, 0]

    @cached_property
    def head_size(self):
        """Diagonal of the head's box, of the diagonal of the body's."""
        head = self.points[self.part == words.PART["head"]]
        diagonal = lambda points: float(np.linalg.norm(np.ptp(points, axis=0)))
        return diagonal(head) / diagonal(self.points) if len(head) else 0.0

    @cached_property
    def flesh(self):
        """Radius of the largest ball inside at each point of the pool, roughly."""
        return samples.inner_radii(self.points, self.normals, self.points[::3])

    def tokens(self):
        """As the program reads the body: inputs, centre, scale, and the index of each token among the points."""
        chosen, inputs, centre, scale = samples.tokens_of(self.all_points, self.all_normals, self.all_pieces)
        return inputs, centre, scale, chosen


def _complete(arrays):
    """All arrays by our names; what a file does not say is unknown."""
    a = {OTHER_NAMES.get(name, name): arrays[name] for name in arrays}
    if len(a["role_joints"]) != len(words.ROLES) or "roles" in a:
        names = [str(name) for name in a["roles"]] if "roles" in a else words.ROLES[: len(a["role_joints"])]
        known = [k for k, name in enumerate(names) if name in words.ROLE]
        rows = [words.ROLE[names[k]] for k in known]
        for name, nothing in (("role_joints", -1), ("role_fraction", 0)):
            whole = np.full((len(words.ROLES), *a[name].shape[1:]), nothing, a[name].dtype)
            whole[rows] = a[name][known]
            a[name] = whole
    a.setdefault("pieces", np.ones(len(a["points"]), "f4"))
    a.setdefault("fingers", np.full(2, words.UNKNOWN))
    for name in ("name", "source", "maker", "licence"):
        a.setdefault(name, "")
    a.setdefault("report_only", False)
    extent = np.ptp(a["points"], axis=0)
    a.setdefault("side", extent.max())
    a.setdefault("height", extent[1])
    if "bone_ends" not in a:
        from labels import bone_ends

        reach = np.full(len(a["joints"]), 0.05 * a["side"])
        a["bone_ends"] = bone_ends(a["joints"], a["parents"], a["joint_part"], reach)
        if "bone" in a:  # given by point
            a["bone_ends"][a["own"]] = a["bone"][:, 3:]
    return a


def load_body(path, maker=None):
    with np.load(path, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    if "name" not in arrays:
        arrays["name"] = os.path.splitext(os.path.basename(path))[0]
    if maker and not arrays.get("maker"):
        arrays["maker"] = maker
    return Body(arrays)


def load_bodies(folder, maker=None):
    """All bodies of a folder, by name; empty where there is none."""
    return [load_body(path, maker) for path in sorted(glob.glob(os.path.join(folder, "*.npz")))] if folder else []

"""Labels of a body: limber's anatomy (or labels set by hand) turned into roles, parts, plan, fingers and bones.

Hand labels are read from the project's docs/data/body_labels.json and from labels/*.json beside this file: objects, or
lists of objects, with `file` (below the data's folder), `up`, `front` and `parts` as `limber info --json` writes them;
three more keys are optional: `plan` (one of the plans, where the few joints do not say it), `positions` (joint -> where
it should be, in the file's space) and `drop` (true: no truth at all). An entry without parts adds to an earlier one of
the same file, one with parts replaces it.
"""
import glob
import json
import os
import subprocess
from dataclasses import dataclass, field

import numpy as np

import vocabulary as words

HERE = os.path.dirname(os.path.abspath(__file__))
REPOSITORY = os.path.dirname(os.path.dirname(HERE))
BODY_KINDS = ("trunk", "neck", "head", "tail", "leg", "arm", "wing", "fin")  # whose joints J2J counts
LANDMARKS = ("upper", "middle", "hock", "end", "toes")
CENTRE_PARTS = {"neck": "neck", "head": "head", "jaw": "head", "eye": "head", "hair": "head", "prop": "prop"}


@dataclass
class Anatomy:
    """What is known of a body: its own axes in the file's frame, and its parts by the names of joints."""

    parts: list
    up: np.ndarray
    front: np.ndarray
    confidence: float
    by_hand: bool
    plan: str = None
    drop: bool = False
    moved: dict = field(default_factory=dict)  # joints that are not where they should be: name -> position
    positions: dict = field(default_factory=dict)  # of joints by limber's names; empty where labels are by hand


@dataclass
class Labels:
    role_joints: np.ndarray  # (roles, 2): a role lies between two joints; -1: the body has none
    role_fraction: np.ndarray  # (roles,): 0 at the first joint
    joint_part: np.ndarray  # (joints,) index into PARTS
    counted: np.ndarray  # (joints,) which joints J2J counts
    parents: np.ndarray  # (joints,): as the file has them, or along the labelled chains of a flat rig
    fingers: np.ndarray  # (2,): left, right
    plan: str


def hand_labels(folders=()):
    """file -> label, of the project's own and of further folders; later ones replace earlier ones."""
    files = [os.path.join(REPOSITORY, "docs", "data", "body_labels.json")]
    for folder in (os.path.join(HERE, "labels"), *folders):
        files += sorted(glob.glob(os.path.join(folder, "*.json")))
    labels = {}
    for path in files:
        if not os.path.exists(path):
            continue
        with open(path, encoding="utf-8") as file:
            entries = json.load(file)
        for entry in entries.values() if isinstance(entries, dict) and "file" not in entries else \
                entries if isinstance(entries, list) else [entries]:
            before = {} if entry.get("parts") else labels.get(entry["file"], {})
            labels[entry["file"]] = {**before, **entry}
    return labels


def anatomy_of(path, file, limber, by_hand):
    """The labels set by hand where the file has some with parts, else what limber reads."""
    label = by_hand.get(file, {})
    extra = {"plan": label.get("plan"), "drop": bool(label.get("drop")), "moved": label.get("positions", {})}
    if extra["drop"]:
        return Anatomy([], None, None, 1.0, True, **extra)
    axes = lambda said: (np.array(said["up"], float), np.array(said["front"], float))
    if label.get("parts"):
        return Anatomy(label["parts"], *axes(label), 1.0, True, **extra)
    said = subprocess.run([limber, "info", path, "--json"], capture_output=True, timeout=600, check=True)
    info = json.loads(said.stdout)
    read = info.get("anatomy")
    if not read:
        raise ValueError("limber reads no anatomy")
    positions = dict(zip(info["joint_names"], (np.array(p, float) for p in info["joint_positions"])))
    return Anatomy(read["parts"], *axes(read), read["confidence"], False, positions=positions, **extra)


def limber_names(names, joints, positions):
    """The file's joints as limber calls them: of equal names the second is name_2, told apart by position if given."""
    taken, result, seen = set(), [], {}
    for name, joint in zip(names, joints):
        seen[name] = seen.get(name, 0) + 1
        expected = name if seen[name] == 1 else f"{name}_{seen[name]}"
        options = [n for n in positions if n not in taken and (n == name or n.startswith(name + "_"))]
        if names.count(name) > 1 and options:  # of joints at one position the expected one
            expected = min(options, key=lambda n: (np.linalg.norm(positions[n] - joint).round(6), n != expected))
        taken.add(expected)
        result.append(expected)
    return result


def along(joints, chain, count):
    """`count` positions at equal fractions of a chain's length, as (joint, next joint, fraction)."""
    if len(chain) == 1:
        return [(chain[0], chain[0], 0.0)]
    lengths = np.linalg.norm(np.diff(joints[chain], axis=0), axis=1) + 1e-9
    ends = np.r_[0, np.cumsum(lengths)] / lengths.sum()
    result = []
    for wanted in np.linspace(0, 1, count):
        k = int(np.clip(np.searchsorted(ends, wanted) - 1, 0, len(lengths) - 1))
        result.append((chain[k], chain[k + 1], float((wanted - ends[k]) / (ends[k + 1] - ends[k]))))
    return result


def _limb_role(part, leg_pairs, has_arms):
    """fore, hind, mida, midb, midc of a leg or an arm; None for further ones."""
    if part["kind"] == "arm":
        return "fore" if part["pair"] == 0 else None
    if part["pair"] == leg_pairs - 1:
        return "hind"
    k = part["pair"] + (0 if has_arms else -1)
    return "fore" if k < 0 else ("mida", "midb", "midc")[k] if k < 3 else None


class PartReader:
    """Fills the labels part by part."""

    def __init__(self, parts, names, joints, parents):
        self.parts, self.joints = parts, joints
        self.at = {name: index for index, name in enumerate(names)}
        self.names = names
        self.role, self.fingers = {}, [0, 0]
        self.joint_part = np.zeros(len(names), int)
        self.counted = np.zeros(len(names), bool)
        self.parents = np.array(parents)
        self.leg_pairs = len({part["pair"] for part in parts if part["kind"] == "leg"})
        self.has_arms = any(part["kind"] == "arm" for part in parts)

    def put(self, role, where):
        if role in words.ROLE:
            self.role[role] = where if isinstance(where, tuple) else (where, where, 0.0)

    def read(self):
        for part in self.parts:
            chain = [self.at[name] for name in part["joints"] if name in self.at]
            if chain:
                self.read_part(part, chain, {"left": ".L", "right": ".R"}.get(part["side"], ""))

    def read_part(self, part, chain, side):
        kind, pair = part["kind"], part["pair"]
        if kind in BODY_KINDS:
            self.counted[chain] = True
        if kind == "trunk" or (kind == "tail" and not side):
            for index, where in enumerate(along(self.joints, chain, 4)):
                self.put(f"{kind}_{index}", where)
            self.joint_part[chain] = words.PART[kind]
        elif kind in CENTRE_PARTS:
            if kind in ("neck", "head", "jaw") and pair == 0 and not (kind == "jaw" and side):
                self.put(kind, chain[0])
            self.joint_part[chain] = words.PART[CENTRE_PARTS[kind]]
        elif not side:
            return
        elif kind == "finger":
            self.read_finger(part, chain, side)
        elif kind in ("leg", "arm"):
            self.read_limb(part, chain, side)
        elif kind in ("ear", "wing", "fin"):
            self.joint_part[chain] = words.PART[kind + side]
            if kind == "ear" and pair == 0:
                self.put("ear" + side, chain[0])
            elif kind == "wing" and pair == 0:
                for index, where in enumerate(along(self.joints, chain, 3)):
                    self.put(f"wing_{index}{side}", where)
            elif kind == "fin" and pair < 2:
                self.put(f"fin{pair}_0{side}", chain[0])
                if pair == 0 and len(chain) > 1:
                    self.put("fin0_1" + side, chain[-1])

    def read_finger(self, part, chain, side):
        if not self.has_arms:  # the rays of a wing
            self.joint_part[chain] = words.PART["wing" + side]
            return
        self.joint_part[chain] = words.PART["fore_end" + side]
        self.fingers[side == ".R"] = max(self.fingers[side == ".R"], min(part["pair"] + 1, words.FINGERS))
        inside_palm = len(chain) > words.FINGER_JOINTS and "meta" in self.names[chain[0]].lower()
        for index, joint in enumerate(chain[inside_palm:][: words.FINGER_JOINTS]):
            self.put(f"finger_{part['pair'] + 1}_{index}{side}", joint)

    def read_limb(self, part, chain, side):
        role = _limb_role(part, self.leg_pairs, self.has_arms)
        landmark = {mark: self.at[part[mark]] for mark in LANDMARKS if part.get(mark) in self.at}
        if role is None or role.startswith("mid"):
            self.joint_part[chain] = words.PART["mid" + side]
            for mark in ("upper", "middle", "end"):
                if role and mark in landmark:
                    self.put(f"{role}_{mark}{side}", landmark[mark])
            return
        landmark.setdefault("upper", chain[0])
        for mark, joint in landmark.items():
            self.put(f"{role}_{mark}{side}", joint)
        if role == "fore" and chain[0] != landmark["upper"]:
            self.put("fore_base" + side, chain[0])
        segment = "trunk"
        for joint in chain:
            if joint == landmark["upper"]:
                segment = f"{role}_upper{side}"
            if joint in (landmark.get("middle"), landmark.get("hock")):
                segment = f"{role}_lower{side}"
            if joint in (landmark.get("end"), landmark.get("toes")):
                segment = f"{role}_end{side}"
            self.joint_part[joint] = words.PART[segment]

    def ancestors(self, joint):
        result = []
        while self.parents[joint] >= 0 and len(result) <= len(self.parents):
            joint = self.parents[joint]
            result.append(joint)
        return result

    def link_chains(self):
        """In a flat rig each joint is a child of the root: chains follow the labels instead, and start at the trunk."""
        chains = [[self.at[name] for name in part["joints"] if name in self.at] for part in self.parts]
        spine = [j for part, chain in zip(self.parts, chains) if part["kind"] == "trunk" for j in chain]
        neck = [j for part, chain in zip(self.parts, chains) if part["kind"] in ("neck", "head") for j in chain]
        for part, chain in zip(self.parts, chains):
            for before, joint in zip(chain, chain[1:]):
                self.adopt(joint, before)
            carrier = neck if part["kind"] in ("ear", "jaw", "eye", "hair") else spine
            if part.get("carrier") is not None and part["carrier"] < len(chains):
                carrier = chains[part["carrier"]]
            carrier = [j for j in carrier if j not in chain]
            if chain and carrier and part["kind"] != "trunk" and not set(self.ancestors(chain[0])) & set(spine + neck):
                self.adopt(chain[0], min(carrier, key=lambda j: np.linalg.norm(self.joints[j] - self.joints[chain[0]])))

    def adopt(self, joint, parent):
        above = self.ancestors(joint)
        if parent in above or joint == parent or joint in self.ancestors(parent):
            return
        self.parents[joint] = parent


def plan_of(parts, positions):
    """The plan that parts make; `positions` are of the roles that the body has."""
    pairs = lambda kind: len({p["pair"] for p in parts if p["kind"] == kind and p["side"] != "center"})
    legs, arms, wings, fins = (pairs(kind) for kind in ("leg", "arm", "wing", "fin"))
    ends = [positions[role] for role in ("trunk_0", "head", "neck", "trunk_3") if role in positions][:2]
    lean = 0.0  # 1: the trunk is upright, 0: it lies
    if len(ends) == 2:
        lean = float((ends[1] - ends[0])[1] / max(np.linalg.norm(ends[1] - ends[0]), 1e-9))
    if legs >= 3:
        return "many"
    if legs == 2:
        return "winged_four" if wings else "four"
    if legs == 1:
        if wings and not arms:
            return "bird"
        tail = any(p["kind"] == "tail" for p in parts)
        return "dinosaur" if tail and lean < 0.7 and not wings else "upright"
    if fins:
        return "swims"
    if arms:
        return "upright"
    if wings:
        return "bird"
    chain = sum(len(p["joints"]) for p in parts if p["kind"] in ("trunk", "tail", "neck"))
    return "crawls" if chain >= 5 else "none"


def read_labels(anatomy, names, joints, parents):
    """Labels of a body whose joints are given in its own frame."""
    reader = PartReader(anatomy.parts, names, joints, parents)
    reader.read()
    reader.link_chains()
    role_joints = np.full((len(words.ROLES), 2), -1)
    role_fraction = np.zeros(len(words.ROLES))
    for role, (first, second, fraction) in reader.role.items():
        role_joints[words.ROLE[role]] = first, second
        role_fraction[words.ROLE[role]] = fraction
    positions = {role: (1 - f) * joints[a] + f * joints[b] for role, (a, b, f) in reader.role.items()}
    plan = anatomy.plan or plan_of(anatomy.parts, positions)
    return Labels(role_joints, role_fraction, reader.joint_part, reader.counted, reader.parents,
                  np.array(reader.fingers), plan)


def bone_ends(joints, parents, joint_part, reach):
    """For each joint the end of its own bone: the child that goes on along its part, else the straightest; at a chain's
    end `reach` (joints,), how far what it moves goes on, along the direction of the bone above."""
    ends, children = joints.copy(), [[] for _ in parents]
    for joint, parent in enumerate(parents):
        if parent >= 0:
            children[parent].append(joint)
    for joint, parent in enumerate(parents):
        offsets = {c: joints[c] - joints[joint] for c in children[joint]}
        offsets = {c: offset for c, offset in offsets.items() if np.linalg.norm(offset) > 1e-9}
        before = joints[joint] - joints[parent] if parent >= 0 else None
        if offsets:
            same = [c for c in offsets if joint_part[c] == joint_part[joint] != words.PART["other"]] or list(offsets)
            trunk = [c for c in same if words.PARTS[joint_part[c]] in ("trunk", "neck", "head")]
            same = trunk or same
            straight = (lambda c: before @ offsets[c] / np.linalg.norm(offsets[c])) if before is not None else \
                (lambda c: np.linalg.norm(offsets[c]))
            ends[joint] = joints[max(same, key=straight)]
        elif before is not None and np.linalg.norm(before) > 1e-9:
            ends[joint] = joints[joint] + before / np.linalg.norm(before) * reach[joint]
    return ends

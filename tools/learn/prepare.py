"""Rigged files -> one .npz each: points of the surface with weights, and labels, in the body's own frame.

A body's own frame: +Y up, +Z front, +X its left. What is written (n = 4096 points, the first 1536 farthest first):

    points, normals (n, 3)   pieces (n,)             outward normals; the fraction of the area that the piece has
    weight_joint, weight (1536, 8)                   the strongest joints of a point, weights sum to 1
    joints, bone_ends (j, 3)   parents, joint_part, counted (j,)
    role_joints (roles, 2)   role_fraction (roles,)  as labels.Labels
    plan, fingers (2,)                               indices and numbers; -1: unknown
    axes (3, 3)                                      rows: the file's directions of left, up, front
    side, height, confidence, name, source, maker, licence, report_only, by_hand

Heads, hands, arms and legs of some files stand alone in files of their own, as bodies without a plan.
"""
import json
import os
import time
import zlib
from collections import Counter

import numpy as np
from scipy.spatial.transform import Rotation

import samples
import vocabulary as words
from labels import anatomy_of, bone_ends, hand_labels, limber_names, read_labels
from makers import sources
from rigged_file import read_rigged

INFLUENCES = 8
SPANNING_WEIGHT = 1 / 256  # a joint deforms the surface where a vertex has more weight than this of it


def _spanning(model, parents):
    """Joints that carry weight, and those on the paths between them."""
    carries = (model.weights > SPANNING_WEIGHT).any(0)
    below = carries.copy()
    for joint in np.flatnonzero(carries):
        for _ in range(len(parents)):
            joint = parents[joint]
            if joint < 0:
                break
            below[joint] = True
    return below


def _own_axes(anatomy):
    up = anatomy.up / np.linalg.norm(anatomy.up)
    front = anatomy.front - up * (anatomy.front @ up)
    front /= np.linalg.norm(front)
    return np.stack([np.cross(up, front), up, front])


def _reach(points, joints, parents, strongest):
    """How far beyond each joint its points go, along the bone above."""
    reach = np.zeros(len(joints))
    for joint, parent in enumerate(parents):
        along = joints[joint] - joints[parent] if parent >= 0 else np.zeros(3)
        length = np.linalg.norm(along)
        if length > 1e-9:
            beyond = (points[strongest == joint] - joints[joint]) @ along / length
            reach[joint] = max(float(beyond.max()), 0.0) if len(beyond) else 0.3 * length
    return reach


# Parts of bodies that stand alone, as heads, hands and busts' pieces do, and one in how many files gives each.
ALONE = {"head": (("head", "ear", "neck"), 3), "hand": (("fore_end.L",), 4), "arm": (("fore",), 8), "leg": (("hind",), 8)}
FEWEST_ALONE = 150  # triangles


def _alone(model, vertices, joint_part, arrays):
    """A part of the body by itself is no body: name of the part -> arrays, in any orientation."""
    seed = zlib.crc32(str(arrays["name"]).encode())
    random = np.random.RandomState(seed)
    part = joint_part[model.weights.argmax(1)]
    for number, (name, (parts, odds)) in enumerate(ALONE.items()):
        wanted = [k for k, other in enumerate(words.PARTS) if other.startswith(parts) and not other.endswith(".R")]
        triangles = model.triangles[np.isin(part[model.triangles], wanted).all(1)]
        turn = Rotation.random(random_state=random).as_matrix()
        if (seed >> number) % odds or len(triangles) < FEWEST_ALONE:
            continue
        points, normals, pieces, _, _ = samples.draw_points(vertices @ turn.T, triangles)
        order = samples.farthest_first(points, samples.POOL)
        order = np.r_[order, np.setdiff1d(np.arange(len(points)), order)]
        influences = np.zeros((samples.POOL, INFLUENCES), "f4")
        influences[:, 0] = 1
        extent = np.ptp(points, axis=0)
        yield name, {
            **arrays, "points": points[order].astype("f4"), "normals": normals[order].astype("f4"),
            "pieces": pieces[order].astype("f4"), "weight_joint": np.zeros((samples.POOL, INFLUENCES), "i2"),
            "weight": influences, "joints": points.mean(0, keepdims=True).astype("f4"),
            "bone_ends": points.mean(0, keepdims=True).astype("f4"), "parents": np.full(1, -1, "i2"),
            "joint_part": np.zeros(1, "i1"), "counted": np.zeros(1, bool),
            "role_joints": np.full((len(words.ROLES), 2), -1, "i2"),
            "role_fraction": np.zeros(len(words.ROLES), "f4"), "plan": words.PLAN["none"],
            "fingers": np.zeros(2, int), "axes": turn @ arrays["axes"], "side": float(extent.max()),
            "height": float(extent[1]), "name": f"{arrays['name']}__{name}_alone",
        }


def prepare_file(source, limber, by_hand):
    """The arrays of one file, and those of parts of it that stand alone; ValueError where there is no truth in it."""
    anatomy = anatomy_of(source.path, source.file, limber, by_hand)
    if anatomy.drop:
        raise ValueError("labelled as without truth")
    model = read_rigged(source.path, limber)
    axes = _own_axes(anatomy)
    names = limber_names(model.names, model.joints, anatomy.positions)
    for name, position in anatomy.moved.items():
        model.joints[names.index(name)] = position
    joints = model.joints @ axes.T
    labels = read_labels(anatomy, names, joints, model.parents)
    bound = (model.weights.sum(1) > 0)[model.triangles].all(1)
    vertices = model.vertices @ axes.T
    points, normals, pieces, corners, barycentric = samples.draw_points(vertices, model.triangles[bound])

    order = samples.farthest_first(points, samples.POOL)
    order = np.r_[order, np.setdiff1d(np.arange(len(points)), order)]
    points, normals, pieces, corners, barycentric = (x[order] for x in (points, normals, pieces, corners, barycentric))
    tokens = slice(0, samples.TOKENS)
    if samples.outward(points[tokens], normals[tokens], points)[2]:
        normals = -normals

    pool = slice(0, samples.POOL)
    weights = np.einsum("nk,nkj->nj", barycentric[pool], model.weights[corners[pool]])
    weights /= np.maximum(weights.sum(1, keepdims=True), 1e-9)
    strongest = np.argsort(-weights, 1, kind="stable")[:, :INFLUENCES]
    kept = np.take_along_axis(weights, strongest, 1)
    kept /= np.maximum(kept.sum(1, keepdims=True), 1e-9)
    reach = _reach(points[pool], joints, labels.parents, strongest[:, 0])
    ends = bone_ends(joints, labels.parents, labels.joint_part, reach)
    extent = np.ptp(vertices[np.unique(model.triangles)], axis=0)
    arrays = {
        "points": points.astype("f4"), "normals": normals.astype("f4"), "pieces": pieces.astype("f4"),
        "weight_joint": strongest.astype("i2"), "weight": kept.astype("f4"),
        "joints": joints.astype("f4"), "bone_ends": ends.astype("f4"), "parents": labels.parents.astype("i2"),
        "joint_part": labels.joint_part.astype("i1"), "counted": labels.counted & _spanning(model, labels.parents),
        "role_joints": labels.role_joints.astype("i2"), "role_fraction": labels.role_fraction.astype("f4"),
        "plan": words.PLAN[labels.plan], "fingers": labels.fingers, "axes": axes, "side": float(extent.max()),
        "height": float(extent[1]), "confidence": float(anatomy.confidence), "name": source.name, "source": source.file,
        "maker": source.maker, "licence": source.licence, "report_only": source.report_only, "by_hand": anatomy.by_hand,
    }
    return arrays, list(_alone(model, vertices, labels.joint_part, arrays))


def prepare(data, out, limber, label_folders=(), only="", limit=None, again=False):
    """Prepares every file that has no .npz yet (--again: all); a line for each goes into prepared.log."""
    os.makedirs(out, exist_ok=True)
    by_hand = hand_labels(label_folders)
    plans, failed, done = Counter(), {}, 0
    with open(os.path.join(out, "prepared.log"), "a", encoding="utf-8") as log:
        for source in sources(data):
            target = os.path.join(out, source.name + ".npz")
            if only not in source.file or (os.path.exists(target) and not again):
                continue
            if limit is not None and done >= limit:
                break
            done += 1
            started = time.time()
            try:
                arrays, alone = prepare_file(source, limber, by_hand)
                _save(target, arrays)
                for name, part in alone:
                    _save(target.removesuffix(".npz") + f"__{name}_alone.npz", part)
                plans[words.PLANS[arrays["plan"]]] += 1
                said = _summary(arrays)
            except Exception as error:  # one faulty file must not end the preparation of hundreds
                failed[source.file] = f"{type(error).__name__}: {error}"
                said = "LEFT OUT " + failed[source.file][:160]
            line = f"{source.file:56} {source.maker:12} {said}  ({time.time() - started:.1f} s)"
            print(line, flush=True)
            log.write(line + "\n")
            log.flush()
    print(f"{done - len(failed)} bodies prepared in {out}: {dict(plans)}; {len(failed)} left out")
    with open(os.path.join(out, "left_out.json"), "w", encoding="utf-8") as file:
        json.dump(failed, file, indent=1)


def _summary(a):
    roles = (a["role_joints"][:, 0] >= 0).sum()
    return (f"{words.PLANS[a['plan']]:11} confidence {a['confidence']:.2f}, roles {roles:2}, "
            f"fingers {a['fingers'].tolist()}, joints {a['counted'].sum()} of {len(a['joints'])}"
            f"{', labels by hand' if a['by_hand'] else ''}{', report only' if a['report_only'] else ''}")


def _save(target, arrays):
    part = target + ".part"
    with open(part, "wb") as file:
        np.savez_compressed(file, **arrays)
    os.replace(part, target)

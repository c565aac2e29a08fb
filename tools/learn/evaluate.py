"""What networks say of bodies that they were not trained on, measured: one row for each body.

J2J: mean distance from a joint to the nearest of the other skeleton, both directions, halved sum, without fingers;
named: between joints of one role. Both in % of the longest side of the body's box; fingers in % of its height.
tables.py makes tables of rows.
"""
import json
import os
import re

import numpy as np
from scipy.spatial import cKDTree

import reader
import vocabulary as words
from body import load_bodies
from makers import MADE_PEOPLE, stem_of

UNNAMED = ("ear", "jaw", "finger")  # roles that are no joints of J2J
NAMED = ["trunk_0", "neck", "head", "tail_0"] + [
    role + side for role in ("fore_upper", "fore_middle", "fore_end", "hind_upper", "hind_middle", "hind_end", "wing_0",
                             "mida_upper", "midb_upper", "midc_upper") for side in words.SIDES]
LIMBS = [[f"{limb}_{segment}{side}" for segment in ("upper", "middle", "end")]
         for limb in ("fore", "hind") for side in words.SIDES]
SAME_JOINT = 0.015  # of the longest side: roles closer than this are one joint
WRONG_JOINT = 0.05  # of the longest side: a joint further off is wrong
PEOPLE_MAKERS = ("rocketbox", "makehuman", "valid")  # all of whose upright bodies are people of ordinary proportions
PEOPLE_FILES = ("human_male", "human_female", "cesium", "manny", "kenney_human", "variation_human")
ROBOTS = r"robot|mech_|george$|leela$|stan$|enemy"  # in names of files


def group_of(body):
    plan = words.PLANS[body.plan]
    if plan != "none" and re.search(ROBOTS, os.path.splitext(os.path.basename(body.source))[0].lower()):
        return "robots"
    if plan == "upright":
        people = body.maker in PEOPLE_MAKERS or any(name in body.source for name in PEOPLE_FILES)
        return "people" if people else "toys"
    return "four" if plan == "four" else "none" if plan == "none" else "others"


def skeleton(said, side):
    """Joints of all roles that the body is said to have; of those nearly at one position one."""
    joints = []
    for role in np.flatnonzero(said["has"] > 0.5):
        position = said["y"][role]
        if words.ROLES[role].startswith(UNNAMED):
            continue
        if all(np.linalg.norm(position - joint) > SAME_JOINT * side for joint in joints):
            joints.append(position)
    return np.array(joints).reshape(-1, 3)


def joint_distance(joints, truth):
    if not len(joints) or not len(truth):
        return None
    return (cKDTree(truth).query(joints)[0].mean() + cKDTree(joints).query(truth)[0].mean()) / 2


def row_of(body, network, stance_network=None):
    """Everything that the tables need of one body, as plain numbers."""
    inputs, centre, scale, chosen = body.tokens()
    said = reader.read(network, inputs, centre, scale)
    error = np.linalg.norm(said["y"] - body.roles, axis=1)
    distance = joint_distance(skeleton(said, body.side), body.joints[body.counted])
    percent = lambda value: None if value is None else float(100 * value / body.side)
    named = [words.ROLE[name] for name in NAMED if body.has[words.ROLE[name]]]
    inside = chosen < len(body.part)
    finger_roles = [k for k, name in enumerate(words.ROLES) if name.startswith("finger") and body.has[k]]
    bones = np.concatenate([body.joints[body.bone], body.bone_ends[body.bone]], 1)[chosen[inside]]
    bone_error = (said["bone"][inside] + np.tile(body.all_points[chosen[inside]], 2) - bones).reshape(-1, 2, 3)
    present = np.flatnonzero(body.has)
    row = {
        "name": body.name, "stem": stem_of(body.source), "maker": body.maker, "report_only": body.report_only,
        "group": group_of(body), "plan": body.plan, "plan_logits": said["plan_logits"].tolist(),
        "j2j": percent(distance), "named": percent(error[named].mean()) if named else None,
        "roles": {words.ROLES[k]: percent(error[k]) for k in present},
        "has_wrong": float(((said["has"] > 0.5) != body.has).mean()),
        "part": float((said["part"][inside].argmax(1) == body.part[chosen[inside]]).mean()),
        "parts": _part_counts(said["part"][inside].argmax(1), body.part[chosen[inside]]),
        "bone": percent(np.linalg.norm(bone_error, axis=-1).mean()),
        "expected": [percent(said["sigma"][k]) for k in present], "error": [percent(error[k]) for k in present],
        "fingers": body.fingers.tolist(), "fingers_said": said["fingers"].argmax(1).tolist(),
        "finger_error": float(100 * error[finger_roles].mean() / body.height) if finger_roles else None,
        "pin": _after_pin(body, network, inputs, centre, scale, error),
    }
    if stance_network is not None and body.plan != words.PLAN["none"]:
        row["stance"] = _stance_right(stance_network, inputs)
    return row


def _part_counts(said, true):
    """Part, without its side -> tokens of it, tokens said to be of it, tokens of both; sides have to agree."""
    counts = {}
    for index, name in enumerate(words.PARTS):
        is_said, is_true = said == index, true == index
        some = np.array([is_true.sum(), is_said.sum(), (is_said & is_true).sum()])
        if some.any():
            part = name.removesuffix(".L").removesuffix(".R")
            counts[part] = (some + counts.get(part, 0)).tolist()
    return counts


def _stance_right(network, inputs):
    """Of four stances that the body is put in: how often the network finds it, and how often the direction of up."""
    right = up = 0
    tried = range(0, 24, 7)
    for k in tried:
        found = reader.read_stance(network, reader.turned_inputs(inputs, words.STANCES[k].T)).argmax()
        right += found == k
        up += np.abs(words.STANCES[found][1] - words.STANCES[k][1]).sum() < 0.5
    return {"right": right / len(tried), "up": up / len(tried)}


def _after_pin(body, network, inputs, centre, scale, error):
    """One pin at the worst joint of a wrong limb: is the whole limb right then? None where all limbs are right."""
    limbs = [[words.ROLE[name] for name in limb if body.has[words.ROLE[name]]] for limb in LIMBS]
    limbs = [limb for limb in limbs if len(limb) > 1 and error[limb].max() > WRONG_JOINT * body.side]
    if not limbs:
        return None
    limb = max(limbs, key=lambda roles: error[roles].max())
    pinned = max(limb, key=lambda role: error[role])
    said = reader.read(network, inputs, centre, scale, {pinned: body.roles[pinned]})
    after = np.linalg.norm(said["y"][limb] - body.roles[limb], axis=1)
    return bool(after.max() <= WRONG_JOINT * body.side)


def about_run(run):
    """What the run was asked for, its makers, licences and bodies."""
    with open(os.path.join(run, "run.json"), encoding="utf-8") as file:
        return json.load(file)


def judged_bodies(run, data):
    """Bodies that the run may be judged by: of makers left out, or to report only; without people made by code."""
    seen = about_run(run)["makers"]
    bodies = [b for b in load_bodies(data) if b.report_only or b.maker not in seen]
    return [b for b in bodies if not b.source.startswith(MADE_PEOPLE)]


def evaluate_run(run, data, stance_run=None, kept="rows.json", limit=0):
    """Rows of all bodies that the run may be judged by, kept in its folder."""
    from network import load_network

    network, saved = load_network(os.path.join(run, "state.pt"))
    stance = load_network(os.path.join(stance_run, "state.pt"))[0] if stance_run else None
    seen, samples = about_run(run)["makers"], saved["step"] * saved["batch"]
    rows = [{**row_of(body, network, stance), "maker_seen": body.maker in seen, "samples": samples}
            for body in judged_bodies(run, data)[: limit or None]]
    with open(os.path.join(run, kept), "w", encoding="utf-8") as file:
        json.dump(rows, file)
    return rows


def load_rows(runs, kept="rows.json"):
    rows = []
    for run in runs:
        with open(os.path.join(run, kept), encoding="utf-8") as file:
            rows += json.load(file)
    return rows


def confidence(row, temperature=1.0):
    return reader.softmax(np.array(row["plan_logits"]) / temperature)


def kind_right(row):
    return int(np.argmax(row["plan_logits"])) == row["plan"]

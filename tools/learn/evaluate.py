"""Tables of what networks say of makers that they were not trained on.

Each row is one body, read by a run whose makers did not include the body's. J2J: mean distance from a joint to the
nearest of the other skeleton, both directions, halved sum, without fingers; named: between joints of one role. Both in
% of the longest side of the body's box; fingers in % of its height. Files to report only are in tables of their own.
"""
import json
import os

import numpy as np
from scipy.spatial import cKDTree

import reader
import vocabulary as words
from body import load_bodies
from makers import MADE_PEOPLE

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
CONFIDENCES = (0, 0.5, 0.7, 0.8, 0.9, 1.01)


def group_of(body):
    plan = words.PLANS[body.plan]
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
        "name": body.name, "maker": body.maker, "report_only": body.report_only, "group": group_of(body),
        "plan": body.plan, "plan_logits": said["plan_logits"].tolist(), "j2j": percent(distance),
        "named": percent(error[named].mean()) if named else None,
        "roles": {words.ROLES[k]: percent(error[k]) for k in present},
        "has_wrong": float(((said["has"] > 0.5) != body.has).mean()),
        "part": float((said["part"][inside].argmax(1) == body.part[chosen[inside]]).mean()),
        "bone": percent(np.linalg.norm(bone_error, axis=-1).mean()),
        "expected": [percent(said["sigma"][k]) for k in present], "error": [percent(error[k]) for k in present],
        "fingers": body.fingers.tolist(), "fingers_said": said["fingers"].argmax(1).tolist(),
        "finger_error": float(100 * error[finger_roles].mean() / body.height) if finger_roles else None,
        "pin": _after_pin(body, network, inputs, centre, scale, error),
    }
    if stance_network is not None and body.plan != words.PLAN["none"]:
        row["stance"] = _stance_right(stance_network, inputs)
    return row


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


def evaluate_run(run, data, stance_run=None, kept="rows.json", limit=0):
    """Rows of all bodies that the run may be judged by (of makers left out, or to report only), kept in its folder."""
    from network import load_network

    network, _ = load_network(os.path.join(run, "state.pt"))
    stance = load_network(os.path.join(stance_run, "state.pt"))[0] if stance_run else None
    with open(os.path.join(run, "run.json"), encoding="utf-8") as file:
        seen = set(json.load(file)["makers"])
    bodies = [b for b in load_bodies(data) if b.report_only or b.maker not in seen]
    bodies = [b for b in bodies if not b.source.startswith(MADE_PEOPLE)]
    rows = [{**row_of(body, network, stance), "maker_seen": body.maker in seen} for body in bodies[: limit or None]]
    with open(os.path.join(run, kept), "w", encoding="utf-8") as file:
        json.dump(rows, file)
    return rows


def load_rows(runs, kept="rows.json"):
    rows = []
    for run in runs:
        with open(os.path.join(run, kept), encoding="utf-8") as file:
            rows += json.load(file)
    return rows


def _mean(values):
    values = [v for v in values if v is not None]
    return f"{np.mean(values):.1f}" if values else "-"


def _median(values):
    values = [v for v in values if v is not None]
    return f"{np.median(values):.1f}" if values else "-"


def confidence(row, temperature=1.0):
    return reader.softmax(np.array(row["plan_logits"]) / temperature)


def kind_right(row):
    return int(np.argmax(row["plan_logits"])) == row["plan"]


def table(rows, key, title):
    """One line for each value of `key`, as Markdown."""
    columns = ("files", "kind right, %", "J2J", "its median", "named", "roles wrong, %", "parts right, %", "bones",
               "front and up, %")
    lines = [f"| {title} | " + " | ".join(columns) + " |", "| --- |" + " --- |" * len(columns)]
    values = sorted({key(row) for row in rows})
    for value in values + (["all"] if len(values) > 1 else []):
        some = [row for row in rows if value == "all" or key(row) == value]
        cells = [len(some), _mean([100.0 * kind_right(r) for r in some]), _mean([r["j2j"] for r in some]),
                 _median([r["j2j"] for r in some]), _mean([r["named"] for r in some]),
                 _mean([100 * r["has_wrong"] for r in some]), _mean([100 * r["part"] for r in some]),
                 _mean([r["bone"] for r in some]), _mean([100 * r["stance"]["right"] for r in some if "stance" in r])]
        lines.append(f"| {value} | " + " | ".join(map(str, cells)) + " |")
    return "\n".join(lines)


def confusion(rows):
    """What was said, by plan."""
    count = np.zeros((len(words.PLANS),) * 2, int)
    for row in rows:
        count[row["plan"], int(np.argmax(row["plan_logits"]))] += 1
    lines = ["| plan \\ said | " + " | ".join(words.PLANS) + " |", "| --- |" + " --- |" * len(words.PLANS)]
    for plan, line in zip(words.PLANS, count):
        if line.any():
            lines.append(f"| {plan} | " + " | ".join(map(str, line)) + " |")
    return "\n".join(lines)


def calibration_tables(rows, temperature=1.0, error_factor=1.0):
    lines = ["| confidence | kind right |", "| --- | --- |"]
    for low, high in zip(CONFIDENCES, CONFIDENCES[1:]):
        some = [kind_right(row) for row in rows if low <= confidence(row, temperature).max() < high]
        lines.append(f"| {low} to {min(high, 1)} | {sum(some)} of {len(some)} |")
    expected = error_factor * np.concatenate([row["expected"] for row in rows] or [[]])
    error = np.concatenate([row["error"] for row in rows] or [[]])
    lines += ["", "| expected error, % of the longest side | true error |", "| --- | --- |"]
    for fifth in np.array_split(np.argsort(expected, kind="stable"), 5):
        if len(fifth):
            lines.append(f"| {expected[fifth].mean():.1f} | {error[fifth].mean():.1f} |")
    return "\n".join(lines)


def other_figures(rows):
    hands = [(t, s) for row in rows for t, s in zip(row["fingers"], row["fingers_said"]) if t > 0]
    pins = [row["pin"] for row in rows if row["pin"] is not None]
    percent_of = lambda hits: f"{100 * np.mean(hits):.0f} % of {len(hits)}" if hits else "-"
    return (f"fingers: number right on {percent_of([t == s for t, s in hands])} hands with fingers; their joints "
            f"{_mean([row['finger_error'] for row in rows])} % of the height. "
            f"One pin at a wrong limb makes the whole limb right in {percent_of(pins)}.")


def report(rows, calibration=None):
    """All tables as Markdown: makers left out, then files to report only, by whether their makers were left out."""
    calibration = calibration or {}
    t, f = calibration.get("plan_temperature", 1.0), calibration.get("error_factor", 1.0)
    reported = [row for row in rows if row["report_only"]]
    sections = {"Makers left out": [row for row in rows if not row["report_only"]],
                "Files to report only, makers left out": [row for row in reported if not row["maker_seen"]],
                "Files to report only, makers seen in training": [row for row in reported if row["maker_seen"]]}
    parts = []
    for title, some in sections.items():
        if some:
            parts += [f"## {title}", table(some, lambda r: r["group"], "group"),
                      table(some, lambda r: words.PLANS[r["plan"]], "plan"), table(some, lambda r: r["maker"], "maker"),
                      confusion(some), calibration_tables(some, t, f), other_figures(some)]
    return "\n\n".join(parts) + "\n"

#!/usr/bin/python3
"""Checks labels set by hand against the rigs that they are for, and prints what is doubtful.

    check_labels.py [LABELS.json] --data ../shared/data --limber PROGRAM [--only TEXT]

A label is wrong (and the exit status 1) where a joint does not exist, is in two parts, or a key has no known value. It
is doubtful where the joints of a pair are not each other's mirror image, a side is on the other side, a foot is not
below its hip or is far above the lowest point, the head is neither in front of the trunk nor above it, pairs of legs
are not listed from the front to the back, or a joint has no label.
"""
import argparse
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
KINDS = ("trunk", "neck", "head", "jaw", "eye", "ear", "hair", "tail", "leg", "arm", "finger", "wing", "fin", "prop",
         "attachment")
PLANS = ("upright", "four", "bird", "dinosaur", "many", "swims", "crawls", "winged_four", "none")
SIDES = ("left", "right", "center")
LANDMARKS = ("upper", "middle", "hock", "end", "toes")
UNPAIRED = ("prop", "attachment", "hair")  # may be on one side alone
MIRROR_TOLERANCE = 0.06  # of the longest side of the box
FOOT_TOLERANCE = 0.25  # of the height above the lowest point


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class Rig:
    """Joints by limber's names in the body's own frame (left, up, front), and the box of the surface in it."""

    def __init__(self, info, label):
        up, front = label["up"], label["front"]
        axes = (cross(up, front), up, front)
        to_body = lambda p: [dot(axis, p) for axis in axes]
        self.stored = dict(zip(info["joint_names"], map(to_body, info["joint_positions"])))
        self.joints = {**self.stored, **{name: to_body(p) for name, p in label.get("positions", {}).items()}}
        low, high = (to_body(info["bounds"][end]) for end in ("min", "max"))
        self.low, self.high = list(map(min, low, high)), list(map(max, low, high))
        self.size = max(h - l for l, h in zip(self.low, self.high))


def wrong_keys(label, rig):
    seen = {}
    if label.get("plan") not in PLANS:
        yield f"plan {label.get('plan')} is none of {', '.join(PLANS)}"
    for part in label["parts"]:
        if part["kind"] not in KINDS or part["side"] not in SIDES:
            yield f"unknown part {part['kind']} {part['side']}"
        for mark in LANDMARKS:
            if mark in part and part[mark] not in part["joints"]:
                yield f"{mark} {part[mark]} is not a joint of its {part['kind']}"
        for name in part["joints"]:
            if name not in rig.joints:
                yield f"no joint {name}"
            if name in seen:
                yield f"{name} is in {seen[name]} and in {part['kind']}"
            seen[name] = part["kind"]
    for name in label.get("positions", {}):
        if name not in seen:
            yield f"a position for {name}, which is in no part"


def middle_of(rig, parts):
    """Where the plane of symmetry crosses the left axis: median of the middles of pairs, else of the centred joints."""
    first = {(part["kind"], part["pair"], part["side"]): rig.joints[part["joints"][0]][0] for part in parts}
    middles = [(x + first[kind, pair, "right"]) / 2 for (kind, pair, side), x in first.items()
               if side == "left" and (kind, pair, "right") in first and kind not in UNPAIRED]
    if not middles:
        middles = [rig.joints[name][0] for part in parts if part["side"] == "center" for name in part["joints"]]
    return sorted(middles)[len(middles) // 2] if middles else (rig.low[0] + rig.high[0]) / 2


def doubtful_pairs(rig, parts, middle):
    for left in parts:
        if left["side"] != "left" or left["kind"] in UNPAIRED:
            continue
        right = [p for p in parts if p["side"] == "right" and (p["kind"], p["pair"]) == (left["kind"], left["pair"])]
        if not right or len(right[0]["joints"]) != len(left["joints"]):
            yield f"{left['kind']} {left['pair']} has no like on the right"
            continue
        for a, b in zip(left["joints"], right[0]["joints"]):
            p, q = rig.joints[a], rig.joints[b]
            error = max(abs(p[0] + q[0] - 2 * middle), abs(p[1] - q[1]), abs(p[2] - q[2])) / rig.size
            if error > MIRROR_TOLERANCE:
                yield f"{left['kind']} {left['pair']}: {a} and {b} are no mirror images, {100 * error:.0f} % off"
            if p[0] < q[0] - 0.01 * rig.size:
                yield f"{left['kind']} {left['pair']}: {a} of the left is to the right of {b}"


def doubtful_legs(rig, label):
    legs = [part for part in label["parts"] if part["kind"] == "leg"]
    height = rig.high[1] - rig.low[1]
    for leg in legs:
        if leg.get("end") and label["plan"] != "many":
            above = (rig.joints[leg["end"]][1] - rig.low[1]) / height
            if above > FOOT_TOLERANCE:
                yield f"{leg['side']} foot {leg['end']} is {100 * above:.0f} % of the height above the lowest point"
            if rig.joints[leg["end"]][1] > rig.joints[leg["joints"][0]][1]:
                yield f"{leg['side']} foot {leg['end']} is above its hip"
    in_order = sorted(legs, key=lambda leg: leg["pair"])
    for side in ("left", "right"):
        fronts = [rig.joints[leg["joints"][0]][2] for leg in in_order if leg["side"] == side]
        if any(b > a + 0.02 * rig.size for a, b in zip(fronts, fronts[1:])):
            yield f"legs of the {side} are not listed from front to back"


def doubtful_axis(rig, parts):
    first = {part["kind"]: rig.joints[part["joints"][0]] for part in reversed(parts) if part["side"] == "center"}
    if "trunk" not in first:
        yield "no trunk"
    if "head" in first and "trunk" in first:
        step = [h - t for h, t in zip(first["head"], first["trunk"])]
        if max(step[1], step[2]) < 0.02 * rig.size:
            yield "the head is neither in front of the trunk nor above it"
    if "tail" in first and "trunk" in first and first["tail"][2] > first["trunk"][2] + 0.1 * rig.size:
        yield "the tail is in front of the trunk"


def check(label, info):
    """Lists of what is wrong and of what is doubtful."""
    rig = Rig(info, label)
    wrong = list(wrong_keys(label, rig))
    if wrong:
        return wrong, []
    middle = middle_of(rig, label["parts"])
    doubts = [*doubtful_pairs(rig, label["parts"], middle), *doubtful_legs(rig, label)]
    doubts += doubtful_axis(rig, label["parts"])
    named = {name for part in label["parts"] for name in part["joints"]}
    rest = [name for name in rig.joints if name not in named and name != "ROOT"]
    if rest:
        doubts.append("without a label: " + ", ".join(rest))
    return wrong, doubts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("labels", nargs="?", default=os.path.join(HERE, "flat_rigs.json"))
    parser.add_argument("--data", required=True, help="the folder that the labels' `file` is below")
    parser.add_argument("--limber", required=True, help="the program limber")
    parser.add_argument("--only", default="", help="files whose name holds this text")
    options = parser.parse_args()
    with open(options.labels, encoding="utf-8") as file:
        labels = json.load(file)
    labels = [label for label in labels if options.only in label["file"]]
    wrong_files = doubtful_files = 0
    for label in labels:
        path = os.path.join(options.data, label["file"])
        if label.get("drop"):
            wrong, doubts = ([] if label.get("reason") else ["dropped without a reason"]), []
        else:
            command = [options.limber, "info", path, "--json"]
            said = subprocess.run(command, capture_output=True, timeout=600, check=True)
            wrong, doubts = check(label, json.loads(said.stdout))
        for text in wrong:
            print(f"{label['file']}: wrong: {text}", flush=True)
        for text in doubts:
            print(f"{label['file']}: doubtful: {text}", flush=True)
        wrong_files += bool(wrong)
        doubtful_files += bool(doubts)
    repeated = len(labels) - len({label["file"] for label in labels})
    dropped = sum(bool(label.get("drop")) for label in labels)
    print(f"{len(labels)} files, {dropped} dropped, {wrong_files} wrong, {doubtful_files} doubtful, {repeated} twice")
    sys.exit(1 if wrong_files or repeated else 0)


if __name__ == "__main__":
    main()

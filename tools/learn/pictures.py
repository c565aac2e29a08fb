"""Pictures of what a network says of bodies that it was not trained on: contact sheets, mistakes in red."""
import os
import re

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import reader
import vocabulary as words
from evaluate import UNNAMED, about_run, confidence, joint_distance, judged_bodies, skeleton
from makers import stem_of

VIEW, CAPTION, COLUMNS, ROWS = 140, 38, 4, 5  # pixels of one view and of the caption; pictures of a sheet
FINE = 3  # drawn so many times larger, then reduced
WRONG_JOINT = 0.08  # of the longest side: a joint further off is marked
COLOURS_OF_A_SHEET = 96
RED, INK, PAPER = (214, 20, 30), (40, 40, 44), (255, 255, 255)
COLOURS = {"other": (150, 150, 150), "prop": (110, 110, 110), "trunk": (196, 160, 110), "neck": (208, 124, 60),
           "head": (226, 178, 40), "tail": (150, 96, 60), "fore": (40, 120, 216), "hind": (40, 160, 70),
           "mid": (20, 168, 168), "wing": (150, 70, 200), "fin": (220, 80, 160), "ear": (240, 140, 120)}
FRONT, SIDE = np.array([[1, 0, 0], [0, -1, 0]]), np.array([[0, 0, -1], [0, -1, 0]])  # from body to picture


def colour_of(name):
    """Of a role or a part: that of its limb, the same for both sides."""
    return next((colour for start, colour in COLOURS.items() if name.startswith(start)), COLOURS["other"])


def chains():
    """Roles that follow each other along a limb, as lists of indices."""
    found = {}
    for index, name in enumerate(words.ROLES):
        if not name.startswith(UNNAMED):
            limb = "trunk" if name in ("neck", "head") else re.match(r"[a-z]+\d?", name)[0]
            found.setdefault(limb + name[-2:] * (name[-2:] in words.SIDES), []).append(index)
    return list(found.values())


def choose(runs, data, count):
    """(body, run) of `count` bodies as different as can be: makers and plans take turns. Of several runs the one that
    did not see the body's maker."""
    found = {}
    for run in runs:
        seen = about_run(run)["makers"]
        for body in judged_bodies(run, data):
            key = body.maker, stem_of(body.source)
            if key not in found or (found[key][2] and body.maker not in seen):
                found[key] = body, run, body.maker in seen
    groups = {}
    for key in sorted(found):
        groups.setdefault((found[key][0].maker, found[key][0].plan), []).append(found[key][:2])
    chosen = [pair for turn in range(max(map(len, groups.values()), default=0))
              for group in sorted(groups) for pair in groups[group][turn : turn + 1]][:count]
    return sorted(chosen, key=lambda pair: (pair[0].plan, pair[0].maker, pair[0].name))


class Reading:
    """What a network says of a body, and what of it is wrong."""

    def __init__(self, body, network, temperature=1.0):
        self.body = body
        inputs, centre, scale, self.chosen = body.tokens()
        self.said = reader.read(network, inputs, centre, scale)
        self.error = np.linalg.norm(self.said["y"] - body.roles, axis=1) / body.side
        named = np.array([not name.startswith(UNNAMED) for name in words.ROLES])
        self.true, self.present = body.has & named, (self.said["has"] > 0.5) & named
        self.wrong_joints = self.true & (self.error > WRONG_JOINT)
        sure = confidence({"plan_logits": self.said["plan_logits"]}, temperature)
        self.plan, self.confidence = int(sure.argmax()), float(sure.max())
        self.wrong_plan = self.plan != body.plan
        self.part = self.said["part"].argmax(1)

    @property
    def is_wrong(self):
        return bool(self.wrong_plan or self.wrong_joints.any())

    def captions(self):
        """(text, whether it is red) of each line."""
        distance = joint_distance(skeleton(self.said, self.body.side), self.body.joints[self.body.counted])
        kind = f"said {words.PLANS[self.plan]} {self.confidence:.2f}"
        if self.wrong_plan:
            kind += f", is {words.PLANS[self.body.plan]}"
        joints = "" if distance is None else f"J2J {100 * distance / self.body.side:.1f} %"
        wrong = int(self.wrong_joints.sum())
        if wrong:
            joints += f", {wrong} of {int(self.true.sum())} joints off > {100 * WRONG_JOINT:.0f} %"
        name = os.path.splitext(os.path.basename(self.body.source))[0]
        return [(f"{name[:28]} ({self.body.maker})", False), (kind, self.wrong_plan), (joints, wrong > 0)]


def _dot(draw, at, radius, colour, outline=None):
    draw.ellipse([at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius], fill=colour, outline=outline)


def _view(draw, reading, axes, corner):
    """One view of a body into the square whose upper left corner is given, in fine pixels."""
    body, size = reading.body, VIEW * FINE
    points = body.all_points[reading.chosen]
    low, high = points.min(0), points.max(0)
    scale = 0.88 * size / max((high - low).max(), 1e-9)
    middle = (low + high) / 2
    flat = lambda positions: (np.asarray(positions) - middle) @ axes.T * scale + corner + size / 2
    toward = np.cross(axes[0], -axes[1])  # to the viewer
    depth = (points - middle) @ toward
    depth = (depth - depth.min()) / max(np.ptp(depth), 1e-9)
    at = flat(points)
    for k in np.argsort(depth, kind="stable"):
        pale = 0.75 - 0.35 * round(3 * depth[k]) / 3  # in few steps, for a small file
        colour = np.array(colour_of(words.PARTS[reading.part[k]]))
        _dot(draw, at[k], 1.7 * FINE, tuple((pale * 255 + (1 - pale) * colour).astype(int)))
    said, true = flat(reading.said["y"]), flat(body.roles)
    for chain in chains():
        present = [role for role in chain if reading.present[role]]
        for first, second in zip(present, present[1:]):
            draw.line([*said[first], *said[second]], fill=INK, width=FINE)
    for role in np.flatnonzero(reading.wrong_joints):
        draw.line([*said[role], *true[role]], fill=RED, width=FINE)
    for role in np.flatnonzero(reading.true):
        colour, arm = (RED if reading.wrong_joints[role] else INK), 2.6 * FINE
        for sign in (1, -1):
            x, y = true[role]
            draw.line([x - arm, y - sign * arm, x + arm, y + sign * arm], fill=colour, width=FINE)
    for role in np.flatnonzero(reading.present):
        _dot(draw, said[role], 2.6 * FINE, colour_of(words.ROLES[role]), INK)


def picture(reading):
    """Front and side of a body with what is said of it."""
    fine = Image.new("RGB", (2 * VIEW * FINE, VIEW * FINE), PAPER)
    draw = ImageDraw.Draw(fine)
    for k, axes in enumerate((FRONT, SIDE)):
        _view(draw, reading, axes, np.array([k * VIEW * FINE, 0]))
    whole = Image.new("RGB", (2 * VIEW, VIEW + CAPTION), PAPER)
    whole.paste(fine.resize((2 * VIEW, VIEW), Image.LANCZOS), (0, CAPTION))
    draw, font = ImageDraw.Draw(whole), ImageFont.load_default()
    for k, (text, is_red) in enumerate(reading.captions()):
        draw.text((4, 3 + 11 * k), text, fill=RED if is_red else INK, font=font)
    frame = [0, 0, whole.width - 1, whole.height - 1]
    draw.rectangle(frame, outline=RED if reading.is_wrong else (215, 215, 215), width=2 if reading.is_wrong else 1)
    return whole


def sheets(readings):
    """Contact sheets in few colours, so that the files are small."""
    result = []
    for start in range(0, len(readings), COLUMNS * ROWS):
        some = [picture(reading) for reading in readings[start : start + COLUMNS * ROWS]]
        width, height = some[0].size
        sheet = Image.new("RGB", (COLUMNS * width, -(-len(some) // COLUMNS) * height), PAPER)
        for k, one in enumerate(some):
            sheet.paste(one, (k % COLUMNS * width, k // COLUMNS * height))
        result.append(sheet.quantize(COLOURS_OF_A_SHEET, dither=Image.Dither.NONE))
    return result


def describe(readings, seen, names):
    """The page's text: what is to be seen, and the sheets."""
    unseen = sorted({r.body.maker for r in readings if r.body.maker not in seen})
    known = sorted({r.body.maker for r in readings if r.body.maker in seen})
    makers = f"Makers that the network did not see: {', '.join(unseen) or 'none'}."
    if known:
        makers += f" Of {', '.join(known)} it saw other files."
    kinds, joints = (sum(map(wrong, readings)) for wrong in (lambda r: r.wrong_plan, lambda r: r.wrong_joints.any()))
    return (f"{len(readings)} bodies; the kind is wrong of {kinds}, a joint is off by more than "
            f"{100 * WRONG_JOINT:.0f} % of the longest side in {joints}. {makers}\n\n"
            + "\n".join(f"![Front and side of bodies, with joints said and true](images/{name})" for name in names))

"""What a reading can say: roles (named joints of a body), parts (of its surface), plans, and the 24 stances.

Shared by preparation, training and export: the order of these lists is the order of the networks' outputs, and the
weights file carries the names.
"""
import numpy as np

SIDED_ROLES = (
    [f"fore_{segment}" for segment in ("base", "upper", "middle", "hock", "end")]
    + [f"hind_{segment}" for segment in ("upper", "middle", "hock", "end", "toes")]
    + ["wing_0", "wing_1", "wing_2", "fin0_0", "fin0_1", "fin1_0"]
    + [f"mid{pair}_{segment}" for pair in "abc" for segment in ("upper", "middle", "end")]
    + ["ear"]
)
CENTRE_ROLES = (["trunk_0", "trunk_1", "trunk_2", "trunk_3", "neck", "head", "jaw"]
                + ["tail_0", "tail_1", "tail_2", "tail_3"])
FINGERS, FINGER_JOINTS = 5, 3
FINGER_ROLES = [f"finger_{finger}_{joint}" for finger in range(1, FINGERS + 1) for joint in range(FINGER_JOINTS)]
SIDES = (".L", ".R")

ROLES = (
    CENTRE_ROLES
    + [role + side for side in SIDES for role in SIDED_ROLES]
    + [role + side for side in SIDES for role in FINGER_ROLES]
)
ROLE = {name: index for index, name in enumerate(ROLES)}

SIDED_PARTS = (["fore_upper", "fore_lower", "fore_end", "hind_upper", "hind_lower", "hind_end"]
               + ["mid", "wing", "fin", "ear"])
PARTS = ["other", "trunk", "neck", "head", "tail", "prop"] + [part + side for side in SIDES for part in SIDED_PARTS]
PART = {name: index for index, name in enumerate(PARTS)}

PLANS = ["upright", "four", "bird", "dinosaur", "many", "swims", "crawls", "winged_four", "none"]
PLAN = {name: index for index, name in enumerate(PLANS)}

UNKNOWN = -1  # a label that nobody set: no loss is taken of it


def mirrored(name):
    """The name on the other side of the body; names of the middle stay."""
    return name[:-1] + {"L": "R", "R": "L"}[name[-1]] if name[-2:] in SIDES else name


MIRROR_ROLE = np.array([ROLE[mirrored(name)] for name in ROLES])
MIRROR_PART = np.array([PART[mirrored(name)] for name in PARTS])


def stances():
    """(24, 3, 3) proper rotations that bring a given frame to the body's (+Y up, +Z front, +X left).

    Row 1 of each is the axis that is up, row 2 the one that is front: up runs over +x, -x, +y, -y, +z, -z, and for each
    front over those of the same list that are orthogonal to it.
    """
    axes = [sign * np.eye(3)[k] for k in range(3) for sign in (1, -1)]
    return np.array([[np.cross(up, front), up, front] for up in axes for front in axes if abs(up @ front) < 0.5])


STANCES = stances()
UPRIGHT_STANCE = int(np.argmin([np.abs(stance - np.eye(3)).sum() for stance in STANCES]))

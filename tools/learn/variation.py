"""One body -> any number of training samples: posed, stretched, thickened, dressed, damaged, mirrored.

Tokens are drawn after posing, and their inner balls measured there: what was made larger must not be recognised by the
thinness of its samples. All randomness comes from the generator that is given.
"""
from dataclasses import dataclass

import numpy as np

import reader
import samples
import vocabulary as words

MAX_PINS = 5
# Standard deviation of a joint's rotation, radians, by its part; in chains divided by the root of the number of joints.
ROTATION = {"trunk": 0.09, "neck": 0.2, "head": 0.2, "tail": 0.25,
            "fore_upper": 0.35, "fore_lower": 0.4, "fore_end": 0.2,
            "hind_upper": 0.3, "hind_lower": 0.35, "hind_end": 0.15,
            "mid": 0.22, "wing": 0.28, "fin": 0.2, "ear": 0.2}
# Groups of parts that are stretched together.
GROUP = {"neck": "neck", "head": "head", "tail": "tail", "fore_upper": "fore", "fore_lower": "fore", "fore_end": "hand",
         "hind_upper": "hind", "hind_lower": "hind", "hind_end": "foot", "mid": "hind",
         "wing": "wing", "fin": "fin", "ear": "ear"}
GROUPS = sorted(set(GROUP.values()) | {"trunk"})
LOOSE_GROUPS = ("head", "ear", "tail", "fin", "wing", "hand")  # whose sizes differ more between bodies
UNIFORM_PARTS = ("head", "fore_end", "hind_end", "ear")  # stretched alike in all directions
MAX_HEAD = 0.6  # largest size of a stretched head, of the diagonal of the body's box
MAX_PROP = 0.75  # the same of a prop
SURFACE = 0.35  # area of a body's surface, about, of the square of that diagonal
OPTIONAL = ("ear", "tail")  # parts that a body may lose and still be of its plan
PROP = words.PART["prop"]
AS_MADE = 0.4  # of the samples show the body as its maker left it


@dataclass
class Sample:
    inputs: np.ndarray  # (tokens, 11)
    y: np.ndarray  # (roles, 3) in the tokens' frame
    has: np.ndarray  # (roles,)
    part: np.ndarray  # (tokens,)
    bone: np.ndarray  # (tokens, 6) offsets from the token to the two ends of its bone
    bone_known: np.ndarray  # (tokens,)
    plan: int
    fingers: np.ndarray  # (2,)
    pin_roles: np.ndarray  # (MAX_PINS,), -1: none
    pin_positions: np.ndarray  # (MAX_PINS, 3)


@dataclass
class _Cloud:
    """Points on their way: all arrays are by point but for roles and has."""

    points: np.ndarray
    normals: np.ndarray
    pieces: np.ndarray
    part: np.ndarray
    start: np.ndarray  # the two ends of each point's bone
    end: np.ndarray
    known: np.ndarray
    flesh: np.ndarray  # radius of the inner ball at rest
    index: np.ndarray  # of the body's point; -1: of what was added
    roles: np.ndarray
    has: np.ndarray
    fingers: np.ndarray

    def keep(self, chosen):
        for name in ("points", "normals", "pieces", "part", "start", "end", "known", "flesh", "index"):
            setattr(self, name, getattr(self, name)[chosen])

    def map_positions(self, function):
        for name in ("points", "start", "end", "roles"):
            setattr(self, name, function(getattr(self, name)))


def rotations(vectors):
    """(n, 3) rotation vectors -> (n, 3, 3)."""
    angle = np.linalg.norm(vectors, axis=1)
    x, y, z = (vectors / np.maximum(angle, 1e-9)[:, None]).T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], 1).reshape(-1, 3, 3)
    sine, rest = np.sin(angle)[:, None, None], (1 - np.cos(angle))[:, None, None]
    return (np.eye(3) + sine * cross + rest * cross @ cross).astype("f4")


def unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9)


def _split(part):
    return (part[:-2], part[-1]) if part[-2:] in words.SIDES else (part, "")


def _rotation_vectors(body, rng):
    """A rotation for each active joint; sides alike in two thirds of the samples."""
    amount = rng.uniform(0.05, 0.3) if rng.rand() < 0.3 else rng.uniform(0.3, 1.6)
    alike = rng.rand() < 0.65
    curl = rng.randn(2) * 0.5 * min(amount, 1)
    drawn, seen, vectors = {}, {}, np.zeros((len(body.active), 3), "f4")
    for k, part in enumerate(body.active_part):
        base, side = _split(part)
        index = seen[part] = seen.get(part, -1) + 1
        count = body.active_part.count(part) if part not in drawn else drawn[part]
        drawn[part] = count
        key = (base, index, "" if alike else side)
        if key not in drawn:
            drawn[key] = rng.randn(3) * ROTATION.get(base, 0.03) * amount / np.sqrt(min(count, 9))
        vector = drawn[key]
        if side == "R":  # a rotation vector in the mirror
            vector = vector * (1, -1, -1)
        if body.curl_axis[k].any():
            vector = vector * 0.5 + body.curl_axis[k] * (-curl[0 if alike else 1] if side == "R" else curl[0])
        vectors[k] = vector
    return vectors


def _lifted_arms(body, rng, matrices):
    """Arms of people from raised to hanging: the first joint of each upper arm is rotated to one elevation."""
    wanted, done = np.radians(rng.uniform(-85, 60 if rng.rand() < 0.2 else 15)), set()
    for k, part in enumerate(body.active_part):
        if part in ("fore_upper.L", "fore_upper.R") and part not in done:
            done.add(part)
            direction = body.direction[k]
            now = np.arctan2(direction[1], abs(direction[0]) + 1e-6)
            angle = (wanted - now) * (1 if part[-1] == "L" else -1)
            matrices[k] = rotations(np.array([[0, 0, angle]]))[0] @ matrices[k]


def _about(axis, angle):
    """Rotation by an angle about a vector of any length."""
    return rotations(np.asarray(axis)[None] / max(np.linalg.norm(axis), 1e-9) * angle)[0]


def _act(body, rng, matrices):
    """People who sit, stride, kneel, crouch or bow, with arms before them or bent."""
    left, up, front = np.eye(3)
    first = {}
    for k, part in enumerate(body.active_part):
        first.setdefault(part, k)
    trunk = [k for k, part in enumerate(body.active_part) if part == "trunk"]
    bow, twist, lean = rng.uniform(-0.2, 1.0) * rng.rand(), rng.randn() * 0.25, rng.randn() * 0.15
    for k in trunk:
        matrices[k] = _about([bow, twist, lean], np.linalg.norm([bow, twist, lean]) / len(trunk)) @ matrices[k]
    for part, amount in (("neck", 0.2), ("head", 0.35)):
        if (k := first.get(part)) is not None:
            matrices[k] = rotations(rng.randn(1, 3) * amount)[0] @ matrices[k]
    strides, hip, knee = rng.rand() < 0.5, rng.uniform(0, 1.9), rng.rand()
    forward, bend, toward = rng.uniform(0, 1.7) * (rng.rand() < 0.6), rng.uniform(0, 2.3), rng.rand()
    for side, sign in (("L", 1.0), ("R", -1.0)):
        if strides:
            hip, knee = (-0.5 * hip if sign < 0 else hip), rng.rand()
        if rng.rand() < 0.3:
            forward, bend, toward = rng.uniform(0, 1.7), rng.uniform(0, 2.3), rng.rand()
        turns = {
            "hind_upper": _about(front, sign * rng.uniform(-0.1, 0.4)) @ _about(left, -hip),
            "hind_lower": _about(left, knee * (max(hip, 0) + 0.8)),
            "fore_upper": _about(up, -sign * forward),
        }
        for part, turn in turns.items():
            if (k := first.get(f"{part}.{side}")) is not None:
                matrices[k] = turn @ matrices[k]
        if (k := first.get(f"fore_lower.{side}")) is not None:
            axis = np.cross(body.direction[k], toward * front + (1 - toward) * up)
            matrices[k] = _about(axis, bend) @ matrices[k]


def _stretches(body, rng):
    """group -> (along the bone, across it)."""
    result = {}
    for group in GROUPS:
        spread = 0.22 if group in LOOSE_GROUPS else 0.14
        result[group] = np.exp(rng.randn(2) * spread * rng.choice([0.3, 1.0]) + (0.08 if group == "head" else 0))
    upright = body.plan == words.PLAN["upright"]
    if rng.rand() < (0.4 if upright else 0.2):  # toys: large heads, short limbs
        largest = max(MAX_HEAD / max(body.head_size, 0.05), 1)
        result["head"] = np.full(2, min(rng.uniform(1.2, 3.2 if upright else 2), largest))
        for group, shortest in (("hind", 0.4), ("fore", 0.5), ("trunk", 0.5)):
            result[group] = np.array([rng.uniform(shortest, 1), rng.uniform(0.75, 1.5)])
    return result


def _pose(body, acts, rng):
    """Matrices (active, 3, 3) and offsets (active, 3): a point of joint k goes to matrices[k] @ point + offsets[k]."""
    turn = rotations(_rotation_vectors(body, rng))
    if body.plan == words.PLAN["upright"] and rng.rand() < 0.6:
        _lifted_arms(body, rng, turn)
    if acts:
        _act(body, rng, turn)
    stretch = _stretches(body, rng)
    base = [_split(part)[0] for part in body.active_part]
    along, across = np.array([stretch[GROUP.get(b, "trunk")] for b in base], "f4").T
    across = np.where(np.isin(base, UNIFORM_PARTS), along, across)
    outer = body.direction[:, :, None] * body.direction[:, None]
    scale = (across[:, None, None] * np.eye(3, dtype="f4") + (along - across)[:, None, None] * outer).astype("f4")
    rotation, position = np.empty_like(turn), np.empty_like(body.active)
    for k, parent in enumerate(body.active_parent):
        if parent < 0:
            rotation[k], position[k] = turn[k], body.active[k]
        else:
            rotation[k] = rotation[parent] @ turn[k]
            position[k] = position[parent] + rotation[parent] @ (scale[parent] @ (body.active[k] - body.active[parent]))
    matrices = rotation @ scale
    return matrices, position - np.einsum("kab,kb->ka", matrices, body.active)


def _cloud_of(body, matrices, offsets):
    blended = (body.weights @ matrices.reshape(len(matrices), 9)).reshape(-1, 3, 3)
    points = np.einsum("nab,nb->na", blended, body.points) + body.weights @ offsets
    normals = unit(np.einsum("nab,nb->na", blended, body.normals))
    move = lambda positions, of: np.einsum("nab,nb->na", matrices[of], positions) + offsets[of]
    of, bone = body.of, body.bone
    joints, ends = move(body.joints, of), move(body.bone_ends, of)
    active = move(body.active, np.arange(len(matrices)))
    roles = (1 - body.role_fraction) * active[body.role_first] + body.role_fraction * active[body.role_second]
    return _Cloud(points, normals, body.pieces.copy(), body.part.copy(), joints[bone], ends[bone],
                  np.ones(len(points), bool), body.flesh, np.arange(len(points)), roles, body.has.copy(),
                  body.fingers.copy())


def _at_rest(body):
    count = len(body.active)
    return _cloud_of(body, np.tile(np.eye(3, dtype="f4"), (count, 1, 1)), np.zeros((count, 3), "f4"))


def _lose_parts(cloud, body, rng):
    """Props and optional parts go, with their roles."""
    if rng.rand() < 0.25:
        _keep_most(cloud, cloud.part != PROP)
    if body.plan in (words.PLAN["upright"], words.PLAN["four"]) and rng.rand() < 0.08:
        lost = OPTIONAL[rng.randint(len(OPTIONAL))]
        names = [i for i, role in enumerate(words.ROLES) if role.startswith(lost)]
        gone = [index for part, index in words.PART.items() if part.startswith(lost)]
        if cloud.has[names].any() and _keep_most(cloud, ~np.isin(cloud.part, gone)):
            cloud.has[names] = False


def _lose_fingers(cloud, body, rng):
    """Mittens: all fingers of some hands are not there, and neither are their roles."""
    for hand, side in enumerate(words.SIDES):
        finger = body.finger[side][body.bone]
        if finger.any() and rng.rand() < 0.8 and _keep_most(cloud, ~finger[cloud.index]):
            cloud.fingers[hand] = 0
            is_finger = [role.startswith("finger") and role.endswith(side) for role in words.ROLES]
            cloud.has[is_finger] = False


# What a broken body lacks: beginnings of the names of roles and parts. A stump may be left.
LIMBS = (("fore_",), ("fore_middle", "fore_lower", "fore_end"), ("hind_",), ("hind_middle", "hind_lower", "hind_end"),
         ("head", "neck", "jaw", "ear"), ("head", "jaw", "ear"))
LIMB_ODDS = (0.15, 0.2, 0.15, 0.2, 0.15, 0.15)


def _break(cloud, rng):
    """Half bodies, busts, torsos: limbs or all beyond a plane are not there, and neither are the roles."""
    if rng.rand() < 0.6:
        lost = LIMBS[rng.choice(len(LIMBS), p=LIMB_ODDS)]
        side = rng.choice(["", "", ".L", ".R"]) if lost[0] != "head" else ""
        is_lost = lambda name: name.startswith(lost) and name.endswith(side)
        fingers = lambda name: lost[0].startswith("fore") and name.startswith("finger") and name.endswith(side)
        gone = np.array([is_lost(name) or fingers(name) for name in words.ROLES])
        if _keep_most(cloud, ~np.isin(cloud.part, [k for name, k in words.PART.items() if is_lost(name)])):
            cloud.has &= ~gone
            if lost[0].startswith("fore"):
                cloud.fingers[[side != ".R", side != ".L"]] = 0
        return
    normal = np.array([0, rng.choice([-1, 1]), 0]) if rng.rand() < 0.7 else rng.choice([-1, 1]) * np.eye(3)[rng.choice([0, 2])]
    along = cloud.points @ normal
    limit = np.quantile(along, rng.uniform(0.4, 0.95))
    if _keep_most(cloud, along < limit):
        cloud.has &= cloud.roles @ normal < limit + 0.02 * np.ptp(along)
        for hand, side in enumerate(words.SIDES):
            if not cloud.has[words.ROLE["fore_end" + side]]:
                cloud.fingers[hand] = 0


def _keep_most(cloud, keep):
    if keep.sum() < 1.1 * samples.TOKENS or keep.all():
        return False
    cloud.keep(keep)
    return True


def _thicken(cloud, rng):
    """Fat, thin and swollen limbs: points go along their normals by a fraction of the flesh below them at rest."""
    amount = rng.randn(len(words.PARTS)) * 0.15 + rng.randn() * 0.12
    amount = (amount + amount[words.MIRROR_PART]) / 2
    cloud.points = cloud.points + cloud.normals * (cloud.flesh * amount[cloud.part].clip(-0.5, 0.6))[:, None]


def _bend(cloud, rng):
    """A smooth quadratic map of space: bent, tapered and sheared bodies of the same plan; normals by its Jacobian."""
    centre, scale = samples.frame_of(cloud.points)
    tensor = rng.randn(3, 3, 3) * 0.05
    tensor = (tensor + tensor.transpose(0, 2, 1)) / 2
    if rng.rand() < 0.7:  # left and right stay alike
        mirror = np.array([-1, 1, 1])
        tensor[(mirror[:, None, None] * mirror[:, None] * mirror) < 0] = 0
    relative = (cloud.points - centre) / scale
    jacobian = np.eye(3) + 2 * np.einsum("abc,nc->nab", tensor, relative.clip(-2.5, 2.5))
    if np.linalg.det(jacobian).min() < 0.3:
        return
    def function(positions):
        r = (positions - centre) / scale
        return positions + scale * np.einsum("abc,nb,nc->na", tensor, r, r)
    cloud.map_positions(function)
    cloud.normals = unit(np.linalg.solve(jacobian.transpose(0, 2, 1), cloud.normals[..., None])[..., 0])


def _add(cloud, points, normals, rng, part=PROP, loose=0.8):
    """Points of something that is no body; mostly a piece of its own."""
    before, count = len(cloud.points), len(points)
    if np.linalg.norm(np.ptp(points, axis=0)) > MAX_PROP * np.linalg.norm(np.ptp(cloud.points, axis=0)):
        return
    if rng.rand() < loose:
        cloud.pieces = cloud.pieces * (before / (before + count))
        pieces = np.full(count, count / (before + count), "f4")
    else:
        pieces = np.full(count, cloud.pieces.max(), "f4")
    join = lambda a, b: np.concatenate([a, b]).astype(a.dtype)
    cloud.points, cloud.normals = join(cloud.points, points), join(cloud.normals, unit(normals))
    cloud.pieces, cloud.part = join(cloud.pieces, pieces), join(cloud.part, np.full(count, part))
    cloud.start, cloud.end = join(cloud.start, points), join(cloud.end, points)
    cloud.known, cloud.flesh = join(cloud.known, np.zeros(count, bool)), join(cloud.flesh, np.zeros(count))
    cloud.index = join(cloud.index, np.full(count, -1))


def _of(cloud, *parts):
    return np.flatnonzero(np.isin(cloud.part, [words.PART[part] for part in parts]))


def _held(cloud, size, count, rng):
    """A rod, blade or staff through a hand."""
    hand = _of(cloud, "fore_end.L", "fore_end.R")
    if not len(hand):
        return
    axis = unit(rng.randn(3))
    angle = rng.rand(count) * 2 * np.pi
    side = unit(np.cross(axis, rng.randn(3)))
    ring = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * np.cross(axis, side)
    flat = np.array([1, rng.uniform(0.1, 1), 1])
    centre = cloud.points[rng.choice(hand)]
    length, radius = size * rng.uniform(0.1, 0.5), size * rng.uniform(0.004, 0.03)
    _add(cloud, centre + axis * (rng.uniform(-0.3, 1, count) * length)[:, None] + ring * radius * flat, ring, rng)


def _hat(cloud, size, count, rng):
    head = _of(cloud, "head")
    if len(head) < 8:
        return
    points = cloud.points[head]
    width = (points[:, [0, 2]].std() + 1e-6) * rng.uniform(1.2, 3)
    centre = np.array([points[:, 0].mean(), np.quantile(points[:, 1], 0.8), points[:, 2].mean()])
    height, angle = rng.rand(count), rng.rand(count) * 2 * np.pi
    radius = width * (1 - height) ** rng.uniform(0.2, 1.5)
    ring = np.stack([np.cos(angle), 0 * angle, np.sin(angle)], 1)
    rise = np.outer(height, [0, width * rng.uniform(0.2, 2.5), 0])
    _add(cloud, centre + ring * radius[:, None] + rise, ring + [0, 0.3, 0], rng)


def _cape(cloud, size, count, rng):
    trunk = _of(cloud, "trunk")
    if len(trunk) < 8:
        return
    points = cloud.points[trunk]
    top, low = np.quantile(points[:, 1], 0.95), cloud.points[:, 1].min()
    width, down = points[:, 0].std() * rng.uniform(1.5, 3), rng.rand(count)
    x = points[:, 0].mean() + width * rng.uniform(-1, 1, count) * (1 + 0.5 * down)
    z = np.quantile(points[:, 2], 0.05) - size * (0.01 + down * rng.uniform(0, 0.12))
    normals = np.tile([0, 0.1, -1.0], (count, 1)) * rng.choice([-1, 1], count)[:, None]
    _add(cloud, np.stack([x, top - down * (top - low) * rng.uniform(0.5, 0.95), z], 1), normals, rng)


def _robe(cloud, size, count, rng):
    """A skirt or robe that hides the legs of people."""
    trunk, legs = _of(cloud, "trunk"), _of(cloud, *[f"hind_{p}{s}" for p in ("upper", "lower") for s in words.SIDES])
    if len(trunk) < 8 or len(legs) < 8:
        return
    leg_points = cloud.points[legs]
    top, low = np.quantile(leg_points[:, 1], 0.95), np.quantile(leg_points[:, 1], rng.uniform(0, 0.5))
    centre = leg_points[:, [0, 2]].mean(0)
    reach = np.abs(leg_points[:, [0, 2]] - centre).max(0) * rng.uniform(0.9, 1.2) + 1e-6
    down, angle = rng.rand(count), rng.rand(count) * 2 * np.pi
    ring = np.stack([np.cos(angle), np.sin(angle)], 1)
    flat = centre + ring * reach * (rng.uniform(0.5, 1) * (1 - down) + down)[:, None]
    points = np.stack([flat[:, 0], top - down * (top - low), flat[:, 1]], 1)
    if rng.rand() < 0.7:  # what is below it is not there
        hidden = np.isin(np.arange(len(cloud.points)), legs) & (cloud.points[:, 1] > low)
        _keep_most(cloud, ~hidden)
    _add(cloud, points, np.stack([ring[:, 0], 0.2 + 0 * down, ring[:, 1]], 1), rng)


def _pack(cloud, size, count, rng):
    """A box at the back, the side or the chest: pack, quiver, shield, saddle."""
    trunk = _of(cloud, "trunk")
    if len(trunk) < 8:
        return
    at, outward = cloud.points[k := rng.choice(trunk)], cloud.normals[k]
    half = size * rng.uniform(0.02, 0.12, 3)
    turn, centre = rotations(rng.randn(1, 3) * 0.4)[0], at + outward * half.min()
    _add(cloud, *_block_points(centre - half, centre + half, turn, False, count, rng), rng)


def _block_points(low, high, turn, round_one, count, rng):
    """Points and normals of a box, or of a cylinder along y, that is turned about its centre."""
    half = (high - low) / 2
    areas = np.array([half[1] * half[2], half[0] * half[2], half[0] * half[1]])
    face, sign = rng.choice(3, count, p=areas / areas.sum()), rng.choice([-1.0, 1.0], count)
    points = rng.uniform(-1, 1, (count, 3))
    points[np.arange(count), face] = sign
    normals = np.zeros((count, 3))
    normals[np.arange(count), face] = sign
    if round_one:
        angle = rng.rand(count) * 2 * np.pi
        ring = np.stack([np.cos(angle), np.sin(angle)], 1)
        caps = face == 1
        points[:, [0, 2]] = ring * np.where(caps, np.sqrt(rng.rand(count)), 1)[:, None]
        normals[~caps] = 0
        normals[~caps, 0], normals[~caps, 2] = ring[~caps].T
    return (low + high) / 2 + (points * half) @ turn.T, unit(normals / half) @ turn.T


def _support(cloud, size, count, rng):
    """What a body stands on, sits on or leans on, mostly of one piece with it: a plinth, a seat, a stump."""
    body = cloud.points[cloud.index >= 0]
    low, high = body.min(0), body.max(0)
    kind = rng.choice(["plinth", "plinth", "seat", "stump"])
    if kind == "plinth":
        middle, reach = (low + high)[[0, 2]] / 2, (high - low)[[0, 2]] / 2 * rng.uniform(0.4, 1.1, 2)
        top, bottom = low[1] + size * rng.uniform(0, 0.03), low[1] - size * rng.uniform(0.01, 0.12)
    else:
        under = _of(cloud, "trunk") if kind == "seat" else np.flatnonzero(cloud.index >= 0)
        if len(under) < 8:
            return
        at = cloud.points[rng.choice(under)]
        middle, reach = at[[0, 2]] + rng.randn(2) * 0.04 * size, size * rng.uniform(0.04, 0.16, 2)
        bottom = low[1]
        top = np.quantile(cloud.points[under, 1], 0.08) if kind == "seat" else rng.uniform(bottom, at[1]) + 0.05 * size
    corners = np.array([[middle[0] - reach[0], bottom, middle[1] - reach[1]],
                        [middle[0] + reach[0], max(top, bottom + 0.01 * size), middle[1] + reach[1]]])
    half = (corners[1] - corners[0]) / 2
    area = 8 * (half[0] * half[1] + half[1] * half[2] + half[0] * half[2])
    turn, round_one = rotations(np.array([[0, rng.rand() * np.pi, 0]]))[0].astype(float), rng.rand() < 0.5
    count = int(np.clip(len(body) * area / (SURFACE * size**2), count, len(body)))
    points, normals = _block_points(*corners, turn, round_one, count, rng)
    if rng.rand() < 0.5:  # rock
        points = points + normals * (rng.randn(count) * size * 0.008)[:, None]
        normals = unit(normals + rng.randn(count, 3) * 0.2)
    local = np.abs((cloud.points - corners.mean(0)) @ turn) / half
    inside = (local < 1).all(1) if not round_one else (np.hypot(local[:, 0], local[:, 2]) < 1) & (local[:, 1] < 1)
    if inside.mean() > 0.3:
        return
    _keep_most(cloud, ~inside)
    _add(cloud, points, normals, rng, loose=0.25)


def _debris(cloud, size, count, rng):
    """Loose small balls around the body."""
    low, high = cloud.points.min(0), cloud.points.max(0)
    for _ in range(rng.randint(1, 5)):
        directions = unit(rng.randn(max(count // 8, 3), 3))
        centre = rng.uniform(low - 0.1 * size, high + 0.1 * size)
        _add(cloud, centre + directions * size * rng.uniform(0.004, 0.03), directions, rng, loose=1.0)


PROPS = ((_held, 5), (_hat, 4), (_cape, 2), (_robe, 3), (_pack, 3), (_support, 3), (_debris, 1))
PROP_ODDS = np.array([odds for _, odds in PROPS]) / sum(odds for _, odds in PROPS)


def _dress(cloud, body, rng):
    size = np.linalg.norm(np.ptp(cloud.points, axis=0))
    for _ in range(1 + (rng.rand() < 0.3)):
        kind = PROPS[rng.choice(len(PROPS), p=PROP_ODDS)][0]
        if kind is not _robe or body.plan == words.PLAN["upright"]:
            kind(cloud, size, int(len(body.points) * rng.uniform(0.03, 0.15)), rng)


def _damage(cloud, rng):
    """Holes, noise of scans, normals that lie."""
    if rng.rand() < 0.12:
        centre, scale = samples.frame_of(cloud.points)
        keep = np.ones(len(cloud.points), bool)
        for _ in range(rng.randint(1, 5)):
            hole = cloud.points[rng.randint(len(cloud.points))]
            keep &= ((cloud.points - hole) ** 2).sum(1) > (scale * rng.uniform(0.05, 0.3)) ** 2
        _keep_most(cloud, keep)
    if rng.rand() < 0.1:
        _, scale = samples.frame_of(cloud.points)
        cloud.points = cloud.points + rng.randn(*cloud.points.shape) * scale * rng.uniform(0.002, 0.012)
        cloud.normals = unit(cloud.normals + rng.randn(*cloud.normals.shape) * rng.uniform(0.05, 0.4))
    if rng.rand() < 0.15:
        cloud.pieces = np.ones_like(cloud.pieces)


def _transform(cloud, matrix):
    cloud.map_positions(lambda positions: positions @ matrix.T)
    cloud.normals = unit(cloud.normals @ np.linalg.inv(matrix))


def _mirror(cloud):
    _transform(cloud, np.diag([-1.0, 1, 1]))
    cloud.roles, cloud.has = cloud.roles[words.MIRROR_ROLE], cloud.has[words.MIRROR_ROLE]
    cloud.part, cloud.fingers = words.MIRROR_PART[cloud.part], cloud.fingers[::-1]


def _pins(has, y, rng):
    """No pin in half of the samples, else one to five true joints, as exactly as a user drags them."""
    roles, positions = np.full(MAX_PINS, -1), np.zeros((MAX_PINS, 3), "f4")
    present = np.flatnonzero(has)
    if rng.rand() < 0.5 and len(present):
        chosen = rng.choice(present, min(rng.randint(1, MAX_PINS + 1), len(present)), replace=False)
        roles[: len(chosen)] = chosen
        positions[: len(chosen)] = y[chosen] + rng.randn(len(chosen), 3) * 0.01
    return roles, positions


def mirrored(sample, rng):
    """The sample in the mirror, with other pins: as good a sample, and drawn for nothing."""
    inputs = reader.mirrored_inputs(sample.inputs)
    y, has = sample.y[words.MIRROR_ROLE] * reader.MIRROR, sample.has[words.MIRROR_ROLE]
    pin_roles, pin_positions = _pins(has > 0, y, rng)
    return Sample(inputs, y, has, words.MIRROR_PART[sample.part], sample.bone * np.tile(reader.MIRROR, 2),
                  sample.bone_known, sample.plan, sample.fingers[::-1].copy(), pin_roles.astype("i8"), pin_positions)


def _off_axes(acts, rng):
    """A rotation vector: bodies are not exactly along the axes, and whose pose is not symmetric may look aside."""
    off = rng.randn(3) * np.radians([5, 8, 4])
    if acts and rng.rand() < 0.4:
        off[1] = np.radians(rng.uniform(-45, 45))
    return off


def _as_made(body, rng):
    """The body in its maker's pose and proportions, nearly: what limber is mostly given."""
    cloud = _at_rest(body)
    if rng.rand() < 0.3:
        _thicken(cloud, rng)
    _transform(cloud, np.diag(np.exp(rng.randn(3) * 0.03)))
    if rng.rand() < 0.5:
        _mirror(cloud)
    _transform(cloud, rotations(rng.randn(1, 3) * np.radians([2, 3, 1]))[0].astype(float))
    return _finish(cloud, body, rng)


def vary(body, rng):
    """A training sample."""
    if rng.rand() < AS_MADE:
        return _as_made(body, rng)
    acts = body.plan == words.PLAN["upright"] and rng.rand() < 0.45
    cloud = _cloud_of(body, *_pose(body, acts, rng))
    _lose_parts(cloud, body, rng)
    if rng.rand() < 0.15:
        _lose_fingers(cloud, body, rng)
    if rng.rand() < 0.4:
        _thicken(cloud, rng)
    if rng.rand() < 0.4:
        _bend(cloud, rng)
    if rng.rand() < 0.35:
        _dress(cloud, body, rng)
    if acts and rng.rand() < 0.35:
        size = np.linalg.norm(np.ptp(cloud.points, axis=0))
        _support(cloud, size, len(body.points) // 30, rng)
    if rng.rand() < 0.2:
        _break(cloud, rng)
    _damage(cloud, rng)
    _transform(cloud, np.diag(np.exp(rng.randn(3) * 0.1)))
    if rng.rand() < 0.5:
        _mirror(cloud)
    _transform(cloud, rotations(_off_axes(acts, rng)[None])[0].astype(float))
    return _finish(cloud, body, rng)


def _finish(cloud, body, rng):
    points = cloud.points.astype("f4")
    chosen, radii = samples.pool_tokens(points, cloud.normals)
    inputs, centre, scale = samples.token_inputs(points[chosen], cloud.normals[chosen], radii, cloud.pieces[chosen])
    y = ((cloud.roles - centre) / scale * cloud.has[:, None]).astype("f4")
    bone = np.concatenate([cloud.start[chosen] - points[chosen], cloud.end[chosen] - points[chosen]], 1) / scale
    pin_roles, pin_positions = _pins(cloud.has, y, rng)
    return Sample(inputs, y, cloud.has.astype("f4"), cloud.part[chosen].astype("i8"), bone.astype("f4"),
                  cloud.known[chosen].astype("f4"), body.plan, cloud.fingers.astype("i8"), pin_roles.astype("i8"),
                  pin_positions)

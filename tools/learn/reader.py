"""Reads bodies with trained networks: the mean of a body's and its mirror image's reading, in the body's frame."""
import numpy as np
import torch

import vocabulary as words

MIRROR = np.array([-1.0, 1.0, 1.0], "f4")
_AXES = np.r_[0:3, 3:6, 6:9]  # of inputs: position, normal, ball's centre


def mirrored_inputs(inputs):
    result = inputs.copy()
    result[:, _AXES] *= np.tile(MIRROR, 3)
    return result


def turned_inputs(inputs, rotation):
    """The tokens of the body rotated by a (3, 3) matrix."""
    result = inputs.copy()
    for start in (0, 3, 6):
        result[:, start : start + 3] = inputs[:, start : start + 3] @ rotation.T
    return result


def in_all_stances(inputs):
    """(24, tokens, 11): the tokens as each of vocabulary.STANCES turns them."""
    return np.stack([turned_inputs(inputs, stance.astype("f4")) for stance in words.STANCES])


def softmax(x, axis=-1):
    e = np.exp(x - x.max(axis, keepdims=True))
    return e / e.sum(axis, keepdims=True)


def _once(network, inputs, pins):
    roles = positions = None
    if pins:
        roles = torch.tensor([list(pins)])
        positions = torch.from_numpy(np.array([list(pins.values())], "f4"))
    with torch.no_grad():
        said = network(torch.from_numpy(inputs[None]), roles, positions)
    return {name: value[0].numpy() for name, value in said.items()}


def read(network, inputs, centre=0.0, scale=1.0, pins=None, both=True):
    """What the network says of tokens. pins: role index -> position, in the frame of the body as are all results.

    y, sigma (expected error), has (probabilities), plan_logits, part (tokens, parts), bone (tokens, 6), fingers (2, 6).
    A pinned role is present, without error, where it is pinned."""
    pins = pins or {}
    own = {role: (np.asarray(position) - centre) / scale for role, position in pins.items()}
    said = _once(network, inputs, own)
    if both:
        flipped = {int(words.MIRROR_ROLE[role]): position * MIRROR for role, position in own.items()}
        other = _once(network, mirrored_inputs(inputs), flipped)
        other["y"] = other["y"][words.MIRROR_ROLE] * MIRROR
        other["bone"] = other["bone"] * np.tile(MIRROR, 2)
        other["part"] = other["part"][:, words.MIRROR_PART]
        other["fingers"] = other["fingers"][::-1]
        for name in ("has", "sig"):
            other[name] = other[name][words.MIRROR_ROLE]
        said = {name: (said[name] + other[name]) / 2 for name in said}
    result = {
        "y": said["y"] * scale + centre, "sigma": np.exp(said["sig"]) * scale, "has": 1 / (1 + np.exp(-said["has"])),
        "plan_logits": said["plan"], "part": softmax(said["part"]), "bone": said["bone"] * scale,
        "fingers": softmax(said["fingers"]),
    }
    for role, position in pins.items():
        result["y"][role], result["sigma"][role], result["has"][role] = position, 0, 1
    return result


def read_stance(network, inputs):
    """Probabilities of the 24 stances, each of which brings the given frame to the body's."""
    with torch.no_grad():
        return softmax(network(torch.from_numpy(in_all_stances(inputs))).numpy())

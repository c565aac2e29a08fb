"""Trained networks -> one weights file, as limber/reading loads it, and back.

Little endian: "LRD1", the length of a JSON text (u32), the text, zeros to a multiple of 4, then all tensors as IEEE
half precision numbers in the order of the text's list "tensors", zeros to a multiple of 4. Matrices of linear steps
are input-major: row = input.
"""
import json
import os
import struct

import numpy as np
import torch
import torch.nn as nn

import samples
import vocabulary as words
from reader import read_stance
from network import STANCE_TOKENS, load_network, make_network

MAGIC = b"LRD1"
MAX_BYTES = 1_500_000
NO_CALIBRATION = {"plan_temperature": 1.0, "error_factor": 1.0, "sure_threshold": 0.9}


def is_weights_file(source):
    return source.endswith(".lrd")


def trained_for(source, kind):
    """Samples and hours of a run, or of a weights file, and of what its weights started from."""
    samples, hours = 0, 0.0
    while source:
        if is_weights_file(source):
            card = read_weights(source)[1]["card"]
            samples, hours, source = samples + card["samples"][kind], hours + card["hours"][kind], ""
        else:
            saved = torch.load(os.path.join(source, "state.pt"), map_location="cpu")
            samples += saved["step"] * saved["batch"]
            hours += saved["seconds"] / 3600
            with open(os.path.join(source, "run.json"), encoding="utf-8") as file:
                source = json.load(file)["options"]["start"]
    return {"samples": samples, "hours": round(hours, 2)}


def network_of(source, kind):
    """The network of a run or a weights file, and its sizes."""
    if is_weights_file(source):
        networks, about = read_weights(source)
        return networks[kind], _sizes(about["networks"][kind])
    network, saved = load_network(os.path.join(source, "state.pt"))
    return network, saved["sizes"]


def _sizes(about):
    return {name: size for name, size in about.items() if name not in ("features", "tokens")}


def blend(network, others):
    """The mean of the weights of networks that were trained on from one another (Wortsman et al. 2022, Model soups)."""
    with torch.no_grad():
        for value, *rest in zip(network.parameters(), *(other.parameters() for other in others)):
            value.copy_(torch.stack([value, *rest]).mean(0))


def _linear_weights(network):
    return {f"{name}.weight" for name, module in network.named_modules() if isinstance(module, nn.Linear)}


def _tensors(kind, network):
    linear = _linear_weights(network)
    for name, value in network.state_dict().items():
        yield f"{kind}.{name}", (value.T if name in linear else value).contiguous().numpy()


def _padded(data):
    return data + b"\0" * (-len(data) % 4)


def write_weights(path, networks, calibration=None, card=None):
    """networks: kind -> (network, sizes). Returns the number of bytes."""
    tensors = [entry for kind, (network, _) in sorted(networks.items()) for entry in _tensors(kind, network.cpu())]
    for name, value in tensors:
        if not np.isfinite(value.astype("f2")).all():
            raise SystemExit(f"{name} has numbers that half precision does not hold")
    tokens = {"reading": samples.TOKENS, "stance": STANCE_TOKENS}
    text = json.dumps({
        "networks": {kind: {**sizes, "features": samples.FEATURES, "tokens": tokens[kind]}
                     for kind, (_, sizes) in sorted(networks.items())},
        "roles": words.ROLES, "parts": words.PARTS, "plans": words.PLANS,
        "calibration": {name: (calibration or NO_CALIBRATION)[name] for name in NO_CALIBRATION}, "card": card or {},
        "tensors": [{"name": name, "shape": list(value.shape)} for name, value in tensors],
    }, separators=(",", ":")).encode()
    data = b"".join(value.astype("<f2").tobytes() for _, value in tensors)
    whole = _padded(MAGIC + struct.pack("<I", len(text)) + text) + _padded(data)
    if len(whole) > MAX_BYTES:
        raise SystemExit(f"the weights file would have {len(whole)} bytes, more than {MAX_BYTES}")
    with open(path, "wb") as file:
        file.write(whole)
    return len(whole)


def read_weights(path):
    """kind -> network of a weights file, and the file's JSON."""
    with open(path, "rb") as file:
        whole = file.read()
    if whole[:4] != MAGIC:
        raise SystemExit(f"{path} is no weights file of limber")
    size = struct.unpack_from("<I", whole, 4)[0]
    about = json.loads(whole[8 : 8 + size])
    at, values = len(_padded(whole[: 8 + size])), {}
    for entry in about["tensors"]:
        count = int(np.prod(entry["shape"]))
        values[entry["name"]] = np.frombuffer(whole, "<f2", count, at).reshape(entry["shape"]).astype("f4")
        at += 2 * count
    networks = {}
    for kind, sizes in about["networks"].items():
        network, _ = make_network(kind, **_sizes(sizes))
        linear = _linear_weights(network)
        state = {}
        for name in network.state_dict():
            value = values[f"{kind}.{name}"]
            state[name] = torch.from_numpy(np.ascontiguousarray(value.T if name in linear else value))
        network.load_state_dict(state)
        networks[kind] = network.eval()
    return networks, about


def write_golden(path, networks, bodies):
    """Inputs and outputs of some bodies, to compare another implementation of the arithmetic with."""
    cases = []
    for body in bodies:
        inputs, centre, scale, _ = body.tokens()
        tensor = torch.from_numpy(inputs[None])
        with torch.no_grad():
            case = {"name": body.name, "inputs": inputs.tolist(), "centre": centre.tolist(), "scale": scale}
            if "reading" in networks:
                pinned = int(np.flatnonzero(body.has)[0]) if body.has.any() else 0
                position = ((body.roles[pinned] - centre) / scale).astype("f4")
                said = networks["reading"](tensor)
                after = networks["reading"](tensor, torch.tensor([[pinned]]), torch.from_numpy(position[None, None]))
                case["reading"] = {name: value[0].tolist() for name, value in said.items()}
                case["pin"] = {"role": pinned, "position": position.tolist(), "y": after["y"][0].tolist()}
            if "stance" in networks:
                case["stance"] = read_stance(networks["stance"], inputs).tolist()
        cases.append(case)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(cases, file)

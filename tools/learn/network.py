"""The two networks: "reading" (joints, parts, plan, bones, fingers of a body) and "stance" (which way is up and front).

Tokens of the surface; the first of them are positions with their neighbours; a small transformer over these, a few
tokens for the whole body and the pins that a user set. Roles are found by votes over the positions. limber/reading does
the same arithmetic; what changes here changes there.
"""
import torch
import torch.nn as nn
import torch.nn.functional as F

import samples
import vocabulary as words

SIGMA_RANGE = (-6.0, 2.0)  # of the logarithm of a role's expected error
READING = {"width": 96, "layers": 6, "heads": 4, "ratio": 2, "places": 96, "near": 12, "globals": 4}
STANCE = {"width": 64, "layers": 3, "heads": 4, "ratio": 2, "places": 48, "near": 8, "globals": 4}
STANCE_TOKENS = 256  # the first of them: 24 passes are made
EMBEDDING = 64


class Layer(nn.Module):
    """Attention and two linear steps, each on a normalised copy and added; `padding` (batch, n) is what is no token."""

    def __init__(self, width, heads, ratio):
        super().__init__()
        self.heads = heads
        self.n1, self.n2 = nn.LayerNorm(width, eps=1e-5), nn.LayerNorm(width, eps=1e-5)
        self.qkv, self.out = nn.Linear(width, 3 * width), nn.Linear(width, width)
        self.a, self.b = nn.Linear(width, ratio * width), nn.Linear(ratio * width, width)

    def forward(self, x, padding=None):
        batch, count, width = x.shape
        q, k, v = self.qkv(self.n1(x)).view(batch, count, 3, self.heads, width // self.heads).permute(2, 0, 3, 1, 4)
        attention = q @ k.transpose(-1, -2) * (width // self.heads) ** -0.5
        if padding is not None:
            attention = attention.masked_fill(padding[:, None, None], -1e9)
        attention = torch.softmax(attention, -1)
        x = x + self.out((attention @ v).transpose(1, 2).reshape(batch, count, width))
        return x + self.b(F.relu(self.a(self.n2(x))))


def with_sines(inputs):
    """(batch, tokens, 11) as samples.token_inputs -> (batch, tokens, 29)."""
    position = inputs[..., :3]
    return torch.cat([inputs] + [f(position * s) for s in samples.SINE_SCALES for f in (torch.sin, torch.cos)], -1)


class Trunk(nn.Module):
    """What both networks share: from tokens to a vector of the whole and one for each position."""

    def __init__(self, width, layers, heads, ratio, places, near, **other):
        super().__init__()
        self.positions, self.near, self.globals = places, near, other["globals"]
        self.e1, self.e2 = nn.Linear(samples.FEATURES, EMBEDDING), nn.Linear(EMBEDDING, width)
        self.wf, self.wr, self.wg = nn.Linear(width, width), nn.Linear(4, width), nn.Linear(width, width)
        self.token = nn.Parameter(torch.randn(self.globals, width) * 0.1)
        self.layers = nn.ModuleList([Layer(width, heads, ratio) for _ in range(layers)])
        self.norm = nn.LayerNorm(width, eps=1e-5)
        self.whole = nn.Linear(self.globals * width, width)

    def encode(self, inputs, pins=None, padding=None):
        """(vector of the whole, of each position, of each token before attention, each token's nearest position)."""
        batch = len(inputs)
        point = inputs[..., :3]
        token = self.e2(F.relu(self.e1(with_sines(inputs))))
        centre = point[:, : self.positions]
        with torch.no_grad():
            distance = ((centre[:, :, None] - point[:, None]) ** 2).sum(-1)
            near = distance.topk(self.near, largest=False)[1]
            own = distance.argmin(1)
        row = torch.arange(batch, device=inputs.device)[:, None, None]
        offset = point[row, near] - centre[:, :, None]
        offset = torch.cat([offset, offset.norm(dim=-1, keepdim=True)], -1)
        gathered = F.relu(self.wf(F.relu(token))[row, near] + self.wr(offset)).max(2)[0]
        x = torch.cat([self.token.expand(batch, -1, -1), token[:, : self.positions] + self.wg(gathered)], 1)
        if pins is not None:
            here = torch.zeros(x.shape[:2], dtype=torch.bool, device=x.device)
            x, padding = torch.cat([x, pins], 1), torch.cat([here, padding], 1)
        for layer in self.layers:
            x = layer(x, padding if pins is not None else None)
        x = self.norm(x)
        whole = F.relu(self.whole(x[:, : self.globals].reshape(batch, -1)))
        return whole, x[:, self.globals : self.globals + self.positions], token, own


class Reading(Trunk):
    def __init__(self, **sizes):
        super().__init__(**sizes)
        width, roles = sizes["width"], len(words.ROLES)
        self.vote, self.off = nn.Linear(width, roles), nn.Linear(width, 3 * roles)
        self.has, self.sig = nn.Linear(width, roles), nn.Linear(width, roles)
        self.plan, self.fingers = nn.Linear(width, len(words.PLANS)), nn.Linear(width, 2 * (words.FINGERS + 1))
        self.p1, self.p2 = nn.Linear(2 * width, width), nn.Linear(width, len(words.PARTS))
        self.p2b = nn.Linear(width, 6)
        self.role_table = nn.Parameter(torch.randn(roles, width) * 0.1)
        self.pin = nn.Linear(3, width)
        self.pin_vector = nn.Parameter(torch.randn(width) * 0.1)

    def forward(self, inputs, pin_roles=None, pin_positions=None, some=slice(None)):
        """pin_roles (batch, pins) with -1 for none, pin_positions (batch, pins, 3); `some`: the tokens whose part and
        bone are asked for. Returns y (batch, roles, 3) in the tokens' frame, has, sig, plan, fingers, part, bone."""
        pins = padding = None
        if pin_roles is not None and pin_roles.shape[1]:
            padding = pin_roles < 0
            pins = self.role_table[pin_roles.clamp(min=0)] + self.pin(pin_positions) + self.pin_vector
        whole, x, token, own = self.encode(inputs, pins, padding)
        batch = len(inputs)
        attention = torch.softmax(self.vote(x), 1)
        offset = self.off(x).view(batch, self.positions, -1, 3)
        y = (attention[..., None] * (inputs[:, : self.positions, None, :3] + offset)).sum(1)
        token, own = token[:, some], own[:, some]
        row = torch.arange(batch, device=inputs.device)[:, None]
        hidden = F.relu(self.p1(torch.cat([F.relu(token), x[row, own]], -1)))
        return {
            "y": y, "has": self.has(whole), "sig": self.sig(whole).clamp(*SIGMA_RANGE), "plan": self.plan(whole),
            "fingers": self.fingers(whole).view(batch, 2, words.FINGERS + 1), "part": self.p2(hidden),
            "bone": self.p2b(hidden),
        }


class Stance(Trunk):
    def __init__(self, **sizes):
        super().__init__(**sizes)
        self.score = nn.Linear(sizes["width"], 1)

    def forward(self, inputs):
        """(batch,): how well the bodies stand, up +Y and front +Z; of a body's 24 stances the one that scores most is it."""
        return self.score(self.encode(inputs[:, :STANCE_TOKENS])[0])[:, 0]


KINDS = {"reading": (Reading, READING), "stance": (Stance, STANCE)}


def make_network(kind, **sizes):
    """The network of a kind, and the sizes that it was made with."""
    network, usual = KINDS[kind]
    sizes = {**usual, **sizes}
    return network(**sizes), sizes


def load_network(path, mean=True):
    """A trained network of a checkpoint, ready to read; `mean`: the running mean of its weights, which reads better."""
    saved = torch.load(path, map_location="cpu")
    network, _ = make_network(saved["kind"], **saved["sizes"])
    network.load_state_dict(saved["mean"] if mean else saved["network"])
    return network.eval(), saved

"""What plans of bodies have in common: joints with the ends of their bones, named parts, flesh in a style, heads,
hands, legs, wings, tails, things worn and held. Frame: +Y up, +Z front, +X the body's left; bodies are
about 1 to 2 long."""
import numpy as np

from made_shapes import ball, box, frame, lateral, plate, sheet, smooth_line, sweep, turn, unit, vec

Y, Z, X = vec(0, 1, 0), vec(0, 0, 1), vec(1, 0, 0)
SIDES = (('L', 1.0), ('R', -1.0))
STYLES = dict(box=.2, prism=.08, capsule=.16, smooth=.3, cylinder=.07, lowpoly=.12, ball=.07)


class Maker:
    """A body under construction. `r` is the generator of random numbers; style says what flesh is made of."""

    def __init__(self, r, style=None):
        self.r = r
        self.style = style or r.choice(list(STYLES), p=list(STYLES.values()))
        self.corners = {'box': 4, 'prism': 4,
                        'lowpoly': int(r.choice([5, 6, 7]))}.get(self.style, int(r.choice([8, 10, 12, 14])))
        self.hard = self.style in ('box', 'prism', 'cylinder', 'ball')
        self.parents, self.J, self.tips, self.parts, self.pieces = [], [], [], [], []
        self.fingers, self.toes, self.taper = [0, 0], {}, self.r.uniform(1, 3)

    def toes_of(self, ankle):
        return self.toes.get(ankle)

    # --- random numbers
    def u(self, a, b):
        return self.r.uniform(a, b)

    def maybe(self, p):
        return self.r.rand() < p

    def pick(self, *what):
        return what[self.r.randint(len(what))]

    # --- skeleton
    def joint(self, p, parent, tip=None):
        self.parents.append(parent)
        self.J.append(np.array(p, float))
        self.tips.append(None if tip is None else np.array(tip, float))
        return len(self.J) - 1

    def chain(self, P, parent):
        """Joints at all rows of P but the last, which is where the last bone ends."""
        out = []
        for a, b in zip(P[:-1], P[1:]):
            parent = self.joint(a, parent, b)
            out.append(parent)
        return out

    def part(self, kind, side, joints, pair=0, **landmarks):
        d = dict(kind=kind, side={'L': 'left', 'R': 'right', '': 'center'}[side], pair=int(pair),
                 joints=['j%d' % j for j in joints])
        d.update({k: 'j%d' % j for k, j in landmarks.items() if j is not None})
        self.parts.append(d)

    # --- surface
    def add(self, piece, *joints, flesh=True, smooth=0.0):
        piece.joints, piece.flesh, piece.smooth = list(joints), flesh, smooth
        self.pieces.append(piece)
        return piece

    def blob(self, c, h, joint, M=np.eye(3), flesh=True, style=None):
        """A rounded lump in the body's style."""
        style = style or self.style
        if style in ('box', 'prism'):
            taper = (1, 1) if style == 'box' else self.r.uniform(.6, 1.1, 2)
            return self.add(box(c, np.asarray(h) * (.9, .9, .95), M, taper), joint, flesh=flesh)
        return self.add(ball(c, h, M, max(self.corners, 6)), joint, flesh=flesh)

    def flesh(self, P, rad, joints, style=None, ends='round'):
        """Flesh along the line P (#n + 1), bone i (joints[i]) from P[i] to P[i + 1]. rad: half widths
        (#n + 1, or #n + 1 x 2)."""
        style = style or self.style
        P, rad = np.asarray(P, float), np.asarray(rad, float)
        rad = np.stack([rad, rad], 1) if rad.ndim == 1 else rad
        n = len(joints)
        side = lateral(P)
        if style in ('smooth', 'lowpoly') and n:
            per = 4 if style == 'smooth' else 2
            Q, t = smooth_line(np.c_[P, np.log(np.maximum(rad, 1e-4))], per)
            self.add(sweep(Q[:, :3], np.exp(Q[:, 3:]), np.minimum(t, n - 1e-6), self.corners, 0, ends, side), *joints,
                     smooth=self.r.uniform(.15, .4))
            return
        for k in range(n):
            a, b, ra, rb = P[k], P[k + 1], rad[k], rad[k + 1]
            l = np.linalg.norm(b - a)
            if l < 1e-6:
                continue
            s = side if np.linalg.norm(np.cross(side, unit(b - a))) > .2 else lateral(np.array([a, b]))
            if style == 'box':
                w = np.maximum(ra, rb) * .92
                o = unit(b - a) * min(l * .04, w.min() * .3)
                piece = sweep([a - o, b + o], [w, w], corners=4, square=1, ends='flat', side=s)
            elif style == 'prism':
                piece = sweep([a, b], [ra, rb], corners=4, square=1, ends='flat', side=s)
            elif style == 'cylinder':
                piece = sweep([a, b], [ra * .9, rb * .9], corners=self.corners, ends='flat', side=s)
                if k:
                    self.add(ball(a, np.full(3, ra.mean()) * .95, corners=8), joints[k])
            elif style == 'ball':
                M = np.stack([s, s, unit(b - a)], 1)
                M[:, 0] = unit(s - M[:, 2] * (s @ M[:, 2]))
                M[:, 1] = np.cross(M[:, 2], M[:, 0])
                w = (ra + rb) / 2
                piece = ball((a + b) / 2, (w[0] * 1.1, w[1] * 1.1, l / 2 * 1.12 + w.mean() * .2), M, self.corners)
            else:
                piece = sweep([a, b], [ra, rb], corners=self.corners, ends='round', side=s)
            self.add(piece, joints[k], smooth=0.0)

    def flat(self, outline, thick, c, M, joint, flesh=True):
        return self.add(plate(outline, thick, c, M), joint, flesh=flesh)


def leaf(length, width, r, sharp=.5):
    """Outline of a leaf, feather or fin: from the origin along +y."""
    t = np.linspace(0, 1, 6)
    w = width * np.sin(np.pi * np.clip(t * .85 + .12, 0, 1)) ** r.uniform(.5, 1.5)
    lean = r.uniform(-.3, .3) * length * t ** 2
    w[-1] *= 1 - sharp
    return np.concatenate([np.stack([lean + w, t * length], 1), np.stack([lean - w, t * length], 1)[::-1]])


# --- heads

def head(m, at, parent, d, size, kind=None, up=Y, eyes=None, ears=None):
    """size: half the height of the skull; d: where the face looks; kind: person, snout, beak, flat, bug, block."""
    r = m.r
    d = unit(d)
    M = frame(d, up)
    up = M[:, 1]
    j = m.joint(at, parent)
    m.part('head', '', [j])
    kind = kind or m.pick('person', 'snout', 'beak', 'flat', 'block')
    on_top = kind in ('person', 'block')
    h = size * {'person': vec(m.u(.7, 1), 1, m.u(.75, 1.05)), 'block': vec(m.u(.8, 1.2), 1, m.u(.7, 1.1)),
                'snout': vec(m.u(.6, 1), m.u(.7, 1), m.u(.8, 1.2)),
                'beak': vec(m.u(.7, 1), m.u(.8, 1), m.u(.8, 1.1)), 'flat': vec(m.u(.7, 1.2), m.u(.35, .6),
                                                                               m.u(.9, 1.5)),
                'bug': vec(m.u(.6, 1.3), m.u(.5, 1), m.u(.5, 1))}[kind]
    c = at + (up * h[1] * .9 + d * h[2] * m.u(0, .25) if on_top else d * h[2] * m.u(.4, .8) + up * h[1] * m.u(0, .4))
    m.tips[j] = c + (up * h[1] if on_top else d * h[2])
    if kind == 'block' and m.style not in ('box', 'prism') and m.maybe(.6):                    # with rounded edges
        o = up * h[1] * m.u(.3, .75)
        m.add(sweep([c - o, c, c + o], np.tile(h[[0, 2]], (3, 1)) * [[m.u(.8, 1)], [1], [m.u(.8, 1)]], None,
                    max(m.corners, 8), m.u(.1, .6), 'round', M[:, 0]), j)
    elif kind == 'block' or (m.style in ('box', 'prism') and m.maybe(.8)):
        m.add(box(c, h * .93, M, r.uniform(.75, 1.1, 2) if m.maybe(.4) else (1, 1)), j)
    else:
        m.add(ball(c, h, M, max(6, m.corners)), j)
    w = size * m.u(.25, .55)
    if kind == 'snout' or kind == 'flat':
        l = size * (m.u(.4, 1.6) if kind == 'snout' else m.u(.6, 2.2))
        s = c + d * h[2] * .45 - up * h[1] * m.u(.1, .4)
        e = s + d * (l + h[2] * .4) - up * l * m.u(-.1, .35)
        flat = m.u(.35, .7) if kind == 'flat' else m.u(.7, 1)
        tip = m.u(.35, 1)
        own = m.maybe(.45)
        up_rad = np.array([[w, w * flat], [w * tip, w * flat * tip]])
        m.flesh([s, e], up_rad * (1, .7 if own else 1), [j], ends='round')
        m.tips[j] = e
        if own:
            o = up * w * flat
            k = m.joint(s - o, j, e - o - up * l * m.u(0, .3))
            m.part('jaw', '', [k])
            m.flesh([s - o, m.tips[k]], up_rad * (.9, .5), [k])
        elif m.maybe(.3):
            m.blob(e, np.full(3, w * tip * .5), j, flesh=False)
    elif kind == 'beak':
        l, s = size * m.u(.3, 1.6), c + d * h[2] * .75 - up * h[1] * m.u(-.1, .2)
        e = s + d * l - up * l * m.u(-.05, .4)
        rad = np.array([[w * .7, w * .5], [w * .1, w * .08]])
        if m.maybe(.2):
            rad = np.array([[w, w * .3], [w, w * .2]])
        if m.maybe(.3):
            o = up * w * .3
            k = m.joint(s - o, j, e - o)
            m.part('jaw', '', [k])
            m.add(sweep([s - o, e - o], rad * (1, .6), corners=6, ends='flat'), k)
        m.add(sweep([s, e], rad, corners=6, ends='flat'), j)
        m.tips[j] = e
        if m.maybe(.2):
            m.flat(leaf(size * m.u(.4, 1), size * .25, r), size * .1, c + up * h[1] * .8 - d * size * .1,
                   np.stack([-d, up, M[:, 0]], 1), j)
    elif kind == 'person':
        if m.maybe(.5):
            n = c + d * h[2] * .95
            m.add(ball(n, size * r.uniform(.08, .25, 3), M, 6), j)
        if m.maybe(.35):                                              # jaw or beard
            m.blob(c - up * h[1] * m.u(.6, 1) + d * h[2] * m.u(.2, .6),
                   size * vec(m.u(.3, .7), m.u(.2, .7), m.u(.2, .6)), j, M)
    elif kind == 'bug':
        if m.maybe(.6):
            for s, q in SIDES:
                a = c + M @ (vec(q * .4, .5, .3) * h)
                e = a + M @ (vec(q * m.u(.2, .6), m.u(.1, .8), m.u(.4, 1)) * size * m.u(.8, 2.5))
                m.add(sweep([a, (a + e) / 2 + up * size * .2, e], np.full(3, size * m.u(.04, .1)), corners=5), j)
        if m.maybe(.5):
            for s, q in SIDES:
                a, l = c + M @ (vec(q * .4, -.4, .7) * h), size * m.u(.3, 1)
                m.add(sweep([a, a + M @ (vec(q * .4, -.1, 1) * l * .6), a + M @ (vec(0, -.1, 1.2) * l)],
                            size * vec(.15, .12, .03), corners=5), j)
    if eyes if eyes is not None else m.maybe(.55):
        e, out = size * m.u(.12, .35), m.u(.3, .75)
        for s, q in SIDES:
            p = c + M @ (vec(q * out, .3, (1 - out ** 2 * .6) ** .5) * h * .95)
            m.add(ball(p, np.full(3, e) * (1, 1, m.u(.3, 1)), M, 8), j, flesh=False)
    if ears if ears is not None else m.maybe({'person': .4, 'block': .2, 'snout': .85, 'beak': .12, 'flat': .15,
                                              'bug': 0}[kind]):
        e, w, own = size * m.u(.3, 1.7), size * m.u(.15, .45), m.maybe(.4)
        if kind == 'person' and m.maybe(.5):
            e = size * .35
        v = unit(M @ vec(m.u(.1, 1), m.u(.1, 1.2) if kind != 'person' else m.u(-.2, 1), m.u(-.5, .2)))
        form = m.pick('leaf', 'cone', 'ball', 'flesh')
        for s, q in SIDES:
            b = c + M @ (vec(q * .75, .55, -.1) * h)
            w0 = v - M[:, 0] * (M[:, 0] @ v) * (1 - q)
            k = j
            if own:
                k = m.joint(b, j, b + w0 * e)
                m.part('ear', s, [k])
            if form == 'leaf':
                F = frame(w0, -d)
                m.flat(leaf(e, w, r), w * m.u(.1, .5), b, np.stack([F[:, 0], w0, np.cross(F[:, 0], w0)], 1), k)
            elif form == 'cone':
                m.add(sweep([b - w0 * e * .1, b + w0 * e], vec([w, w * .5], [w * .08, w * .08]),
                            corners=max(4, m.corners - 4), ends='flat', side=M[:, 0]), k)
            elif form == 'ball':
                m.blob(b + w0 * w * .6, np.array([w, w, w * .5]), k, M)
            else:
                m.flesh([b, b + w0 * e], [w * .7, w * .3], [k])
    if m.maybe({'beak': .04, 'person': .07, 'block': .1}.get(kind, .2)):                              # horns, antlers
        l, w, n = size * m.u(.3, 2.2), size * m.u(.06, .22), m.pick(1, 2, 2, 2)
        branch = m.maybe(.3)
        v, bend = M @ vec(m.u(.1, 1), m.u(.4, 1), m.u(-.6, .5)), M @ vec(m.u(-.5, .5), m.u(0, 1), m.u(-.8, .8))
        for s, q in SIDES[:n]:
            f = np.eye(3) - (1 - q) * np.outer(M[:, 0], M[:, 0])
            a = c + M @ (vec(q * .45 if n == 2 else 0, .8, .1) * h)
            if n == 1:
                f = np.eye(3) - np.outer(M[:, 0], M[:, 0])
            P = np.array([a, a + f @ unit(v) * l * .5, a + f @ unit(v + bend * .7) * l])
            m.add(sweep(smooth_line(P, 3)[0], np.linspace(w, w * .15, 7), corners=5), j)
            if branch:
                for t in (.45, .8):
                    b = a + (P[2] - a) * t
                    m.add(sweep([b, b + f @ unit(M @ r.randn(3) * (.4, 1, .6) + up) * l * .35], [w * .6, w * .1],
                                corners=4), j)
    m.skull = (c, h, M)
    return j


def hair(m, j, size):
    c, h, M = m.skull
    up, d, form = M[:, 1], M[:, 2], m.pick('cap', 'cap', 'long', 'spikes', 'buns')
    if form in ('cap', 'long'):
        m.blob(c + up * h[1] * m.u(.15, .3) - d * h[2] * m.u(.1, .25), h * m.u(1.02, 1.2), j, M, flesh=m.maybe(.5))
    if form == 'long':
        l, w = size * m.u(1, 4), h[0] * m.u(.6, 1.1)
        a = c - d * h[2] * .8
        m.flesh([a, a - up * l - d * l * m.u(0, .2)], [[w, h[2] * .3], [w * m.u(.5, 1.2), h[2] * .15]], [j],
                style=m.pick('box', 'smooth', 'capsule'))
    if form == 'spikes':
        for _ in range(m.r.randint(4, 12)):
            v = unit(m.r.randn(3) * (1, .6, 1) + up * 1.1 - d * .6)
            a = c + v * h * .8
            m.add(sweep([a, a + v * size * m.u(.3, .9)], [size * .25, size * .02], corners=5, ends='flat'), j)
    if form == 'buns':
        for s, q in SIDES:
            m.blob(c + M @ (vec(q * .9, m.u(.2, .8), -.4) * h), np.full(3, size * m.u(.25, .5)), j, M)


# --- chains

def tail(m, at, parent, length, radius, d, n, sag=0.0, tip=None, kind='tail', side='', flat=1.0, wave=0.0, style=None,
         curl=0.0):
    """Tail of n joints from `at` along d; `sag` bends it towards up (or down), at most upright, `curl` by an angle over
    its length, past upright too. Returns joints and line."""
    if not curl and n > 3 and m.maybe(.12):
        sag, curl = 0.0, m.pick(-1, 1, 1) * m.u(1, 4)
    n = max(n, 2) if length > 1 else n
    P, p, d = [np.array(at, float)], np.array(at, float), unit(d)
    for k in range(n):
        d = unit(turn(X, curl / n) @ d + vec(wave * np.sin(k * 1.7), sag / n, 0))
        p = p + d * length / n
        P.append(p)
    P = np.array(P)
    js = m.chain(P, parent)
    m.part(kind, side, js)
    s = np.linspace(0, 1, n + 1)
    end = tip if tip is not None else m.u(.08, .8)
    w = radius * (1 + (end - 1) * s ** m.u(.6, 1.6))
    m.flesh(P, np.stack([w, w * flat], 1), js, style=style)
    if m.maybe(.15):
        m.blob(P[-1], np.full(3, radius * m.u(.5, 1.5)), js[-1])
    return js, P


def trunk(m, P, rad, style=None):
    """Trunk along P (#n + 1) with half widths rad (#k x 2, resampled). Returns its joints."""
    P = np.asarray(P, float)
    js = m.chain(P, -1)
    m.part('trunk', '', js)
    n = len(js)
    rad = np.asarray(rad, float)
    s, q = np.linspace(0, 1, n + 1), np.linspace(0, 1, len(rad))
    style = style or m.style
    if style in ('smooth', 'lowpoly'):
        t = np.linspace(0, 1, max(2 * n, 6) + 1)
        w = smooth_line(np.log(rad), 6)[0]
        w = np.exp(np.stack([np.interp(t, np.linspace(0, 1, len(w)), w[:, k]) for k in (0, 1)], 1))
        Q = np.stack([np.interp(t, s, P[:, k]) for k in range(3)], 1)
        if n > 2:
            L, tt = smooth_line(P, 6)
            Q = np.stack([np.interp(t * n, tt, L[:, k]) for k in range(3)], 1)
        m.add(sweep(Q, w, np.minimum(t * n, n - 1e-6), m.corners + 2, m.u(0, .15), 'round', X), *js, smooth=m.u(.2, .5))
        return js
    w = np.stack([np.interp(s, q, rad[:, k]) for k in (0, 1)], 1)
    if style in ('box', 'prism') and n > 1 and m.maybe(.6):                  # fewer boxes than bones
        k = m.r.randint(1, 3)
        cut = np.linspace(0, n, k + 1)
        for i in range(k):
            a, b = (np.array([np.interp(cut[i + e], np.arange(n + 1), P[:, c]) for c in range(3)]) for e in (0, 1))
            wa, wb = (np.array([np.interp(cut[i + e] / n, q, rad[:, c]) for c in (0, 1)]) for e in (0, 1))
            big = np.maximum(wa, wb)
            o = unit(b - a) * big[1] * m.u(.1, .5)
            piece = sweep([a - o * (i == 0), b + o * (i == k - 1)], [big, big] if style == 'box' else [wa, wb],
                          corners=4, square=1, ends='flat', side=X)
            t = (piece.V - P[0]) @ unit(P[-1] - P[0]) / max(np.linalg.norm(P[-1] - P[0]), 1e-9) * n
            piece.u = np.clip(t, 0, n - 1e-6)
            m.add(piece, *js)
        return js
    if style == 'cylinder':
        style = m.pick('cylinder', 'capsule', 'box')
    m.flesh(P, w, js, style='capsule' if style == 'ball' and n == 1 else style)
    return js


def neck(m, at, parent, end, n, r0, r1, bow=0.0):
    """n joints (0: flesh only) from `at` to `end`; returns the joint to hang a head from."""
    at, end = np.asarray(at, float), np.asarray(end, float)
    t = np.linspace(0, 1, max(n, 1) + 1)
    P = at + np.outer(t, end - at) + np.outer(np.sin(np.pi * t) * bow, Z)
    if n:
        js = m.chain(P, parent)
        m.part('neck', '', js)
        m.flesh(P, np.linspace(r0, r1, n + 1), js)
        return js[-1]
    m.flesh(P, [r0, r1], [parent])
    return parent


def limb(m, side, P, rad, parent, kind, pair=0, end=0.0, collar=None, toes=None, style=None, flat=1.0):
    """Leg or arm with joints at P (#n + 1; the last is the ankle or wrist, a joint of its own where end > 0).
    end: length of foot or hand; toes: fraction of the foot where a joint of toes sits. Returns joints and the
    end's joint."""
    P = np.asarray(P, float)
    n = len(P) - 1
    js, p = [], parent
    if collar is not None:
        p = m.joint(collar, parent, P[0])
        js.append(p)
    seg = m.chain(P, p)
    land = dict(upper=seg[0])
    if n >= 2:
        land['middle'] = seg[1]
    if n >= 3:
        land['hock'] = seg[2]
    m.flesh(P, np.stack([np.asarray(rad), np.asarray(rad) * flat], 1), seg, style=style)
    e, last = None, unit(P[-1] - P[-2])
    if end > 0:
        fwd = unit(Z + .25 * P[-1, 0] / max(abs(P[-1, 0]), 1e-9) * X) if kind == 'leg' else last
        tip = P[-1] + fwd * end
        e = m.joint(P[-1], seg[-1], tip)
        land['end'] = e
        ends = [e]
        if kind == 'leg' and toes:
            m.tips[e] = P[-1] + fwd * end * toes - Y * P[-1, 1] * .5
            t = m.joint(m.tips[e], e, tip - Y * P[-1, 1] * .5)
            land['toes'] = t
            m.toes[e] = t
            ends.append(t)
        m.part(kind, side, js + seg + ends, pair, **land)
    else:
        m.part(kind, side, js + seg, pair, **land)
    return seg, e


def foot(m, e, length, width, height, form='shoe', drop=0.0, toes=None):
    """Flesh of a foot from the ankle joint e to the ground, which is at height `drop` below it."""
    a, tip = m.J[e], m.tips[e]
    if toes is not None:
        tip = m.tips[toes]
    d = (tip - a) * (1, 0, 1)
    d = unit(d) if np.linalg.norm(d) > 1e-6 else Z
    M = frame(d)
    c = a + d * length * .5 - Y * (drop - height * .5)
    own = [e] if toes is None else [e, toes]
    if form == 'shoe':
        back = a - d * width * .4 - Y * (drop - height * .5)
        front = a + d * length - Y * (drop - height * .4)
        if m.style in ('box', 'prism') or m.maybe(.15):
            pc = sweep([back - d * width * .3, front], [[width, height / 2], [width, height / 2]], corners=4, square=1,
                       ends='flat', side=M[:, 0])
        else:
            pc = sweep([back, (back + front) / 2, front], [[width * .8, height / 2], [width * .95, height / 2],
                                                           [width, height * .38]], corners=m.corners, side=M[:, 0])
        if toes is not None:
            pc.u = ((pc.V - m.J[toes]) @ d > 0) * 1.0
        m.add(pc, *own)
    elif form == 'paw':
        m.blob(c - d * length * .15, (width, height * .6, length * .6), e, M)
    elif form == 'hoof':
        o = a - Y * drop
        m.add(sweep([a, o], [width * .8, width * 1.15], corners=max(m.corners, 4), ends='flat'), e)
    elif form == 'claws':
        k = m.pick(2, 3, 3, 4)
        for i in range(k):
            v = turn(Y, (i - (k - 1) / 2) * m.u(.35, .6)) @ d
            o = a - Y * (drop - width * .4)
            m.add(sweep([o, o + v * length], [width * .45, width * .12], corners=max(4, m.corners - 4)), e)
        if m.maybe(.5):
            o = a - Y * (drop - width * .3)
            m.add(sweep([o, o - d * length * .5], [width * .4, width * .12], corners=5), e)
        m.blob(a - Y * drop * .5, np.full(3, width * .6), e, M)


def hand(m, side, e, size, fingers):
    """Hand at joint e along its bone: palm and `fingers` fingers with joints, counted from the thumb on."""
    a, d = m.J[e], unit(m.tips[e] - m.J[e])
    t = Z - d * (Z @ d)
    t = unit(t) if np.linalg.norm(t) > .15 else unit(Y - d * (Y @ d))                     # towards the thumb
    M = np.stack([t, np.cross(d, t), d], 1)
    thick = size * m.u(.13, .3)
    palm = size * (m.u(.4, .55) if fingers else m.u(.5, 1))
    w = size * (m.u(.2, .36) if fingers else m.u(.25, .5))
    m.tips[e] = a + d * palm
    if m.style in ('box', 'prism'):
        m.add(box(a + d * palm * .5, (w, thick, palm * .55), M), e)
    else:
        m.add(ball(a + d * palm * .5, (w, thick, palm * .65), M, max(m.corners, 6)), e)
    if not fingers:
        return
    n, thumb = m.r.randint(1, 4), fingers > 1 and m.maybe(.92)
    spread, curl = m.u(.05, .35), m.pick(0, m.u(0, .25), m.u(0, .8))
    long = size * m.u(.45, .8)
    rf = min(w * .9 / max(fingers - thumb, 1), size * m.u(.07, .16)) * m.u(.7, 1)
    inward = np.cross(d, t) * (1 if side == 'L' else -1)
    inward = inward if (inward @ Y <= 0.01 or abs(d[1]) > .7) else -inward  # palm looks down or to the body
    k0 = fingers - (1 if thumb else 0)
    for k in range(fingers):
        if thumb and k == 0:
            b, v, l = a + d * palm * .35 + t * w * .7, unit(t * m.u(.6, 1.1) + d * .8 + inward * .2), long * .75
        else:
            i = k - (1 if thumb else 0)
            x = (0 if k0 == 1 else 1 - 2 * i / (k0 - 1)) * .82
            b = a + d * palm * (1 - .12 * x * x) + t * w * x
            v, l = unit(d + t * x * spread), long * (1 - .18 * abs(x - .15))
        P = [b]
        for i in range(n):
            v2 = unit(v + inward * np.tan(min(curl * (i + .3), 1.2)) * .8)
            P.append(P[-1] + v2 * l / n)
        js = m.chain(P, e)
        m.part('finger', side, js, k)
        m.flesh(P, np.linspace(rf, rf * m.u(.5, .95), n + 1), js, style=m.style if m.style != 'ball' else 'capsule')
    m.fingers[0 if side == 'L' else 1] = fingers


def wings(m, root, parent, span, chord, n, form, direction, sweep_back=.3, fold=0.0):
    """A pair of wings. form: 'feather' plates, 'bat' sheet with rays, 'insect' leaf, 'fold' along the flanks."""
    r = m.r
    thick = chord * m.u(.01, .1)
    if form == 'insect':
        shape = leaf(span, chord * .5, r, sharp=.6)
    for s, q in SIDES:
        f = vec(q, 1, 1)
        d, P = unit(direction) * f, [np.asarray(root) * f]
        for k in range(n):
            P.append(P[-1] + d * span / n)
            if form == 'bat' and n > 1 and fold > 0:
                d = unit(d + (vec(q * .4, -fold * 2.2, -.3) if k == 0 else vec(q * .2, -fold, -fold)))
            elif form != 'fold':
                d = unit(d + vec(0, 0, -sweep_back / n))
        P = np.array(P)
        js = m.chain(P, parent)
        m.part('wing', s, js, 0, upper=js[0])
        bone = min(thick * 1.5 + chord * .02, chord * .15)
        if form != 'insect':
            m.flesh(P, np.linspace(bone, bone * .4, n + 1), js, style='capsule' if m.style == 'smooth' else None)
        if form == 'insect':
            M = frame(d, Y)
            m.add(plate(shape * (q, 1), thick, P[0],
                        np.stack([np.cross(Y, d) if abs(d[1]) < .9 else X, d, np.cross(np.cross(Y, d), d)], 1)), js[0])
            continue
        back = vec(0, -.15, -1.0) if form != 'fold' else vec(q * .15, -1, .25)
        u = np.linspace(0, n, 4 * n + 1)
        L = np.stack([np.interp(u, np.arange(n + 1), P[:, k]) for k in range(3)], 1)
        t = u / n
        w = chord * (1 - m.shape_taper * t ** 2)
        edge = np.ones(len(u))
        if form == 'bat':
            edge = 1 - .35 * np.abs(np.sin(np.pi * t * m.rays))
        w = np.maximum(w * edge, chord * .06)
        G = np.stack([L + np.outer(w * g, unit(back)) + np.outer(np.sin(np.pi * g) * w * .08, Y)
                      for g in (-.06, .3, .65, 1)], 1)
        if form == 'fold':
            G[:, 0] = L + vec(0, 1, 0) * chord * .08
        piece = sheet(G if q > 0 else G[:, ::-1], max(thick, .004) * m.wing_thick, np.minimum(u, n - 1e-6)[:, None])
        m.add(piece, *js, smooth=.2)
        if form == 'bat' and m.maybe(.6):
            for k in range(m.rays + 1):
                i = min(int(k / m.rays * (len(u) - 1)), len(u) - 1)
                m.add(sweep([L[i], G[i, 3] if q > 0 else G[i, 3]], [bone * .7, bone * .25], corners=4),
                      js[min(int(u[i]), n - 1)])


def wing_taste(m):
    m.shape_taper, m.rays, m.wing_thick = m.u(.2, .95), m.pick(2, 3, 4), m.pick(.5, 1, 2, 3)


# --- things worn, held, stood upon

def prop_joint(m, at, parent, tip):
    j = m.joint(at, parent, tip)
    m.part('prop', '', [j])
    return j


def hat(m, parent):
    c, h, M = m.skull
    up, top = M[:, 1], c + M[:, 1] * h[1] * m.u(.45, .75)
    w = (h[0] + h[2]) / 2
    j = prop_joint(m, top, parent, top + up * w)
    form = m.pick('cone', 'brim', 'helmet', 'crown', 'cap')
    n = max(m.corners, 6)
    if form in ('cone', 'brim'):
        l = w * m.u(.7, 2.6)
        m.add(sweep([top, top + up * l], [w * m.u(.75, 1.05), w * (.05 if form == 'cone' else m.u(.5, 1))], corners=n,
                    ends='flat', side=M[:, 0]), j, flesh=False)
        b = w * m.u(1.2, 2.2)
        if form == 'brim' or m.maybe(.7):
            m.add(sweep([top, top + up * w * m.u(.05, .15)], [b, b], corners=n, ends='flat', side=M[:, 0]), j,
                  flesh=False)
    elif form == 'helmet':
        m.blob(c + up * h[1] * .25, h * m.u(1.05, 1.25), j, M, flesh=False, style=m.style if m.maybe(.5) else 'ball')
        if m.maybe(.4):
            m.flat(leaf(w * m.u(.5, 1.4), w * .3, m.r), w * .1, c + up * h[1], np.stack([-M[:, 2], up, M[:, 0]], 1), j,
                   flesh=False)
    elif form == 'crown':
        m.add(sweep([top, top + up * w * m.u(.3, .7)], [w, w * m.u(1, 1.3)], corners=n, ends='open', side=M[:, 0]), j,
              flesh=False)
    else:
        m.blob(top + up * h[1] * .1, vec(w * 1.05, h[1] * .5, w * 1.1), j, M, flesh=False)
        m.add(box(top + M[:, 2] * w * 1.1, (w * .7, h[1] * .06, w * .6), M), j, flesh=False)


def held(m, e, size):
    """A weapon, shield, gun, staff, book or ball in the hand of joint e; size: about the body's height."""
    a, d = m.tips[e], unit(m.tips[e] - m.J[e])
    v = unit(m.pick(Z, Y, Z + Y * .5, unit(m.r.randn(3)), -Y + Z * .3) + m.r.randn(3) * .15)
    M = frame(v, d)
    form, l = m.pick('sword', 'staff', 'shield', 'gun', 'hammer', 'ball', 'book', 'bow'), size * m.u(.2, .8)
    t = size * m.u(.01, .025)
    j = prop_joint(m, a, e, a + v * l * {'gun': .7, 'shield': .1, 'ball': .15, 'book': .1, 'bow': .5}.get(form, 1))
    A = lambda piece: m.add(piece, j, flesh=False)
    if form == 'sword':
        A(sweep([a - v * l * .15, a + v * l * .1], [t, t], corners=6, ends='flat'))
        A(box(a + v * l * .1, (t * m.u(3, 8), t * 1.2, t), M))
        A(sweep([a + v * l * .1, a + v * l * .85, a + v * l], [[t * m.u(1.5, 4), t * .5], [t * 2, t * .5],
                                                               [t * .1, t * .1]], corners=4, square=1, ends='flat',
                                                               side=M[:, 0]))
    elif form in ('staff', 'hammer'):
        A(sweep([a - v * l * m.u(.2, .9), a + v * l], [t, t], corners=6, ends='flat'))
        A((ball if m.maybe(.5) else box)(a + v * l, size * m.r.uniform(.02, .09, 3), M))
    elif form == 'shield':
        w = size * m.u(.08, .22)
        n = unit(d * .3 + Z * m.u(-.2, 1) + X * np.sign(a[0]) * m.u(0, 1))
        A(sweep([a, a + n * t], [[w, w * m.u(.8, 1.5)]] * 2, corners=m.pick(4, 6, 12), ends='flat'))
    elif form == 'gun':
        l *= .7
        A(box(a + v * l * .3, (t, t * 2.2, l * .5), M))
        A(sweep([a, a - M[:, 1] * l * .25], [t, t], corners=4, ends='flat'))
        A(sweep([a + v * l * .7, a + v * l * 1.1], [t * .5, t * .5], corners=6, ends='flat'))
    elif form == 'ball':
        A(ball(a + d * size * .05, size * m.u(.03, .12) * m.r.uniform(.8, 1.2, 3), M, m.pick(6, 10)))
    elif form == 'book':
        A(box(a, size * m.r.uniform(.02, .12, 3), M))
    else:
        q = np.linspace(-1, 1, 9)
        A(sweep(a + np.outer(q, v) * l * .5 + np.outer(q * q, M[:, 1]) * l * -.25, np.full(9, t * .7), corners=5))


def cape(m, top, width, bottom, depth, parent, back):
    """Cloth down the back from height `top` to `bottom`, from z = back outwards by depth."""
    n = m.r.randint(1, 4)
    t, x = np.linspace(0, 1, 7), np.linspace(-1, 1, 7)
    flare, curve, waves = m.u(.9, 2), m.u(0, .8) * width, m.u(0, .05)
    G = np.zeros((7, 7, 3))
    G[..., 0] = np.outer(1 + (flare - 1) * t, x) * width
    G[..., 1] = (top + (bottom - top) * t)[:, None]
    G[..., 2] = back - np.outer(t, np.ones(7)) * depth + np.outer(np.ones(7),
                                                                  x * x) * curve * .6 + waves * np.sin(x
                                                                          * 7)[None] * t[:, None]
    P = np.stack([0 * np.linspace(0, 1, n + 1), np.interp(np.linspace(0, 1, n + 1), t, G[:, 3, 1]),
                  np.interp(np.linspace(0, 1, n + 1), t, G[:, 3, 2])], 1)
    js = m.chain(P, parent)
    m.part('prop', '', js)
    m.add(sheet(G[:, ::-1], m.pick(0, .01, .02), np.minimum(t * n, n - 1e-6)[:, None]), *js, flesh=False, smooth=.3)


def robe(m, top, bottom, r0, r1, centre, trunk_joint, legs, depth=.8, front_z=0.0):
    """Cloth round the legs from `top` to `bottom`; its surface goes with the leg of its side, or with the hips."""
    n = 6
    t = np.linspace(0, 1, n)
    w = r0 + (r1 - r0) * t ** m.u(.6, 1.6)
    P = np.stack([0 * t + centre[0], top + (bottom - top) * t, centre[2] + front_z * t], 1)
    shape = m.pick('open', 'flat')
    pc = sweep(P, np.stack([w, w * depth], 1), None, max(m.corners, 6), m.u(0, .4) if m.style != 'box' else .9, shape,
               X)
    if legs and m.maybe(.5):
        own = [trunk_joint, legs[0], legs[1]]
        low = (top - pc.V[:, 1]) / max(top - bottom, 1e-9)
        pc.u = np.where(low < .3, 0.5, np.where(pc.V[:, 0] > 0, 1.5, 2.5))
        m.add(pc, *own, flesh=shape == 'flat')
    else:
        m.add(pc, trunk_joint, flesh=shape == 'flat')

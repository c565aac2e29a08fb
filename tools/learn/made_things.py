"""Things that are no bodies (plan `none`): furniture, vehicles, rocks, plants, buildings, tools,
vessels, heaps. One joint each."""
import numpy as np

from made_maker import X, Y, Z, leaf
from made_shapes import ball, box, frame, plate, smooth_line, sweep, turn, unit, vec


def put(m, piece):
    return m.add(piece, 0, flesh=m.merge)


def start(m, at=(0, .5, 0)):
    m.joint(at, -1, np.array(at) + Y * .3)
    m.merge = m.maybe(.7)


def block(m, c, h, M=np.eye(3), taper=(1, 1)):
    put(m, box(c, h, M, taper))


def rod(m, a, b, ra, rb=None, corners=None, ends='flat'):
    put(m, sweep([a, b], [ra, ra if rb is None else rb], corners=corners or max(m.corners, 4), ends=ends))


def furniture(m):
    start(m)
    w, d, h, q = m.u(.25, 1), m.u(.25, .7), m.u(.2, .8), m.u(.02, .08)
    form = m.pick('table', 'chair', 'sofa', 'shelf', 'bed', 'lamp', 'stool')
    legs = lambda x, z, y: [rod(m, vec(i * x, 0, j * z), vec(i * x * m.spread, y, j * z * m.spread), q, q,
                                m.pick(4, 8)) for i in (-1, 1) for j in (-1, 1)]
    m.spread = m.u(.7, 1)
    if form in ('table', 'chair', 'bed'):
        legs(w - q, d - q, h)
        block(m, (0, h, 0), (w, q * m.u(.5, 2), d))
        if form != 'table':
            block(m, (0, h + w * .5, -d), (w, w * m.u(.4, 1), q))
        if form == 'bed' or m.maybe(.2):
            block(m, (0, h + .1, d * .1), (w * .95, .08, d * .9))
        if form == 'chair' and m.maybe(.3):
            for i in (-1, 1):
                block(m, (i * w, h + w * .3, 0), (q, q, d * .8))
                rod(m, vec(i * w, h, d * .7), vec(i * w, h + w * .3, d * .7), q)
    elif form == 'sofa':
        block(m, (0, h * .4, 0), (w * 1.5, h * .4, d))
        block(m, (0, h, -d), (w * 1.5, h * .7, d * .25))
        for i in (-1, 1):
            block(m, (i * w * 1.5, h * .7, 0), (w * .2, h * .5, d))
    elif form == 'shelf':
        for k in range(m.r.randint(2, 6)):
            block(m, (0, k * h * .4, 0), (w, q * .5, d * .5))
        for i in (-1, 1):
            block(m, (i * w, k * h * .2, 0), (q * .5, k * h * .2 + q, d * .5))
    elif form == 'lamp':
        rod(m, vec(0, 0, 0), vec(0, .04, 0), w * .4, w * .3)
        rod(m, vec(0, 0, 0), vec(0, h * 2, 0), q * .5)
        rod(m, vec(0, h * 1.8, 0), vec(0, h * 2.4, 0), w * .5, w * .25)
    else:
        n = m.pick(3, 4, 5)
        for k in range(n):
            v = turn(Y, 6.283 * k / n) @ X * w
            rod(m, v, v * .6 + Y * h, q)
        rod(m, vec(0, h, 0), vec(0, h + q * 2, 0), w * .9)


def wheel(m, c, r, w):
    rod(m, c - X * w, c + X * w, r, corners=m.pick(8, 12, 16))


def vehicle(m):
    start(m)
    l, w, h, r = m.u(.6, 1.2), m.u(.25, .45), m.u(.12, .3), m.u(.1, .2)
    form = m.pick('car', 'truck', 'tank', 'plane', 'boat', 'train', 'cart', 'rocket', 'bicycle', 'helicopter')
    if form in ('car', 'truck', 'train', 'cart', 'tank'):
        block(m, (0, r + h, 0), (w, h, l))
        if form == 'car':
            block(m, (0, r + h * 2.6, -l * m.u(-.1, .3)), (w * .9, h * .8, l * .5))
        elif form in ('truck', 'train'):
            block(m, (0, r + h * 3, l * m.u(.4, .7)), (w * .95, h * 1.2, l * .25))
            if m.maybe(.5):
                block(m, (0, r + h * 2.6, -l * .3), (w, h * 1.2, l * .5))
            else:
                rod(m, vec(0, r + h * 2, -l * .9), vec(0, r + h * 2, l * .5), w * .8)
        elif form == 'tank':
            rod(m, vec(0, r + h * 2, 0), vec(0, r + h * 3, 0), w * .7, w * .6)
            rod(m, vec(0, r + h * 2.5, 0), vec(0, r + h * 2.6, l * 1.3), .04)
            for i in (-1, 1):
                block(m, (i * w, r, 0), (w * .25, r, l * 1.05))
        if form != 'tank':
            n = m.pick(1, 2, 2, 3) if form != 'cart' else m.pick(1, 2)
            for z in np.linspace(-.65, .65, n) * l if n > 1 else [0]:
                for i in (-1, 1):
                    wheel(m, vec(i * w, r, z), r, .05)
    elif form in ('plane', 'rocket', 'helicopter'):
        d = Z if form != 'rocket' else Y
        P = np.outer(np.linspace(-1, 1, 7), d) * l + Y * (.4 if form != 'rocket' else l)
        put(m, sweep(P, w * .6 * vec(.4, .6, .9, 1, 1, .8, .2), corners=m.corners))
        if form == 'plane':
            s = m.u(.6, 1.4)
            for q in (1, -1):
                put(m, plate([[0, .2], [q * s, -.1], [q * s, -.25], [0, -.2]], .04, vec(0, .4 + m.u(-.1, .2), .1),
                             np.stack([X, Z, -Y], 1)))
                put(m, plate([[0, .1], [q * s * .4, -.05], [q * s * .4, -.12], [0, -.1]], .03, vec(0, .42, -l * .85),
                             np.stack([X, Z, -Y], 1)))
            put(m, plate([[.15, 0], [-.1, .3], [-.2, .3], [-.15, 0]], .03, vec(0, .45, -l * .85),
                         np.stack([Z, Y, -X], 1)))
        elif form == 'rocket':
            n = m.pick(3, 4)
            for k in range(n):
                v = turn(Y, 6.283 * k / n) @ X
                put(m, plate([[0, .4], [.4, -.1], [.4, -.25], [0, 0]], .03, v * w * .2,
                             np.stack([v, Y, np.cross(v, Y)], 1)))
        else:
            rod(m, vec(0, .4, -l * .6), vec(0, .5, -l * 1.8), .08, .04)
            rod(m, vec(0, .4, 0), vec(0, .4 + w, 0), .03)
            for k in range(m.pick(1, 2)):
                block(m, (0, .42 + w, 0), (l * 1.2, .01, .05), turn(Y, k * 1.57 + m.u(0, 1)))
            for q in (1, -1):
                rod(m, vec(q * w * .6, .02, -l * .6), vec(q * w * .6, .02, l * .6), .02)
    elif form == 'boat':
        z = np.linspace(-1, 1, 9)
        put(m, sweep(np.stack([0 * z, .3 + .1 * z ** 2, z * l], 1),
                     np.stack([w * (1 - np.maximum(z, 0) ** 2 * .9), h * (1 - .3 * np.maximum(z, 0))], 1),
                     corners=m.pick(4, 8), side=X, ends='flat'))
        if m.maybe(.7):
            rod(m, vec(0, .3, 0), vec(0, 1.4, 0), .02)
            put(m, plate([[0, 0], [.7, 0], [0, 1]], .01, vec(0, .45, -.05), np.stack([-Z, Y, X], 1)))
        else:
            block(m, (0, .55, -l * .2), (w * .6, .15, l * .3))
    else:
        for z in (-.5, .5):
            put(m, sweep(smooth_line(np.array([vec(0, .35 + .33 * np.sin(a), z * l * 1.2 + .33 * np.cos(a))
                                               for a in np.linspace(0, 6.283, 13)]), 1)[0], np.full(13, .03),
                                               corners=5))
        for a, b in ((vec(0, .35, -.5 * l), vec(0, .75, -.2)), (vec(0, .75, -.2), vec(0, .7, .3)),
                     (vec(0, .7, .3), vec(0, .35, -.1)), (vec(0, .35, .6 * l), vec(0, .95, .35)),
                     (vec(-.25, .95, .3), vec(.25, .95, .3))):
            rod(m, a, b, .025)


def rough(m, piece, amount):
    c = piece.V.mean(0)
    d = piece.V - c
    W = m.r.randn(3, 5) * 2.2
    ph = m.r.rand(5) * 6.283
    piece.V = c + d * (1 + amount * np.sin(d / max(np.linalg.norm(d, axis=1).mean(), 1e-9) @ W
                                           + ph).mean(1, keepdims=True))
    piece.inside = None
    return piece


def rock(m):
    start(m)
    for k in range(m.pick(1, 1, 1, 2, 3, 6)):
        h = m.r.uniform(.15, .6, 3)
        c = m.r.randn(3) * (.5, .05, .5) * (k > 0) + Y * h[1] * .8
        put(m, rough(m, ball(c, h, np.linalg.qr(m.r.randn(3, 3))[0], m.pick(6, 8, 14, 18)), m.u(.2, .9)))


def plant(m):
    start(m)
    form = m.pick('tree', 'fir', 'bush', 'flower', 'cactus', 'mushroom', 'palm', 'bare')
    h, r = m.u(.5, 1.2), m.u(.03, .12)
    if form in ('tree', 'bare'):
        rod(m, vec(0, 0, 0), vec(m.u(-.1, .1), h, 0), r, r * .6)
        for k in range(m.r.randint(1, 9)):
            v = unit(vec(m.u(-1, 1), m.u(.2, 1), m.u(-1, 1)))
            a = Y * h * m.u(.6, 1)
            b = a + v * m.u(.2, .6)
            rod(m, a, b, r * .5, r * .2)
            if form == 'bare':
                for _ in range(2):
                    rod(m, b, b + unit(v + m.r.randn(3) * .5) * .25, r * .2, r * .05)
            else:
                put(m, rough(m, ball(b, m.r.uniform(.15, .45, 3), corners=m.pick(6, 8, 12)), m.u(0, .5)))
    elif form == 'fir':
        rod(m, vec(0, 0, 0), vec(0, h, 0), r)
        n = m.r.randint(1, 6)
        for k in range(n):
            y = h * (.3 + .9 * k / n)
            rod(m, vec(0, y, 0), vec(0, y + h * .5, 0), .45 * (1 - .7 * k / n), .01)
    elif form == 'bush':
        for _ in range(m.r.randint(3, 12)):
            put(m, rough(m, ball(m.r.uniform(-.4, .4, 3) + Y * .4, m.r.uniform(.12, .35, 3), corners=m.pick(6, 8, 10)),
                         .4))
    elif form == 'flower':
        rod(m, vec(0, 0, 0), vec(.05, h, 0), .02)
        n, l = m.r.randint(4, 10), m.u(.1, .3)
        for k in range(n):
            v = turn(Y, 6.283 * k / n) @ unit(vec(1, .2, 0))
            put(m, plate(leaf(l, l * .3, m.r), .01, vec(.05, h, 0),
                         np.stack([np.cross(v, Y), v, np.cross(np.cross(v, Y), v)], 1)))
        put(m, ball(vec(.05, h, 0), np.full(3, .06)))
        for _ in range(m.r.randint(0, 5)):
            v = unit(vec(m.u(-1, 1), m.u(.2, 1), m.u(-1, 1)))
            put(m, plate(leaf(.3, .06, m.r), .01, Y * h * m.u(0, .6), frame(v)[:, [0, 2, 1]] * (1, 1, -1)))
    elif form == 'cactus':
        rod(m, vec(0, 0, 0), vec(0, h, 0), r * 1.5, ends='round')
        for q in (1, -1)[:m.pick(1, 2)]:
            y = h * m.u(.3, .6)
            put(m, sweep(smooth_line(np.array([vec(0, y, 0), vec(q * .3, y, 0), vec(q * .34, y + m.u(.15, .4), 0)]),
                                     4)[0], np.full(9, r), corners=m.corners))
    elif form == 'mushroom':
        rod(m, vec(0, 0, 0), vec(0, h * .6, 0), r * 1.5, r)
        t = np.linspace(0, 1, 6)
        put(m, sweep(np.outer(h * .5 + t * h * .3, Y), m.u(.2, .5) * np.sqrt(1.02 - t * t), corners=max(8, m.corners),
                     ends='flat'))
    else:
        put(m, sweep(smooth_line(np.array([vec(0, 0, 0), vec(.1, h * .5, 0), vec(.3, h, 0)]), 4)[0],
                     np.linspace(r, r * .6, 9), corners=m.corners))
        n = m.r.randint(4, 9)
        for k in range(n):
            v = turn(Y, 6.283 * k / n) @ unit(vec(1, m.u(-.5, .3), 0))
            put(m, plate(leaf(.6, .1, m.r), .015, vec(.3, h, 0),
                         np.stack([np.cross(v, Y), v, np.cross(np.cross(v, Y), v)], 1)))


def building(m):
    start(m)
    w, d, h = m.u(.3, .8), m.u(.3, .8), m.u(.3, 1)
    form = m.pick('house', 'tower', 'castle', 'bridge', 'tent', 'temple', 'windmill')
    if form in ('house', 'castle'):
        block(m, (0, h / 2, 0), (w, h / 2, d))
    if form == 'house':
        put(m, plate([[-w * 1.15, 0], [w * 1.15, 0], [0, m.u(.2, .7)]], d * 2.2, vec(0, h, 0), np.eye(3)))
        if m.maybe(.5):
            block(m, (w * .5, h * 1.3, d * .3), (.06, h * .4, .06))
        if m.maybe(.5):
            block(m, (w * .6, h * .3, d), (w * .4, h * .3, d * .4))
    elif form == 'tower':
        rod(m, vec(0, 0, 0), vec(0, h * 2, 0), w * .6, w * m.u(.3, .6))
        rod(m, vec(0, h * 2, 0), vec(0, h * 2 + m.u(.1, .7), 0), w * .75, w * m.u(.01, .7))
    elif form == 'castle':
        for i in (-1, 1):
            for j in (-1, 1):
                rod(m, vec(i * w, 0, j * d), vec(i * w, h * 1.4, j * d), w * .25)
                if m.maybe(.7):
                    rod(m, vec(i * w, h * 1.4, j * d), vec(i * w, h * 1.9, j * d), w * .3, .01)
    elif form == 'bridge':
        x = np.linspace(-1, 1, 9)
        put(m, sweep(np.stack([x, .4 + .2 * (1 - x * x), 0 * x], 1), np.tile([d * .5, .04], (9, 1)), corners=4,
                     square=1, ends='flat', side=Z))
        for i in (-.9, 0, .9):
            block(m, (i, .25, 0), (.06, .25, d * .4))
    elif form == 'tent':
        rod(m, vec(0, 0, 0), vec(0, h, 0), w, .02, corners=m.pick(4, 6, 8))
    elif form == 'temple':
        block(m, (0, .05, 0), (w, .05, d))
        for x in np.linspace(-.85, .85, m.r.randint(2, 5)):
            for j in (-1, 1):
                rod(m, vec(x * w, .1, j * d * .85), vec(x * w, h, j * d * .85), .04)
        put(m, plate([[-w, 0], [w, 0], [0, .3]], d * 2, vec(0, h, 0), np.eye(3)))
    else:
        rod(m, vec(0, 0, 0), vec(0, h * 1.5, 0), w * .5, w * .35)
        for k in range(4):
            M = turn(Z, k * 1.5708 + .4)
            put(m, plate([[-.05, .05], [.05, .05], [.1, .7], [-.1, .7]], .02, vec(0, h * 1.3, w * .55), M))


def tool(m):
    """Weapons and tools that lie or stand, vessels, food, toys without limbs."""
    start(m)
    form = m.pick('sword', 'hammer', 'bottle', 'cup', 'barrel', 'crate', 'chest', 'book', 'ring', 'fruit', 'shield',
                  'gun', 'key', 'fork', 'bell', 'spring')
    h, r, c = m.u(.5, 1.2), m.u(.05, .2), max(m.corners, 6)
    if form == 'sword':
        rod(m, vec(0, 0, 0), vec(0, .2, 0), .025)
        block(m, (0, .2, 0), (.15, .02, .03))
        put(m, sweep([vec(0, .2, 0), vec(0, h, 0), vec(0, h * 1.1, 0)], [[.06, .015], [.05, .015], [.004, .004]],
                     corners=4, square=1, ends='flat', side=X))
    elif form == 'hammer':
        rod(m, vec(0, 0, 0), vec(0, h, 0), .03)
        block(m, (0, h, 0), m.r.uniform(.05, .25, 3))
    elif form in ('bottle', 'cup', 'barrel', 'bell', 'fruit'):
        prof = {'bottle': [1, 1, 1, .9, .35, .3, .3], 'cup': [.6, .8, .95, 1, 1, 1, 1],
                'barrel': [.8, .93, 1, 1, 1, .93, .8], 'bell': [1.2, 1, .8, .75, .7, .5, .15],
                'fruit': [.4, .8, 1, 1, .95, .75, .3]}[form]
        P = np.outer(np.linspace(0, h, 7), Y)
        put(m, sweep(P, np.array(prof) * h * m.u(.25, .6), corners=c, ends='flat' if form != 'cup'
                     else m.pick('flat', 'open')))
        if form == 'cup' or m.maybe(.2):
            a = np.linspace(-1.4, 1.4, 9)
            put(m, sweep(np.stack([h * .5 + .2 * np.cos(a), h * .5 + .25 * h * np.sin(a), 0 * a], 1), np.full(9, .03),
                         corners=5))
        if form == 'fruit':
            rod(m, vec(0, h, 0), vec(.05, h * 1.15, 0), .02)
    elif form in ('crate', 'chest', 'book'):
        s = m.r.uniform(.2, .6, 3) * (1, 1 if form == 'crate' else .6 if form == 'chest' else .15, 1)
        block(m, (0, s[1], 0), s)
        if form == 'chest':
            rod(m, vec(-s[0], s[1] * 2, 0), vec(s[0], s[1] * 2, 0), s[2])
        if form == 'crate':
            for i in (-1, 1):
                for j in (-1, 1):
                    block(m, (i * s[0], s[1], j * s[2]), (.04, s[1] * 1.05, .04))
    elif form in ('ring', 'spring'):
        n = 1 if form == 'ring' else m.r.randint(3, 7)
        a = np.linspace(0, 6.283 * n, 16 * n + 1)
        put(m, sweep(np.stack([h * .4 * np.cos(a), .4 + a * (.02 if n > 1 else 0), h * .4 * np.sin(a)], 1),
                     np.full(len(a), r * .6), corners=6, side=Y))
    elif form == 'shield':
        put(m, sweep([vec(0, .5, 0), vec(0, .5, .06)], [[h * .4, h * m.u(.4, .6)]] * 2, corners=m.pick(4, 6, 12),
                     ends='flat'))
        put(m, ball(vec(0, .5, .06), (h * .12, h * .12, .06)))
    elif form == 'gun':
        block(m, (0, .4, 0), (.05, .07, .3))
        rod(m, vec(0, .4, -.2), vec(0, .15, -.28), .05, corners=4)
        rod(m, vec(0, .43, .3), vec(0, .43, .3 + m.u(.1, .6)), .025)
    elif form == 'key':
        a = np.linspace(0, 6.283, 13)
        put(m, sweep(np.stack([.15 * np.cos(a), .9 + .15 * np.sin(a), 0 * a], 1), np.full(13, .035), corners=5))
        rod(m, vec(0, 0, 0), vec(0, .76, 0), .03)
        for y in (.02, .12):
            block(m, (.08, y, 0), (.08, .03, .02))
    else:
        rod(m, vec(0, 0, 0), vec(0, .6, 0), .03)
        for x in (-.1, 0, .1):
            rod(m, vec(x, .7, 0), vec(x, 1, 0), .015)
        block(m, (0, .65, 0), (.13, .06, .02))


def heap(m):
    start(m)
    for _ in range(m.r.randint(1, 9)):
        c, k = m.r.uniform(-.5, .5, 3) + Y * .6, m.r.randint(3)
        M = frame(m.r.randn(3))
        if k == 0:
            block(m, c, m.r.uniform(.05, .5, 3), M)
        elif k == 1:
            put(m, ball(c, m.r.uniform(.05, .5, 3), M, max(m.corners, 6)))
        else:
            put(m, sweep([c - M[:, 2] * m.u(.1, .5), c + M[:, 2] * m.u(.1, .5)], m.r.uniform(.03, .3, 2),
                         corners=m.corners, ends=m.pick('round', 'flat')))


THINGS = {'furniture': ('none', furniture, 1.5), 'vehicle': ('none', vehicle, 1.5), 'rock': ('none', rock, 1),
          'plant': ('none', plant, 1.3), 'building': ('none', building, 1.2),
          'tool': ('none', tool, 1.2), 'heap': ('none', heap, .5)}

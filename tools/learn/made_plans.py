"""Plans of bodies as random skeletons with flesh: people, toys, robots, four-legged, birds, dinosaurs, insects, fish,
snakes, dragons. KINDS: name -> (plan, function of a Maker, how many in proportion). A plan's name is one of
vocabulary.PLANS."""
import numpy as np

from made_maker import (SIDES, X, Y, Z, Maker, cape, foot, hair, hand, hat, head, held, leaf, limb, neck, robe, tail,
                        trunk,
                        wing_taste, wings)
from made_shapes import ball, box, frame, sheet, sweep, turn, unit, vec


# --- upright

def person(m, leg=(.42, .52), body=(.26, .34), skull=(.055, .075), wide=(.85, 1.15), arm=(.29, .36), face='person',
           slim=1.0, dress=.35,
           prop=.3, feet='shoe', cloth=None, finger=None):
    """Two legs, two arms, a trunk and a head; lengths as parts of a height of about 1."""
    r = m.r
    L, T, H = m.u(*leg), m.u(*body), m.u(*skull)
    w = m.u(*wide) * slim * (.5 * T * .5 + .4 * H)                                          # half the chest's width
    lean = m.u(.1, .5) if m.maybe(.12) else m.u(-.04, .06)
    hips = vec(0, L, 0)
    n = m.r.randint(1, 5)
    t = np.linspace(0, 1, n + 1)[:, None]
    top = hips + vec(0, np.cos(lean), np.sin(lean)) * T
    P = hips + (top - hips) * t + Z * np.sin(np.pi * t) * m.u(-.03, .03)
    deep, belly = m.u(.5, .85), m.u(.65, 1.0) if m.maybe(.65) else m.u(1, 1.7)
    hip_w = w * m.u(.7, 1.1)
    js = trunk(m, P, np.array([[hip_w, hip_w * deep], [w * belly * .9, w * belly * deep], [w * 1.02, w * deep],
                               [w * .8, w * deep * .8]]))
    chest = js[-1]
    nl = H * (m.u(.2, .7) if m.maybe(.75) else 0)
    at = top + vec(0, nl + H * .1, nl * m.u(0, .6) + lean * .05)
    hang = neck(m, top, chest, at, m.r.randint(0, 3) if nl > H * .25 else 0, min(w * .5, H * .6), min(w * .45, H * .55))
    hd = head(m, at, hang, vec(0, m.u(-.1, .1), 1), H, face if not isinstance(face, tuple) else m.pick(*face))
    covered = m.maybe(dress * .5)
    if face == 'person' and m.maybe(.6):
        hair(m, hd, H)
    if m.maybe(dress * .6):
        hat(m, hd)
    # arms
    al = m.u(*arm)
    sx = w * m.u(.95, 1.25)
    shoulder = top + vec(sx, -T * m.u(.02, .2) , 0)
    ra = min(m.u(.08, .15) * (al + T) * .5 * (slim if slim < 1 else 1), w * .8, T * .3)
    pose = m.pick('T', 'A', 'A', 'hang', 'hang', 'front', 'free')
    thin = m.u(.5, 1)
    nf = finger if finger is not None else (0 if m.maybe(.45)
                                            else int(r.choice([1, 2, 3, 4, 5], p=[.05, .15, .25, .25, .3])))
    hs = al * m.u(.18, .38)
    na = int(r.choice([1, 2], p=[.15, .85])) if not m.hard else int(r.choice([1, 2], p=[.5, .5]))
    collar = m.maybe(.45)
    angles = []
    for k in range(2):
        ang = {'T': m.u(-8, 8), 'A': m.u(-65, -30), 'hang': m.u(-90, -72), 'front': m.u(-70, -20),
               'free': m.u(-90, 75)}[pose]
        angles.append((np.radians(ang), m.u(-.1, .25) if pose != 'front' else m.u(.6, 2), m.u(0, .25) if pose in 'TA'
                       else m.u(0, 1.4)))
    if m.maybe(.75):
        angles[1] = angles[0]
    hands = []
    for (s, q), (ang, fwd, bend) in zip(SIDES, angles):
        f = vec(q, 1, 1)
        d = unit(vec(np.cos(ang), np.sin(ang), fwd))
        S = shoulder * f
        axis = np.cross(d, Z) if abs(d[2]) < .8 else X
        d2 = turn(unit(axis), m.u(.0, .05)) @ unit(d + Z * bend * .8 + Y * bend * .25)
        e = S + d * f * al * .48
        wr = e + d2 * f * al * .52
        PP = [S, e, wr] if na == 2 else [S, S + (wr - S)]
        rad = ra * np.linspace(1, thin, len(PP))
        rad[-1] *= .85
        seg, en = limb(m, s, PP, rad, chest, 'arm', end=hs if nf or m.maybe(.85) else 0,
                       collar=(top + vec(w * .2, -T * .06, 0)) * f if collar else None)
        if en is not None:
            if s == 'L' or m.maybe(.97):
                hand(m, s, en, max(hs, ra * 1.3), nf)
            else:
                hand(m, s, en, max(hs, ra * 1.3), max(nf - 1, 0))
            hands.append(en)
        if m.style == 'smooth' or m.maybe(.3):
            m.add(ball(S, np.full(3, ra * m.u(1, 1.25)), corners=max(6, m.corners)), seg[0])
    # legs
    rl = min(hip_w * m.u(.4, .62), L * .3)
    nl2 = int(r.choice([1, 2, 2, 2])) if not m.hard else int(r.choice([1, 2]))
    lx = hip_w * m.u(.45, .75)
    spread = m.u(0, .12) * L if m.maybe(.8) else m.u(.1, .35) * L
    fh = min(L * m.u(.06, .16), rl * 1.6)
    fl = max(L * m.u(.12, .3), rl * m.u(1.1, 2))
    digit = feet in ('hoof', 'digit') and L > .2
    bend = (m.u(.1, .3) if digit else m.pick(.01, .02, m.u(0, .15))) * L
    step = m.u(.1, .4) * L if m.maybe(.12) else 0
    toes = m.u(.5, .75) if m.maybe(.4) and feet == 'shoe' else None
    legs = []
    for s, q in SIDES:
        f = vec(q, 1, 1)
        hip = hips + vec(lx * q, -L * .03, 0)
        an = vec((lx + spread) * q, fh, -L * .02 + step * q)
        k = hip * .52 + an * .48 + Z * bend
        PP = [hip, k, an] if nl2 == 2 else [hip, an]
        rad = rl * np.array([1, .78, .6] if nl2 == 2 else [1, .7])
        if digit:
            hk = hip * .22 + an * .78 - Z * bend * 1.3
            PP, rad = [hip, hip * .55 + an * .45 + Z * bend, hk, an], rl * np.array([1, .7, .45, .4])
        if m.style == 'box':
            rad = rl * np.ones(len(PP)) * .95
        seg, en = limb(m, s, PP, rad, js[0], 'leg', end=fl if m.maybe(.9) or digit else 0, toes=toes)
        if en is not None:
            foot(m, en, fl, max(rl * m.u(.65, .95), .02), fh * 1.1, 'hoof' if feet == 'hoof'
                 else m.pick('shoe', 'claws') if feet == 'digit' else
                 ('shoe' if face == 'person' else m.pick('shoe', 'paw', 'claws')), drop=an[1], toes=m.toes_of(en))
        legs.append(seg[0])
    # clothes and props
    cloth = cloth or (m.pick('skirt', 'robe', 'coat', 'belt') if covered else None)
    if cloth == 'robe':
        robe(m, hips[1] + T * m.u(-.1, .75), L * m.u(0, .15), w * m.u(.8, 1.1), (lx + spread + rl) * m.u(1.1, 2), hips,
             js[0], legs, m.u(.65, 1))
    elif cloth in ('skirt', 'coat'):
        robe(m, hips[1] + T * m.u(.0, .3), L * m.u(.3, .75), hip_w * m.u(1, 1.15), (lx + rl) * m.u(1.1, 1.9), hips,
             js[0], legs, m.u(.65, 1))
    elif cloth == 'belt':
        m.add(sweep([hips - Y * T * .05, hips + Y * T * .08], np.full((2, 2), hip_w * 1.1) * (1, deep),
                    corners=max(m.corners, 6), ends='flat', side=X), js[0], flesh=False)
    if m.maybe(dress * .35):
        cape(m, top[1], w * m.u(.6, 1), m.u(0, .5) * L, L * m.u(.05, .5), chest, -w * deep - .01)
    elif m.maybe(dress * .25):
        j = m.joint(top - Z * w * deep - Y * T * .4, chest, top - Z * w)
        m.part('prop', '', [j])
        m.add((box if m.maybe(.6) else ball)(m.J[j] - Z * w * .4, (w * m.u(.5, .9), T * m.u(.25, .5), w * m.u(.3, .7))),
              j, flesh=False)
    if hands and m.maybe(prop):
        held(m, m.pick(*hands), L + T + 2 * H)
        if len(hands) > 1 and m.maybe(.25):
            held(m, hands[1], L + T + 2 * H)
    if m.maybe(dress * .3):                                                                # pads on the shoulders
        for q in (1, -1):
            m.blob(shoulder * (q, 1, 1), np.full(3, ra * m.u(1.2, 1.9)), chest, flesh=False)
    m.hips, m.chest, m.top, m.w, m.L, m.T, m.H, m.deep = js[0], chest, top, w, L, T, H, deep


def adult(m):
    m.style = m.pick('smooth', 'smooth', 'capsule', 'lowpoly')
    person(m)


def chibi(m):
    person(m, (.12, .3), (.18, .3), (.16, .28), (.7, 1.2), (.16, .3), m.pick('person', 'person', 'person', 'block'),
           dress=.45)


def big_head(m):
    person(m, (.22, .42), (.2, .32), (.09, .17), (.6, 1.2), (.24, .42), m.pick('person', 'block', 'snout'),
           slim=m.u(.5, 1.1), dress=.4)


def box_person(m):
    m.style = 'box'
    person(m, (.25, .5), (.25, .4), (.08, .18), (.8, 1.6), (.28, .45), 'block', finger=0 if m.maybe(.85) else None,
           dress=.35)


def robed(m):
    person(m, (.2, .5), (.22, .34), (.06, .2), (.8, 1.2), (.25, .42), 'person',
           cloth=m.pick('robe', 'robe', 'skirt', 'coat'), dress=.7, prop=.5)


def monster(m):
    person(m, (.15, .45), (.25, .5), (.06, .2), (.8, 2.2), (.25, .75), ('person', 'snout', 'flat', 'bug', 'block'),
           slim=m.u(.6, 1.4), dress=.2,
           feet=m.pick('shoe', 'digit', 'hoof', 'digit'), finger=m.pick(None, 3, 3, 4, 2))
    if m.maybe(.45):
        tail(m, vec(0, m.L, -m.w * m.deep * .6), m.hips, m.u(.2, .9), m.w * m.u(.2, .6), vec(0, m.u(-.8, .3), -1),
             m.r.randint(1, 7), m.u(-.8, 1))
    if m.maybe(.3):
        back_wings(m)


def back_wings(m):
    wing_taste(m)
    form = m.pick('feather', 'bat', 'insect')
    wings(m, m.top + vec(m.w * .35, -m.T * .15, -m.w * m.deep * .8), m.chest, m.u(.25, .9), m.u(.15, .5),
          1 if form == 'insect' else m.r.randint(1, 4), form,
          vec(1, m.u(-.4, 1), m.u(-1, 0)), m.u(0, .6), m.u(0, 1))


def winged_person(m):
    person(m, (.25, .48), (.22, .34), (.06, .2), dress=.3)
    back_wings(m)


def mascot(m):
    """An animal that stands like a person."""
    person(m, (.12, .35), (.25, .42), (.1, .24), (.8, 1.5), (.18, .36), ('snout', 'snout', 'beak', 'flat', 'block'),
           dress=.25, feet=m.pick('shoe', 'digit'),
           finger=m.pick(0, 0, 3, 4))
    if m.maybe(.8):
        tail(m, vec(0, m.L, -m.w * m.deep * .7), m.hips, m.u(.05, .6), m.w * m.u(.15, .5), vec(0, m.u(-.6, .6), -1),
             m.r.randint(1, 5), m.u(-.5, 1.2))


def gorilla(m):
    person(m, (.18, .3), (.3, .45), (.08, .14), (1.2, 1.9), (.45, .65), ('snout', 'person'), dress=0,
           finger=m.pick(0, 5, 4), feet='shoe')


def robot(m):
    m.style = m.pick('box', 'cylinder', 'prism', 'cylinder')
    person(m, (.15, .5), (.2, .42), (.05, .2), (.7, 1.8), (.25, .6), 'block', slim=m.u(.5, 1.2), dress=.15, prop=.3,
           feet='shoe', finger=m.pick(0, 0, 2, 3, 3, 5))
    for _ in range(m.r.randint(0, 6)):                                        # boxes and rods on it
        j = m.pick(m.hips, m.chest, m.chest)
        c = m.J[j] + m.r.randn(3) * (m.w, m.T * .3, m.w * .8)
        M = frame(m.pick(X, Y, Z))
        m.add(box(c, m.r.uniform(.01, .08, 3), M) if m.maybe(.6) else sweep([c, c + m.pick(X, Y, Z) * m.u(.03, .2)],
                                                                            np.full(2, m.u(.01, .05)), corners=8,
                                                                            ends='flat'), j)


def roller(m):
    """A robot or a ghost: trunk, head and arms upon a cone, a ball, wheels or nothing."""
    r = m.r
    T, w = m.u(.3, .7), m.u(.1, .3)
    base = m.u(.05, .4)
    hips = vec(0, base, 0)
    top = hips + Y * T
    n = m.r.randint(1, 4)
    js = trunk(m, hips + np.outer(np.linspace(0, 1, n + 1), Y * T),
               np.array([[w * m.u(.6, 1.2)] * 2, [w, w * .8], [w * m.u(.6, 1.1), w * .7]]))
    form = m.pick('cone', 'ball', 'wheels', 'wisp')
    if form == 'cone':
        m.add(sweep([vec(0, 0, 0), hips], [w * m.u(1, 2), w * .9], corners=max(6, m.corners), ends='flat'), js[0])
    elif form == 'ball':
        m.add(ball(vec(0, base * .8, 0), np.full(3, base * .8)), js[0])
    elif form == 'wheels':
        for q in (1, -1):
            for z in (-1, 1)[:m.pick(1, 2)]:
                c = vec(q * w * 1.1, base * .5, z * w * .7)
                m.add(sweep([c - X * w * .15, c + X * w * .15], [base * .6] * 2, corners=10, ends='flat'), js[0])
    else:
        tail(m, hips, js[0], base + m.u(.1, .5), w * .9, vec(0, -1, m.u(-.6, 0)), m.r.randint(1, 4), m.u(-.3, .5))
    H = m.u(.07, .25)
    at = top + Y * m.u(0, .08)
    if m.maybe(.9):
        head(m, at, neck(m, top, js[-1], at + Y * .01, 0, H * .4, H * .4), Z, H, m.pick('block', 'person', 'snout'))
    al, ang = m.u(.2, .5), np.radians(m.u(-90, 10))
    nf, fw, straight, ra = m.pick(0, 0, 2, 3), m.u(-.2, 1), m.maybe(.2), w * m.u(.12, .3)
    for s, q in SIDES:
        S = top + vec(q * w * m.u(.95, 1.), -T * .12, 0)
        d = unit(vec(np.cos(ang) * q, np.sin(ang), fw))
        P = [S, S + d * al * .5, S + unit(d + Z * .4) * al]
        P = P[::2] if straight else P
        seg, e = limb(m, s, P, np.full(len(P), ra), js[-1], 'arm', end=al * .25)
        hand(m, s, e, al * .28, nf)


def egg(m):
    """A face with arms and legs: fruit, blobs, bodies that are one lump with their head."""
    w, h = m.u(.2, .4), m.u(.25, .5)
    L = m.u(.05, .4)
    c = vec(0, L + h, 0)
    n = m.r.randint(1, 4)
    P = vec(0, L + h * .2, 0) + np.outer(np.linspace(0, 1, n + 1), Y * h * 1.6)
    js = m.chain(P, -1)
    m.part('trunk', '', js)
    pc = ball(c, (w, h, w * m.u(.7, 1)),
              corners=max(8, m.corners)) if m.style not in ('box',
                                                            'prism') else box(c, (w, h, w * m.u(.6, 1)), frame(Y, -Z))
    if m.style in ('smooth', 'lowpoly', 'capsule'):
        q = np.linspace(0, 1, 9)
        k = m.u(.6, 1.6)
        pc = sweep(np.outer(L + 2 * h * q, Y), np.stack([w * np.sin(np.pi * q ** k * .96 + .05)] * 2, 1) + .01, None,
                   max(8, m.corners), ends='flat', side=X)
    pc.u = np.clip((pc.V[:, 1] - P[0, 1]) / (h * 1.6) * n, 0, n - 1e-6)
    m.add(pc, *js)
    al, ang, nf, ra, fw = m.u(.15, .5), np.radians(m.u(-80, 20)), m.pick(0, 0, 3, 4), m.u(.025, .07), m.u(-.1, .4)
    na, nl = m.pick(1, 2, 2), m.pick(1, 2, 2)
    for s, q in SIDES:
        S = c + vec(q * w * .93, -h * .1, 0)
        d = unit(vec(np.cos(ang) * q, np.sin(ang), fw))
        P2 = np.array([S, S + d * al * .5, S + unit(d + Z * .2) * al])
        seg, e = limb(m, s, P2 if na == 2 else P2[::2], np.full(na + 1, ra), js[-1], 'arm', end=al * .25)
        hand(m, s, e, max(al * .25, ra * 2), nf)
        hip = vec(q * w * .45, L + h * .12, 0)
        an = vec(q * w * .5, .04, 0)
        seg, e = limb(m, s, [hip, (hip + an) / 2, an] if nl == 2 else [hip, an], np.full(nl + 1, ra * 1.2), js[0],
                      'leg', end=ra * 3)
        foot(m, e, ra * 3.2, ra * 1.4, .06, 'shoe', drop=.04)
    for q in (1, -1) if m.maybe(.8) else (0,):
        m.add(ball(c + vec(q * w * .35, h * .25, w * .8), np.full(3, w * m.u(.12, .25)), corners=8), js[-1],
              flesh=False)
    for _ in range(m.r.randint(0, 6)):
        v = unit(vec(m.u(-.6, .6), 1, m.u(-.6, .6)))
        M = frame(v)
        m.flat(leaf(m.u(.1, .3), m.u(.03, .1), m.r), .015, c + Y * h * .93,
               np.stack([M[:, 0], v, np.cross(M[:, 0], v)], 1), js[-1])


# --- four legs

def four(m, long=(.7, 1.1), high=(.5, 1.0), wide=(.14, .26), neck_long=(.15, .4), neck_angle=(0, 70), skull=(.1, .2),
         face=('snout',), leg_r=(.04, .09),
         splay=0.0, tail_long=(.2, .8), feet=('paw', 'hoof'), tall=1.0, tail_r=(.15, .5), ears=None,
         sag=(-1.2, .9), ns=None, tilt=(-.08, .15)):
    """Trunk from the pelvis at the back to the chest at the front, on four legs; units: a trunk of about 1."""
    r = m.r
    B, h = m.u(*long), m.u(*high)
    wb, wf = m.u(*wide), m.u(*wide)
    up = m.u(.85, 1.25) * tall
    slope = m.u(*tilt)
    a, b = vec(0, h, -B / 2), vec(0, h + slope * B, B / 2)
    n = m.r.randint(1, 6)
    t = np.linspace(0, 1, n + 1)[:, None]
    P = a + (b - a) * t + Y * np.sin(np.pi * t) * m.u(-.06, .08) * B
    mid = m.u(.7, 1.25)
    js = trunk(m, P, np.array([[wb * .8, wb * up * .8], [wb, wb * up], [(wb + wf) / 2 * mid, (wb + wf) / 2 * up * mid],
                               [wf, wf * up], [wf * .75, wf * up * .8]]))
    ang, nl = np.radians(m.u(*neck_angle)), m.u(*neck_long)
    root = b + vec(0, wf * up * m.u(.1, .5), wf * m.u(0, .4))
    end = root + vec(0, np.sin(ang), np.cos(ang)) * nl
    H = m.u(*skull)
    hang = neck(m, root - vec(0, np.sin(ang), np.cos(ang)) * .03, js[-1], end, int(r.choice([1, 2, 3, 4]))
                if nl > .15 and m.maybe(.85) else 0, min(wf * m.u(.5, .85), H * 1.6),
                min(wf * m.u(.35, .6), H * 1.0), nl * m.u(-.15, .1))
    hd = head(m, end, hang, vec(0, m.u(-.6, .1), 1), H, m.pick(*face), ears=ears)
    if m.maybe(.12):                                                               # mane
        m.blob(end - vec(0, 0, H * .3), H * m.r.uniform(1.1, 1.7, 3), hang, flesh=m.maybe(.5))
    if m.maybe(.92) and tail_long[1] > 0:
        tail(m, a + vec(0, wb * up * m.u(0, .5), -wb * .6), js[0], m.u(*tail_long), wb * m.u(*tail_r),
             vec(0, m.u(-.8, .6), -1), m.r.randint(1, 7), m.u(*sag))
    ns = ns or (int(r.choice([1, 2, 3], p=[.2, .4, .4])) if not m.hard else int(r.choice([1, 2, 3], p=[.5, .35, .15])))
    form, walk = m.pick(*feet), m.u(.05, .25) * h if m.maybe(.25) else 0
    rl = min(m.u(*leg_r), wb, wf) * (1.25 if m.style == 'box' else 1)
    fat = m.u(1, 1.8)
    bone_end = m.maybe(.8)
    toe = rl * m.u(1, 2.2)
    thin = m.u(.4, .95)
    bow = m.u(.05, .25)
    for pair, (at, w, par, hind) in enumerate(((b, wf, js[-1], False), (a, wb, js[0], True))):
        inset = m.u(.02, .18) * B * (1 if hind else -1)
        x = w * m.u(.6, .95)
        collar = m.maybe(.4)
        for s, q in SIDES:
            f = vec(q, 1, 1)
            top = at + vec(x, -w * up * .1, inset)
            low = min(rl * (.7 if form != 'hoof' else 1.2), h * .2)
            an = vec(x + splay * .96 * h, low, top[2] + (.05 if hind else .03) * B * (-1 if hind else 1)
                     * (splay > 0) + walk * q * (1 if hind else -1))
            o = (an - top)
            fw = Z * np.linalg.norm(o) * bow * (1 if hind else -1)
            out = vec(splay * .35, splay * .35, 0) * h
            if ns == 1:
                L = [top, an]
            elif ns == 2:
                L = [top, top + o * .5 + fw + out, an]
            else:
                L = [top, top + o * .4 + fw + out, top + o * .72 - fw * (.9 if hind else -.1) + out * .3, an]
            rad = rl * np.linspace(fat, thin, len(L)) if m.style != 'box' else rl * np.ones(len(L))
            seg, e = limb(m, s, np.array(L) * f, rad, par, 'leg', pair, end=toe if bone_end else 0,
                          toes=.6 if bone_end and m.maybe(.15) else None,
                          collar=(at + vec(x * .4, w * up * .4, 0)) * f if collar and not hind else None)
            if e is not None:
                foot(m, e, toe, max(rl * thin * 1.1, rl * .6), low * 1.2, form, drop=low)
            if m.maybe(.5) and ns > 1 and m.style != 'box':
                m.blob(top * f + o * .12 * f, (rl * fat, rl * fat * 1.3, rl * fat * 1.3), seg[0])
    m.back, m.front, m.js, m.wf, m.wb, m.up, m.B, m.hd, m.h = a, b, js, wf, wb, up, B, hd, h
    if m.maybe(.04):
        rider(m, (a + b) / 2 + Y * wf * up * .8, js[len(js) // 2], m.u(.5, 1.1))
    elif m.maybe(.05):                                                                    # a pack or saddle
        j = m.joint((a + b) / 2 + Y * wf * up, js[len(js) // 2], (a + b) / 2 + Y * wf * up * 1.5)
        m.part('prop', '', [j])
        m.add(box(m.J[j], (wf * m.u(.6, 1.2), wf * m.u(.2, .7), B * m.u(.1, .25))), j, flesh=False)


def rider(m, seat, parent, size):
    """A person astride, a prop of the body that carries it."""
    other = Maker(m.r)
    other.style = m.style if m.maybe(.5) else other.style
    other.corners = m.corners if other.style == m.style else other.corners
    person(other, (.2, .35), (.25, .35), (.07, .16), (.7, 1.2), (.25, .35), dress=.3, prop=.3)
    j = m.joint(seat, parent, seat + Y * size * .5)
    m.part('prop', '', [j])
    offset = seat - other.J[other.hips] * size
    for piece in other.pieces:
        piece.V, piece.u = piece.V * size + offset, piece.u * 0
        inner = piece.inside
        piece.inside = inner and (lambda X, f=inner: f((X - offset) / size))
        m.add(piece, j, flesh=False)


def horse(m): four(m, (.9, 1.1), (.8, 1.15), (.14, .22), (.35, .6), (25, 75), (.09, .13), leg_r=(.035, .07),
                   tail_long=(.3, .8), feet=('hoof', 'hoof', 'paw'), sag=(-4, -.5))


def giraffe(m): four(m, (.7, 1), (.9, 1.4), (.13, .2), (.8, 1.7), (40, 85), (.08, .13), leg_r=(.03, .06),
                     tail_long=(.2, .6), feet=('hoof',), sag=(-4, -1), tilt=(.05, .35))


def dog(m): four(m, (.7, 1.1), (.4, .8), (.12, .22), (.08, .35), (10, 75), (.1, .22), leg_r=(.035, .08), feet=('paw',),
                 sag=(-1, 1.5))


def stout(m):
    four(m, (.8, 1.1), (.45, .8), (.22, .42), (.0, .25), (-20, 40), (.14, .26), leg_r=(.06, .14), tail_long=(.1, .5),
         feet=('hoof', 'paw', 'hoof'), tail_r=(.05, .25), sag=(-3, 1))


def toy_four(m):
    four(m, (.45, .8), (.3, .6), (.16, .34), (0, .12), (20, 90), (.2, .45), face=('snout', 'block', 'person', 'beak'),
         leg_r=(.05, .13), tail_long=(.08, .7), feet=('paw', 'shoe'))


def elephant(m):
    four(m, (.8, 1.1), (.6, .9), (.25, .38), (.0, .15), (0, 40), (.18, .28), face=('person', 'block'), leg_r=(.08, .13),
         tail_long=(.2, .5), feet=('hoof',), tail_r=(.05, .12),
         sag=(-4, -1), ears=False)
    c, h, M = m.skull
    n = m.r.randint(2, 6)
    P, d = [c + Z * h[2] * .7], vec(0, -.6, 1)
    for k in range(n):
        P.append(P[-1] + unit(d) * m.u(.5, .8) / n)
        d = d + vec(0, -1.0 if k < n / 2 else 0.6, 0) * 1.2 / n * 2
    js = m.chain(np.array(P), m.hd)
    m.part('other', '', js)
    m.flesh(P, np.linspace(h[0] * .5, h[0] * .2, n + 1), js)
    for s, q in SIDES:
        F = np.stack([vec(q, 0, -.5) / 1.12, Y, np.cross(vec(q, 0, -.5) / 1.12, Y)], 1)
        m.flat(leaf(h[1] * m.u(1.2, 2), h[0] * .8, m.r) @ np.array([[0, -1], [1, 0]]) * (1, 1), .02,
               c + vec(q * h[0] * .8, 0, 0), F, m.hd)


def crocodile(m):
    four(m, (.8, 1.3), (.12, .3), (.14, .32), (0, .3), (-10, 15), (.1, .2), face=('flat', 'flat', 'snout'),
         leg_r=(.03, .09), splay=m.u(.4, 1.1), tail_long=(.4, 1.6), feet=('claws', 'paw'),
         tall=m.u(.4, .9), tail_r=(.3, .85), ears=False, sag=(-.2, .3))
    for k in range(m.r.randint(0, 9)):
        t = m.u(0, 1)
        m.flat(leaf(m.wb * .4, m.wb * .2, m.r), m.wb * .1, m.back * (1 - t) + m.front * t + Y * m.wb * m.up * .9,
               np.stack([Z, Y, -X], 1), m.js[min(int(t * len(m.js)), len(m.js) - 1)])


def lizard(m): crocodile(m)


def tortoise(m):
    four(m, (.6, .9), (.15, .4), (.18, .3), (.1, .35), (-10, 45), (.08, .17), face=('snout', 'beak', 'flat', 'person'),
         leg_r=(.05, .1), splay=m.u(.2, .8), tail_long=(.05, .3), feet=('paw', 'claws'),
         tall=.7, ears=False)
    c = (m.back + m.front) / 2 + Y * m.u(0, .06)
    k = m.js[len(m.js) // 2]
    h = vec(m.u(.32, .5), m.u(.15, .4), m.B * m.u(.5, .68))
    if m.style == 'box' or m.maybe(.1):
        m.add(sweep([c, c + Y * h[1] * m.u(.6, 1)], [h[[0, 2]], h[[0, 2]] * m.u(.5, .95)], corners=4, square=1,
                    ends='flat', side=X), k)
    else:
        m.add(ball(c, h, corners=max(m.corners, 6)), k)
    if m.maybe(.5):
        m.add(sweep([c - Y * .05, c + Y * .02], [h[[0, 2]] * m.u(1, 1.15)] * 2, corners=max(m.corners, 6), ends='flat',
                    side=X), k)


def frog(m):
    four(m, (.4, .7), (.2, .38), (.2, .36), (0, .05), (0, 40), (.18, .3), face=('flat', 'person', 'flat', 'snout'),
         leg_r=(.05, .1), splay=m.u(.5, 1.1), tail_long=(0, 0), feet=('claws', 'paw'),
         tall=m.u(.6, .95), ears=False, ns=m.pick(2, 3), tilt=(.1, .6))
    for q in (1, -1):
        c, h, M = m.skull
        m.blob(c + vec(q * h[0] * .6, h[1] * .8, h[2] * .2), np.full(3, h[0] * m.u(.25, .4)), m.hd)


def rat(m): four(m, (.5, .9), (.15, .35), (.13, .26), (0, .12), (0, 40), (.1, .2), leg_r=(.025, .06), splay=m.u(0, .4),
                 tail_long=(.1, 1.3), feet=('paw', 'claws'), tail_r=(.05, .6))


def woolly(m):
    four(m, (.7, .9), (.5, .8), (.16, .24), (.05, .3), (10, 60), (.1, .18), leg_r=(.03, .06), tail_long=(.05, .25),
         feet=('hoof',))
    c = (m.back + m.front) / 2
    if m.style == 'box':
        m.add(box(c, (m.wb * 1.4, m.wb * 1.4, m.B * .6)), m.js[0])
    for _ in range(m.r.randint(4, 16)):
        t = m.u(-.1, 1.1)
        v = unit(m.r.randn(3))
        m.blob(m.back * (1 - t) + m.front * t + v * (m.wb, m.wb * m.up, m.wb) * .7, np.full(3, m.wb * m.u(.4, .8)),
               m.js[int(np.clip(t * len(m.js), 0, len(m.js) - 1))])


def sitting(m):
    """Cats and dogs that sit: trunk steep, hind legs folded."""
    four(m, (.6, .9), (.25, .4), (.15, .25), (.1, .3), (50, 90), (.12, .24), leg_r=(.04, .08), feet=('paw',),
         tilt=(.6, 1.0), ns=2)


# --- birds

def bird(m, folded=None, long=(.5, .9), tilt=(.1, 1.1), high=(.25, .6), wide=(.14, .26), neck_long=(0, .15),
         skull=(.1, .2), span=(.6, 1.6), leg_r=(.015, .04), tail_long=(.2, .6),
         feet=('claws', 'claws', 'shoe', 'paw'), face=('beak',), form=None, legs=True):
    r = m.r
    B, ti, h, w = m.u(*long), m.u(*tilt), m.u(*high), m.u(*wide)
    a = vec(0, h, -B * np.cos(ti) / 2)
    b = a + vec(0, np.sin(ti), np.cos(ti)) * B
    n = m.r.randint(1, 4)
    up = m.u(.85, 1.2)
    js = trunk(m, a + np.outer(np.linspace(0, 1, n + 1), b - a),
               np.array([[w * .5, w * .5], [w * .95, w * up], [w, w * up], [w * .6, w * .6]]))
    nl, ang = m.u(*neck_long), np.radians(m.u(20, 90))
    root = b
    end = root + vec(0, np.sin(ang), np.cos(ang)) * max(nl, .02)
    H = m.u(*skull)
    hang = neck(m, root, js[-1], end, m.r.randint(1, 5) if nl > .12 else m.pick(0, 0, 1), min(w * .55, H),
                min(w * .45, H * .7), nl * m.u(-.2, .25))
    head(m, end, hang, vec(0, m.u(-.3, .1), 1), H, m.pick(*face))
    ax = unit(b - a)
    # tail of feathers
    if m.maybe(.9):
        l, d = m.u(*tail_long), unit(vec(0, m.u(-.4, .4), -1) - ax * .6)
        k = m.r.randint(1, 3)
        P = a - ax * w * .2 + np.outer(np.linspace(0, 1, k + 1), d * l)
        tj = m.chain(P, js[0])
        m.part('tail', '', tj)
        M = np.stack([np.cross(Y, -d) / max(np.linalg.norm(np.cross(Y, -d)), 1e-6), d, np.cross(np.cross(Y, -d), d)], 1)
        M[:, 2] = np.cross(M[:, 0], M[:, 1])
        wide_tail = m.u(.05, .3)
        if m.style == 'box':
            m.add(sweep([P[0], P[-1]], [[wide_tail * .7, w * .2], [wide_tail, w * .12]], corners=4, square=1,
                        ends='flat', side=X), *tj[:1])
        elif m.maybe(.5):
            for i in range(m.r.randint(1, 6)):
                q = turn(M[:, 2], m.u(-.6, .6)) @ d
                m.flat(leaf(l, wide_tail * .4, r), .012, P[0], np.stack([np.cross(q, M[:, 2]), q, M[:, 2]], 1), tj[0])
        else:
            pc = m.flat(np.array([[-w * .3, 0], [w * .3, 0], [wide_tail, l], [0, l * m.u(.8, 1.1)], [-wide_tail, l]]),
                        m.u(.01, .08), P[0], M, tj[0])
            if k > 1:
                pc.joints, pc.u = tj, np.clip((pc.V - P[0]) @ d / l * k, 0, k - 1e-6)
    # wings
    wing_taste(m)
    folded = m.maybe(.55) if folded is None else folded
    form = form or 'feather'
    sp, ch, nw = m.u(*span), m.u(.3, .8) * B, m.r.randint(1, 4)
    root = b * .72 + a * .28 + vec(w * .85, 0, 0) + np.cross(ax, -X) * w * .35 * -1
    if folded:
        sp, ch = min(B * m.u(.7, 1.25), .9 * root[1] / max(ax[1] + .15, .1)), ch * .7
        if m.style == 'box':
            for s, q in SIDES:
                P = root * (q, 1, 1) + np.outer(np.linspace(0, 1, nw + 1), (-ax + vec(q * .1, -.15, 0)) * sp)
                wj = m.chain(P, js[-1])
                m.part('wing', s, wj, 0, upper=wj[0])
                m.flesh(P, np.stack([np.full(nw + 1, w * .14), np.full(nw + 1, ch * .6)], 1), wj)
        else:
            wings(m, root, js[-1], sp, ch * 1.1, nw, 'fold', -ax + vec(m.u(.05, .3), -m.u(0, .3), 0))
    else:
        wings(m, root, js[-1], sp, ch, nw, form, vec(1, m.u(-.3, .7), m.u(-.3, .3)), m.u(0, .9), 0)
    # legs
    if legs:
        rl, x, an_h = m.u(*leg_r), w * m.u(.35, .7), .012
        ns, fl, ft = (int(r.choice([1, 2, 3], p=[.25, .35, .4]))), m.u(.06, .18), m.pick(*feet)
        at = a + (b - a) * m.u(.15, .5)
        bow = m.u(.05, .3) * at[1]
        fly = not folded and m.maybe(.4)
        for s, q in SIDES:
            top = at + vec(x, -w * up * .5, 0)
            an = vec(x, an_h + rl, top[2] + .02)
            if fly:
                an = top + vec(0, -.06, -h * .5)
            o = an - top
            L = [[top, an], [top, top + o * .5 + Z * bow, an], [top, top + o * .3 + Z * bow,
                                                                top + o * .6 - Z * bow * .8, an]][ns - 1]
            fat = np.linspace(2.5, 1, len(L)) if m.style != 'box' else np.linspace(1.6, 1, len(L))
            seg, e = limb(m, s, np.array(L) * (q, 1, 1), rl * fat, js[0], 'leg', end=fl if m.maybe(.95) else 0)
            if e is not None:
                foot(m, e, fl, rl * 1.6, rl * 2, ft, drop=(an_h + rl) if not fly else rl)
    m.js = js


def standing_bird(m): bird(m, True)


def flying_bird(m): bird(m, False, tilt=(-.1, .4), span=(.7, 2.0))


def penguin(m): bird(m, True, (.6, .9), (1.1, 1.57), (.1, .25), (.18, .32), (0, .05), (.12, .22), leg_r=(.03, .07),
                     tail_long=(.05, .2), feet=('shoe', 'claws'))


def chick(m): bird(m, None, (.3, .5), (.2, 1.2), (.15, .35), (.18, .34), (0, .03), (.16, .32), (.2, .5), (.02, .05),
                   (.03, .2))


def wader(m): bird(m, None, (.4, .7), (.0, .9), (.6, 1.3), (.12, .2), (.3, .9), (.06, .12), leg_r=(.012, .03))


def bat(m): bird(m, False, (.2, .4), (.2, 1.4), (.3, .5), (.08, .18), (0, .05), (.09, .2), (.6, 1.4), (.015, .03),
                 (.05, .2), face=('snout', 'person'), form='bat')


def wyvern(m):
    bird(m, m.maybe(.1), (.6, 1.), (.1, .9), (.5, .9), (.14, .24), (.2, .8), (.1, .18), (.8, 1.8), (.04, .08),
         (.05, .1), face=('snout', 'flat'), form='bat')
    m.parts = [p for p in m.parts if p['kind'] != 'tail' or drop(m, p)]
    a = m.J[m.js[0]]
    tail(m, a, m.js[0], m.u(.6, 1.8), .1 * m.u(.6, 1.2), vec(0, m.u(-.4, .2), -1), m.r.randint(3, 9), m.u(-.5, .8))


def drop(m, part):
    """Take a part's joints' surface away; its joints stay, so that numbers do."""
    js = [int(j[1:]) for j in part['joints']]
    m.pieces = [p for p in m.pieces if not set(p.joints) & set(js)]
    return False


# --- dinosaurs and other two-legged with a tail

def dinosaur(m, neck_long=(.1, .6), skull=(.12, .26), tail_long=(.6, 1.6), face=('snout', 'flat', 'snout', 'beak')):
    r = m.r
    B, ti, h, w = m.u(.6, .9), m.u(-.1, .75), m.u(.6, 1.1), m.u(.13, .26)
    a = vec(0, h, -B * .4)
    b = a + vec(0, np.sin(ti), np.cos(ti)) * B
    n = m.r.randint(1, 5)
    js = trunk(m, a + np.outer(np.linspace(0, 1, n + 1), b - a),
               np.array([[w * .85, w * .9], [w, w * 1.15], [w * .95, w * 1.05], [w * .65, w * .7]]))
    nl, ang = m.u(*neck_long), np.radians(m.u(15, 75))
    end = b + vec(0, np.sin(ang), np.cos(ang)) * nl
    H = m.u(*skull)
    hang = neck(m, b, js[-1], end, m.r.randint(1, 4) if nl > .12 and m.maybe(.9) else 0, min(w * .65, H * 1.2),
                min(w * .5, H * .8), nl * m.u(-.1, .1))
    head(m, end, hang, vec(0, m.u(-.4, .1), 1), H, m.pick(*face))
    tail(m, a + vec(0, 0, -w * .4), js[0], m.u(*tail_long), w * m.u(.5, .9), vec(0, m.u(-.5, .25), -1),
         m.r.randint(2, 9), m.u(-.3, .6), tip=m.u(.05, .3))
    at = a + (b - a) * m.u(.05, .35)
    ns = int(r.choice([1, 2, 3], p=[.1, .35, .55])) if not m.hard else m.pick(1, 2, 3)
    x, rl, bow, fl = w * m.u(.6, .95), m.u(.05, .09), m.u(.08, .25) * h, m.u(.12, .3)
    step = m.u(.1, .35) * h if m.maybe(.25) else 0
    for s, q in SIDES:
        top = at + vec(x, -w * .2, 0)
        an = vec(x * 1.05, .06, top[2] + .02 + step * q)
        o = an - top
        L = [[top, an], [top, top + o * .5 + Z * bow, an], [top, top + o * .38 + Z * bow, top + o * .7 - Z * bow * .9,
                                                            an]][ns - 1]
        seg, e = limb(m, s, np.array(L) * (q, 1, 1), rl * np.linspace(1.9, .7, len(L)) if m.style != 'box'
                      else np.full(len(L), rl * 1.3), js[0], 'leg',
                      end=fl, toes=.5 if m.maybe(.2) else None)
        foot(m, e, fl, rl * 1.2, .08, m.pick('claws', 'claws', 'shoe', 'paw'), drop=.06, toes=m.toes_of(e))
    if m.maybe(.9):
        al, nf, na = m.u(.1, .4), m.pick(0, 2, 2, 3), m.pick(1, 2, 2)
        ra = m.u(.02, .045)
        v1, v2 = vec(m.u(.1, .5), -1, m.u(-.6, .3)), vec(m.u(-.1, .3), m.u(-.8, .3), 1)
        for s, q in SIDES:
            S = b + vec(w * .65, -w * .3, -.03)
            e1 = S + unit(v1) * al * .5
            wr = e1 + unit(v2) * al * .5
            seg, e = limb(m, s, np.array([S, e1, wr] if na == 2 else [S, wr]) * (q, 1, 1),
                          ra * np.linspace(1.3, .8, na + 1), js[-1], 'arm', end=al * .25 if nf or m.maybe(.5) else 0)
            if e is not None:
                hand(m, s, e, max(al * .28, ra * 2), nf)
    for k in range(m.r.randint(3, 10) if m.maybe(.25) else 0):                          # crest along the back
        t = (k + .5) / 10
        m.flat(leaf(w * m.u(.5, 1), w * .3, r), .02, a * (1 - t) + b * t + Y * w * .9, np.stack([Z, Y, -X], 1),
               js[min(int(t * n), n - 1)])


def kangaroo(m): dinosaur(m, (.1, .25), (.1, .16), (.6, 1.0), ('snout',))


# --- many legs

def insect(m, pairs=3, body=(.4, .7), arms=.1, wing=.25, reach=(.4, .9), tail_p=.5, abdomen=True,
           face=('bug', 'bug', 'person'), lift=(.1, .6), curl=None):
    r = m.r
    B, h, w = m.u(*body), m.u(.12, .35), m.u(.08, .22)
    a, b = vec(0, h, -B / 2), vec(0, h + m.u(-.05, .1), B / 2)
    n = m.r.randint(1, 4) if pairs < 5 else m.r.randint(3, 12)
    js = trunk(m, a + np.outer(np.linspace(0, 1, n + 1), b - a),
               np.array([[w * .8, w * .8], [w, w * m.u(.6, 1.1)], [w * m.u(.6, 1), w * .7]]))
    if m.maybe(.85):
        H = m.u(.06, .18)
        hang = neck(m, b, js[-1], b + Z * .04, 0, H * .5, H * .5)
        head(m, b + Z * .04, hang, vec(0, m.u(-.5, .2), 1), H, m.pick(*face), ears=False)
    if m.maybe(tail_p) or curl:
        rt = w * m.u(.6, 1.6)
        if curl:
            tail(m, a, js[0], m.u(.5, 1.1), w * .6, vec(0, .1, -1), m.r.randint(4, 8), tip=.3, curl=m.u(1.6, 3.6))
        elif abdomen:
            l = m.u(.25, .8)
            k = m.r.randint(1, 4)
            P = a - np.outer(np.linspace(0, 1, k + 1), vec(0, m.u(-.3, .3), 1) * l)
            tj = m.chain(P, js[0])
            m.part('tail', '', tj)
            t = np.linspace(0, 1, 7)
            L = np.stack([np.interp(t * k, np.arange(k + 1), P[:, c]) for c in range(3)], 1)
            if m.style == 'box':
                m.flesh(P, np.full(k + 1, rt), tj)
            else:
                m.add(sweep(L, rt * np.sin(np.pi * (t * .85 + .1)) ** .7, np.minimum(t * k, k - 1e-6),
                            max(m.corners, 5)), *tj)
    elif abdomen:
        m.blob(a - Z * w * m.u(.5, 1.2), w * vec(m.u(.8, 1.7), m.u(.8, 1.4), m.u(1, 2)), js[0])
    ns, rl = int(r.choice([1, 2, 3], p=[.15, .4, .45])), m.u(.012, .045)
    far, up, fan = m.u(*reach), m.u(*lift), m.u(.2, 1.5)
    thin = m.u(.2, .8)
    for k in range(pairs):
        t = k / max(pairs - 1, 1)
        at = b * (1 - t) + a * t
        at = at + (a - b) * m.u(-.02, .02) if pairs < 5 else at
        own = js[int(np.clip((1 - t) * n, 0, n - 1))]
        dz, fr = (.5 - t) * fan * (.4 if pairs > 4 else 1), far * m.u(.85, 1.15)
        for s, q in SIDES:
            top = at + vec(w * .75, -w * .1, 0)
            ft = vec(top[0] + fr, .01, top[2] + dz * fr)
            o = ft - top
            j1 = top + o * .35 + Y * up * fr
            L = [[top, ft], [top, j1, ft], [top, top + o * .2 + Y * up * fr * .4, j1 + o * .2, ft]][ns - 1]
            limb(m, s, np.array(L) * (q, 1, 1), rl * np.linspace(1.2, thin, len(L)), own, 'leg', k, end=0)
    if m.maybe(arms):                                                              # claws
        al, ra = m.u(.3, .7), m.u(.025, .07)
        big = m.u(1.5, 4)
        v = unit(vec(m.u(.3, 1), m.u(-.1, .4), 1))
        na = m.r.randint(1, 4)
        for s, q in SIDES:
            S = b + vec(w * .7, 0, -.03)
            L = np.array([S, S + unit(v + X * .6) * al * .4, S + v * al * .8, S + unit(v - X * .15) * al])
            L = L[[0, 3]] if na == 1 else L[[0, 1, 3]] if na == 2 else L
            seg, e = limb(m, s, L * (q, 1, 1), np.full(len(L), ra), js[-1], 'arm', end=al * .35)
            d = unit(m.tips[e] - m.J[e])
            M = frame(d)
            if m.style == 'box':
                m.add(box(m.J[e] + d * al * .15, (ra * big * .6, ra * big * .4, al * .2), M), e)
            else:
                m.add(ball(m.J[e] + d * al * .12, (ra * big * .6, ra * big * .4, al * .17), M), e)
            for z in (1, -1):
                c = m.J[e] + d * al * .2 + M[:, 0] * z * ra * big * .3
                m.add(sweep([c, c + d * al * .12 + M[:, 0] * z * ra * .3, c + d * al * .25 - M[:, 0] * z * ra * .3],
                            ra * big * vec(.28, .2, .04), corners=6), e)
    if m.maybe(wing):
        wing_taste(m)
        at = b * .6 + a * .4 + vec(w * .4, w * .6, 0)
        fold = m.maybe(.35)
        wings(m, at, js[-1], m.u(.4, 1), m.u(.15, .5), m.pick(1, 1, 2), 'insect' if m.maybe(.8) else 'feather',
              vec(m.u(.15, .4), .15, -1) if fold else vec(1, m.u(-.1, .9), m.u(-.8, .3)))
    m.js, m.a, m.b, m.w = js, a, b, w


def ant(m): insect(m, 3, wing=.08)


def bee(m): insect(m, 3, reach=(.15, .4), wing=1, lift=(-.2, .2))


def beetle(m):
    insect(m, 3, reach=(.25, .6), wing=.15, abdomen=False)
    m.blob((m.a + m.b) / 2 - Z * .1 + Y * m.w * .3, vec(m.u(1.2, 2), m.u(.8, 1.4), m.u(1.8, 2.8)) * m.w, m.js[0])


def spider(m): insect(m, 4, (.25, .5), arms=.25, wing=0, reach=(.5, 1.3), lift=(.2, .7))


def crab(m):
    insect(m, m.pick(3, 4, 4), (.2, .4), arms=1, wing=0, tail_p=.05, abdomen=False, reach=(.3, .7),
           face=('person', 'bug'))
    m.blob((m.a + m.b) / 2, vec(m.u(.25, .45), m.u(.1, .22), m.u(.2, .32)), m.js[0])


def scorpion(m): insect(m, m.pick(3, 4, 4), (.35, .6), arms=.95, wing=0, curl=True, reach=(.3, .7))


def centipede(m): insect(m, m.r.randint(5, 16), (1.2, 2.4), arms=.1, wing=0, tail_p=.3, abdomen=False, reach=(.12, .4),
                         lift=(0, .5))


def octopus(m):
    """A head and trunk in one over four pairs of arms (three to five)."""
    w, h = m.u(.15, .3), m.u(.2, .45)
    low = m.u(.1, .4)
    pairs = m.pick(3, 4, 4, 4, 5)
    a, b = vec(0, low, 0), vec(0, low + h, m.u(-.15, .05))
    js = m.chain([a, b], -1)
    m.part('trunk', '', js)
    j = m.joint(b, js[0], b + vec(0, h * .8, m.u(-.5, 0) * h))
    m.part('head', '', [j])
    c = (b + m.tips[j]) / 2
    m.flesh([a, b], [w * .75, w * .8], [js[0]])
    m.blob(c, (w, h * m.u(.55, .8), w * m.u(.9, 1.3)), j)
    if m.maybe(.7):
        for q in (1, -1):
            m.add(ball(b + vec(q * w * .75, 0, w * .5), np.full(3, w * m.u(.15, .3)), corners=8), j, flesh=False)
    n, ln, rl = m.r.randint(3, 8), m.u(.5, 1.4), w * m.u(.15, .35)
    dip, rise = m.u(-.9, -.1), m.u(-.2, 1.2)
    for k in range(pairs):
        ang = np.pi * ((k + .5) / pairs)
        for s, q in SIDES:
            d0 = vec(np.sin(ang) * q, 0, np.cos(ang))
            P, d = [a + d0 * w * .6], unit(d0 + Y * dip)
            bendy = m.u(.0, .5)
            for i in range(n):
                P.append(P[-1] + d * ln / n)
                d = unit(d + Y * ((rise if i > n / 3 else .3) - d[1] * .3) * 1.2 / n + np.cross(Y, d0) * bendy
                         * np.sin(i * 1.3) * .6)
            P = np.array(P)
            P[:, 1] = np.maximum(P[:, 1], rl * .5)
            t = np.linspace(0, 1, n + 1)
            limb(m, s, P, rl * (1 - .85 * t), js[0], 'leg', k)


# --- swimmers

def fish(m, long=1.0, deep=(.12, .35), wide=(.3, .8), ends=(.05, .25), tail_share=(.3, .5), fins=2, dorsal=(.1, .4),
         fluke='fin', face=.15, head_share=(.15, .35), fin_long=(.12, .4)):
    """Nose at +Z, one body of sections, a tail that swims, plates of fins. wide: width over depth."""
    r = m.r
    nose = long / 2
    hd_z, tl_z = nose - long * m.u(*head_share), nose - long * (1 - m.u(*tail_share))
    D = m.u(*deep) * long
    wd = m.u(*wide)
    nt, nh = m.r.randint(1, 3), m.r.randint(1, 6)
    end_z = -long / 2
    mid = (hd_z + tl_z) / 2 if nt == 2 else tl_z
    js = m.chain([vec(0, 0, tl_z), vec(0, 0, hd_z)] if nt == 1 else [vec(0, 0, tl_z), vec(0, 0, mid), vec(0, 0, hd_z)],
                 -1)
    m.part('trunk', '', js)
    has_head = m.maybe(.85)
    hj = m.joint(vec(0, 0, hd_z), js[-1], vec(0, 0, nose)) if has_head else js[-1]
    if has_head:
        m.part('head', '', [hj])
    TP = np.stack([0 * np.zeros(nh + 1), np.zeros(nh + 1), np.linspace(tl_z, end_z, nh + 1)], 1)
    tj = m.chain(TP, js[0])
    m.part('tail', '', tj)
    # sections from nose to tail
    z = np.linspace(nose, end_z, 15)
    t = (nose - z) / long
    pk, e0, e1 = m.u(.25, .5), m.u(*ends) + .1, m.u(.05, .2)
    prof = np.where(t < pk, e0 + (1 - e0) * np.sqrt(np.maximum(1 - ((pk - t) / pk) ** 2, 0)),
                    e1 + (1 - e1) * np.cos(np.clip((t - pk) / (1 - pk), 0, 1) * np.pi / 2) ** m.u(.8, 1.8))
    low = m.u(-.15, .1) * D * np.sin(np.pi * t)
    joints = [hj] + js[::-1] + tj if has_head else js[::-1] + tj
    stops = np.r_[[nose, hd_z] if has_head else [nose], [mid, tl_z] if nt == 2 else [tl_z], TP[1:, 2]]
    u = np.interp(-z, -stops, np.arange(len(stops)))
    own = np.minimum(u, len(joints) - 1e-6)
    square = m.u(0, .25)
    if m.style in ('box', 'prism'):
        cuts = np.linspace(0, 14, m.r.randint(2, 6)).astype(int)
        for i0, i1 in zip(cuts, cuts[1:]):
            p0, p1 = (prof[i0:i1 + 1].max(),) * 2 if m.style == 'box' else (prof[i0], prof[i1])
            k = int(own[(i0 + i1) // 2])
            pc = sweep([vec(0, 0, z[i0]), vec(0, 0, z[i1])], [[p0 * D * wd, p0 * D], [p1 * D * wd, p1 * D]], corners=4,
                       square=1, ends='flat', side=X)
            pc.u = np.clip(np.interp(-pc.V[:, 2], -stops, np.arange(len(stops))), 0, len(joints) - 1e-6)
            m.add(pc, *joints)
    else:
        m.add(sweep(np.stack([0 * z, low, z], 1), np.stack([prof * D * wd, prof * D], 1), own, max(m.corners, 5),
                    square, 'round', X), *joints, smooth=.4)
    if has_head and m.maybe(face):
        k = m.joint(vec(0, -D * .3, hd_z), hj, vec(0, -D * .3, nose))
        m.part('jaw', '', [k])
        m.blob(vec(0, -D * e0 * .8, (nose + hd_z) / 2), (D * wd * .6, D * .15, (nose - hd_z) / 2), k)
    if m.maybe(.6):
        for q in (1, -1):
            i = 2
            m.add(ball(vec(q * prof[i] * D * wd * .9, D * .2 * prof[i], z[i] - .02), np.full(3, D * m.u(.08, .22)),
                       corners=8), hj, flesh=False)
    thin = m.u(.01, .04)
    thin = thin * (2 if m.style == 'box' else 1)
    # tail fin
    s = m.u(.1, .38) * long
    end = vec(0, 0, end_z)
    if fluke == 'fluke':
        for q in (1, -1):
            m.flat([[0, .04], [q * s, -s * .5], [q * s * .9, -s * .75], [0, -s * .35]], thin * 2, end,
                   np.stack([X, Z, -Y], 1), tj[-1])
    elif fluke == 'whip':
        pass
    else:
        up, dn = (1, m.u(.3, .6)) if fluke == 'shark' else (1, m.u(.8, 1.1))
        fork = m.u(.0, .6)
        m.flat([[.03, 0], [s * .9 * -1, s * up], [-s * (1 - fork), 0], [-s * .9, -s * dn]] if m.maybe(.8)
               else leaf(s, s * .8, r)[:, ::-1] * (-1, 1), thin, end, np.stack([Z, Y, -X], 1), tj[-1])
    # dorsal and belly fins
    at = lambda zz: np.interp(-zz, -z, prof) * D
    spots = [(m.u(-.1, .15), 1, dorsal)] + ([(m.u(-.3, -.1), 1, (.04, .15))] if m.maybe(.3)
                                            else []) + ([(m.u(-.35, -.1), -1, (.05, .2))] if m.maybe(.5) else [])
    for zz, q, size in spots:
        if size[1] <= 0 or not m.maybe(.9):
            continue
        s, wz = m.u(*size) * long, m.u(.08, .3) * long
        c = vec(0, q * at(zz) * (.9 if m.style != 'prism' else .5), zz)
        k = int(np.clip(np.interp(-zz, -stops, np.arange(len(stops))), 0, len(joints) - 1))
        m.flat([[wz, 0], [-wz * m.u(-.2, .6), q * s], [-wz, q * s * m.u(.1, .9)], [-wz * .9, 0]], thin, c,
               np.stack([Z, Y, -X], 1), joints[k])
    # paired fins
    for pair in range(fins if fins < 3 else m.r.randint(1, 3)):
        s, zz = m.u(*fin_long) * long * (1 if pair == 0 else .6), hd_z - .03 - (.25 * long if pair else 0)
        y, dip, out, two = -at(zz) * m.u(.1, .6), m.u(-.9, .2), m.u(.3, 1.2), m.maybe(.3) and pair == 0
        k = js[-1] if pair == 0 else js[0]
        back = m.u(-1, -.2)
        shape = leaf(s, s * m.u(.2, .45), r)
        for sd, q in SIDES:
            p = vec(q * at(zz) * wd * (1 - (y / max(at(zz), 1e-6)) ** 2) ** .5 * .95, y, zz)
            d = unit(vec(q * out, dip, back))
            fj = m.chain([p, p + d * s * .5, p + d * s] if two else [p, p + d * s], k)
            m.part('fin', sd, fj, pair, )
            sidev = unit(np.cross(d, unit(vec(-q * dip, 1, 0))))
            pc = m.flat(shape * (q, 1), thin, p, np.stack([sidev, d, np.cross(sidev, d)], 1), fj[0])
            if two:
                pc.joints, pc.u = fj, np.clip((pc.V - p) @ d / s * 2, 0, 2 - 1e-6)


def common_fish(m): fish(m)


def round_fish(m): fish(m, m.u(.6, .9), (.35, .6), (.5, 1.1), (.2, .5), (.2, .4), 1 if m.maybe(.7) else 2, (.05, .3))


def long_fish(m): fish(m, m.u(1.4, 2.2), (.04, .1), (.5, 1), (.2, .5), (.5, .75), m.pick(1, 2), (.02, .1),
                       head_share=(.08, .15), fin_long=(.03, .1))


def flat_fish(m): fish(m, 1.0, (.25, .5), (.1, .25), (.1, .3), fins=m.pick(1, 2), dorsal=(.15, .5))


def shark(m): fish(m, m.u(1.2, 1.6), (.1, .17), (.8, 1.1), (.1, .3), (.35, .5), 2, (.1, .22), 'shark', .35,
                   fin_long=(.18, .35))


def whale(m): fish(m, m.u(1.2, 1.8), (.12, .3), (.8, 1.25), (.3, .9), (.35, .55), m.pick(1, 1, 2), (.0, .12), 'fluke',
                   .4, (.2, .4), (.15, .35))


def ray(m):
    """A flat disc whose sides are its fins."""
    r = m.r
    w, l, th = m.u(.5, 1.1), m.u(.35, .6), m.u(.03, .1)
    nose, rear = l * m.u(.8, 1.1), -l
    n = m.r.randint(1, 3)
    js = m.chain(np.stack([np.zeros(n + 1), np.zeros(n + 1), np.linspace(rear * .7, nose * .4, n + 1)], 1), -1)
    m.part('trunk', '', js)
    body_w = m.u(.12, .3)
    t = np.linspace(0, 1, 9)
    u = np.minimum(t * n, n - 1e-6)
    m.add(sweep(np.stack([0 * t, 0 * t, rear + (nose - rear) * t], 1),
                np.stack([body_w * np.sin(np.pi * (t * .86 + .08)), th * 1.6 * np.sin(np.pi * (t * .86 + .08))], 1), u,
                max(6, m.corners), side=X), *js)
    if m.maybe(.7):
        j = m.joint(vec(0, 0, nose * .4), js[-1], vec(0, 0, nose))
        m.part('head', '', [j])
        m.blob(vec(0, 0, nose * .7), (body_w * .7, th * 1.5, nose * .35), j)
    k = m.r.randint(1, 4)
    tip_z, dihedral, droop = m.u(-.6, .2) * l, m.u(-.3, .5), m.u(-.6, .2)
    for s, q in SIDES:
        P = [vec(q * (body_w * .6 + (w - body_w * .6) * x), dihedral * w * x + droop * w * x * x, tip_z * x * x)
             for x in np.linspace(0, 1, k + 1)]
        P = np.array(P)
        fj = m.chain(P, js[-1])
        m.part('fin', s, fj)
        x = np.linspace(0, 1, 9)
        L = np.stack([np.interp(x * k, np.arange(k + 1), P[:, c]) for c in range(3)], 1)
        half = np.maximum(1 - x ** m.taper, .04)
        front, back = nose * .85 * half, rear * .95 * half
        g = np.linspace(0, 1, 4)
        G = np.stack([L * (1, 1, 1) + np.outer(front * (1 - f) + back * f, Z) for f in g], 1)
        m.add(sheet(G[:, ::-1] if q < 0 else G, th * m.u(.3, 1), np.minimum(x * k, k - 1e-6)[:, None]), *fj)
    tail(m, vec(0, 0, rear * .95), js[0], m.u(.3, 1.6), th * m.u(.4, 1), -Z, m.r.randint(1, 7), m.u(-.2, .3), tip=.1)


# --- crawlers

def snake(m, posture=None):
    r = m.r
    n, rad = m.r.randint(6, 24), m.u(.025, .09)
    ln = m.u(1.6, 2.6)
    posture = posture or m.pick('flat', 'flat', 'flat', 'straight', 'cobra', 'coil')
    s = np.linspace(0, 1, 161)
    if posture == 'coil':
        turns, R0 = m.u(1.2, 3), m.u(.25, .45)
        a = s * turns * 2 * np.pi
        rr = R0 * (1 - .55 * s[::-1]) if m.maybe(.5) else R0 * (1 - .3 * s)
        P = np.stack([rr * np.cos(a), rad + (1 - s) * turns * rad * 1.9, rr * np.sin(a)], 1)
        k = 22
        d = P[0] * (1, 0, 1)
        P[:k] += np.outer(np.linspace(1, 0, k) ** 1.5, Z * R0 * 1.1 + Y * m.u(.1, .5) - d * .8)
    else:
        wave = 0 if posture == 'straight' else m.u(.08, .45)
        ph, fr = m.u(0, 6.3), m.u(.7, 2.6)
        x = wave * np.sin(6.28 * s * fr + ph) * np.minimum(1, s * 4 + .2)
        P = np.stack([x - x.mean(), np.full(len(s), rad), (.5 - s) * ln], 1)
        if posture == 'cobra' or m.maybe(.25):
            k = m.r.randint(18, 60)
            up = np.linspace(1, 0, k) ** 1.6
            P[:k, 1] += up * m.u(.3, .8)
            P[:k, 2] -= up * m.u(.1, .6) * k / 160 * ln
            P[:6, 2] += np.linspace(.12, 0, 6)
    d = np.r_[0, np.cumsum(np.linalg.norm(np.diff(P, axis=0), axis=1))]
    q = np.linspace(0, d[-1], n + 1)
    K = np.stack([np.interp(q, d, P[:, c]) for c in range(3)], 1)
    mid = m.r.randint(2, max(3, n * 2 // 3))
    js = m.chain(K[mid:0:-1], -1)
    m.part('trunk', '', js)
    last = js[-1]
    if m.maybe(.5) and len(js) > 2:
        m.parts[-1]['joints'] = ['j%d' % j for j in js[:-1]]
        m.part('neck', '', js[-1:])
    tj = m.chain(K[mid:], js[0])
    m.part('tail', '', tj)
    joints = js[::-1] + tj
    t = d / d[-1]
    w = rad * np.minimum(1, .55 + t * 6) * (1 - .9 * t ** m.u(1.5, 6))
    if posture == 'cobra' and m.maybe(.8):
        hood = np.exp(-((t - .08) / .05) ** 2)
        wide = np.stack([w * (1 + hood * m.u(1, 3)), w], 1)
    else:
        wide = np.stack([w, w * m.u(.7, 1.1)], 1)
    step = 2 if m.style == 'smooth' else 4
    i = np.unique(np.r_[0:161:step, 160])
    per = np.interp(d, q[1:], np.arange(n))
    if m.style in ('box', 'prism', 'cylinder', 'ball', 'capsule'):
        KK = K[1:]
        W = np.interp(q[1:], d, w)
        m.flesh(KK, np.maximum(W, .006), joints)
    else:
        m.add(sweep(P[i], np.maximum(wide[i], .004), np.minimum(per[i], n - 1 - 1e-6), max(m.corners, 5), 0, 'round',
                    X if posture != 'coil' else Y), *joints, smooth=.4)
    m.flesh([K[0], K[1]], [rad * .8, rad * .7], [last], style='capsule' if not m.hard else None)
    H = rad * m.u(1, 2)
    hd = unit((K[0] - K[1]) * (1, .2, 1) + Z * (2 if posture != 'coil' else 1) * .1 + vec(0, m.u(-.05, .05), 0))
    head(m, K[0], last, hd, H, m.pick('flat', 'flat', 'snout', 'bug'), ears=False)


def worm(m):
    """Short and thick: worms, grubs, caterpillars, slugs."""
    r = m.r
    n, ln, rad = m.r.randint(6, 10), 1.2, m.u(.08, .24)
    s = np.linspace(0, 1, n + 1)
    hump, rise = m.u(0, .3), m.u(0, .4) if m.maybe(.4) else 0
    P = np.stack([m.u(0, .12) * np.sin(s * 5 + m.u(0, 6)), rad + hump * np.sin(np.pi * s) ** 2 + rise
                  * np.maximum(.35 - s, 0) * 2.2, (.5 - s) * ln], 1)
    mid = m.r.randint(2, n - 1)
    js = m.chain(P[mid:0:-1], -1)
    m.part('trunk', '', js)
    tj = m.chain(P[mid:], js[0])
    m.part('tail', '', tj)
    w = rad * np.interp(s, [0, .15, .7, 1], [.75, 1, m.u(.7, 1.1), m.u(.1, .8)])
    joints = js[::-1] + tj
    style = m.pick(m.style, 'ball', 'capsule')
    m.flesh(P[1:], w[1:], joints, style=style)
    head(m, P[1], js[-1], unit(P[0] - P[1] + Z * .2), rad * m.u(.8, 1.3), m.pick('bug', 'person', 'flat', 'block'),
         ears=False)
    for k in range(1, n if m.maybe(.3) else 1):
        for q in (1, -1):
            m.blob(P[k] + vec(q * w[k] * .6, -w[k] * .8, 0), np.full(3, rad * .25),
                   joints[min(max(k - 1, 0), len(joints) - 1)])
    if m.maybe(.2):
        c = P[mid] + Y * rad * 1.2
        j = m.joint(c, js[0], c + Y * rad * 2)
        m.part('prop', '', [j])
        t = np.linspace(0, 1, 24)
        a, R = t * m.u(1.5, 2.5) * 2 * np.pi, rad * m.u(1.2, 2)
        m.add(sweep(np.stack([.25 * R * t, c[1] + R * (1 - t) * np.sin(a) + R * .6, c[2] + R * (1 - t) * np.cos(a)], 1),
                    R * .55 * (1 - t) + .01, corners=8), j, flesh=False)


# --- dragons and winged four-legged

def dragon(m):
    form = m.pick('four', 'four', 'croc', 'toy')
    if form == 'four':
        four(m, (.8, 1.1), (.4, .9), (.15, .28), (.2, .9), (10, 75), (.11, .2), ('snout', 'flat', 'snout'), (.05, .1),
             tail_long=(.6, 1.8), feet=('claws', 'paw'), tail_r=(.4, .8), sag=(-.6, .8))
    elif form == 'toy':
        four(m, (.45, .8), (.3, .6), (.18, .32), (.0, .2), (30, 90), (.18, .35), ('snout', 'block'), (.06, .12),
             tail_long=(.3, .8), feet=('claws', 'paw'), tail_r=(.4, .8))
    else:
        four(m, (.8, 1.2), (.2, .4), (.15, .25), (.2, .8), (0, 50), (.1, .2), ('snout', 'flat'), (.04, .08),
             m.u(.2, .7), (.6, 1.8), ('claws',), tail_r=(.4, .8))
    wing_taste(m)
    fold = m.maybe(.3)
    wings(m, m.front * .8 + m.back * .2 + vec(m.wf * .7, m.wf * m.up * .6, 0), m.js[-1], m.u(.6, 1.8), m.u(.3, .8),
          m.r.randint(1, 5), 'bat' if m.maybe(.8) else 'feather',
          vec(m.u(.2, .5), m.u(.4, 1), -1) if fold else vec(1, m.u(0, 1), m.u(-.6, .2)), m.u(0, .6),
          m.u(0, .8) if m.maybe(.4) else 0)


def pegasus(m):
    horse(m)
    wing_taste(m)
    fold = m.maybe(.35)
    wings(m, m.front * .75 + m.back * .25 + vec(m.wf * .85, m.wf * m.up * .5, 0), m.js[-1], m.u(.5, 1.3), m.u(.2, .5),
          m.r.randint(1, 4), 'fold' if fold else 'feather',
          vec(m.u(.05, .25), .1, -1) if fold else vec(1, m.u(.1, 1), m.u(-.5, .2)), m.u(0, .6))


KINDS = {
    'adult': ('upright', adult, 4), 'chibi': ('upright', chibi, 5), 'big_head': ('upright', big_head, 4),
    'box_person': ('upright', box_person, 4),
    'robed': ('upright', robed, 3), 'monster': ('upright', monster, 5),
    'winged_person': ('upright', winged_person, 1.5), 'mascot': ('upright', mascot, 4),
    'gorilla': ('upright', gorilla, 1), 'robot': ('upright', robot, 4), 'roller': ('upright', roller, 1.5),
    'egg': ('upright', egg, 2),
    'horse': ('four', horse, 2.5), 'giraffe': ('four', giraffe, 1.5), 'dog': ('four', dog, 3),
    'stout': ('four', stout, 3), 'toy_four': ('four', toy_four, 3),
    'elephant': ('four', elephant, 1), 'crocodile': ('four', crocodile, 3), 'tortoise': ('four', tortoise, 2),
    'frog': ('four', frog, 2), 'rat': ('four', rat, 1.5),
    'woolly': ('four', woolly, 1), 'sitting': ('four', sitting, 1),
    'standing_bird': ('bird', standing_bird, 3), 'flying_bird': ('bird', flying_bird, 3),
    'penguin': ('bird', penguin, 1), 'chick': ('bird', chick, 2), 'wader': ('bird', wader, 1.5),
    'bat': ('bird', bat, 1.5), 'wyvern': ('bird', wyvern, 1.5), 'dinosaur': ('dinosaur', dinosaur, 5),
    'kangaroo': ('dinosaur', kangaroo, 1),
    'ant': ('many', ant, 2), 'bee': ('many', bee, 1.5), 'beetle': ('many', beetle, 1), 'spider': ('many', spider, 2),
    'crab': ('many', crab, 1.5), 'scorpion': ('many', scorpion, 1),
    'centipede': ('many', centipede, 1), 'octopus': ('many', octopus, 1.5),
    'fish': ('swims', common_fish, 3), 'round_fish': ('swims', round_fish, 2.5), 'long_fish': ('swims', long_fish, 1.5),
    'flat_fish': ('swims', flat_fish, 1), 'shark': ('swims', shark, 1.5),
    'whale': ('swims', whale, 1.5), 'ray': ('swims', ray, 1), 'snake': ('crawls', snake, 3.5),
    'worm': ('crawls', worm, 1.5),
    'dragon': ('winged_four', dragon, 3), 'pegasus': ('winged_four', pegasus, 1),
}

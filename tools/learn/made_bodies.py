#!/usr/bin/python3
"""Bodies made by code, prepared as prepare.py prepares rigged files: samples of the surface with exact labels.

    made_bodies.py OUT_FOLDER N [--first I] [--kind KIND] [--obj FOLDER]

Body number i of a kind is the same for ever: its seed is made of the kind's name and i. Files that exist are kept, so
that a run that was stopped goes on. Kinds and their proportions: made_plans.KINDS and made_things.THINGS.
Fields: those of real bodies (P, N, rad, wi, wv, J, parents, label, count, rj, rt, plan, ...) and
    roles     names of the rows of rj and rt
    part      (#P) roles.PARTS of each sample
    own       (#P) joint that carries the sample
    bone      (#P x 6) the ends of that joint's bone
    piece     (#P) area of the sample's connected component over all area
    fingers   (2) fingers of the left and the right hand
    kind      name of the kind
"""
import argparse
import os
import sys
import zlib

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from made_maker import Maker, Y
from made_plans import KINDS
from labels import PartReader
from made_shapes import ball, box, inner_radii, surface_points, sweep, vec
from made_things import THINGS
from samples import farthest_first
from vocabulary import PLAN, ROLES

ALL = {**KINDS, **THINGS}
POINTS, POOL, TOKENS = 4096, 1536, 512


def build(kind, number):
    """The Maker with all joints, parts and pieces of one body, and how its surface comes: loose, merged or scanned."""
    r = np.random.RandomState(zlib.crc32(('%s %d' % (kind, number)).encode()))
    m = Maker(r)
    ALL[kind][1](m)
    m.kind, m.plan = kind, ALL[kind][0]
    m.surface = r.choice(['loose', 'merged', 'scan'], p=[.3, .5, .2])
    V = np.concatenate([p.V for p in m.pieces])
    lo, hi = V.min(0), V.max(0)
    size = np.linalg.norm(hi - lo)
    if r.rand() < (.35 if m.surface == 'scan' else .04):                                        # plinth
        low = V[V[:, 1] < lo[1] + .15 * (hi - lo)[1]]
        c, w = (low.min(0) + low.max(0)) / 2, max(np.ptp(low[:, [0, 2]], axis=0).max(), .1 * size) * m.u(.55, 1.1)
        h, base = size * m.u(.02, .15), lo[1] + .01 * size
        j = m.joint(vec(c[0], base - h, c[2]), -1, vec(c[0], base, c[2]))
        m.part('prop', '', [j])
        if r.rand() < .5:
            m.add(box(m.J[j] + Y * h / 2, (w, h / 2, w * m.u(.6, 1))), j, flesh=False)
        else:
            m.add(sweep([m.J[j], m.tips[j]], [w, w * m.u(.75, 1)], corners=12, ends='flat'), j, flesh=False)
    if r.rand() < (.25 if m.surface == 'scan' else .03):                                        # debris
        for _ in range(r.randint(1, 6)):
            c = lo + (hi - lo) * r.uniform(-.15, 1.15, 3)
            j = m.joint(c, -1, c + Y * .02 * size)
            m.part('prop', '', [j])
            piece = ball(c, size * r.uniform(.003, .03, 3), corners=6)
            m.add(piece, j, flesh=False)
    for k, tip in enumerate(m.tips):
        if tip is None:
            m.tips[k] = m.J[k] + Y * .02 * size
    return m


def soft_weights(u, joints, width, parent):
    """Own joint, joints (#u x 2) and weights (#u x 2) of samples at position u along a piece's joints. Weights are
    shared with the neighbour within `width` of a bone's length, at the first joint with its parent (-1: none)."""
    k = np.minimum(u.astype(int), len(joints) - 1)
    own = np.asarray(joints)[k]
    f = u - k
    before = np.r_[joints[0] if parent < 0 else parent, joints][k]
    after = np.r_[joints, joints[-1]][k + 1]
    low = f < .5
    other = np.where(low, before, after)
    near = np.where(low, f, 1 - f)
    w = np.where((other != own) & (width > 0), np.clip(.5 - .5 * near / max(width, 1e-9), 0, .48), 0)
    return own, np.stack([own, np.where(w > 0, other, own)], 1), np.stack([1 - w, w], 1)


def components(m, hits):
    """Pieces that overlap (hits[i, j]: samples of i inside j) as groups."""
    group = np.arange(len(m.pieces))

    def top(i):
        while group[i] != i:
            i = group[i]
        return i
    for i, j in zip(*np.nonzero(hits)):
        group[top(i)] = top(j)
    return np.array([top(i) for i in range(len(group))])


def sampled(m, total=POINTS):
    """P, N, piece index, u, fraction of area of each connected component. In loose bodies inner surfaces stay."""
    sizes = [len(p.V) for p in m.pieces]
    V = np.concatenate([p.V for p in m.pieces])
    F = np.concatenate([p.F + o for p, o in zip(m.pieces, np.r_[0, np.cumsum(sizes)[:-1]])])
    U = np.concatenate([p.u for p in m.pieces])
    owner = np.repeat(np.arange(len(m.pieces)), [len(p.F) for p in m.pieces])
    n = len(m.pieces)
    flesh = np.array([p.flesh for p in m.pieces])
    boxes = [(p.V.min(0), p.V.max(0)) for p in m.pieces]
    hits, count, out, have, first = np.zeros((n, n), int), np.zeros(n), [], 0, 0
    while have < total:
        P, N, f, w = surface_points(V, F, first, total)
        first += total
        I = owner[f]
        keep = np.ones(len(P), bool)
        if m.surface != 'loose':
            for j, p in enumerate(m.pieces):
                if p.inside is None or (m.surface == 'merged' and not p.flesh):
                    continue
                at = np.nonzero(((P >= boxes[j][0]) & (P <= boxes[j][1])).all(1) & (I != j))[0]
                if m.surface == 'merged':
                    at = at[flesh[I[at]]]
                if not len(at):
                    continue
                at = at[p.inside(P[at])]
                np.add.at(hits, (I[at], j), 1)
                keep[at] = False
        np.add.at(count, I, keep)
        out.append((P[keep], N[keep], I[keep], (U[F[f]] * w).sum(1)[keep]))
        have += keep.sum()
        if first > 12 * total and have < total // 2:
            m.surface = 'loose'
            return sampled(m, total)
    P, N, I, u = (np.concatenate(x)[:total] for x in zip(*out))
    if m.surface == 'loose':
        a, b, c = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
        count = np.bincount(owner, np.linalg.norm(np.cross(b - a, c - a), axis=1), n)
    group = components(m, hits)
    area = np.bincount(group, count, n)
    return P, N, I, u, (area / area.sum())[group[I]]


def scanned(P, N, r):
    """Noise, bumps and holes of a scan: moved points, tilted normals, and which samples are left."""
    size = np.linalg.norm(P.max(0) - P.min(0))
    keep = np.ones(len(P), bool)
    if r.rand() < .6:
        P = P + N * (r.randn(len(P), 1) * size * r.uniform(.001, .006))
    if r.rand() < .6:
        K = r.randn(3, 6) * r.uniform(10, 40) / size
        P = P + N * (np.sin(P @ K + r.rand(6) * 6.283).mean(1, keepdims=True) * size * r.uniform(.002, .012))
    N = N + r.randn(*N.shape) * r.uniform(0, .35)
    N /= np.maximum(np.linalg.norm(N, axis=1, keepdims=True), 1e-9)
    for _ in range(r.randint(0, 6)):
        c = P[r.randint(len(P))]
        keep &= ((P - c) ** 2).sum(1) > (size * r.uniform(.01, .06)) ** 2
    if r.rand() < .3:                                                                         # nothing seen from below
        keep &= ~((N[:, 1] < -.6) & (r.rand(len(P)) < .8))
    return P, N, keep if keep.sum() > POOL else np.ones(len(P), bool)


def prepared(m, r):
    P, N, I, u, fraction = sampled(m)
    if m.surface == 'scan':
        P, N, keep = scanned(P, N, r)
        P, N, I, u, fraction = P[keep], N[keep], I[keep], u[keep], fraction[keep]
    J, tips = np.array(m.J), np.array(m.tips)
    size = np.linalg.norm(P.max(0) - P.min(0))
    o = farthest_first(P, POOL)
    all_points = P
    P, N, I, u, fraction = P[o], N[o], I[o], u[o], fraction[o]
    rad = inner_radii(P, N, all_points, size)
    flip = inner_radii(P[:TOKENS], -N[:TOKENS], all_points, size)
    turned = bool(np.median(rad[:TOKENS]) > 2.5 * np.median(flip))
    if turned:
        N = -N
        rad = inner_radii(P, N, all_points, size)
    own, wi, wv = np.zeros(POOL, int), np.zeros((POOL, 2), int), np.zeros((POOL, 2))
    for k in np.unique(I):
        at = I == k
        own[at], wi[at], wv[at] = soft_weights(u[at], m.pieces[k].joints, m.pieces[k].smooth,
                                               m.parents[m.pieces[k].joints[0]])
    names = ['j%d' % k for k in range(len(J))]
    reader = PartReader(m.parts, names, J, m.parents)
    reader.read()
    roles, label, count = reader.role, reader.joint_part, reader.counted
    rj = np.array([roles[x][:2] if x in roles else (-1, -1) for x in ROLES])
    rt = np.array([roles[x][2] if x in roles else 0 for x in ROLES])
    lo, hi = all_points.min(0), all_points.max(0)
    return dict(P=P.astype('f4'), N=N.astype('f4'), rad=rad.astype('f4'), wi=wi.astype('i2'), wv=wv.astype('f4'),
                J=J.astype('f4'), parents=np.array(m.parents), label=label,
                count=count, rj=rj, rt=rt.astype('f4'), plan=PLAN[m.plan],
                conf=1., how='made', axes=np.eye(3),
                side=float((hi - lo).max()), height=float(hi[1] - lo[1]), path='', turned=turned,
                roles=np.array(ROLES), part=label[own].astype('i2'), own=own.astype('i2'),
                bone=np.concatenate([J[own], tips[own]], 1).astype('f4'), piece=fraction.astype('f4'),
                fingers=np.array(m.fingers), kind=m.kind, surface=m.surface, style=m.style)


def counts(n):
    """How many bodies of each kind there are among the first n: numbers of one kind only grow with n."""
    fraction = np.array([k[2] for k in ALL.values()], float)
    whole = fraction / fraction.sum() * n
    out = np.floor(whole).astype(int)
    out[np.argsort(out - whole, kind='stable')[:n - out.sum()]] += 1
    return dict(zip(ALL, out))


def write_obj(m, path):
    with open(path, 'w') as f:
        base = 1
        for k, p in enumerate(m.pieces):
            f.write('o piece_%d\n' % k)
            f.writelines('v %.6g %.6g %.6g\n' % tuple(v) for v in p.V)
            f.writelines('f %d %d %d\n' % tuple(t + base) for t in p.F)
            base += len(p.V)


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument('out')
    ap.add_argument('n', type=int, help='bodies in all, shared out over the kinds; with --kind: of that kind')
    ap.add_argument('--first', type=int, default=0, help='number of the first body of each kind')
    ap.add_argument('--kind', choices=list(ALL))
    ap.add_argument('--obj', action='store_true', help='write triangles as .obj in place of samples')
    o = ap.parse_args()
    os.makedirs(o.out, exist_ok=True)
    want = {o.kind: o.n} if o.kind else counts(o.n)
    todo = sorted(((i + .5) / c, kind, i) for kind, c in want.items() for i in range(c))
    for done, (_, kind, i) in enumerate(todo):
        dst = os.path.join(o.out, 'made_%s__%s_%05d.' % (ALL[kind][0], kind, o.first + i) + ('obj' if o.obj else 'npz'))
        if os.path.exists(dst):
            continue
        m = build(kind, o.first + i)
        if o.obj:
            write_obj(m, dst)
            continue
        d = prepared(m, np.random.RandomState(zlib.crc32(('scan %s %d' % (kind, o.first + i)).encode())))
        with open(dst + '.part', 'wb') as f:
            np.savez_compressed(f, **d)
        os.replace(dst + '.part', dst)
        if done % 100 == 0:
            print(done, len(todo), kind, flush=True)


if __name__ == '__main__':
    main()

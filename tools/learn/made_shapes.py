"""Surfaces of triangles for bodies made by code: balls, boxes, plates, sheets and forms swept along a line.

Each function returns a Piece: V (#V x 3), F (#F x 3, outward), u (#V: position along the chain of joints it belongs to,
k + t at fraction t of joint k's bone) and `inside(points)` -> bool, or None where the piece encloses nothing
(cloth, fins).
Pieces overlap freely. Right-handed, any unit.
"""
import numpy as np

PCG_STATE, PCG_INC = 0x853c49e6748fea9b, 0xda3e39cb94b95bdb


def vec(*x):
    return np.array(x, float)


def unit(v):
    v = np.asarray(v, float)
    return v / max(np.linalg.norm(v), 1e-12)


class Piece:
    __slots__ = ('V', 'F', 'u', 'joints', 'inside', 'flesh', 'smooth')

    def __init__(self, V, F, u=None, inside=None):
        self.V, self.F = np.asarray(V, float), np.asarray(F, int).reshape(-1, 3)
        self.u = np.zeros(len(self.V)) if u is None else np.asarray(u, float)
        self.joints, self.inside, self.flesh, self.smooth = [0], inside, True, 0.0


def frame(along, hint=(0, 1, 0)):
    """Columns: side, up, along; `up` as close to `hint` as can be."""
    along = unit(along)
    side = np.cross(hint, along)
    if np.linalg.norm(side) < 1e-3:
        side = np.cross((1, 0, 0) if abs(along[0]) < .9 else (0, 0, 1), along)
    side = unit(side)
    return np.stack([side, np.cross(along, side), along], 1)


def turn(axis, angle):
    """Matrix that rotates by `angle` about `axis`."""
    x, y, z = unit(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * (K @ K)


def rings(n, m, closed_start=True, closed_end=True):
    """Triangles of n rings of m vertices; after them, where closed, one vertex for each end's fan."""
    i = np.arange(n - 1)[:, None] * m
    a, b = i + np.arange(m), i + (np.arange(m) + 1) % m
    F = [np.stack([a, b, b + m], 2).reshape(-1, 3), np.stack([a, b + m, a + m], 2).reshape(-1, 3)]
    k = np.arange(m)
    if closed_start:
        F.append(np.stack([np.full(m, n * m), (k + 1) % m, k], 1))
    if closed_end:
        e = n * m + (1 if closed_start else 0)
        F.append(np.stack([np.full(m, e), (n - 1) * m + k, (n - 1) * m + (k + 1) % m], 1))
    return np.concatenate(F)


def section(m, square=0.0):
    """Unit outline of m corners; square = 1 for a square of four corners that touches the unit circle's box."""
    if square >= 1 or m == 4:
        return np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]], float)
    t = (np.arange(m) + .5) / m * 2 * np.pi
    c = np.stack([np.cos(t), np.sin(t)], 1)
    e = 2 + 8 * square
    return c / (np.abs(c) ** e).sum(1, keepdims=True) ** (1 / e)


def smooth_line(P, per):
    """Catmull-Rom line through rows of P, `per` steps between each two; with the parameter of each point."""
    n = len(P)
    if n < 3:
        t = np.linspace(0, n - 1, per * (n - 1) + 1)
        return np.stack([np.interp(t, np.arange(n), P[:, k]) for k in range(P.shape[1])], 1), t
    Q = np.concatenate([2 * P[:1] - P[1:2], P, 2 * P[-1:] - P[-2:-1]])
    t = np.linspace(0, n - 1, per * (n - 1) + 1)
    k = np.minimum(t.astype(int), n - 2)
    f = (t - k)[:, None]
    a, b, c, d = Q[k], Q[k + 1], Q[k + 2], Q[k + 3]
    return .5 * (2 * b + (c - a) * f + (2 * a - 5 * b + 4 * c - d) * f ** 2 + (3 * b - a - 3 * c + d) * f ** 3), t


def lateral(P):
    """A direction to measure a line's sections by: the axis that its segments run along the least, X first."""
    d = np.diff(P, axis=0)
    d = d / np.maximum(np.linalg.norm(d, axis=1, keepdims=True), 1e-12)
    worst = np.abs(d).max(0) - vec(.12, 0, .06)
    return np.eye(3)[worst.argmin()]


def sweep(P, rad, u=None, corners=10, square=0.0, ends='round', side=None, twist=0.0):
    """Sections of half widths rad (#P x 2: along `side`, and across) along P; ends 'round', 'flat' or 'open'."""
    P = np.asarray(P, float)
    rad = np.asarray(rad, float)
    if rad.ndim == 1:
        rad = np.stack([rad, rad], 1)
    u = np.zeros(len(P)) if u is None else np.asarray(u, float)
    keep = np.r_[True, np.linalg.norm(np.diff(P, axis=0), axis=1) > 1e-7]
    P, rad, u = P[keep], np.maximum(rad[keep], 1e-5), u[keep]
    if len(P) < 2:
        P = np.stack([P[0], P[0] + vec(0, 0, 1e-4)])
        rad, u = np.repeat(rad, 2, 0), np.repeat(u, 2)
    side = lateral(P) if side is None else np.asarray(side, float)
    t = np.gradient(P, axis=0)
    t /= np.maximum(np.linalg.norm(t, axis=1, keepdims=True), 1e-12)
    x = side - t * (t @ side)[:, None]
    thin = np.linalg.norm(x, axis=1) < .05
    x[thin] += np.cross(t[thin], np.roll(side, 1))
    x /= np.maximum(np.linalg.norm(x, axis=1, keepdims=True), 1e-12)
    y = np.cross(t, x)
    core = (P, rad, x, y, t)
    if ends == 'round':
        q = np.array([.97, .8, .45] if corners > 5 else [.75])
        k = np.sqrt(1 - q * q)

        def cap(i, sign):
            r = rad[i].mean()
            return (P[i] + sign * t[i] * (q * r)[:, None], rad[i] * k[:, None], np.repeat(x[i:i + 1], len(q), 0),
                    np.repeat(y[i:i + 1], len(q), 0), np.full(len(q), u[i]))
        a, b = cap(0, -1), cap(len(P) - 1, 1)
        P, rad, x, y, u = (np.concatenate([a[i], o, b[i][::-1]]) for i, o in enumerate((P, rad, x, y, u)))
    s = section(corners, square)
    if twist:
        c, d = np.cos(twist), np.sin(twist)
        s = s @ np.array([[c, d], [-d, c]])
    V = P[:, None] + s[None, :, :1] * rad[:, None, :1] * x[:, None] + s[None, :, 1:] * rad[:, None, 1:] * y[:, None]
    V, uu = V.reshape(-1, 3), np.repeat(u, len(s))
    if ends != 'open':
        V, uu = np.concatenate([V, P[:1], P[-1:]]), np.r_[uu, u[0], u[-1]]
    F = rings(len(P), len(s), ends != 'open', ends != 'open')
    boxy = square >= .8 or corners == 4

    def inside(X):
        P, rad, x, y, t = core
        out = np.zeros(len(X), bool)
        for k in range(len(P) - 1):
            d = P[k + 1] - P[k]
            l = np.linalg.norm(d)
            w = X - P[k]
            a = w @ (d / max(l, 1e-12))
            f = np.clip(a / max(l, 1e-12), 0, 1)
            r = (rad[k] * (1 - f)[:, None] + rad[k + 1] * f[:, None]) * .97
            over = np.where(a < 0, -a, np.where(a > l, a - l, 0))
            w = w - np.outer(f, d)
            fx, fy = np.abs(w @ x[k]) / r[:, 0], np.abs(w @ y[k]) / r[:, 1]
            if boxy:
                ok = (np.maximum(fx, fy) < 1) & (over < 1e-4 + .02 * l)
            elif ends == 'round':
                ok = fx ** 2 + fy ** 2 + (over / r.mean(1)) ** 2 < 1
            else:
                ok = (fx ** 2 + fy ** 2 < 1) & (over < 1e-4 + .02 * l)
            out |= ok
        return out
    return Piece(V, F, uu, inside if ends != 'open' else None)


def ball(c, h, M=np.eye(3), corners=12):
    """Ellipsoid of half axes h along the columns of M."""
    c, h = np.asarray(c, float), np.asarray(h, float)
    n = max(3, corners // 2)
    t = (np.arange(n) + .5) / n * np.pi
    s = section(corners) if corners != 4 else section(4) * .75
    V = np.stack([np.outer(np.sin(t), s[:, 0]), np.outer(np.sin(t), s[:, 1]),
                  np.repeat(-np.cos(t)[:, None], len(s), 1)], 2)
    V = np.concatenate([V.reshape(-1, 3), [[0, 0, -1]], [[0, 0, 1]]])

    def inside(X):
        return ((((X - c) @ M) / h) ** 2).sum(1) < .93
    return Piece(c + (V * h) @ M.T, rings(n, len(s)), None, inside)


def box(c, h, M=np.eye(3), taper=(1, 1)):
    """Box of half sizes h along the columns of M; the sides of its +along end are `taper` times as wide."""
    c, h = np.asarray(c, float), np.asarray(h, float)
    P = c + np.outer([-h[2], h[2]], M[:, 2])
    piece = sweep(P, [h[:2], h[:2] * taper], corners=4, square=1, ends='flat', side=M[:, 0])
    return piece


def plate(outline, thick, c, M):
    """Flat form: corners (#n x 2, star-shaped about their mean) in the plane of M's first two columns, both sides."""
    o = np.asarray(outline, float)
    area = (o[:, 0] * np.roll(o[:, 1], -1) - o[:, 1] * np.roll(o[:, 0], -1)).sum()
    if area < 0:
        o = o[::-1]
    z = np.array([-thick / 2, thick / 2])
    V = np.concatenate([np.c_[o, np.full(len(o), k)] for k in z] + [np.r_[o.mean(0), k][None] for k in z])
    return Piece(np.asarray(c, float) + V @ M.T, rings(2, len(o)))


def sheet(G, thick=0.0, u=None):
    """Cloth over a grid of points (#n x #m x 3); of one side, or with a back at distance `thick`."""
    n, m = G.shape[:2]
    k = np.arange(n * m).reshape(n, m)
    F = np.concatenate([np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:]], 2).reshape(-1, 3),
                        np.stack([k[:-1, :-1], k[1:, 1:], k[:-1, 1:]], 2).reshape(-1, 3)])
    V = G.reshape(-1, 3)
    uu = np.zeros(n * m) if u is None else np.broadcast_to(u, (n, m)).reshape(-1)
    if thick > 0:
        a, b = np.gradient(G, axis=0), np.gradient(G, axis=1)
        nr = np.cross(a, b).reshape(-1, 3)
        nr /= np.maximum(np.linalg.norm(nr, axis=1, keepdims=True), 1e-12)
        rim = np.r_[k[0, :-1], k[:-1, -1], k[-1, :0:-1], k[:0:-1, 0]]
        nxt = np.roll(rim, -1)
        N = n * m
        F = np.concatenate([F, F[:, ::-1] + N, np.stack([rim, rim + N, nxt + N], 1), np.stack([rim, nxt + N, nxt], 1)])
        F = F[:, ::-1] if thick < 0 else F
        V, uu = np.concatenate([V, V - nr * thick]), np.r_[uu, uu]
    return Piece(V, F, uu)


_NUMBERS = [PCG_STATE, []]


def uniform_numbers(n):
    """The first n numbers in [0, 1) of PCG32 as every reader of a model draws them."""
    state, have = _NUMBERS
    while len(have) < n:
        old = state
        state = (old * 6364136223846793005 + PCG_INC) & 0xffffffffffffffff
        x = (((old >> 18) ^ old) >> 27) & 0xffffffff
        r = old >> 59
        have.append((((x >> r) | (x << ((-r) & 31))) & 0xffffffff) / 4294967296.0)
    _NUMBERS[0] = state
    return np.array(have[:n])


def surface_points(V, F, first, n):
    """Points `first` to `first + n` of the fixed sequence: positions, normals, triangles, barycentric weights."""
    a, b, c = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    cross = np.cross(b - a, c - a)
    twice = np.linalg.norm(cross, axis=1)
    total = np.cumsum(twice / 2)
    r = uniform_numbers(3 * (first + n))[3 * first:].reshape(n, 3)
    f = np.searchsorted(total, r[:, 0] * total[-1], side='right').clip(0, len(F) - 1)
    u, v = r[:, 1], r[:, 2]
    over = u + v > 1
    u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
    w = np.stack([1 - u - v, u, v], 1)
    return (V[F[f]] * w[:, :, None]).sum(1), cross[f] / np.maximum(twice[f, None], 1e-20), f, w


def inner_radii(P, N, Q, size):
    """Radius of the largest ball that touches P from inside (normals N) and has none of the points Q inside."""
    cap = .25 * size
    out = np.full(len(P), cap, np.float32)
    P, N, Q = (np.ascontiguousarray(x.T, np.float32)[:, :, None] for x in (P, N, Q))
    Q = Q[:, None, :, 0]
    for s in range(0, len(out), 64):
        k = slice(s, s + 64)
        d = P[0, k] - Q[0]
        q, h = d * d, d * N[0, k]
        for a in (1, 2):
            np.subtract(P[a, k], Q[a], out=d)
            h += d * N[a, k]
            d *= d
            q += d
        np.sqrt(q, out=d)
        d *= np.float32(.3)
        ok = h > d
        h *= 2
        np.divide(q, h, out=d, where=ok)
        d[~ok] = cap
        out[k] = np.minimum(d.min(1), cap)
    return out

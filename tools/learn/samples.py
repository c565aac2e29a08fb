"""Points on a surface, as limber/reading draws them: fixed generator, farthest first, inner balls, features of tokens.

limber's C++ is the reference; this is the same up to rounding.
"""
from functools import lru_cache

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

POINTS = 4096  # drawn on a surface
POOL = 1536  # of them, farthest first, from which training draws tokens after posing
TOKENS = 512
BALL_LIMIT = 0.25  # largest radius of an inner ball, of the diagonal of the points' box
RIM_COSINE = 0.3  # a point bounds a ball where the direction to it makes at least this cosine with the inner normal
FLIP_RATIO = 2.5  # median radius over that with flipped normals, above which a surface is inside out
CHUNK = 64  # points whose balls are measured at once
SINE_SCALES = (1.5, 3.0, 6.0)
FEATURES = 3 + 3 + 3 + 1 + 1 + 6 * len(SINE_SCALES)


@lru_cache(maxsize=1)
def random_numbers():
    """(POINTS, 3) numbers in [0, 1) of the generator PCG32 from its customary state; the same for every surface."""
    state, increment, mask = 0x853C49E6748FEA9B, 0xDA3E39CB94B95BDB, (1 << 64) - 1
    numbers = np.empty(3 * POINTS)
    for k in range(len(numbers)):
        old = state
        state = (old * 6364136223846793005 + increment) & mask
        xored = (((old >> 18) ^ old) >> 27) & 0xFFFFFFFF
        shift = old >> 59
        numbers[k] = ((xored >> shift) | (xored << (-shift & 31))) & 0xFFFFFFFF
    return (numbers / 2.0**32).reshape(POINTS, 3)


def with_area(vertices, triangles):
    """The triangles that have an area, their areas and unit normals."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    cross = np.cross(b - a, c - a)
    double = np.linalg.norm(cross, axis=1)
    keep = double > 0
    return triangles[keep], double[keep] / 2, cross[keep] / double[keep, None]


def piece_fractions(vertices, triangles, areas):
    """For each triangle: area of its connected component over all area; vertices at equal positions are one."""
    grid = max(np.ptp(vertices, axis=0).max(), 1e-30) * 1e-6
    _, welded = np.unique(np.round(vertices / grid).astype(np.int64), axis=0, return_inverse=True)
    corners = welded.reshape(-1)[triangles]
    ends = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]]])
    size = corners.max() + 1
    graph = coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), (size, size))
    count, component = connected_components(graph, directed=False)
    component = component[corners[:, 0]]
    return (np.bincount(component, areas, count) / areas.sum())[component]


def draw_points(vertices, triangles):
    """4096 points by area: positions, normals, the piece's fraction, corners of the triangle, barycentric weights."""
    triangles, areas, normals = with_area(vertices, triangles)
    if not len(triangles):
        raise ValueError("no triangle has an area")
    random = random_numbers()
    cumulative = np.cumsum(areas)
    of = np.minimum(np.searchsorted(cumulative, random[:, 0] * cumulative[-1], side="right"), len(areas) - 1)
    u, v = random[:, 1], random[:, 2]
    fold = u + v > 1
    u, v = np.where(fold, 1 - u, u), np.where(fold, 1 - v, v)
    weights = np.stack([1 - u - v, u, v], 1)
    corners = triangles[of]
    points = np.einsum("nk,nka->na", weights, vertices[corners])
    return points, normals[of], piece_fractions(vertices, triangles, areas)[of], corners, weights


def farthest_first(points, count):
    """Indices of `count` points: the one farthest from the mean, then each time the one farthest from all chosen."""
    columns = np.ascontiguousarray(points.T)
    chosen = np.empty(count, int)
    distance = ((points - points.mean(0)) ** 2).sum(1)
    chosen[0] = distance.argmax()
    distance = np.full(len(points), np.inf, points.dtype)
    for k in range(1, count):
        offset = columns - columns[:, chosen[k - 1], None]
        offset *= offset
        np.minimum(distance, offset.sum(0), out=distance)
        chosen[k] = distance.argmax()
    return chosen


def squared_distances(points, others):
    """(n, m) by one product of matrices; not negative, and off by rounding of the positions' squares."""
    one = np.ones((1, 1), np.float32)
    square = lambda x: (x * x).sum(1, keepdims=True)
    left = np.concatenate([-2 * points, square(points), np.broadcast_to(one, (len(points), 1))], 1)
    right = np.concatenate([others, np.broadcast_to(one, (len(others), 1)), square(others)], 1)
    product = left @ right.T
    return np.maximum(product, 1e-12, out=product)


def inner_radii(points, normals, others, square=None):
    """Radius of the largest ball inside that touches each point and has no other point inside but at its rim.

    square: squared distances between the two, where they are known."""
    points, normals, others = (np.asarray(x, np.float32) for x in (points, normals, others))
    centre = others.mean(0)
    points, others = points - centre, others - centre
    limit = BALL_LIMIT * np.linalg.norm(others.max(0) - others.min(0))
    curvature = np.full(len(points), 0.5 / limit, np.float32)
    for start in range(0, len(points), CHUNK):  # what stays in the cache
        rows = slice(start, start + CHUNK)
        known = squared_distances(points[rows], others) if square is None else square[rows]
        height = (points[rows] * normals[rows]).sum(1)[:, None] - normals[rows] @ others.T
        steep = height * np.abs(height)
        steep -= RIM_COSINE**2 * known
        height /= known
        height *= steep > 0
        np.maximum(curvature[rows], height.max(1), out=curvature[rows])
    return 0.5 / curvature


def outward(points, normals, others):
    """Normals, and radii of inner balls: as they are, or flipped as a whole where the surface is inside out."""
    radii, flipped = inner_radii(points, normals, others), inner_radii(points, -normals, others)
    if np.median(radii) > FLIP_RATIO * np.median(flipped):
        return -normals, flipped, True
    return normals, radii, False


def frame_of(points):
    """Mean, and the scale that makes the mean squared distance from it 1."""
    centre = points.mean(0)
    return centre, max(float(np.sqrt(((points - centre) ** 2).sum(1).mean())), 1e-12)


def token_inputs(points, normals, radii, pieces):
    """(tokens, 11) in the tokens' own frame, and that frame (centre, scale). The sines are added by the network."""
    centre, scale = frame_of(points)
    position = (points - centre) / scale
    radius = (radii / scale)[:, None]
    inputs = np.concatenate([position, normals, position - normals * radius, radius, pieces[:, None]], 1)
    return inputs.astype(np.float32), centre, scale


def pool_tokens(points, normals, count=TOKENS):
    """As farthest_first and inner_radii among the points of a pool, for training: quicker, rounded otherwise.

    Returns the chosen indices and their radii."""
    points = np.asarray(points, np.float32)
    points = points - points.mean(0)
    square = squared_distances(points, points)
    chosen = np.empty(count, int)
    chosen[0] = (points * points).sum(1).argmax()
    distance = square[chosen[0]].copy()
    for k in range(1, count):
        chosen[k] = distance.argmax()
        np.minimum(distance, square[chosen[k]], out=distance)
    return chosen, inner_radii(points[chosen], normals[chosen], points, square[chosen])


def tokens_of(points, normals, pieces, count=TOKENS):
    """What the program itself reads of a surface: the first `count` farthest first, with balls against all points."""
    chosen = farthest_first(points, count)
    turned, radii, _ = outward(points[chosen], normals[chosen], points)
    return (chosen, *token_inputs(points[chosen], turned, radii, pieces[chosen]))

#!/usr/bin/python3
"""Quick checks of bodies made by code: `tools/learn/test_made_bodies.py`."""
import os
import sys
import unittest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import numpy as np

import made_bodies
import made_shapes as shapes
from labels import PartReader, plan_of


def volume(piece):
    a, b, c = (piece.V[piece.F[:, k]] - piece.V.mean(0) for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


class Shapes(unittest.TestCase):
    def test_closed_forms_look_outward_and_know_their_inside(self):
        line = np.array([[0, 0, 0], [0, .5, .1], [0, 1, 0]])
        for piece in (shapes.ball((0, .5, 0), (.2, .3, .4)), shapes.box((0, .5, 0), (.2, .3, .4)),
                      shapes.sweep(line, [.1, .2, .1]),
                      shapes.sweep(line, [.1, .2, .1], corners=4, square=1, ends="flat")):
            edges = np.concatenate([piece.F[:, [0, 1]], piece.F[:, [1, 2]], piece.F[:, [2, 0]]])
            self.assertEqual({tuple(e) for e in edges}, {tuple(e[::-1]) for e in edges})
            self.assertGreater(volume(piece), 0)
            self.assertTrue(piece.inside(np.array([[0, .5, .05]]))[0])
            self.assertFalse(piece.inside(np.array([[0, .5, 2.0]]))[0])

    def test_points_are_those_of_every_reader(self):
        self.assertEqual([round(x * 2**32) for x in shapes.uniform_numbers(2)], [355248013, 41705475])

    def test_inner_ball_of_a_ball(self):
        ball = shapes.ball((0, 0, 0), (1, 1, 1), corners=160)
        P, N, _, _ = shapes.surface_points(ball.V, ball.F, 0, 2000)
        self.assertLess(abs(np.median(shapes.inner_radii(P[:200], N[:200], P, 20)) - 1), .1)


class Bodies(unittest.TestCase):
    def test_every_kind_has_its_plan_and_whole_labels(self):
        for kind, (plan, _, _) in made_bodies.ALL.items():
            with self.subTest(kind):
                m = made_bodies.build(kind, 7)
                J = np.array(m.J)
                reader = PartReader(m.parts, ["j%d" % k for k in range(len(J))], J, m.parents)
                reader.read()
                roles = reader.role
                positions = {role: (1 - f) * J[a] + f * J[b] for role, (a, b, f) in roles.items()}
                self.assertEqual(plan_of(m.parts, positions), plan)
                self.assertTrue(np.isfinite(J).all() and all(np.isfinite(p.V).all() for p in m.pieces))
                for p in m.pieces:
                    self.assertTrue(p.u.min() >= 0 and p.u.max() < len(p.joints))
                named = [sum("finger_%d_0%s" % (k, s) in roles for k in range(1, 6)) for s in (".L", ".R")]
                self.assertEqual(named, m.fingers)

    def test_a_body_is_the_same_each_time(self):
        a, b = (made_bodies.prepared(made_bodies.build("chibi", 3), np.random.RandomState(1)) for _ in range(2))
        for name in a:
            self.assertTrue(np.array_equal(a[name], b[name]), name)
        self.assertEqual(a["P"].shape, (made_bodies.POOL, 3))
        self.assertEqual(a["bone"].shape, (made_bodies.POOL, 6))
        self.assertTrue(((a["piece"] > 0) & (a["piece"] <= 1)).all())

    def test_numbers_of_a_kind_only_grow(self):
        few, more = made_bodies.counts(1000), made_bodies.counts(3000)
        self.assertEqual((sum(few.values()), sum(more.values())), (1000, 3000))
        self.assertTrue(all(more[kind] >= few[kind] > 0 for kind in few))


if __name__ == "__main__":
    unittest.main()

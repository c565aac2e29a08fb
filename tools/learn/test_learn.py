#!/usr/bin/python3
"""Quick checks of tools/learn, without models and without training: `tools/learn/test_learn.py`."""
import os
import sys
import tempfile
import unittest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import numpy as np
import torch

import export
import losses
import reader
import samples
import variation
import vocabulary as words
from body import Body
from labels import Anatomy, bone_ends, limber_names, read_labels
from makers import CODE, folds
from network import make_network


def cube(half=1.0, centre=(0, 0, 0)):
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float) * half + centre
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return corners, triangles


def person_labels():
    """A stick figure: names, joints and parents, and limber's parts."""
    names = ["hips", "chest", "head", "arm.L", "elbow.L", "hand.L", "arm.R", "elbow.R", "hand.R"]
    joints = np.array([[0, 1, 0], [0, 1.4, 0], [0, 1.7, 0], [0.2, 1.4, 0], [0.5, 1.4, 0], [0.8, 1.4, 0], [-0.2, 1.4, 0],
                       [-0.5, 1.4, 0], [-0.8, 1.4, 0]], float)
    parents = [-1, 0, 1, 1, 3, 4, 1, 6, 7]
    arm = lambda side, s: {"kind": "arm", "side": side, "pair": 0, "joints": ["arm" + s, "elbow" + s, "hand" + s],
                           "upper": "arm" + s, "middle": "elbow" + s, "end": "hand" + s}
    parts = [{"kind": "trunk", "side": "center", "pair": 0, "joints": ["hips", "chest"]},
             {"kind": "head", "side": "center", "pair": 0, "joints": ["head"]}, arm("left", ".L"), arm("right", ".R")]
    return names, joints, np.array(parents), parts


def person_body():
    names, joints, parents, parts = person_labels()
    labels = read_labels(Anatomy(parts, None, None, 1.0, True), names, joints, parents)
    random = np.random.RandomState(1)
    bone = random.randint(1, len(joints), samples.POINTS)
    normals = variation.unit(random.randn(samples.POINTS, 3))
    points = joints[bone] + normals * 0.08
    pool = samples.POOL
    return Body({
        "points": points.astype("f4"), "normals": normals.astype("f4"), "pieces": np.ones(len(points), "f4"),
        "weight_joint": bone[:pool, None], "weight": np.ones((pool, 1), "f4"), "joints": joints.astype("f4"),
        "bone_ends": bone_ends(joints, labels.parents, labels.joint_part, np.full(len(joints), 0.1)).astype("f4"),
        "parents": labels.parents, "joint_part": labels.joint_part, "counted": labels.counted,
        "role_joints": labels.role_joints, "role_fraction": labels.role_fraction, "plan": words.PLAN[labels.plan],
        "fingers": labels.fingers, "axes": np.eye(3), "side": 1.8, "height": 0.9, "name": "figure", "maker": "test",
        "source": "", "licence": "", "report_only": False,
    })


class Vocabulary(unittest.TestCase):
    def test_mirror_is_its_own_inverse(self):
        for mirror in (words.MIRROR_ROLE, words.MIRROR_PART, reader.MIRROR_STANCE):
            np.testing.assert_array_equal(mirror[mirror], np.arange(len(mirror)))

    def test_stances_are_the_rotations_of_the_cube(self):
        self.assertEqual(len({stance.tobytes() for stance in words.STANCES.round().astype(int)}), 24)
        np.testing.assert_allclose(np.linalg.det(words.STANCES), 1)
        np.testing.assert_array_equal(words.STANCES[words.UPRIGHT_STANCE], np.eye(3))
        self.assertEqual((len(words.ROLES), len(words.PARTS), len(words.PLANS)), (93, 26, 9))


class Samples(unittest.TestCase):
    def test_generator_is_pcg32(self):
        # The generator's customary first outputs for this state, from its author's minimal implementation.
        numbers = (samples.random_numbers().reshape(-1)[:4] * 2**32).astype(np.uint64)
        state, expected = 0x853C49E6748FEA9B, []
        for _ in range(4):
            old, state = state, (state * 6364136223846793005 + 0xDA3E39CB94B95BDB) % 2**64
            word, shift = (((old >> 18) ^ old) >> 27) % 2**32, old >> 59
            expected.append(((word >> shift) | (word << (32 - shift))) % 2**32)
        self.assertEqual(numbers.tolist(), expected)

    def test_points_lie_on_the_surface_and_pieces_have_their_area(self):
        small, triangles = cube(0.5, (4, 0, 0))
        large, _ = cube(1.0)
        vertices, both = np.concatenate([large, small]), np.concatenate([triangles, triangles + 8])
        points, normals, pieces, _, _ = samples.draw_points(vertices, both)
        far = points[:, 0] > 2
        np.testing.assert_allclose(np.abs(points[~far]).max(1), 1)
        np.testing.assert_allclose(pieces[far], 0.2)
        self.assertAlmostEqual(far.mean(), 0.2, delta=0.03)
        self.assertTrue((np.einsum("na,na->n", normals[~far], points[~far]) > 0).all())

    def test_inner_ball_of_a_ball_is_the_ball(self):
        normals = variation.unit(np.random.RandomState(2).randn(3000, 3))
        radii = samples.inner_radii(normals[:100], normals[:100], normals)
        self.assertAlmostEqual(np.median(radii), samples.BALL_LIMIT * 2 * 3**0.5, delta=0.03)  # the limit, below 1
        shell = np.concatenate([normals, 0.8 * normals])
        self.assertLess(np.median(samples.inner_radii(normals[:100], normals[:100], shell)), 0.2)

    def test_tokens_are_centred_with_scale_one(self):
        vertices, triangles = cube(3.0, (5, 6, 7))
        points, normals, pieces, _, _ = samples.draw_points(vertices, triangles)
        _, inputs, centre, _ = samples.tokens_of(points, normals, pieces)
        np.testing.assert_allclose((inputs[:, :3] ** 2).sum(1).mean(), 1, rtol=1e-5)
        np.testing.assert_allclose(centre, (5, 6, 7), atol=0.2)


class Labels(unittest.TestCase):
    def test_roles_of_a_figure(self):
        names, joints, parents, parts = person_labels()
        labels = read_labels(Anatomy(parts, None, None, 1.0, True), names, joints, parents)
        self.assertEqual(labels.plan, "upright")
        self.assertEqual(labels.role_joints[words.ROLE["fore_middle.R"]].tolist(), [7, 7])
        self.assertEqual(words.PARTS[labels.joint_part[4]], "fore_lower.L")

    def test_chains_of_a_flat_rig_are_linked(self):
        names, joints, _, parts = person_labels()
        labels = read_labels(Anatomy(parts, None, None, 1.0, True), names, joints, np.full(len(names), -1))
        self.assertEqual(labels.parents[4], 3)
        self.assertEqual(labels.parents[3], 1)

    def test_equal_names(self):
        self.assertEqual(limber_names(["a", "a", "b"], np.zeros((3, 3)), {}), ["a", "a_2", "b"])

    def test_makers_of_a_fold_are_whole(self):
        groups = folds({"a": 100, "b": 40, "c": 30, "d": 20, "e": 1, CODE: 500}, 3)
        self.assertEqual(sorted(m for g in groups for m in g), ["a", "b", "c", "d", "e"])


class Variation(unittest.TestCase):
    def test_samples_are_finite_and_repeatable(self):
        body = person_body()
        for seed in range(12):
            one, two = (variation.vary(body, np.random.RandomState(seed), seed % 2 == 1) for _ in range(2))
            np.testing.assert_array_equal(one.inputs, two.inputs)
            for value in (one.inputs, one.y, one.bone):
                self.assertTrue(np.isfinite(value).all())
            self.assertEqual(one.inputs.shape, (samples.TOKENS, 11))

    def test_bones_and_roles_move_together(self):
        body = person_body()
        sample = variation.vary(body, np.random.RandomState(3))
        elbow, hand = (sample.y[words.ROLE[f"fore_{r}.L"]] for r in ("middle", "end"))
        tokens = np.flatnonzero((sample.part == words.PART["fore_lower.L"]) & (sample.bone_known > 0))
        ends = sample.inputs[tokens, :3] + sample.bone[tokens, :3], sample.inputs[tokens, :3] + sample.bone[tokens, 3:]
        np.testing.assert_allclose(ends[0], np.tile(elbow, (len(tokens), 1)), atol=1e-4)
        np.testing.assert_allclose(ends[1], np.tile(hand, (len(tokens), 1)), atol=1e-4)

    def test_stance_turns_back(self):
        body = person_body()
        straight = variation.vary(body, np.random.RandomState(5))
        self.assertEqual(straight.stance, words.UPRIGHT_STANCE)
        for stance in words.STANCES:
            np.testing.assert_allclose(stance @ (stance.T @ [0, 1, 0]), [0, 1, 0])


class Networks(unittest.TestCase):
    def test_padding_of_pins_changes_nothing(self):
        torch.manual_seed(1)
        network = make_network("reading")[0].eval()
        inputs = torch.randn(1, samples.TOKENS, 11)
        with torch.no_grad():
            bare = network(inputs)["y"]
            padded = network(inputs, torch.full((1, 5), -1), torch.zeros(1, 5, 3))["y"]
            pinned = network(inputs, torch.tensor([[3, -1]]), torch.ones(1, 2, 3))["y"]
        torch.testing.assert_close(bare, padded, atol=1e-5, rtol=1e-5)
        self.assertGreater(float((bare - pinned).abs().max()), 1e-4)

    def test_losses_have_gradients(self):
        body = person_body()
        batch = [variation.vary(body, np.random.RandomState(seed)) for seed in range(2)]
        truth = {name: torch.from_numpy(np.stack([getattr(s, name) for s in batch])) for name in
                 ("inputs", "y", "has", "part", "bone", "bone_known", "fingers", "pin_roles", "pin_positions")}
        truth["plan"] = torch.tensor([s.plan for s in batch])
        network = make_network("reading")[0]
        parts, _ = losses.reading_losses(network(truth["inputs"], truth["pin_roles"], truth["pin_positions"]), truth)
        losses.total(parts).backward()
        without = [name for name, p in network.named_parameters() if p.grad is None]
        self.assertEqual(without, [])

    def test_weights_file_gives_the_networks_back(self):
        torch.manual_seed(2)
        networks = {kind: make_network(kind) for kind in ("reading", "stance")}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "weights.lrd")
            self.assertLess(export.write_weights(path, networks), export.MAX_BYTES)
            back, about = export.read_weights(path)
        self.assertEqual(about["roles"], words.ROLES)
        inputs = torch.randn(1, samples.TOKENS, 11)
        with torch.no_grad():
            expected = networks["stance"][0].eval()(inputs)
            torch.testing.assert_close(back["stance"](inputs), expected, atol=1e-2, rtol=1e-2)


if __name__ == "__main__":
    unittest.main()

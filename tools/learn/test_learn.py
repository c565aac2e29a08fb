#!/usr/bin/python3
"""Quick checks of tools/learn, without models and without training: `tools/learn/test_learn.py`."""
import json
import os
import re
import sys
import tempfile
import unittest

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import numpy as np
import torch

import document
import evaluate
import export
import losses
import pictures
import reader
import samples
import tables
import train
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
        for mirror in (words.MIRROR_ROLE, words.MIRROR_PART):
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
            one, two = (variation.vary(body, np.random.RandomState(seed)) for _ in range(2))
            np.testing.assert_array_equal(one.inputs, two.inputs)
            for value in (one.inputs, one.y, one.bone):
                self.assertTrue(np.isfinite(value).all())
            self.assertEqual(one.inputs.shape, (samples.TOKENS, 11))

    def test_a_mirrored_sample_is_that_of_the_mirrored_body(self):
        sample = variation.vary(person_body(), np.random.RandomState(4))
        twice = variation.mirrored(variation.mirrored(sample, np.random.RandomState(1)), np.random.RandomState(2))
        for name in ("inputs", "y", "has", "part", "bone", "fingers"):
            np.testing.assert_array_equal(getattr(twice, name), getattr(sample, name))
        once = variation.mirrored(sample, np.random.RandomState(1))
        left, right = (words.ROLE[f"fore_middle.{side}"] for side in "LR")
        np.testing.assert_array_equal(once.y[left], sample.y[right] * [-1, 1, 1])
        self.assertEqual(words.PARTS[once.part[0]], words.mirrored(words.PARTS[sample.part[0]]))

    def test_a_body_at_rest_is_as_it_was_made(self):
        body = person_body()
        cloud = variation._at_rest(body)
        np.testing.assert_allclose(cloud.points, body.points, atol=1e-5)
        np.testing.assert_allclose(cloud.roles[body.has > 0], body.roles[body.has > 0], atol=1e-5)

    def test_bones_and_roles_move_together(self):
        body = person_body()
        sample = variation.vary(body, np.random.RandomState(3))
        elbow, hand = (sample.y[words.ROLE[f"fore_{r}.L"]] for r in ("middle", "end"))
        tokens = np.flatnonzero((sample.part == words.PART["fore_lower.L"]) & (sample.bone_known > 0))
        ends = sample.inputs[tokens, :3] + sample.bone[tokens, :3], sample.inputs[tokens, :3] + sample.bone[tokens, 3:]
        np.testing.assert_allclose(ends[0], np.tile(elbow, (len(tokens), 1)), atol=1e-4)
        np.testing.assert_allclose(ends[1], np.tile(hand, (len(tokens), 1)), atol=1e-4)


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

    def test_stance_is_found_by_turning_back(self):
        torch.manual_seed(3)
        network = make_network("stance")[0].eval()
        inputs = variation.vary(person_body(), np.random.RandomState(5)).inputs
        straight = reader.read_stance(network, inputs)[words.UPRIGHT_STANCE]
        for k in (2, 9, 17):
            turned = reader.turned_inputs(inputs, words.STANCES[k].T.astype("f4"))
            self.assertAlmostEqual(float(reader.read_stance(network, turned)[k]), float(straight), places=5)

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

    def test_training_goes_on_from_a_weights_file(self):
        networks = {kind: make_network(kind) for kind in ("reading", "stance")}
        card = {"samples": {"reading": 160, "stance": 32}, "hours": {"reading": 0.5, "stance": 0.1}}
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "weights.lrd")
            export.write_weights(path, networks, card=card)
            begun = train._Run(train.Options(kind="stance", start=path, run=os.path.join(folder, "run")))
            kept, sizes = export.network_of(path, "stance")
            self.assertEqual(export.trained_for(path, "stance"), {"samples": 32, "hours": 0.1})
        self.assertEqual(sizes, begun.sizes)
        for name, value in begun.network.state_dict().items():
            torch.testing.assert_close(value, kept.state_dict()[name])

    def test_a_trained_run_is_measured(self):
        torch.manual_seed(3)
        row = evaluate.row_of(person_body(), make_network("reading")[0].eval(), make_network("stance")[0].eval())
        self.assertEqual(sum(counts[0] for counts in row["parts"].values()),
                         sum(counts[1] for counts in row["parts"].values()))
        right = sum(counts[2] for counts in row["parts"].values()) / sum(counts[0] for counts in row["parts"].values())
        self.assertAlmostEqual(row["part"], right)
        json.dumps(row)


def made_row(stem="cat", plan="four", said="four", maker="me", report_only=False, seen=False, j2j=2.0, sure=4.0):
    logits = np.where(np.arange(len(words.PLANS)) == words.PLAN[said], sure, 0.0)
    return {"stem": stem, "maker": maker, "report_only": report_only, "maker_seen": seen, "samples": 16,
            "group": "four" if plan == "four" else "others", "plan": words.PLAN[plan], "plan_logits": logits.tolist(),
            "j2j": j2j, "named": 3.0, "roles": {"head": 4.0, "fore_upper.L": 1.0, "fore_upper.R": 3.0},
            "has_wrong": 0.1, "part": 0.5, "parts": {"head": [10, 5, 4]}, "bone": 1.0,
            "expected": [1.0, 2.0], "error": [1.0, 4.0],
            "fingers": [0, 5], "fingers_said": [0, 4], "finger_error": None, "pin": None,
            "stance": {"right": 0.5, "up": 1.0}}


def cells(table):
    """Title of each line -> its other cells, without the two lines above."""
    lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in table.split("\n")]
    return {line[0]: line[1:] for line in lines[2:]}


class Tables(unittest.TestCase):
    def test_figures_by_group(self):
        rows = [made_row(), made_row("dog", said="bird", j2j=4.0), made_row("owl", "bird", "bird", j2j=None)]
        found = cells(tables.table("group", tables.by_group(rows)))
        self.assertEqual(found["four-legged"][:4], ["2", "50.0", "3.0", "3.0"])
        self.assertEqual(found["all"][:3], ["3", "66.7", "3.0"])

    def test_copies_and_further_runs_of_a_body_count_once(self):
        rows = [made_row(), made_row(j2j=9.0), made_row(maker="you")]
        self.assertEqual([row["j2j"] for row in tables.once(rows)], [2, 2])

    def test_confidence_is_compared_with_what_is_right(self):
        rows = [made_row(sure=9.0), made_row("dog", said="bird", sure=9.0), made_row("owl", said="bird", sure=0.1)]
        self.assertEqual(cells(tables.kind_confidence(rows))["0.9 to 1"][1], "1 of 2 (50 %)")
        self.assertEqual(tables.sure_and_wrong(rows), [False, True])
        self.assertEqual(tables.sure_and_wrong(rows, temperature=100.0), [])
        self.assertEqual(cells(tables.error_confidence(rows, 2.0))["fifth 5"], ["4.0", "4.0"])

    def test_joints_parts_fingers(self):
        rows = [made_row()]
        self.assertEqual(cells(tables.joint_errors(rows)), {"`head`": ["4.0"], "`fore_upper`": ["2.0"]})
        self.assertEqual(cells(tables.part_table(rows))["`head`"], ["10", "40", "80"])
        fingers = cells(tables.other_figures(rows))
        self.assertEqual(fingers["number of fingers right, hands that have some"], ["0 of 1 (0 %)"])
        self.assertEqual(fingers["no fingers where there are none"], ["1 of 1 (100 %)"])

    def test_seeds_are_compared_on_the_same_bodies(self):
        found = cells(tables.seeds_table({1: [made_row(), made_row("dog", j2j=50.0)], 2: [made_row(j2j=3.0)]}))
        self.assertEqual(found["J2J: four-legged"], ["2.0", "3.0", "2.5", "1.0"])

    def test_report_has_no_figure_without_bodies(self):
        text = tables.report([made_row(), made_row("owl", "bird", report_only=True, seen=True)])
        self.assertIn("## Files to report only, makers seen in training", text)
        self.assertNotIn("## Files to report only, makers left out", text)


class Page(unittest.TestCase):
    def run_with(self, folder, name, rows, makers, **options):
        run = os.path.join(folder, name)
        os.makedirs(run)
        options = {"leave_out": [], "bodies": 0, "samples": 16, "start": "", "seed": 1, **options}
        for file, content in (("rows.json", rows), ("run.json", {"options": options, "makers": makers})):
            with open(os.path.join(run, file), "w", encoding="utf-8") as out:
                json.dump(content, out)
        return run

    def test_marks_of_the_page_are_those_of_the_sections(self):
        with open(os.path.join(HERE, "..", "..", "docs", "reading.md"), encoding="utf-8") as file:
            text = file.read()
        names = re.findall(rf"<!-- {document.MARK} \w+: ([\w-]+) -->", text)
        self.assertEqual(names, re.findall(r"<!-- end of ([\w-]+) -->", text))
        self.assertEqual(sorted(names), sorted(document.SECTIONS + ("pictures",)))

    def test_a_section_is_rewritten_and_the_rest_stays(self):
        with tempfile.TemporaryDirectory() as folder:
            page = os.path.join(folder, "page.md")
            begin, end = f"a\n\n<!-- {document.MARK} document: seeds -->\n", "<!-- end of seeds -->\n\nb\n"
            with open(page, "w", encoding="utf-8") as file:
                file.write(begin + "old\n" + end)
            for text in ("one \\1", "two"):
                self.assertEqual(document.rewrite(page, {"seeds": text, "curve": None}), ["curve"])
                with open(page, encoding="utf-8") as file:
                    self.assertEqual(file.read(), f"{begin}\n{text}\n\n{end}")
            self.assertRaises(SystemExit, document.rewrite, page, {"other": "text"})

    def test_figures_of_seen_makers_stand_beside_those_of_makers_left_out(self):
        with tempfile.TemporaryDirectory() as folder:
            seen, unseen = made_row(report_only=True, seen=True, j2j=1.0), made_row(report_only=True, j2j=5.0)
            fold = self.run_with(folder, "reading_fold0", [unseen], {CODE: 3})
            whole = self.run_with(folder, "reading", [seen], {"me": 2, CODE: 3})
            table = document.reported([fold], whole)
            figures = [[cell.strip() for cell in line.split("|")][5] for line in table.split("\n")[2:]]
            self.assertEqual(figures, ["5.0", "1.0"] * 2)  # the group, and all
            self.assertNotIn("1.0 |", document.reported([self.run_with(folder, "reading_fold1", [], {})], whole))
            self.assertIsNone(document.reported([], whole))

    def test_runs_that_differ_by_seed_or_bodies(self):
        with tempfile.TemporaryDirectory() as folder:
            rows = lambda j2j: [made_row(report_only=True, j2j=j2j)]
            one = self.run_with(folder, "reading", rows(2.0), {"me": 9, CODE: 5})
            two = self.run_with(folder, "reading_seed2", rows(4.0), {"me": 9, CODE: 5}, seed=2)
            short = self.run_with(folder, "reading_short", rows(9.0), {"me": 9}, seed=3, samples=8)
            self.assertEqual(cells(document.seeds([one, two, short]).split("\n\n")[1])["J2J: four-legged"],
                             ["2.0", "4.0", "3.0", "2.0"])
            self.assertIsNone(document.seeds([one, short]))
            drawn = [made_row(j2j=6.0), made_row("dog", maker="not drawn", j2j=90.0)]
            curve = [self.run_with(folder, f"reading_curve{n}", drawn, {"you": n, CODE: 5}, leave_out=["me"])
                     for n in (9, 4)]
            found = cells(document.curve(curve).split("\n\n")[1])
            self.assertEqual(list(found), ["4", "9"])
            self.assertIn("6.0", found["4"])


class Pictures(unittest.TestCase):
    def test_a_mistake_is_red(self):
        torch.manual_seed(4)
        body, network = person_body(), make_network("reading")[0].eval()
        body.source = "wild/me/figure.glb"
        reading = pictures.Reading(body, network)
        reading.error[:], reading.wrong_joints, reading.wrong_plan = 0, np.zeros_like(reading.true), False
        self.assertFalse(reading.is_wrong)
        self.assertNotEqual(pictures.picture(reading).getpixel((0, 0)), pictures.RED)
        reading.wrong_plan = True
        self.assertEqual(pictures.picture(reading).getpixel((0, 0)), pictures.RED)
        self.assertTrue(reading.captions()[1][1])
        sheets = pictures.sheets([reading] * (pictures.COLUMNS * pictures.ROWS + 1))
        self.assertEqual([sheet.size[1] // (pictures.VIEW + pictures.CAPTION) for sheet in sheets], [pictures.ROWS, 1])

    def test_limbs_are_chains_from_the_body_outwards(self):
        named = [[words.ROLES[role] for role in chain] for chain in pictures.chains()]
        self.assertIn(["hind_upper.L", "hind_middle.L", "hind_hock.L", "hind_end.L", "hind_toes.L"], named)
        self.assertIn(["trunk_0", "trunk_1", "trunk_2", "trunk_3", "neck", "head"], named)


if __name__ == "__main__":
    unittest.main()

"""The package as a user of Python meets it. LIMBER_PROGRAM names the program that it is compared with."""
import ast
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import limber

PROGRAM = os.environ.get("LIMBER_PROGRAM")


def tube(rings=24, around=12):
    """An upright closed tube, 2 m high, 0.3 m thick."""
    height = np.repeat(np.linspace(0, 2, rings), around)
    angle = np.tile(np.arange(around) * 2 * np.pi / around, rings)
    vertices = np.stack([0.3 * np.cos(angle), height, 0.3 * np.sin(angle)], axis=1)
    faces = []
    for r in range(rings - 1):
        for a in range(around):
            i, j = r * around + a, r * around + (a + 1) % around
            faces += [(i, i + around, j), (j, i + around, j + around)]
    vertices = np.vstack([vertices, [[0, 0, 0], [0, 2, 0]]])
    for a in range(around):
        b, top = (a + 1) % around, (rings - 1) * around
        faces += [(rings * around, a, b), (rings * around + 1, top + b, top + a)]
    return vertices, np.array(faces)


def two_joints(vertices):
    upper = np.clip(vertices[:, 1] - 0.5, 0, 1)
    return np.tile([0, 1], (len(vertices), 1)), np.stack([1 - upper, upper], axis=1)


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return pathlib.Path(self.folder.name) / name


class Files(InFolder):
    def test_same_bytes_as_the_program(self):
        if not PROGRAM:
            self.skipTest("no program to compare with")
        model = limber.sample("biped")
        model.write(str(self.path("a.glb")))
        report = limber.read(self.path("a.glb"))
        rigged = limber.read(self.path("a.glb"))
        report = rigged.rig(template="humanoid")
        rigged.write(str(self.path("python.glb")))
        subprocess.run([PROGRAM, "rig", self.path("a.glb"), "--template", "humanoid", "--quiet", "-o", self.path("program.glb")], check=True)
        self.assertEqual(self.path("python.glb").read_bytes(), self.path("program.glb").read_bytes())
        self.assertEqual(report["counts"]["joints"], len(rigged.joint_names))
        subprocess.run([PROGRAM, "sample", "walk", "-o", self.path("walk.bvh"), "--quiet"], check=True)
        clips = rigged.retarget(self.path("walk.bvh"))
        self.assertEqual(clips[0]["name"], "walk")
        self.assertGreater(clips[0]["frames"], 10)
        subprocess.run([PROGRAM, "retarget", self.path("program.glb"), self.path("walk.bvh"), "--quiet", "-o", self.path("moving.glb")], check=True)
        self.assertEqual(rigged.glb(), self.path("moving.glb").read_bytes())

    def test_errors_say_where_and_what_to_do(self):
        with self.assertRaises(limber.Error) as caught:
            limber.read(self.path("nothing.glb"))
        self.assertEqual(caught.exception.code, "file")
        self.assertIn("nothing.glb", str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)
        with self.assertRaises(limber.Error) as caught:
            limber.sample("stool").weights
        self.assertIn("rig()", caught.exception.remedy)
        with self.assertRaises(limber.Error):
            limber.Model.from_bytes(b"glTF but not really", "x.glb")
        with self.assertRaises(limber.Error):
            limber.sample("stool").write(str(self.path("a.step")))
        self.assertEqual(os.listdir(self.folder.name), [])


class Arrays(unittest.TestCase):
    def test_a_mesh_comes_back(self):
        vertices, faces = tube()
        model = limber.Model.from_mesh(vertices, faces)
        self.assertEqual(model.vertices.dtype, np.float32)
        self.assertEqual(model.faces.dtype, np.uint32)
        np.testing.assert_array_equal(model.vertices, vertices.astype(np.float32))
        np.testing.assert_array_equal(model.faces, faces)
        again = limber.Model.from_mesh(model.vertices, model.faces)  # other types, no copy made by hand
        np.testing.assert_array_equal(again.vertices, model.vertices)
        self.assertFalse(model.is_rigged)

    def test_arrays_outlive_their_model(self):
        vertices = limber.sample("stool").vertices
        self.assertTrue(np.isfinite(vertices).all())

    def test_wrong_arrays_are_named(self):
        vertices, faces = tube()
        broken = vertices.copy()
        broken[7, 1] = np.nan
        for given, names in [
                ((vertices[:, :2], faces), "vertices"), ((vertices.ravel(), faces), "vertices"), ((broken, faces), "vertices"),
                ((vertices, faces[:, :2]), "faces"), ((vertices, faces + len(vertices)), "faces"), ((vertices, faces - 1), "faces"),
                ((vertices, faces[:0]), "faces")]:
            with self.assertRaises(limber.Error) as caught:
                limber.Model.from_mesh(*given)
            self.assertEqual(caught.exception.where, names)
        for wrong in [faces + 0.5, "faces", None]:
            with self.assertRaises(limber.Error) as caught:
                limber.Model.from_mesh(vertices, wrong)
            self.assertEqual(caught.exception.where, "faces")
        with self.assertRaises(TypeError):
            limber.Model.from_mesh("vertices", faces)

    def test_a_rig_of_ones_own(self):
        vertices, faces = tube()
        model = limber.Model.from_mesh(vertices, faces)
        joints, weights = two_joints(vertices)
        model.attach_rig(["lower", "upper"], [-1, 0], [(0, 0, 0), (0, 1, 0)], joints, weights)
        self.assertEqual(model.joint_names, ["lower", "upper"])
        self.assertEqual(model.parents.tolist(), [-1, 0])
        np.testing.assert_allclose(model.joint_positions, [(0, 0, 0), (0, 1, 0)], atol=1e-6)
        there, amount = model.weights
        dense = np.zeros((len(vertices), 2))
        np.add.at(dense, (np.arange(len(vertices))[:, None], there), amount)
        np.testing.assert_allclose(dense, weights, atol=1e-6)
        # Linear blending by hand: a right angle about z at the upper joint.
        turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
        turned = (vertices - [0, 1, 0]) @ turn.T + [0, 1, 0]
        expected = weights[:, :1] * vertices + weights[:, 1:] * turned
        half = np.sqrt(0.5)
        np.testing.assert_allclose(model.posed({"upper": (0, 0, half, half)}), expected, atol=1e-5)
        self.assertFalse(np.allclose(model.posed({"upper": (0, 0, half, half)}, deformer="dual-quaternion"), expected, atol=1e-3))
        np.testing.assert_allclose(model.posed({}), vertices, atol=1e-6)
        # Other weights, and none.
        model.set_weights(joints, weights[:, ::-1])
        np.testing.assert_allclose(model.posed({"upper": (0, 0, half, half)}), weights[:, 1:] * vertices + weights[:, :1] * turned, atol=1e-5)
        before = model.glb()
        for wrong in [dict(weights=weights[1:]), dict(weights=weights - 1), dict(joints=joints + 1), dict(weights=np.full_like(weights, np.inf))]:
            with self.assertRaises(limber.Error):
                model.set_weights(**{"joints": joints, "weights": weights, **wrong})
        for turns in [{"elbow": (0, 0, 0, 1)}, {"upper": (0, 0, 1)}, {"upper": (0, 0, 0, 0)}, {"upper": (0, 0, np.nan, 1)}]:
            with self.assertRaises(limber.Error):
                model.posed(turns)
        self.assertEqual(model.glb(), before)
        with self.assertRaises(limber.Error):
            model.attach_rig(["lower"], [-1], [(0, 0, 0)], joints * 0, weights)
        model.remove_rig()
        self.assertFalse(model.is_rigged)

    def test_quality(self):
        vertices, faces = tube()
        model = limber.Model.from_mesh(vertices, faces)
        model.attach_rig(["lower", "upper"], [-1, 0], [(0, 0.1, 0), (0, 1, 0)], *two_joints(vertices))
        figures = model.quality()
        self.assertEqual(figures["joints"], 2)
        self.assertEqual(figures["joints_inside"], 1)


class Rigging(InFolder):
    def test_methods_have_names(self):
        self.assertIn("template", limber.riggers())
        self.assertIn("bone-heat", limber.skinning_methods())
        self.assertIn("delta-mush", limber.deformers())
        self.assertIn("limb-ik", limber.retargeting_methods())

    def test_options_reach_the_rigger(self):
        model = limber.sample("quadruped")
        seen = []
        report = model.rig(handles=9, max_influences=2, progress=lambda stage, fraction: seen.append((stage, fraction)))
        self.assertEqual(report["counts"]["joints"], 9)
        self.assertEqual((model.weights[1] > 0).sum(axis=1).max(), 2)
        self.assertTrue(all(0 <= fraction <= 1 for _, fraction in seen))
        with self.assertRaises(limber.Error):
            model.rig()  # has a rig
        self.assertEqual(model.rig(handles=5, existing_rig="replace")["counts"]["joints"], 5)
        for wrong in [dict(rigger="x"), dict(skinning="x"), dict(existing_rig="x"), dict(max_influences=0), dict(template="x"), dict(pins={"head": (0, 1, 0)}),
                      dict(template="quadruped", handles=3), dict(template="quadruped", rigger="prop"), dict(existing_rig="keep-skeleton", handles=3),
                      dict(template="quadruped", pins={"head": (0, 1)}), dict(template="quadruped", up="+w"), dict(template="quadruped", up="+y", front="y"),
                      dict(chains=True), dict(pieces="x"), dict(template=self.path("nothing.bvh")),
                      dict(reading=self.path("nothing.lrd")), dict(template="quadruped", reading=self.path("nothing.lrd")),
                      dict(template=""), dict(rigger=""), dict(template="quadruped", up=""), dict(template="quadruped", front="")]:
            with self.assertRaises(limber.Error):
                limber.sample("quadruped").rig(**wrong)

    def test_errors_name_the_arguments(self):
        with self.assertRaises(limber.Error) as caught:
            limber.sample("quadruped").rig(existing_rig="keep-skeleton", handles=3)
        self.assertEqual((caught.exception.where, caught.exception.remedy), ("handles", 'leave existing_rig="keep-skeleton" out'))
        with self.assertRaises(limber.Error) as caught:
            limber.sample("quadruped").rig(max_influences=9)
        self.assertEqual(caught.exception.where, "max_influences")
        for wrong in [dict(template="nobody"), dict(pieces="nobody"), dict(template="quadruped", front="+w")]:
            with self.assertRaises(limber.Error) as caught:
                limber.sample("quadruped").rig(**wrong)
            self.assertEqual(caught.exception.where, list(wrong)[-1])
        with self.assertRaises(limber.Error) as caught:  # before its file is read
            limber.sample("quadruped").rig(template=self.path("nothing.bvh"), max_influences=9)
        self.assertEqual(caught.exception.where, "max_influences")
        self.path("broken.lrd").write_bytes(b"LRD1")
        with self.assertRaises(limber.Error) as caught:
            limber.sample("quadruped").rig(template="quadruped", reading=self.path("broken.lrd"))
        self.assertEqual(caught.exception.code, "bad-data")
        self.assertIn("broken.lrd", caught.exception.where)
        model = limber.sample("quadruped")
        model.rig(handles=5)
        with self.assertRaises(limber.Error) as caught:
            model.rig()
        self.assertIn('existing_rig="replace" takes it out first', caught.exception.remedy)
        self.assertNotIn("`", str(caught.exception))

    def test_a_check_before_rigging(self):
        model = limber.sample("biped")
        before = model.glb()
        check = model.check_rigging()
        self.assertTrue(check["kinds"][0]["name"].startswith("humanoid"))
        self.assertEqual((check["pose"], check["missing"], check["upright"], check["has_rig"]), ("A", [], True, False))
        self.assertEqual(model.glb(), before)
        model.rig(handles=5)
        advice = {one["kind"]: one["message"] for one in model.check_rigging()["advice"]}
        self.assertIn('existing_rig="replace" takes it out first', advice["has-rig"])
        with self.assertRaises(limber.Error) as caught:
            model.check_rigging(up="+w")
        self.assertEqual(caught.exception.where, "up")

    def test_same_bytes_with_every_option(self):
        subprocess.run([PROGRAM, "sample", "biped", "-o", self.path("bare.glb"), "--quiet"], check=True)
        bare = limber.read(self.path("bare.glb"))
        humanoid = bare.copy()
        humanoid.rig(template="humanoid")
        humanoid.write(self.path("own.glb"))
        places = dict(zip(humanoid.joint_names, humanoid.joint_positions))
        hand = tuple(float(c) for c in np.round(places["leftHand"] + (0.01, 0, 0), 3))
        for options, words in [
            (dict(template="humanoid", pins={"leftHand": hand}, up="+y", front="+z", upright=True, chains=True, pieces="soft"),
             ["--template", "humanoid", "--pin", "leftHand=%r,%r,%r" % hand, "--up", "+y", "--front", "+z", "--upright", "--chains", "--pieces", "soft"]),
            (dict(template=self.path("own.glb")), ["--template", self.path("own.glb")]),
        ]:
            model = bare.copy()
            model.rig(**options)
            subprocess.run([PROGRAM, "rig", self.path("bare.glb"), *words, "--quiet", "-o", self.path("program.glb")], check=True)
            self.assertEqual(model.glb(), self.path("program.glb").read_bytes())

    def test_other_threads_run_while_a_template_is_read(self):
        pipe = self.path("own.json")
        os.mkfifo(pipe)
        writer = threading.Thread(target=lambda: pipe.write_text('{"joints": [{"name": "root", "position": [0, 1, 0]}, {"name": "top", "parent": "root", "position": [0, 2, 0]}]}'))
        signal.alarm(60)  # ends the tests where the two wait for each other
        writer.start()
        model = limber.sample("biped")
        model.rig(template=pipe)
        writer.join()
        signal.alarm(0)
        self.assertEqual(model.joint_names, ["root", "top"])

    def test_a_listener_that_raises_stops_it(self):
        model = limber.sample("winged")
        before = model.glb()

        def listener(stage, fraction):
            raise KeyError("enough")

        with self.assertRaises(KeyError):
            model.rig(template="auto", progress=listener)
        self.assertEqual(model.glb(), before)

    def test_a_listener_may_use_the_model(self):
        model, seen = limber.sample("winged"), []
        model.rig(template="auto", progress=lambda *_: seen.append((model.is_rigged, len(model.vertices))))
        self.assertTrue(seen and not any(rigged for rigged, _ in seen))  # it is rigged once all is done
        self.assertTrue(model.is_rigged)

    def test_a_motion_that_fails_leaves_the_model(self):
        model = limber.sample("biped")
        model.rig(template="humanoid")
        before = model.glb()
        with self.assertRaises(limber.Error):
            model.retarget("there/is/no.bvh")
        self.assertEqual(model.glb(), before)

    def test_other_threads_run_meanwhile(self):
        model, counted, done = limber.sample("winged"), [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        before = counted[0]
        model.rig(template="auto")
        after = counted[0]
        done.set()
        thread.join()
        self.assertGreater(after - before, 5)

    def test_ctrl_c_stops_it(self):
        model = limber.sample("winged")
        whole = model.copy()
        whole.rig(template="auto")
        # A shell's background job begins with the signal ignored.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        one = model.copy()
        with self.assertRaises(KeyboardInterrupt):
            for _ in range(200):  # until the signal comes, which is while the engine is at work
                one = model.copy()
                one.rig(template="auto")
        self.assertIn(one.glb(), (model.glb(), whole.glb()))  # nothing half done

    def test_the_program_is_in_the_package(self):
        if not (pathlib.Path(limber.__file__).parent / "bin" / "limber").exists():
            self.skipTest("not installed from a wheel")
        said = subprocess.run([sys.executable, "-m", "limber", "--version"], capture_output=True, text=True, check=True)
        self.assertEqual(said.stdout.strip(), "limber " + limber.__version__)


class Stubs(unittest.TestCase):
    """limber/__init__.pyi says what there is: names, and parameters by the first line of pybind11's docstrings."""

    def test_are_those_of_the_module(self):
        tree = ast.parse((pathlib.Path(limber.__file__).parent / "__init__.pyi").read_text())
        self.assertEqual(sorted(limber.__all__), sorted(self.names(tree)))
        model = next(node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == "Model")
        public = [name for name in vars(limber.Model) if not name.startswith("_")]
        self.assertEqual(sorted(public), sorted(self.names(model)))
        functions = [(node, getattr(limber, node.name)) for node in tree.body if isinstance(node, ast.FunctionDef)]
        functions += [(node, getattr(limber.Model, node.name)) for node in model.body
                      if isinstance(node, ast.FunctionDef) and not any(getattr(d, "id", "") == "property" for d in node.decorator_list)]
        self.assertGreater(len(functions), 12)
        for node, made in functions:
            said = re.findall(r"(\w+): ", re.sub(r"\[[^\]]*\]", "", made.__doc__.splitlines()[0].split(" -> ")[0]))
            stub = [a.arg for a in node.args.args + node.args.kwonlyargs]
            self.assertEqual([name for name in said if name != "self"], [name for name in stub if name != "self"], node.name)

    @staticmethod
    def names(node):
        for one in node.body:
            if isinstance(one, (ast.FunctionDef, ast.ClassDef)):
                yield one.name
            if isinstance(one, ast.AnnAssign) and one.target.id != "__slots__":
                yield one.target.id


if __name__ == "__main__":
    unittest.main()

"""A tour of limber in Python. Each part stands by itself: paste it into a notebook, or run it whole:

    python tour/tour.py FOLDER_FOR_RESULTS
"""
import pathlib
import sys

import numpy as np

import limber

results = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# %% A model, here one that limber makes itself; limber.read("scan.obj") takes your own.
model = limber.sample("quadruped")
print(f"{len(model.vertices)} vertices, {len(model.faces)} triangles")

# %% Joints and weights. What was done comes back as a dictionary.
report = model.rig(template="quadruped")
print(f"{report['counts']['joints']} joints: {', '.join(model.joint_names[:5])}, ...")
assert model.is_rigged

# %% The rig as arrays: where joints are, and how much each vertex follows them.
positions, parents = model.joint_positions, model.parents
joints, weights = model.weights
lengths = [np.linalg.norm(positions[j] - positions[p]) for j, p in enumerate(parents) if p >= 0]
print(f"bones of {min(lengths):.2f} to {max(lengths):.2f} m; {np.mean((weights > 0).sum(axis=1)):.2f} influences a vertex")
assert np.allclose(weights.sum(axis=1), 1, atol=1e-5)

# %% A pose: quaternions by joint. The head looks aside; only what follows it moves.
turned = model.posed({"head": (0, np.sin(0.4), 0, np.cos(0.4))})
moved = np.linalg.norm(turned - model.vertices, axis=1) > 1e-6
print(f"{moved.mean():.0%} of the vertices move with the head")
assert 0 < moved.mean() < 0.5

# %% Weights of your own method: here each vertex follows the nearest joint alone.
nearest = np.argmin(np.linalg.norm(model.vertices[:, None] - positions[None], axis=2), axis=1)
mine = model.copy()
mine.set_weights(nearest[:, None], np.ones((len(nearest), 1)))

# %% Which is better? Stretch of the surface over a range of motion: less is better.
for name, one in {"bone heat": model, "nearest joint": mine}.items():
    figures = one.quality()
    print(f"{name}: stretch {figures['motion']['stretch']:.3f}, roughness {figures['roughness']:.3f}")
assert model.quality()["motion"]["stretch"] < mine.quality()["motion"]["stretch"]

# %% A file that every program reads.
model.write(results / "quadruped_rigged.glb")
again = limber.read(results / "quadruped_rigged.glb")
assert again.joint_names == model.joint_names

# %% What cannot be done says what, where and what to do.
try:
    limber.Model.from_mesh(np.zeros((4, 2)), [[0, 1, 2]])
except limber.Error as error:
    print(error)

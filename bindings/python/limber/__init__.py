"""limber makes any 3D model limber: a static mesh goes in; a rigged, skinned, posed or moving character comes out.

    import limber
    model = limber.read("person.glb")
    report = model.rig(template="humanoid")
    model.retarget("walk.bvh")
    model.write("walking.glb")

Lengths are metres, +Y is up, quaternions are (x, y, z, w). What cannot be done raises limber.Error, a ValueError with
code, message, where and remedy.
"""
from ._limber import (Error, Model, __version__, deformers, read, retargeting_methods, riggers, sample,
                      skinning_methods, targets)

__all__ = ["Error", "Model", "__version__", "deformers", "read", "retargeting_methods", "riggers", "sample",
           "skinning_methods", "targets"]

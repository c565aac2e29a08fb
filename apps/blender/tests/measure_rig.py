# How long Rig takes from the call to the bound armature, and where the time goes; beside it Blender's own automatic weights for the
# same armature, measured in turn in the same run. Prints medians; tests nothing.
#
#   blender --background --factory-startup --python-exit-code 1 --python measure_rig.py -- ADDON.zip PROGRAM WORK_FOLDER [VERTICES RUNS [NPM_PACKAGE]]
#
# With the folder of the npm package (package in limber-*.tgz) it works in Node.
import os
import statistics
import subprocess
import sys
import time

import bpy

ADDON, PROGRAM, WORK, *MORE = sys.argv[sys.argv.index("--") + 1:]
ADDON, PROGRAM, WORK = (os.path.abspath(path) for path in (ADDON, PROGRAM, WORK))
WANTED, RUNS = (int(given) for given in (MORE or ("50000", "5"))[:2])
os.makedirs(WORK, exist_ok=True)
bpy.ops.preferences.addon_install(overwrite=True, filepath=ADDON)
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.preferences.addon_enable(module="limber")
bpy.context.preferences.addons["limber"].preferences.program = PROGRAM
from limber import glb, program, scene  # noqa: E402

if MORE[2:]:
    program.find = lambda *_: program.with_node(package=os.path.abspath(MORE[2]))
SPENT = {}  # seconds by part, of one run


def timed(owner, name, part):
    """From now on what this function takes counts for the part."""
    real = getattr(owner, name)

    def counted(*arguments, **more):
        started = time.perf_counter()
        try:
            return real(*arguments, **more)
        finally:
            SPENT[part] = SPENT.get(part, 0) + time.perf_counter() - started

    setattr(owner, name, counted)


def person():
    """limber's sample of a person, its surface made anew as quads of about as many vertices as wanted."""
    subprocess.run([PROGRAM, "sample", "biped", "-o", os.path.join(WORK, "biped.glb"), "--quiet"], check=True)
    reader, vertices, faces = glb.Reader(os.path.join(WORK, "biped.glb")), [], []
    for primitive in reader.document["meshes"][0]["primitives"]:
        first = len(vertices)
        vertices += [(x, -z, y) for x, y, z in reader.array(primitive["attributes"]["POSITION"]).tolist()]
        faces += (reader.array(primitive["indices"]).reshape(-1, 3).astype(int) + first).tolist()
    source, size = bpy.data.meshes.new("person"), 0.01
    source.from_pydata(vertices, [], faces)
    obj = bpy.data.objects.new("person", source)
    bpy.context.scene.collection.objects.link(obj)
    remesh = obj.modifiers.new("Remesh", "REMESH")
    for _ in range(4):
        remesh.voxel_size = size
        made = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
        size *= (len(made.data.vertices) / WANTED) ** 0.5
    obj.data = bpy.data.meshes.new_from_object(made)
    obj.modifiers.clear()
    return obj


def select(*objects):
    for one in bpy.data.objects:
        one.select_set(one in objects)
    bpy.context.view_layer.objects.active = objects[-1]


def unbind(obj):
    obj.parent = None
    obj.modifiers.clear()
    obj.vertex_groups.clear()


def left_out(obj):
    return sum(1 for vertex in obj.data.vertices if not any(one.weight > 0 for one in vertex.groups))


def measure(call):
    started = time.perf_counter()
    assert call() == {"FINISHED"}
    return time.perf_counter() - started


def tell(what, seconds, bare):
    print(f"{what}: {statistics.median(seconds):.2f} s ({min(seconds):.2f} to {max(seconds):.2f}), {bare} vertices left out")


for owner, name, part in ((program, "find", "find the program"), (scene, "write_meshes", "export"), (program.Call, "wait", "program"),
                          (scene, "objects_of", "compare with the scene"), (scene, "make_armature", "import: armature"),
                          (scene, "apply_weights", "import: vertex groups")):
    timed(owner, name, part)
person = person()
bpy.context.scene.limber.template = "humanoid"
ours, theirs, parts, bare = [], [], [], [0, 0]
for run in range(RUNS):
    SPENT.clear()
    select(person)
    ours.append(measure(bpy.ops.limber.rig))
    parts.append(dict(SPENT))
    armature, bare[0] = person.find_armature(), left_out(person)
    unbind(person)
    select(person, armature)
    theirs.append(measure(lambda: bpy.ops.object.parent_set(type="ARMATURE_AUTO")))
    bare[1] = left_out(person)
    unbind(person)
    bpy.data.objects.remove(armature)
print(f"{len(person.data.vertices)} vertices, {RUNS} runs, load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
tell("limber, joints and weights, from the call to the bound armature", ours, bare[0])
for part in parts[0]:
    print(f"  {part:<24}{statistics.median(one[part] for one in parts):.3f} s")
tell("Blender's automatic weights for these joints", theirs, bare[1])

# The add-on as Blender runs it, without a window.
#
#   blender --background --factory-startup --python-exit-code 1 --python test_addon.py -- ADDON.zip PROGRAM WORK_FOLDER [NPM_PACKAGE]
#
# With the folder of the npm package the add-on has Node alone, and is to give what the program gives.
# Ends with "N passed, N failed".
import os
import pathlib
import shutil
import subprocess
import sys
import time
import traceback

import bpy
import numpy as np
from mathutils import Matrix, Quaternion, Vector

ADDON, PROGRAM, WORK, *PACKAGE = (os.path.abspath(path) for path in sys.argv[sys.argv.index("--") + 1:])
os.makedirs(WORK, exist_ok=True)
NODE = shutil.which("node")
bpy.ops.preferences.addon_install(overwrite=True, filepath=ADDON)
bpy.ops.preferences.addon_enable(module="limber")
import limber  # noqa: E402  the add-on, now that it is installed
from limber import glb, program, scene  # noqa: E402


def preferences():
    return bpy.context.preferences.addons["limber"].preferences


def choose_program():
    """What the tests run with: the program by its name, or nothing but Node on the path and the package by its folder."""
    mine = preferences()
    mine.program, mine.node, mine.package = "" if PACKAGE else PROGRAM, "", PACKAGE[0] if PACKAGE else ""
    if PACKAGE:
        os.environ["PATH"] = folder_of("node", {"node": NODE})


def folder_of(name, programs):
    """A folder for the path: a program each, as a link, or as the lines of a script."""
    folder = pathlib.Path(WORK, "path", name)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for program, content in programs.items():
        if content.startswith("/"):
            (folder / program).symlink_to(content)
        else:
            (folder / program).write_text(f"#!/bin/sh\n{content}\n")
            (folder / program).chmod(0o755)
    return str(folder)


def at(name):
    return os.path.join(WORK, name)


def run(*arguments):
    subprocess.run([PROGRAM, *arguments, "--quiet"], check=True)


def clear():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="limber")
    choose_program()


def sample(name, matrix=Matrix()):
    """A sample of limber's as an object, and as a file of one mesh; `matrix` moves the object, not the surface."""
    run("sample", name, "-o", at("sample.glb"))
    reader, parts, triangles, first = glb.Reader(at("sample.glb")), [], [], 0
    for primitive in reader.document["meshes"][0]["primitives"]:
        parts.append(reader.array(primitive["attributes"]["POSITION"]))
        triangles.append(reader.array(primitive["indices"]).reshape(-1, 3).astype(np.uint32) + np.uint32(first))
        first += len(parts[-1])
    positions, triangles, writer = np.vstack(parts), np.vstack(triangles), glb.Writer()
    attributes = {"POSITION": writer.add_array(positions, min=positions.min(axis=0).tolist(), max=positions.max(axis=0).tolist())}
    writer.add("meshes", {"primitives": [{"attributes": attributes, "indices": writer.add_array(triangles.reshape(-1))}]})
    writer.document["scenes"][0]["nodes"].append(writer.add("nodes", {"mesh": 0, "name": name}))
    writer.write(at(f"{name}.glb"))
    inverse = np.array(matrix.inverted() @ scene.BACK)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata((positions.astype(float) @ inverse[:3, :3].T + inverse[:3, 3]).tolist(), [], triangles.tolist())
    obj = bpy.data.objects.new(name, mesh)
    obj.matrix_world = matrix
    bpy.context.scene.collection.objects.link(obj)
    return obj


def select(*objects):
    for one in bpy.data.objects:
        one.select_set(one in objects)
    bpy.context.view_layer.objects.active = objects[-1]
    bpy.context.view_layer.update()


def dense_groups(obj, names):
    weights = np.zeros((len(obj.data.vertices), len(names)))
    joint_of = {group.index: names.index(group.name) for group in obj.vertex_groups if group.name in names}
    for v, vertex in enumerate(obj.data.vertices):
        for one in vertex.groups:
            if one.group in joint_of:
                weights[v, joint_of[one.group]] = one.weight
    return weights


def dense_file(path, mesh=0):
    reader = glb.Reader(path)
    names, _, _ = reader.skin()
    joints, weights = reader.weights(mesh)
    full = np.zeros((len(joints), len(names)))
    np.add.at(full, (np.arange(len(joints))[:, None], joints), weights)
    return names, full


def shown(obj):
    """(V, 3): where Blender has the vertices, in glTF's axes."""
    bpy.context.view_layer.update()
    made = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = made.to_mesh()
    positions = np.array([tuple(scene.TURN @ obj.matrix_world @ vertex.co) for vertex in mesh.vertices])
    made.to_mesh_clear()
    return positions


def refused(words, call, *arguments, **more):
    try:
        call(*arguments, **more)
    except RuntimeError as error:
        assert words in str(error), str(error)
        return
    raise AssertionError(f"nothing was refused: {words}")


def rigs_an_object_and_leaves_the_rest_alone():
    obj = sample("biped", Matrix.Translation((3, 1, 0.5)) @ Matrix.Rotation(0.7, 4, "Z") @ Matrix.Scale(2, 4))
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 0
    obj.shape_key_add(name="Basis")
    obj.shape_key_add(name="Smile").data[5].co.x += 0.1
    obj.data.materials.append(bpy.data.materials.new("Skin"))
    obj.vertex_groups.new(name="mine").add((0, 1), 0.5, "REPLACE")
    before = shown(obj)
    world = obj.matrix_world.copy()
    select(obj)
    bpy.context.scene.limber.template = "humanoid"
    assert bpy.ops.limber.rig() == {"FINISHED"}
    armature = obj.find_armature()
    assert armature and len(armature.data.bones) == 22, armature
    assert [modifier.name for modifier in obj.modifiers] == ["Subdivision", "Armature"]
    assert list(obj.data.shape_keys.key_blocks.keys()) == ["Basis", "Smile"] and obj.data.materials[0].name == "Skin"
    assert obj.vertex_groups["mine"].weight(1) == 0.5
    assert max(abs(a - b) for x, y in zip(world, obj.matrix_world) for a, b in zip(x, y)) < 1e-6
    assert np.abs(shown(obj) - before).max() < 1e-5
    # The weights of the program for the same surface.
    run("rig", at("biped.glb"), "--template", "humanoid", "-o", at("biped_rigged.glb"))
    names, weights = dense_file(at("biped_rigged.glb"))
    groups = dense_groups(obj, names)
    assert np.abs(groups.sum(axis=1) - 1).max() < 1e-5  # no vertex is left out
    apart = np.abs(groups - weights)
    # The object is turned and scaled, so positions are rounded otherwise: between the thighs that decides which of the two is nearer.
    assert np.quantile(apart.max(axis=1), 0.995) < 0.02, apart.max()


def weights_are_those_of_the_program():
    obj = sample("quadruped")
    select(obj)
    bpy.context.scene.limber.template = "quadruped"
    assert bpy.ops.limber.rig() == {"FINISHED"}
    run("rig", at("quadruped.glb"), "--template", "quadruped", "-o", at("quadruped_rigged.glb"))
    names, weights = dense_file(at("quadruped_rigged.glb"))
    apart = np.abs(dense_groups(obj, names) - weights).max()
    assert apart < 1e-6, apart
    # And the armature bends the surface as the program does: a turn about the world's axis.
    armature, turn = obj.find_armature(), Quaternion((0, 1, 0), 0.6)
    bone = armature.pose.bones["leftHindUpperLeg" if "leftHindUpperLeg" in names else names[3]]
    rest = (scene.TURN @ bone.bone.matrix_local).to_3x3()
    rest.normalize()
    rest = rest.to_quaternion()
    bone.rotation_mode = "QUATERNION"
    bone.rotation_quaternion = rest.inverted() @ turn @ rest
    run("pose", at("quadruped_rigged.glb"), "--turn", f"{bone.name}=y:{np.degrees(0.6)}", "--bake", "-o", at("posed.glb"))
    expected, _ = glb.Reader(at("posed.glb")).mesh(0)
    assert np.abs(shown(obj) - expected).max() < 1e-4, np.abs(shown(obj) - expected).max()


def weights_for_an_armature_that_is_there():
    obj = sample("biped")
    select(obj)
    bpy.context.scene.limber.template = "humanoid"
    bpy.ops.limber.rig()
    armature = obj.find_armature()
    names = [bone.name for bone in scene.ordered_bones(armature)]
    first = dense_groups(obj, names)
    for group in list(obj.vertex_groups):
        obj.vertex_groups.remove(group)
    select(obj, armature)
    bpy.context.scene.limber.skinning = "bone-heat"
    assert bpy.ops.limber.weights() == {"FINISHED"}
    again = dense_groups(obj, names)
    assert np.abs(again.sum(axis=1) - 1).max() < 1e-5
    apart = np.abs(again - first).max(axis=1)
    print(f"weights made anew: median {np.median(apart):.3f}, 95th percentile {np.quantile(apart, 0.95):.3f} apart")
    assert np.median(apart) < 0.05, np.median(apart)  # bones end where Blender draws them: not quite the same
    bpy.context.scene.limber.skinning = "nearest-bone"
    bpy.ops.limber.weights()
    assert np.abs(dense_groups(obj, names) - again).max() > 0.3
    armature.data.bones["leftHand"].use_deform = False
    bpy.ops.limber.weights()
    assert dense_groups(obj, names)[:, names.index("leftHand")].max() == 0
    assert len([m for m in obj.modifiers if m.type == "ARMATURE"]) == 1


def retargets_a_file_and_an_action():
    obj = sample("biped", Matrix.Translation((0.5, -1, 0)))
    select(obj)
    bpy.context.scene.limber.template = "humanoid"
    bpy.ops.limber.rig()
    armature = obj.find_armature()
    run("sample", "walk", "-o", at("walk.bvh"))
    bpy.context.scene.limber.motion = at("walk.bvh")
    select(armature)
    assert bpy.ops.limber.retarget() == {"FINISHED"}
    action = armature.animation_data.action
    assert action.name == "walk" and len(action.fcurves) > 100
    # Each joint is where the program's own file has it.
    scene.write_character(armature, [obj], at("character.glb"))
    run("retarget", at("character.glb"), at("walk.bvh"), "-o", at("moving.glb"))
    rate, feet = bpy.context.scene.render.fps / bpy.context.scene.render.fps_base, []
    for seconds in (0.0, 24 / 60, 54 / 60):
        frame = 1 + seconds * rate
        bpy.context.scene.frame_set(int(frame), subframe=frame % 1)
        run("pose", at("moving.glb"), "--clip", "walk", "--time", str(seconds), "--bake", "-o", at("moment.glb"))
        expected, _ = glb.Reader(at("moment.glb")).mesh(0)
        apart = np.abs(shown(obj) - expected).max()
        assert apart < 1e-4, (seconds, apart)  # at keys: between them Blender blends quaternions by component
        feet.append(armature.pose.bones["leftFoot"].head.y)
    assert max(feet) - min(feet) > 0.05
    # The same from another armature's action.
    other = sample("biped", Matrix.Translation((2, 0, 0)))
    select(other)
    bpy.ops.limber.rig()
    bpy.context.scene.limber.source = armature
    select(other.find_armature())
    assert bpy.ops.limber.retarget() == {"FINISHED"}
    mine = other.find_armature()
    bpy.context.scene.frame_set(13)
    turns = [mine.pose.bones[name].rotation_quaternion.rotation_difference(armature.pose.bones[name].rotation_quaternion).angle
             for name in ("leftUpperLeg", "rightLowerLeg", "leftUpperArm")]
    assert max(turns) < np.radians(8), np.degrees(turns)
    assert bpy.data.actions["walk"].users > 0


def joints_are_corrected_by_empties():
    obj = sample("biped")
    select(obj)
    bpy.context.scene.limber.template = "humanoid"
    assert bpy.ops.limber.joints() == {"FINISHED"}
    empties = limber.corrections()
    assert len(empties) == 22 and obj.find_armature() is None
    moved = empties["leftHand"]
    moved.location += Vector((0, 0, 0.03))
    select(obj)
    position = moved.location.copy()
    assert bpy.ops.limber.rig() == {"FINISHED"}
    bone = obj.find_armature().data.bones["leftHand"]
    assert (bone.head_local - position).length < 1e-3, (bone.head_local, position)
    assert limber.CORRECTIONS not in bpy.data.collections


def corrections_stay_through_another_fit_and_with_their_model():
    obj, other = sample("biped"), sample("stool")
    select(obj)
    bpy.context.scene.limber.template = "humanoid"
    bpy.ops.limber.joints()
    limber.corrections()["leftHand"].location.z += 0.03
    position = limber.corrections()["leftHand"].location.copy()
    assert bpy.ops.limber.joints() == {"FINISHED"}  # again: what was corrected stays
    select(other)
    refused("joints to correct are those of biped", bpy.ops.limber.rig)
    assert len(limber.corrections()) == 22 and other.find_armature() is None
    select(obj)
    bpy.ops.limber.rig()
    assert (obj.find_armature().data.bones["leftHand"].head_local - position).length < 1e-3


def what_changes_meanwhile_is_refused_whole():
    obj = sample("biped")
    obj.vertex_groups.new(name="mine")
    select(obj)
    bpy.context.scene.limber.template = "humanoid"
    real, names = scene.objects_of, []

    def moved(objects, folder):
        names.extend(objects)
        obj.data.vertices[0].co.x += 0.5
        return real(objects, folder)

    scene.objects_of = moved
    try:
        refused("biped has changed while limber was at work", bpy.ops.limber.rig)
    finally:
        scene.objects_of = real
    assert names == ["biped"] and not any(one.type == "ARMATURE" for one in bpy.data.objects)
    assert [group.name for group in obj.vertex_groups] == ["mine"] and not obj.modifiers and obj.parent is None
    # A group that is called as a joint would be is the user's own.
    obj.vertex_groups.new(name="head")
    refused("vertex group head of its own", bpy.ops.limber.rig)
    assert not any(one.type == "ARMATURE" for one in bpy.data.objects) and len(obj.vertex_groups) == 2
    # Two objects of one mesh.
    twin = bpy.data.objects.new("twin", obj.data)
    bpy.context.scene.collection.objects.link(twin)
    select(obj)
    refused("shares its mesh", bpy.ops.limber.rig)


def is_one_step_to_undo():
    obj = sample("stool")
    select(obj)
    bpy.context.scene.limber.kind = "handles"
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.limber.rig()
    bpy.ops.ed.undo_push(message="limber")
    assert any(one.type == "ARMATURE" for one in bpy.data.objects)
    bpy.ops.ed.undo()
    assert not any(one.type == "ARMATURE" for one in bpy.data.objects)
    assert not bpy.data.objects["stool"].modifiers and not bpy.data.objects["stool"].vertex_groups


def what_cannot_be_done_says_so_and_changes_nothing():
    obj = sample("biped")
    empty = bpy.data.objects.new("nothing", bpy.data.meshes.new("nothing"))
    bpy.context.scene.collection.objects.link(empty)
    select(empty)
    refused("nothing has no faces", bpy.ops.limber.rig)
    for one in bpy.data.objects:
        one.select_set(False)
    refused("select the mesh objects", bpy.ops.limber.rig)
    select(obj)
    refused("select an armature", bpy.ops.limber.weights)
    obj.data.vertices[3].co.x = float("nan")
    refused("not a number", bpy.ops.limber.rig)
    obj.data.vertices[3].co.x = 0
    mine = preferences()
    mine.program = at("no-such-program")
    refused("the program limber is not at", bpy.ops.limber.rig)
    pathlib.Path(at("old")).write_text("#!/bin/sh\necho limber 0.0.9\n")
    os.chmod(at("old"), 0o755)
    mine.program = at("old")
    refused("install a newer one", bpy.ops.limber.rig)
    mine.program = "/bin/true"
    refused("is not limber", bpy.ops.limber.rig)
    choose_program()
    bpy.context.scene.limber.template = "humanoid"
    bpy.ops.limber.rig()
    refused("follows the armature", bpy.ops.limber.rig)
    select(obj.find_armature())
    bpy.context.scene.limber.motion = at("none.bvh")
    refused("choose a file with a motion", bpy.ops.limber.retarget)
    pathlib.Path(at("broken.bvh")).write_text("HIERARCHY\nROOT x\n")
    bpy.context.scene.limber.motion = at("broken.bvh")
    refused("broken.bvh", bpy.ops.limber.retarget)
    assert obj.find_armature().animation_data is None or obj.find_armature().animation_data.action is None


def without_program_or_node_it_says_what_to_install():
    obj, mine, path = sample("stool"), preferences(), os.environ["PATH"]
    select(obj)
    bpy.context.scene.limber.kind = "handles"
    mine.program = mine.package = ""
    package = folder_of("package", {})
    cases = [
        ({}, "neither the program limber nor Node is on the path: install limber, or Node 20 or newer"),
        ({"node": "echo v18.19.0"}, "is Node v18.19.0, too old: install Node 20 or newer, or the program limber"),
        ({"node": "echo hello"}, "is not Node"),
        ({"node": "echo v20.1.0"}, "neither the program limber nor its npm package: npm i -g"),
        ({"node": "echo v20.1.0", "npm": f"echo {package}"}, "neither the program limber nor its npm package: npm i -g"),
        ({"limber": "echo limber 0.0.9", "node": "echo v20.1.0"}, "is limber 0.0.9; 0.1 is needed"),
    ]
    try:
        for programs, words in cases:
            os.environ["PATH"] = folder_of("poor", programs)
            refused(words, bpy.ops.limber.find)
            refused(words, bpy.ops.limber.rig)
        mine.package = package
        os.environ["PATH"] = folder_of("poor", {"node": "echo v22.0.0"})
        refused("does not have limber's npm package", bpy.ops.limber.rig)
        mine.package, mine.node = "", at("no-such-node")
        refused("no Node at", bpy.ops.limber.rig)
    finally:
        os.environ["PATH"] = path
    assert not obj.vertex_groups and not obj.modifiers and obj.parent is None and len(bpy.data.objects) == 1


def the_program_is_taken_before_node_and_the_package_where_npm_has_it():
    path, root = os.environ["PATH"], pathlib.Path(folder_of("root", {}))
    made = root / "limber"
    (made / "bin").mkdir(parents=True)
    (made / "package.json").write_text('{"name": "limber", "version": "0.7.1"}')
    (made / "bin/limber.mjs").write_text("// the package's program")
    node = {"node": "echo v22.0.0", "npm": f"echo {root}"}
    try:
        os.environ["PATH"] = folder_of("rich", {**node, "limber": "echo limber 0.6.0"})
        found = program.find()
        assert (found.version, found.is_package, found.command) == ("0.6.0", False, [os.path.join(os.environ["PATH"], "limber")])
        # What npm i -g puts on the path is the package, for the Node that is new enough.
        os.environ["PATH"] = folder_of("global", {**node, "limber": str(made / "bin/limber.mjs")})
        found = program.find()
        assert (found.version, found.is_package) == ("0.7.1", True)
        assert found.command == [os.path.join(os.environ["PATH"], "node"), str(made / "bin/limber.mjs")]
        assert program.find(package=str(made)).command == program.find(package=str(root)).command == found.command
        beside = pathlib.Path(limber.__file__).parent / "node_modules/limber"
        shutil.copytree(made, beside)
        try:
            assert program.find().command[1] == str(beside / "bin/limber.mjs")
        finally:
            shutil.rmtree(beside.parent)
        (made / "package.json").write_text('{"name": "limber", "version": "0.0.9"}')
        try:
            program.find()
            raise AssertionError("an old package is taken")
        except limber.LimberError as error:
            assert "is limber 0.0.9; 0.1 is needed" in str(error), error
        assert program.find(PROGRAM).command == [PROGRAM]
    finally:
        os.environ["PATH"] = path


def node_retargets_what_it_can_and_names_the_rest():
    """The program retargets more: an armature alone, and files of other formats."""
    obj = sample("biped")
    select(obj)
    bpy.context.scene.limber.template = "humanoid"
    bpy.ops.limber.rig()
    armature = obj.find_armature()
    pathlib.Path(at("motion.fbx")).write_text("none")
    bpy.context.scene.limber.motion = at("motion.fbx")
    refused("needs the program limber" if PACKAGE else "motion.fbx", bpy.ops.limber.retarget)
    bpy.data.objects.remove(obj)
    run("sample", "walk", "-o", at("walk.bvh"))
    bpy.context.scene.limber.motion = at("walk.bvh")
    select(armature)
    if PACKAGE:
        refused("no mesh follows limber_rig", bpy.ops.limber.retarget)
    else:
        assert bpy.ops.limber.retarget() == {"FINISHED"}
    assert bool(armature.animation_data and armature.animation_data.action) == (not PACKAGE)


def beside_blenders_own_weights():
    """No claim, a note: time and vertices without weights of both, on one model."""
    obj = sample("winged")
    select(obj)
    bpy.context.scene.limber.kind = "handles"
    started = time.perf_counter()
    bpy.ops.limber.rig()
    ours, armature = time.perf_counter() - started, obj.find_armature()
    assert all(vertex.groups for vertex in obj.data.vertices)
    for group in list(obj.vertex_groups):
        obj.vertex_groups.remove(group)
    for modifier in list(obj.modifiers):
        obj.modifiers.remove(modifier)
    obj.parent = None
    select(obj, armature)
    started = time.perf_counter()
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    theirs = time.perf_counter() - started
    bare = sum(1 for vertex in obj.data.vertices if not any(one.weight > 0 for one in vertex.groups))
    print(f"{len(obj.data.vertices)} vertices: limber's joints and weights {ours:.2f} s, none left out; "
          f"Blender's weights for these joints {theirs:.2f} s, {bare} left out")


passed = failed = 0
for test in (rigs_an_object_and_leaves_the_rest_alone, weights_are_those_of_the_program, weights_for_an_armature_that_is_there,
             retargets_a_file_and_an_action, joints_are_corrected_by_empties, corrections_stay_through_another_fit_and_with_their_model,
             what_changes_meanwhile_is_refused_whole, is_one_step_to_undo,
             what_cannot_be_done_says_so_and_changes_nothing, without_program_or_node_it_says_what_to_install,
             the_program_is_taken_before_node_and_the_package_where_npm_has_it, node_retargets_what_it_can_and_names_the_rest, beside_blenders_own_weights):
    clear()
    try:
        test()
        passed += 1
    except Exception:
        failed += 1
        print(f"FAILED: {test.__name__}")
        traceback.print_exc(file=sys.stdout)
print(f"{passed} passed, {failed} failed")

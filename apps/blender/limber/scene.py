"""Between Blender's scene and glTF: what goes to limber, and what comes back onto the same objects."""
import bpy
import numpy as np
from mathutils import Matrix, Quaternion, Vector

from . import glb
from .program import LimberError

# Blender's +Z up to glTF's +Y up.
TURN = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
BACK = TURN.inverted()
MOST_WEIGHTS = 4  # that go to limber with a character whose motion is wanted


def positions_of(obj):
    """(V, 3): the mesh's own vertices, in the world and in glTF's axes. Modifiers and shape keys do not count."""
    vertices = obj.data.vertices
    local = np.empty(3 * len(vertices), np.float32)
    vertices.foreach_get("co", local)
    matrix = np.array(TURN @ obj.matrix_world)
    return (local.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32)


def triangles_of(obj):
    mesh = obj.data
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    triangles = corners.reshape(-1, 3).astype(np.uint32)
    return triangles[:, ::-1] if obj.matrix_world.determinant() < 0 else triangles


def add_meshes(writer, objects, skin=None, weights_of=None):
    """A node and a mesh for each object, in their order; what has no triangle is refused."""
    for i, obj in enumerate(objects):
        positions, triangles = positions_of(obj), triangles_of(obj)
        if len(triangles) == 0:
            raise LimberError(f"{obj.name} has no faces: fill them, or leave it out of the selection")
        if not np.isfinite(positions).all():
            raise LimberError(f"{obj.name} has vertices whose coordinates are not a number")
        attributes = {"POSITION": writer.add_array(positions, min=positions.min(axis=0).tolist(), max=positions.max(axis=0).tolist())}
        node = {"name": f"object_{i}"}
        if skin is not None:
            joints, weights = weights_of(obj)
            attributes["JOINTS_0"], attributes["WEIGHTS_0"] = writer.add_array(joints), writer.add_array(weights)
            node["skin"] = skin
        primitive = {"attributes": attributes, "indices": writer.add_array(triangles.reshape(-1))}
        node["mesh"] = writer.add("meshes", {"name": f"object_{i}", "primitives": [primitive]})
        writer.document["scenes"][0]["nodes"].append(writer.add("nodes", node))


def placeholder_weights(obj, joints):
    """Vertices to these joints in turn: what is bound anew is bound to the joints that hold something."""
    slots = np.zeros((len(obj.data.vertices), MOST_WEIGHTS), np.uint16)
    slots[:, 0] = np.resize(joints, len(slots))
    weights = np.zeros(slots.shape, np.float32)
    weights[:, 0] = 1
    return slots, weights


def group_weights(obj, bones):
    """The strongest of each vertex over these bones, by the vertex groups; the first bone where it has none."""
    bone_of = {group.index: bones.index(group.name) for group in obj.vertex_groups if group.name in bones}
    joints = np.zeros((len(obj.data.vertices), MOST_WEIGHTS), np.uint16)
    weights = np.zeros((len(obj.data.vertices), MOST_WEIGHTS), np.float32)
    for v, vertex in enumerate(obj.data.vertices):
        held = sorted(((g.weight, bone_of[g.group]) for g in vertex.groups if g.group in bone_of and g.weight > 0), reverse=True)
        for k, (weight, joint) in enumerate(held[:MOST_WEIGHTS]):
            joints[v, k], weights[v, k] = joint, weight
    total = weights.sum(axis=1)
    weights[total == 0, 0] = 1
    return joints, weights / weights.sum(axis=1, keepdims=True)


def ordered_bones(armature):
    """Parents first."""
    bones = []

    def add(bone):
        bones.append(bone)
        for child in bone.children:
            add(child)

    for bone in armature.data.bones:
        if bone.parent is None:
            add(bone)
    return bones


def rest_locals(armature):
    """By bone: where it rests, seen from its parent; a root from the world, in glTF's axes."""
    world = TURN @ armature.matrix_world
    return {bone.name: (bone.parent.matrix_local.inverted() if bone.parent else world) @ bone.matrix_local for bone in armature.data.bones}


def transform_entries(matrix, name):
    position, turn, scale = matrix.decompose()
    back = Matrix.LocRotScale(position, turn, scale)
    if max(abs(back[i][j] - matrix[i][j]) for i in range(4) for j in range(4)) > 1e-4 * max(1, max(scale)):
        raise LimberError(f"{name} is sheared: apply the scale of the armature first")
    return {"translation": list(position), "rotation": [turn.x, turn.y, turn.z, turn.w], "scale": list(scale)}


def add_skeleton(writer, armature):
    """Nodes of the bones, and a skin of them. (names, nodes by name, the skin)"""
    bones, locals_ = ordered_bones(armature), rest_locals(armature)
    if not bones:
        raise LimberError(f"{armature.name} has no bones")
    nodes = {}
    for bone in bones:
        nodes[bone.name] = writer.add("nodes", {"name": bone.name, **transform_entries(locals_[bone.name], bone.name)})
        if bone.parent:
            writer.document["nodes"][nodes[bone.parent.name]].setdefault("children", []).append(nodes[bone.name])
        else:
            writer.document["scenes"][0]["nodes"].append(nodes[bone.name])
    world = TURN @ armature.matrix_world
    inverse = np.array([np.array((world @ bone.matrix_local).inverted()) for bone in bones], np.float32)
    skin = writer.add("skins", {"joints": [nodes[bone.name] for bone in bones], "inverseBindMatrices": writer.add_array(inverse)})
    return [bone.name for bone in bones], nodes, skin


def write_meshes(objects, path):
    writer = glb.Writer()
    add_meshes(writer, objects)
    writer.write(path)


def write_character(armature, objects, path, are_bound=True):
    """are_bound: with the weights of the vertex groups; else they are to be made, for the bones that deform."""
    writer = glb.Writer()
    names, _, skin = add_skeleton(writer, armature)
    deforming = [j for j, name in enumerate(names) if armature.data.bones[name].use_deform]
    if not are_bound and not deforming:
        raise LimberError(f"no bone of {armature.name} deforms: switch Deform on for those that are to")
    add_meshes(writer, objects, skin, lambda obj: group_weights(obj, names) if are_bound else placeholder_weights(obj, deforming))
    if not objects:
        del writer.document["skins"]
    writer.write(path)


def write_motion(armature, path):
    """The armature's action, frame by frame."""
    action = armature.animation_data and armature.animation_data.action
    if not action:
        raise LimberError(f"{armature.name} has no action")
    scene, writer = bpy.context.scene, glb.Writer()
    if any(min(abs(axis) for axis in bone.scale) < 1e-9 for bone in armature.pose.bones):
        raise LimberError(f"{armature.name} has a bone that is scaled to nothing")
    _, nodes, _ = add_skeleton(writer, armature)
    del writer.document["skins"]
    first, last = (int(round(frame)) for frame in action.frame_range)
    rate, before, part = scene.render.fps / scene.render.fps_base, scene.frame_current, scene.frame_subframe
    moved = {name: [] for name in nodes}
    try:
        for frame in range(first, last + 1):
            scene.frame_set(frame)
            for bone in armature.pose.bones:
                above = bone.parent.matrix.inverted() if bone.parent else TURN @ armature.matrix_world
                moved[bone.name].append((above @ bone.matrix).decompose())
    finally:
        scene.frame_set(before, subframe=part)
    times = writer.add_array((np.arange(last - first + 1) / rate).astype(np.float32), min=[0.0], max=[(last - first) / rate])
    animation = {"name": action.name, "channels": [], "samplers": []}
    for name, poses in moved.items():
        turns = np.array([(t.x, t.y, t.z, t.w) for _, t, _ in poses], np.float32)
        for key, values in (("translation", np.array([p for p, _, _ in poses], np.float32)), ("rotation", turns)):
            animation["channels"].append({"sampler": len(animation["samplers"]), "target": {"node": nodes[name], "path": key}})
            animation["samplers"].append({"input": times, "output": writer.add_array(values), "interpolation": "LINEAR"})
    writer.add("animations", animation)
    writer.write(path)


def joint_positions(path):
    """By joint: where it is, in Blender's world."""
    names, _, bound = glb.Reader(path).skin()
    return {name: BACK @ Vector(matrix[:3, 3]) for name, matrix in zip(names, bound)}


def check_names(names):
    """Throws LimberError where Blender would call bones otherwise."""
    if len(set(names)) != len(names) or any(len(name.encode()) > 63 or not name for name in names):
        raise LimberError("joints of the result have names that Blender does not take")


def make_armature(names, parents, bound, name):
    """A new armature object of these joints; each bone goes to the child that has most below it."""
    check_names(names)
    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    bpy.context.scene.collection.objects.link(armature)
    heads = [BACK @ Vector(matrix[:3, 3]) for matrix in bound]
    children = [[c for c, parent in enumerate(parents) if parent == j] for j in range(len(names))]
    below = [1] * len(names)
    for j in reversed(range(len(names))):
        below[j] += sum(below[c] for c in children[j])
    size = max((a - b).length for a in heads for b in heads[:1]) or 1.0
    active, mode = bpy.context.view_layer.objects.active, bpy.context.mode
    if mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bones, made = armature.data.edit_bones, []
    for j, joint in enumerate(names):
        bone = bones.new(joint)
        bone.head = heads[j]
        along = heads[max(children[j], key=lambda c: below[c])] - heads[j] if children[j] else Vector()
        if along.length < 1e-3 * size and parents[j] >= 0:
            along = 0.5 * (made[parents[j]].tail - made[parents[j]].head)
        bone.tail = heads[j] + (along if along.length >= 1e-4 * size else Vector((0, 0, 0.05 * size)))
        if parents[j] >= 0:
            bone.parent = made[parents[j]]
        made.append(bone)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = active
    armature.show_in_front = True
    return armature


def objects_of(names, folder):
    """The objects of these names as they were when their file was written; throws LimberError where one is not."""
    written, objects = glb.Reader(folder + "/in.glb"), []
    for i, name in enumerate(names):
        obj = bpy.data.objects.get(name)
        if obj is None or obj.type != "MESH" or obj.mode != "OBJECT" or not np.array_equal(positions_of(obj), written.mesh(i)[0]):
            raise LimberError(f"{name} has changed while limber was at work: try again")
        objects.append(obj)
    return objects


def add_group(obj, name, vertices, slots, weights):
    """A vertex group of these weights[vertex, slot]. Blender has no call for many weights: one for those that are whole, and one each."""
    add, held = obj.vertex_groups.new(name=name).add, weights[vertices, slots]
    add(vertices[held == 1].tolist(), 1.0, "REPLACE")
    for vertex, weight in zip(vertices[held != 1].tolist(), held[held != 1].tolist()):
        add((vertex,), weight, "REPLACE")


def apply_weights(objects, names, reader):
    """Vertex groups of these bones anew; all others stay."""
    every = [reader.weights(i) for i in range(len(objects))]
    for obj, (joints, _) in zip(objects, every):
        if len(joints) != len(obj.data.vertices):
            raise LimberError(f"{obj.name} has changed while limber was at work: try again")
    for obj, (joints, weights) in zip(objects, every):
        for group in [group for group in obj.vertex_groups if group.name in names]:
            obj.vertex_groups.remove(group)
        for j in np.unique(joints[weights > 0]).tolist():
            add_group(obj, names[j], *np.nonzero((joints == j) & (weights > 0)), weights)


def bind(obj, armature):
    if not any(modifier.type == "ARMATURE" and modifier.object == armature for modifier in obj.modifiers):
        obj.modifiers.new("Armature", "ARMATURE").object = armature
    if obj.parent is None:
        world = obj.matrix_world.copy()
        obj.parent = armature
        obj.matrix_parent_inverse = armature.matrix_world.inverted()
        obj.matrix_world = world


def apply_rig(objects, path, name="limber_rig"):
    reader = glb.Reader(path)
    names, parents, bound = reader.skin()
    for obj in objects:
        taken = [group.name for group in obj.vertex_groups if group.name in names]
        if taken:
            raise LimberError(f"{obj.name} has a vertex group {taken[0]} of its own, as a joint is called: rename it first")
    armature = make_armature(names, parents, bound, name)
    try:
        apply_weights(objects, names, reader)
        for obj in objects:
            bind(obj, armature)
    except BaseException:
        data = armature.data
        bpy.data.objects.remove(armature)
        bpy.data.armatures.remove(data)
        raise
    return armature


def apply_clips(armature, path):
    """Actions of the armature for the clips of the file; the last is the one that it plays."""
    reader, locals_ = glb.Reader(path), rest_locals(armature)
    rate = bpy.context.scene.render.fps / bpy.context.scene.render.fps_base
    nodes = {node: entry["name"] for node, entry in enumerate(reader.document["nodes"]) if entry.get("name") in locals_}
    data, actions = armature.animation_data or armature.animation_data_create(), []
    if data.action:
        data.action.use_fake_user = True
    try:
        for name, moved in reader.clips():
            action = bpy.data.actions.new(name)
            action.use_fake_user = True  # of several one alone is played: the others must not be lost
            actions.append(action)
            for node, paths in moved.items():
                if node in nodes:
                    add_keys(action, armature.pose.bones[nodes[node]], locals_[nodes[node]], reader.document["nodes"][node], paths, rate)
    except BaseException:
        for action in actions:
            bpy.data.actions.remove(action)
        raise
    if not actions:
        raise LimberError("limber gave no motion back")
    data.action = actions[-1]
    return actions


def at_times(times, path, fixed):
    """(N, width): a path's values at these times, linearly between its own keys; what rests is fixed."""
    if path is None:
        return np.tile(fixed, (len(times), 1))
    own, values = path[0].astype(float), path[1].astype(float).copy()
    if values.shape[1] == 4:
        for k in range(1, len(values)):  # the shorter way round
            values[k] *= -1 if values[k] @ values[k - 1] < 0 else 1
    return np.stack([np.interp(times, own, values[:, axis]) for axis in range(values.shape[1])], axis=1)


def add_keys(action, bone, rest, node, paths, rate):
    times = np.unique(np.concatenate([path[0].astype(float) for path in paths.values()]))
    fixed = {"translation": node.get("translation", (0, 0, 0)), "rotation": node.get("rotation", (0, 0, 0, 1)), "scale": node.get("scale", (1, 1, 1))}
    values = {key: at_times(times, paths.get(key), fixed[key]) for key in fixed}
    frames, back, last = 1 + times * rate, rest.inverted(), None
    keys = {"location": [], "rotation_quaternion": [], "scale": []}
    for position, turn, scale in zip(values["translation"], values["rotation"], values["scale"]):
        x, y, z, w = turn.tolist()
        position, turn, scale = (back @ Matrix.LocRotScale(Vector(position.tolist()), Quaternion((w, x, y, z)).normalized(), Vector(scale.tolist()))).decompose()
        if last is not None and last.dot(turn) < 0:
            turn.negate()
        last = turn
        for key, value in zip(keys, (position, turn, scale)):
            keys[key].append(value)
    bone.rotation_mode = "QUATERNION"
    for key, rows in keys.items():
        rows = np.array(rows)
        for axis in range(rows.shape[1]):
            curve = action.fcurves.new(f'pose.bones["{bpy.utils.escape_identifier(bone.name)}"].{key}', index=axis, action_group=bone.name)
            curve.keyframe_points.add(len(frames))
            curve.keyframe_points.foreach_set("co", np.stack([frames, rows[:, axis]], axis=1).reshape(-1))
            for point in curve.keyframe_points:
                point.interpolation = "LINEAR"
            curve.update()

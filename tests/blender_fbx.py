# Does Blender show an FBX file that limber wrote where three.js does?
#
#   blender --background --factory-startup --python tests/blender_fbx.py -- FILE.fbx...
#
# Imports each file, plays all of its clips, and compares the corners of all triangles with those that tests/three_fbx.mjs
# left beside the file (LIMBER_CORNERS): which three.js shows where the GLB has them. Ends with "N passed, N failed".
import json
import os
import sys

import bpy
import numpy
from mathutils.kdtree import KDTree

TOLERANCE = 1e-5  # of the model's size
LONGEST_NAME = 63  # of Blender's


def things_that_move():
    for thing in bpy.data.objects:
        yield thing
        if thing.type == 'MESH' and thing.data.shape_keys:
            yield thing.data.shape_keys


# Nothing is put back from one clip to the next: each has to say all that any of them moves.
def play(clip):
    for thing in things_that_move():
        wanted = f'{thing.name}|{clip}'[:LONGEST_NAME]  # stack and layer have one name
        if thing.animation_data:
            thing.animation_data.action = bpy.data.actions.get(wanted)


def show(seconds):
    frame = seconds * bpy.context.scene.render.fps / bpy.context.scene.render.fps_base
    bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))


# In glTF's axes.
def corners(name):
    thing = bpy.data.objects[name[:LONGEST_NAME]].evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = thing.to_mesh()
    points = numpy.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get('co', points)
    matrix = numpy.array(thing.matrix_world)
    world = points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    loops = numpy.empty(len(mesh.loops), dtype=int)
    mesh.loops.foreach_get('vertex_index', loops)
    thing.to_mesh_clear()
    return world[loops][:, [0, 2, 1]] * [1, 1, -1]


# The largest distance of a point to the nearest of others.
def farthest(points, others):
    tree = KDTree(len(others))
    for i, place in enumerate(others):
        tree.insert(place, i)
    tree.balance()
    return max(tree.find(place)[2] for place in points)


# Corner by corner; where Blender took out triangles that are none, or are there twice, by the nearest ones.
def apart(found, wanted):
    if len(found) == len(wanted):
        return numpy.linalg.norm(found - wanted, axis=1).max()
    if not 0.9 * len(wanted) < len(found) < len(wanted):
        raise ValueError(f'{len(found) // 3} triangles for {len(wanted) // 3}')
    return max(farthest(found, wanted), farthest(wanted, found))


def largest_distance(path):
    stem = path[:-4]
    with open(stem + '.corners.json') as file:
        told = json.load(file)
    places = numpy.fromfile(stem + '.corners.bin', '<f4').reshape(-1, 3)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.fbx(filepath=path, anim_offset=0.0)
    largest, size, first = 0.0, 0.0, 0
    for clip in told['clips']:
        play(clip['name'])
        for seconds in clip['seconds']:
            show(seconds)
            begin = first
            for mesh in told['meshes']:
                wanted = places[first:first + mesh['corners']]
                first += mesh['corners']
                largest = max(largest, apart(corners(mesh['name']), wanted))
            span = places[begin:first]
            if len(span):
                size = max(size, numpy.linalg.norm(span.max(axis=0) - span.min(axis=0)))
    if first != len(places):
        raise ValueError('not all corners were compared')
    return largest / size if size else 0.0


passed = failed = 0
for path in sys.argv[sys.argv.index('--') + 1:]:
    try:
        distance = largest_distance(path)
        good = distance < TOLERANCE
        if not good:
            print(f'{path}: the surface is {distance:.2g} of its size away')
        elif os.environ.get('LIMBER_SIZES'):
            print(f'{path}: {distance:.1e}')
    except Exception as error:  # of Blender's importer, too
        good = False
        print(f'{path}: {error}')
    passed, failed = passed + good, failed + (not good)
print(f'{passed} passed, {failed} failed')
sys.exit(1 if failed else 0)

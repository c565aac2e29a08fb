# Does Blender show the joints of a glTF file where the file has them?
#
#   blender --background --factory-startup --python tests/blender_positions.py -- FILE.glb...
#
# Imports each file with its last clip, plays it, and compares the heads of all bones with the joints' world positions, worked
# out here from the file by the letter of the glTF specification. Ends with "N passed, N failed".
import json
import struct
import sys
import tempfile

import bpy
import numpy
from mathutils import Matrix, Quaternion, Vector

# Debian's Blender 3.4 reads meshes with a name that Debian's numpy no longer has.
numpy.bool = bool

TOLERANCE = 1e-4  # of the skeleton's size, or metres where it is smaller than one
FRAMES = 5
WIDTHS = {'SCALAR': 1, 'VEC3': 3, 'VEC4': 4, 'MAT4': 16}


def read_glb(path):
    with open(path, 'rb') as file:
        data = file.read()
    length = struct.unpack_from('<I', data, 12)[0]
    document = json.loads(data[20:20 + length])
    binary = data[20 + length + 8:]
    return document, binary


def write_glb(path, document, binary):
    text = json.dumps(document).encode()
    text += b' ' * (-len(text) % 4)
    chunks = struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(binary), b'BIN\0') + binary
    with open(path, 'wb') as file:
        file.write(struct.pack('<4sII', b'glTF', 2, 12 + len(chunks)) + chunks)


def read_floats(document, binary, index):
    accessor = document['accessors'][index]
    assert accessor['componentType'] == 5126 and 'sparse' not in accessor
    view = document['bufferViews'][accessor['bufferView']]
    assert 'byteStride' not in view
    width = WIDTHS[accessor['type']]
    begin = view.get('byteOffset', 0) + accessor.get('byteOffset', 0)
    values = numpy.frombuffer(binary, '<f4', accessor['count'] * width, begin)
    return values.reshape(accessor['count'], width).astype(float)


def rotation(value):
    return Quaternion((value[3], value[0], value[1], value[2])).normalized()


def sample(times, values, path, seconds):
    after = int(numpy.searchsorted(times, seconds, 'right'))
    if after == 0 or after == len(times):
        value = values[min(after, len(times) - 1)]
        return rotation(value) if path == 'rotation' else Vector(value)
    u = (seconds - times[after - 1]) / (times[after] - times[after - 1])
    if path == 'rotation':
        return rotation(values[after - 1]).slerp(rotation(values[after]), u)
    return Vector((1 - u) * values[after - 1] + u * values[after])


def world_positions(document, binary, seconds):
    parts = []
    for node in document['nodes']:
        if 'matrix' in node:
            matrix = Matrix([node['matrix'][row::4] for row in range(4)])
            translation, turn, scale = matrix.decompose()
        else:
            translation, turn = Vector(node.get('translation', (0, 0, 0))), rotation(node.get('rotation', (0, 0, 0, 1)))
            scale = Vector(node.get('scale', (1, 1, 1)))
        parts.append({'translation': translation, 'rotation': turn, 'scale': scale})
    animation = document['animations'][0]
    for channel in animation['channels']:
        sampler = animation['samplers'][channel['sampler']]
        assert sampler.get('interpolation', 'LINEAR') == 'LINEAR'
        times = read_floats(document, binary, sampler['input'])[:, 0]
        values = read_floats(document, binary, sampler['output'])
        path = channel['target']['path']
        parts[channel['target']['node']][path] = sample(times, values, path, seconds)
    worlds = {}

    def place(index, above):
        part = parts[index]
        worlds[index] = above @ Matrix.LocRotScale(part['translation'], part['rotation'], part['scale'])
        for child in document['nodes'][index].get('children', []):
            place(child, worlds[index])

    for index in document['scenes'][document.get('scene', 0)]['nodes']:
        place(index, Matrix.Identity(4))
    return {document['nodes'][joint]['name']: worlds[joint].translation for joint in document['skins'][0]['joints']}


def largest_distance(path):
    document, binary = read_glb(path)
    document['animations'] = document['animations'][-1:]  # Blender leaves joints as the clip before had them
    times = [read_floats(document, binary, sampler['input']) for sampler in document['animations'][0]['samplers']]
    name = document['animations'][0]['name']
    duration = max(float(values[-1, 0]) for values in times)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = 120
    with tempfile.TemporaryDirectory() as folder:
        write_glb(folder + '/last.glb', document, binary)
        bpy.ops.import_scene.gltf(filepath=folder + '/last.glb')
    armature = next(thing for thing in bpy.data.objects if thing.type == 'ARMATURE')
    armature.animation_data.action = next(action for action in bpy.data.actions if action.name.startswith(name))
    for track in armature.animation_data.nla_tracks:
        track.mute = True
    largest, size, compared = 0.0, 1.0, 0
    for step in range(FRAMES):
        seconds = duration * step / (FRAMES - 1)
        frame = seconds * 120
        bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
        wanted = world_positions(document, binary, seconds)
        for bone in armature.pose.bones:
            head = armature.matrix_world @ bone.head
            place = wanted[bone.name]
            largest = max(largest, (head - Vector((place.x, -place.z, place.y))).length)
            size = max(size, place.length)
            compared += 1
    assert compared >= 2 * FRAMES, 'hardly any bone to compare'
    return largest / size


passed = failed = 0
for file in sys.argv[sys.argv.index('--') + 1:]:
    try:
        distance = largest_distance(file)
        problem = None if distance < TOLERANCE else f'bones are {distance} apart'
    except Exception as error:  # whatever goes wrong with one file, the others are looked at
        problem = repr(error)
    if problem:
        print(f'{file}: {problem}')
        failed += 1
    else:
        passed += 1
print(f'{passed} passed, {failed} failed')
sys.stdout.flush()
sys.exit(1 if failed else 0)

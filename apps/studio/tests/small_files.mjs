// Small models in the formats that the page brings into GLB itself, made in code.
const corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
const quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [0, 4, 7, 3], [1, 2, 6, 5]];
// A tower of boxes, so that there is something to put handles into.
const boxes = [0, 1, 2, 3];
const points = boxes.flatMap((box) => corners.map(([x, y, z]) => [x * 0.5, (y + box) * 0.4, z * 0.3]));
const triangles = boxes.flatMap((box) => quads.flatMap((q) => [[q[0], q[1], q[2]], [q[0], q[2], q[3]]].map((t) => t.map((i) => i + 8 * box))));

export const vertexCount = points.length, triangleCount = triangles.length;

export function asciiPly() {
  return Buffer.from(`ply\nformat ascii 1.0\nelement vertex ${points.length}\nproperty float x\nproperty float y\nproperty float z\n`
    + `element face ${triangles.length}\nproperty list uchar int vertex_indices\nend_header\n`
    + points.map((p) => p.join(' ')).join('\n') + '\n' + triangles.map((t) => `3 ${t.join(' ')}`).join('\n') + '\n');
}

export function binaryStl() {
  const bytes = Buffer.alloc(84 + 50 * triangles.length);
  bytes.writeUInt32LE(triangles.length, 80);
  triangles.forEach((triangle, i) => triangle.forEach((corner, k) => points[corner].forEach((value, axis) =>
    bytes.writeFloatLE(value, 84 + 50 * i + 12 + 12 * k + 4 * axis))));
  return bytes;
}

export function asciiFbx() {
  const ends = triangles.flatMap(([a, b, c]) => [a, b, -c - 1]); // the last corner of a polygon is told by its complement
  // three's loader takes a file for a binary one by single letters of its beginning.
  return Buffer.from(`; ${'-'.repeat(240)}
; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
Objects:  {
	Geometry: 1001, "Geometry::tower", "Mesh" {
		Vertices: *${3 * points.length} {
			a: ${points.flat().map((value) => 100 * value).join(',')}
		}
		PolygonVertexIndex: *${ends.length} {
			a: ${ends.join(',')}
		}
		GeometryVersion: 124
	}
	Model: 1002, "Model::tower", "Mesh" {
		Version: 232
	}
}
Connections:  {
	C: "OO",1002,0
	C: "OO",1001,1002
}
`);
}

/** A GLB that says of itself that it is a VRM. */
export function vrmOf(glb) {
  const length = glb.readUInt32LE(12), json = JSON.parse(glb.subarray(20, 20 + length).toString());
  json.extensionsUsed = [...(json.extensionsUsed ?? []), 'VRMC_vrm'];
  json.extensions = { ...json.extensions, VRMC_vrm: { specVersion: '1.0', meta: { name: 'tower' } } };
  const text = Buffer.from(JSON.stringify(json)), padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, ' ')]);
  const rest = glb.subarray(20 + length), head = Buffer.alloc(20);
  head.write('glTF');
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(20 + padded.length + rest.length, 8);
  head.writeUInt32LE(padded.length, 12);
  head.write('JSON', 16);
  return Buffer.concat([head, padded, rest]);
}

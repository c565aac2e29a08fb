// Many bodies, all of one build drawn at once: each takes its joints' matrices from rows of a texture that holds the whole
// animation, so that a frame costs the page one number, however many bodies there are.
import {
  Box3, BufferAttribute, BufferGeometry, DataTexture, FloatType, Group, InstancedBufferAttribute, InstancedMesh, Matrix4, MeshStandardMaterial,
  RGBAFormat, type Texture, Vector3,
} from 'three';
import type { Crowd } from '../engine/messages';
import { patch } from './deformation';
import { loadTexture, plainMaterial } from './surface_look';

const texelsPerJoint = 3; // rows of a matrix
const texelsAcross = texelsPerJoint * 682; // a card takes 2048 at least

const declare = `
  attribute vec4 bodyJoints;
  attribute vec4 bodyWeights;
  attribute float bodyRow;
  uniform highp sampler2D bodyMatrices;
  uniform int bodyJointCount;
  uniform vec3 bodyFrame; // the frame before, the one after, and how far from the one to the other
  vec4 bodyTexel(const in int texel) { return texelFetch(bodyMatrices, ivec2(texel % ${texelsAcross}, texel / ${texelsAcross}), 0); }
  mat4 bodyMatrix(const in float frame) {
    int row = int(bodyRow + frame) * bodyJointCount;
    vec4 x = vec4(0.0), y = vec4(0.0), z = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
      if (bodyWeights[i] == 0.0) continue;
      int first = ${texelsPerJoint} * (row + int(bodyJoints[i]));
      x += bodyWeights[i] * bodyTexel(first);
      y += bodyWeights[i] * bodyTexel(first + 1);
      z += bodyWeights[i] * bodyTexel(first + 2);
    }
    return transpose(mat4(x, y, z, vec4(0.0, 0.0, 0.0, 1.0)));
  }`;
const lines = {
  declare,
  begin: 'mat4 body = (1.0 - bodyFrame.z) * bodyMatrix(bodyFrame.x) + bodyFrame.z * bodyMatrix(bodyFrame.y);',
  normal: 'objectNormal = mat3(body) * objectNormal;',
  position: 'transformed = (body * vec4(transformed, 1.0)).xyz;',
};

function textureOf(matrices: Float32Array): DataTexture {
  const down = Math.ceil(matrices.length / 4 / texelsAcross), values = new Float32Array(4 * texelsAcross * down);
  values.set(matrices);
  const texture = new DataTexture(values, texelsAcross, down, RGBAFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}

export class CrowdView {
  readonly root = new Group();
  /** Of all bodies as they are bound. */
  readonly box = new Box3();
  onChange: () => void = () => {};

  private frame = { value: new Vector3() };
  private disposals: (() => void)[] = [];

  constructor(private crowd: Crowd) {
    const tables = crowd.tables.map(({ matrices }) => textureOf(matrices));
    tables.forEach((table) => this.disposals.push(() => table.dispose()));
    crowd.builds.forEach((surface, build) => {
      const own = new Box3().setFromArray(surface.positions), pictures = new Map<number, Promise<Texture>>();
      crowd.tables.forEach(({ joints }, table) => {
        const bodies = crowd.bodies.filter((body) => body.build === build && body.table === table);
        if (bodies.length === 0) return;
        for (const { place } of bodies) this.box.union(own.clone().applyMatrix4(new Matrix4().fromArray(place)));
        const uniforms = { bodyMatrices: { value: tables[table] }, bodyJointCount: { value: joints }, bodyFrame: this.frame };
        for (const part of surface.parts) this.addPart(surface, part, bodies, uniforms, pictures);
      });
    });
    this.show(0);
  }

  /** At a moment in seconds, of 0 to the crowd's; between frames in between. */
  show(seconds: number) {
    const { frames } = this.crowd, at = Math.min(frames, Math.max(0, (seconds / this.crowd.seconds) * frames)), before = Math.floor(at);
    this.frame.value.set(before, Math.min(frames, before + 1), at - before);
  }

  dispose() { this.disposals.forEach((dispose) => dispose()); }

  private addPart(
    surface: Crowd['builds'][number], part: Crowd['builds'][number]['parts'][number], bodies: Crowd['bodies'],
    uniforms: Record<string, { value: unknown }>, pictures: Map<number, Promise<Texture>>,
  ) {
    const geometry = new BufferGeometry();
    geometry.setIndex(new BufferAttribute(surface.triangles.subarray(part.first, part.first + part.count), 1));
    geometry.setAttribute('position', new BufferAttribute(surface.positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(surface.normals, 3));
    if (surface.uvs.length > 0) geometry.setAttribute('uv', new BufferAttribute(surface.uvs, 2));
    geometry.setAttribute('bodyJoints', new BufferAttribute(surface.joints, 4));
    geometry.setAttribute('bodyWeights', new BufferAttribute(surface.weights, 4));
    geometry.setAttribute('bodyRow', new InstancedBufferAttribute(Float32Array.from(bodies, ({ row }) => row), 1));
    const source = part.material === null ? null : surface.materials[part.material] ?? null, material = plainMaterial(source);
    patch(material, 'crowd', uniforms, lines);
    const mesh = new InstancedMesh(geometry, material, bodies.length);
    bodies.forEach(({ place }, i) => mesh.setMatrixAt(i, new Matrix4().fromArray(place)));
    mesh.frustumCulled = false;
    this.root.add(mesh);
    this.disposals.push(() => {
      geometry.dispose();
      material.dispose();
      mesh.dispose();
    });
    if (source?.texture != null) this.addPicture(material, source.texture, surface.textures, pictures);
  }

  private addPicture(material: MeshStandardMaterial, number: number, files: Uint8Array[], pictures: Map<number, Promise<Texture>>) {
    const file = files[number];
    if (!file) return;
    const picture = pictures.get(number) ?? loadTexture(file);
    if (!pictures.has(number)) picture.then((texture) => this.disposals.push(() => texture.dispose()), () => { /* told below */ });
    pictures.set(number, picture);
    picture.then((texture) => {
      material.map = texture;
      material.needsUpdate = true;
      this.onChange();
    }, () => { /* a picture that the browser cannot read: the plain colour stays */ });
  }
}

// How the surface bends where its weights alone do not say: by rows of moments (DeformRows of the engine), which the graphics
// card sums up, or by the engine, which then gives the surface for each frame.
import { BufferAttribute, BufferGeometry, DataTexture, FloatType, Material, RGBAFormat } from 'three';
import type { Deformation } from '../engine/messages';
import { jointMotions } from './joint_motions';

export type Rows = Extract<Deformation, { form: 'rows' }>;

const perEntry = 20; // numbers: four joints, and of these the x of their moments, the y, the z and the weights
const texels = perEntry / 4;
const entriesAcross = 400; // 2000 texels, which is less than any card takes

type Uniforms = Record<string, { value: unknown }>;

/** The material's vertices go where these lines, in place of three.js' own, take them. */
export function patch(material: Material, name: string, uniforms: Uniforms, lines: { declare: string; begin: string; normal: string; position: string }) {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    for (const [chunk, code] of [
      ['skinning_pars_vertex', lines.declare], ['skinbase_vertex', lines.begin], ['skinnormal_vertex', lines.normal], ['skinning_vertex', lines.position],
    ]) shader.vertexShader = shader.vertexShader.replace(`#include <${chunk}>`, code!);
  };
  material.customProgramCacheKey = () => name;
}

const rowLines = {
  declare: `#include <skinning_pars_vertex>
    attribute vec3 rowPlace;
    attribute vec2 rowRange;
    uniform highp sampler2D rowEntries;
    uniform highp sampler2D jointMotions;
    vec4 rowTexel(const in int texel) {
      int width = textureSize(rowEntries, 0).x;
      return texelFetch(rowEntries, ivec2(texel % width, texel / width), 0);
    }
    vec3 rowTurned(const in vec4 turn, const in vec3 v) {
      float square = dot(turn, turn);
      return square > 0.0 ? v + 2.0 / square * cross(turn.xyz, cross(turn.xyz, v) + turn.w * v) : v;
    }`,
  begin: `
    vec3 rowShift = vec3(0.0);
    vec4 rowTurn = vec4(0.0), rowPivot = vec4(0.0);
    mat3 rowStretch = mat3(1.0);
    int rowEnd = int(rowRange.x) + int(rowRange.y);
    for (int entry = int(rowRange.x); entry < rowEnd; ++entry) {
      int first = ${texels} * entry;
      vec4 joints = rowTexel(first), xs = rowTexel(first + 1), ys = rowTexel(first + 2), zs = rowTexel(first + 3), weights = rowTexel(first + 4);
      for (int i = 0; i < 4; ++i) {
        if (weights[i] == 0.0) continue;
        int joint = int(joints[i]);
        vec4 moment = vec4(xs[i], ys[i], zs[i], weights[i]), turn = texelFetch(jointMotions, ivec2(0, joint), 0);
        rowShift += (getBoneMatrix(joints[i]) * moment - moment).xyz;
        if (rowPivot == vec4(0.0)) rowPivot = turn;
        rowTurn += (dot(rowPivot, turn) < 0.0 ? -weights[i] : weights[i]) * turn;
        for (int column = 0; column < 3; ++column) rowStretch[column] += weights[i] * texelFetch(jointMotions, ivec2(column + 1, joint), 0).xyz;
      }
    }`,
  normal: `
    vec3 rowYz = cross(rowStretch[1], rowStretch[2]);
    mat3 rowCofactors = mat3(rowYz, cross(rowStretch[2], rowStretch[0]), cross(rowStretch[0], rowStretch[1]));
    objectNormal = rowTurned(rowTurn, (dot(rowStretch[0], rowYz) < 0.0 ? -1.0 : 1.0) * (rowCofactors * objectNormal));`,
  position: 'transformed = rowPlace + rowShift + rowTurned(rowTurn, rowStretch * (transformed - rowPlace));',
};

/** The rows of a surface: attributes of its geometry and a texture, for all that is drawn of it. */
export class RowSurface {
  readonly entries: { value: DataTexture };

  constructor(rows: Rows, private geometry: BufferGeometry) {
    geometry.setAttribute('rowPlace', new BufferAttribute(rows.places, 3));
    geometry.setAttribute('rowRange', new BufferAttribute(rows.ranges, 2));
    this.entries = { value: textureOf(rows.entries) };
  }

  /** Others, for the same vertices. */
  take(rows: Rows) {
    for (const [name, values] of [['rowPlace', rows.places], ['rowRange', rows.ranges]] as const) {
      const attribute = this.geometry.getAttribute(name) as BufferAttribute;
      attribute.copyArray(values);
      attribute.needsUpdate = true;
    }
    this.entries.value.dispose();
    this.entries.value = textureOf(rows.entries);
  }

  dispose() { this.entries.value.dispose(); }
}

function textureOf(entries: Float32Array): DataTexture {
  const down = Math.max(1, Math.ceil(entries.length / perEntry / entriesAcross)), values = new Float32Array(perEntry * entriesAcross * down);
  values.set(entries);
  const texture = new DataTexture(values, texels * entriesAcross, down, RGBAFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}

/** What joints do to a surface with rows. */
export class RowMotion {
  private motions: Float32Array;
  private texture: DataTexture;

  constructor(private surface: RowSurface, joints: number) {
    this.motions = new Float32Array(16 * joints);
    this.texture = new DataTexture(this.motions, 4, joints, RGBAFormat, FloatType);
  }
  take(matrices: Float32Array) {
    jointMotions(matrices, this.motions);
    this.texture.needsUpdate = true;
  }
  bend(material: Material) {
    patch(material, 'rows', { rowEntries: this.surface.entries, jointMotions: { value: this.texture } }, rowLines);
  }
  dispose() { this.texture.dispose(); }
}

/** A surface that the engine bends; by its weights alone where it is given none, as in small pictures. */
export class PosedSurface {
  private given = { value: false };

  constructor(private geometry: BufferGeometry, vertices: number) {
    for (const name of ['posedPosition', 'posedNormal']) geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * vertices), 3));
  }

  /** Positions, then normals. */
  take(posed: Float32Array) {
    const half = posed.length / 2, position = this.attribute('posedPosition'), normal = this.attribute('posedNormal');
    this.given.value = half === position.array.length && half > 0;
    if (!this.given.value) return;
    position.copyArray(posed.subarray(0, half));
    normal.copyArray(posed.subarray(half));
    position.needsUpdate = normal.needsUpdate = true;
  }
  bend(material: Material) {
    patch(material, 'posed', { posedGiven: this.given }, {
      declare: '#include <skinning_pars_vertex>\nattribute vec3 posedPosition, posedNormal;\nuniform bool posedGiven;',
      begin: '#include <skinbase_vertex>',
      normal: '#include <skinnormal_vertex>\nif (posedGiven) objectNormal = posedNormal;',
      position: '#include <skinning_vertex>\nif (posedGiven) transformed = posedPosition;',
    });
  }
  private attribute(name: string) { return this.geometry.getAttribute(name) as BufferAttribute; }
}

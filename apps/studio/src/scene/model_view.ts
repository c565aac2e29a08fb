// The model's surface, moved by the engine's matrices on the graphics card.
import {
  Bone, DetachedBindMode, BufferAttribute, BufferGeometry, Color, Group, Material, Matrix4, MeshStandardMaterial, Skeleton, SkinnedMesh, Texture,
} from 'three';
import type { Display } from '../app/state';
import type { PaintedWeights, SurfaceModel, SurfaceParts } from '../engine/messages';
import { PosedSurface, RowMotion, RowSurface } from './deformation';
import { heatColor, jointColor } from './palette';
import { readyForStretch, showStretch } from './stretch';
import { loadTexture, plainMaterial } from './surface_look';

/** Takes its matrices as they come from the engine instead of making them from bones. */
class EngineSkeleton extends Skeleton {
  constructor(joints: number) {
    super(Array.from({ length: joints }, () => new Bone()));
  }
  override update() {}
  take(matrices: Float32Array) {
    if (!this.boneTexture) this.computeBoneTexture();
    this.boneMatrices?.set(matrices);
    if (this.boneTexture) this.boneTexture.needsUpdate = true;
  }
}

/** The surface once more, in one material, moved by matrices of its own. */
export interface Likeness {
  root: Group;
  joints: number;
  take(matrices: Float32Array): void;
  dispose(): void;
}

const heatSteps = 255; // from cold to hot

export class ModelView {
  readonly root = new Group();
  onChange: () => void = () => {};

  private model: SurfaceModel | null = null;
  private skeleton: EngineSkeleton | null = null;
  private meshes: SkinnedMesh<BufferGeometry, MeshStandardMaterial>[] = [];
  private geometry: BufferGeometry | null = null;
  /** What bends the surface in place of its weights. */
  private rows: { surface: RowSurface; motion: RowMotion } | null = null;
  private posedSurface: PosedSurface | null = null;

  show(model: SurfaceModel, joints: number) {
    this.clear();
    this.model = model;
    this.skeleton = new EngineSkeleton(joints);
    this.geometry = new BufferGeometry();
    const add = (name: string, attribute: BufferAttribute) => this.geometry?.setAttribute(name, attribute);
    add('position', new BufferAttribute(model.positions, 3));
    add('normal', new BufferAttribute(model.normals, 3));
    if (model.uvs.length > 0) add('uv', new BufferAttribute(model.uvs, 2));
    add('skinIndex', new BufferAttribute(model.joints, 4));
    add('skinWeight', new BufferAttribute(model.weights, 4));
    add('color', new BufferAttribute(new Float32Array(model.positions.length).fill(1), 3));
    const { deformation } = model;
    if (deformation.form === 'rows') {
      const surface = new RowSurface(deformation, this.geometry);
      this.rows = { surface, motion: new RowMotion(surface, joints) };
    }
    if (deformation.form === 'engine') this.posedSurface = new PosedSurface(this.geometry, model.positions.length / 3);
    for (const part of model.parts) this.meshes.push(this.addPart(part));
  }

  /** Posed: the surface, where the engine bends it (Session.posed). */
  take(matrices: Float32Array, posed: Float32Array = new Float32Array()) {
    if (!this.skeleton || matrices.length !== 16 * this.skeleton.bones.length) return;
    this.skeleton.take(matrices);
    this.rows?.motion.take(matrices);
    this.posedSurface?.take(posed);
  }

  /** Other weights for the surface that is shown. */
  takeWeights({ weights, joints, deformation }: PaintedWeights, display: Display, selected: number | null) {
    if (!this.model || !this.geometry || weights.length !== this.model.weights.length) return;
    this.model.weights.set(weights);
    this.model.joints.set(joints);
    if (deformation?.form === 'rows') {
      this.model.deformation = deformation;
      this.rows?.surface.take(deformation);
    }
    for (const name of ['skinIndex', 'skinWeight']) this.geometry.getAttribute(name).needsUpdate = true;
    if (display === 'weights') this.paint(null);
    if (display === 'joint-weights') this.paint(selected ?? 0);
  }

  setDisplay(display: Display, selected: number | null, wireframe: boolean, parts: SurfaceParts | null = null) {
    const byParts = display === 'parts' && parts?.partOf.length === (this.model?.triangles.length ?? 0) / 3 ? parts : null;
    const painted = display === 'weights' || display === 'joint-weights' || byParts !== null, plain = painted || display === 'stretch';
    if (byParts) this.paintParts(byParts);
    else if (painted) this.paint(display === 'joint-weights' ? selected ?? 0 : null);
    for (const mesh of this.meshes) {
      const material = mesh.material;
      const own = mesh.userData['color'] as Color;
      material.color.copy(plain ? new Color(1, 1, 1) : own);
      material.map = plain ? null : (mesh.userData['map'] as Texture | null);
      material.vertexColors = painted;
      material.transparent = display === 'handles';
      material.opacity = display === 'handles' ? 0.36 : 1;
      material.wireframe = wireframe;
      showStretch(material, display === 'stretch');
      material.needsUpdate = true;
    }
  }

  /** Of the model that is shown; it has this one's geometry, so it is of no use once another model is. */
  likeness(material: Material): Likeness {
    const skeleton = new EngineSkeleton(this.skeleton!.bones.length), root = new Group();
    const motion = this.rows && new RowMotion(this.rows.surface, skeleton.bones.length);
    motion?.bend(material);
    for (const { geometry } of this.meshes) {
      const mesh = new SkinnedMesh(geometry, material);
      mesh.bind(skeleton, new Matrix4());
      mesh.bindMode = DetachedBindMode;
      mesh.frustumCulled = false;
      root.add(mesh);
    }
    return {
      root, joints: skeleton.bones.length,
      take: (matrices) => {
        skeleton.take(matrices);
        motion?.take(matrices);
      },
      dispose: () => {
        skeleton.dispose();
        motion?.dispose();
        material.dispose();
      },
    };
  }

  /** Parts by their place in the model. */
  hide(parts: ReadonlySet<number>) {
    this.meshes.forEach((mesh, part) => { mesh.visible = !parts.has(part); });
  }

  private addPart(part: SurfaceModel['parts'][number]) {
    const geometry = new BufferGeometry();
    for (const [name, attribute] of Object.entries(this.geometry!.attributes)) geometry.setAttribute(name, attribute);
    geometry.setIndex(new BufferAttribute(this.model!.triangles.subarray(part.first, part.first + part.count), 1));
    const source = part.material === null ? null : this.model!.materials[part.material] ?? null;
    const material = plainMaterial(source), color = material.color.clone();
    (this.rows?.motion ?? this.posedSurface)?.bend(material);
    readyForStretch(material);
    const mesh = new SkinnedMesh(geometry, material);
    mesh.bind(this.skeleton!, new Matrix4());
    mesh.bindMode = DetachedBindMode; // the group that it is in moves it, too
    mesh.frustumCulled = false;
    mesh.castShadow = true;
    mesh.userData = { color, map: null };
    this.root.add(mesh);
    const file = source?.texture === null || source === null ? undefined : this.model!.textures[source.texture];
    if (file) this.addTexture(mesh, file);
    return mesh;
  }

  private addTexture(mesh: SkinnedMesh<BufferGeometry, MeshStandardMaterial>, file: Uint8Array) {
    loadTexture(file).then((texture) => {
      mesh.userData['map'] = texture;
      if (!mesh.material.vertexColors) mesh.material.map = texture;
      mesh.material.needsUpdate = true;
      this.onChange();
    }, () => { /* an image that the browser cannot read: the plain colour stays */ });
  }

  /** Each vertex in the colours of its joints, or as hot as one joint holds it. */
  private paint(joint: number | null) {
    const model = this.model!;
    const colors = this.geometry!.getAttribute('color') as BufferAttribute;
    const palette = Array.from({ length: this.skeleton!.bones.length }, (_, j) => jointColor(j));
    const heat = Array.from({ length: heatSteps + 1 }, (_, step) => heatColor(step / heatSteps));
    const color = new Color();
    for (let v = 0; v < colors.count; ++v) {
      let own = 0;
      color.setRGB(0, 0, 0);
      for (let i = 4 * v; i < 4 * v + 4; ++i) {
        const weight = model.weights[i] ?? 0;
        if (model.joints[i] === joint) own += weight;
        const of = palette[model.joints[i] ?? 0];
        if (of && joint === null) color.r += weight * of.r, color.g += weight * of.g, color.b += weight * of.b;
      }
      if (joint !== null) color.copy(heat[Math.round(heatSteps * Math.min(1, own))]!);
      colors.setXYZ(v, color.r, color.g, color.b);
    }
    colors.needsUpdate = true;
  }

  /** Each vertex in the colour of one part that it is in. */
  private paintParts({ names, partOf }: SurfaceParts) {
    const { triangles } = this.model!, colors = this.geometry!.getAttribute('color') as BufferAttribute;
    const palette = names.map((_, part) => jointColor(part));
    triangles.forEach((vertex, corner) => {
      const { r, g, b } = palette[partOf[Math.floor(corner / 3)]!]!;
      colors.setXYZ(vertex, r, g, b);
    });
    colors.needsUpdate = true;
  }

  clear() {
    for (const mesh of this.meshes) {
      (mesh.userData['map'] as Texture | null)?.dispose();
      (mesh.material as Material).dispose();
      mesh.geometry.dispose();
      this.root.remove(mesh);
    }
    this.meshes = [];
    this.skeleton?.dispose();
    this.rows?.motion.dispose();
    this.rows?.surface.dispose();
    this.rows = this.posedSurface = null;
    this.geometry?.dispose();
  }
}

// Models in three.js as they stand at moments of their clips.
import { AnimationMixer, Box3, Vector3 } from 'three';

const kMostMoments = 24;

const standing = new WeakMap(); // how models stood when they were first shown

// Clips leave what they do not move as the one before had it.
function stand(root) {
  if (!standing.has(root)) {
    const all = [];
    root.traverse((object) => all.push([object, object.position.clone(), object.quaternion.clone(), object.scale.clone(), [...(object.morphTargetInfluences ?? [])]]));
    standing.set(root, all);
  }
  for (const [object, position, quaternion, scale, influences] of standing.get(root)) {
    object.position.copy(position);
    object.quaternion.copy(quaternion);
    object.scale.copy(scale);
    influences.forEach((influence, i) => { object.morphTargetInfluences[i] = influence; });
  }
}

/** Lets a model stand as its clip of that name says (the first, where it has none of the name). */
export function show({ root, clips }, name, seconds) {
  stand(root);
  const clip = clips.find((one) => one.name === name) ?? clips[0];
  if (clip) {
    const mixer = new AnimationMixer(root);
    const action = mixer.clipAction(clip);
    action.setLoop(2200).clampWhenFinished = true; // LoopOnce
    action.play();
    mixer.setTime(seconds);
  }
  root.updateMatrixWorld(true);
}

/** In the order of the file. */
export function meshesOf(root) {
  const meshes = [];
  root.traverse((object) => object.isMesh && meshes.push(object));
  return meshes.sort((a, b) => (a.ID ?? 0) - (b.ID ?? 0)); // FBX': others have none
}

/** The corners of all triangles in the world, mesh after mesh. */
export function corners(root) {
  const found = [];
  for (const mesh of meshesOf(root)) {
    if (mesh.isSkinnedMesh) mesh.skeleton.update();
    const { index } = mesh.geometry, count = (index ?? mesh.geometry.attributes.position).count;
    for (let i = 0; i < count; ++i) {
      found.push(mesh.getVertexPosition(index ? index.getX(i) : i, new Vector3()).applyMatrix4(mesh.matrixWorld));
    }
  }
  return found;
}

/** Some of a clip's keys. */
function momentsOf(clip) {
  if (!clip) return [0];
  const keys = [...new Set(clip.tracks.flatMap((track) => [...track.times]))].sort((a, b) => a - b);
  const step = Math.max(1, Math.ceil(keys.length / kMostMoments));
  return keys.filter((_, i) => i % step === 0);
}

/** How far the corners of models are at most from those of another at keys of a clip of that one, over its size. */
export function largestDistances(expected, models, clip, shownName) {
  const largest = models.map(() => 0);
  let size = 0;
  for (const seconds of momentsOf(clip)) {
    show(expected, clip?.name, seconds);
    const wanted = corners(expected.root), isPlaced = wanted.map(({ x }) => Number.isFinite(x)); // not without weights
    size = Math.max(size, new Box3().setFromPoints(wanted.filter((_, i) => isPlaced[i])).getSize(new Vector3()).length());
    models.forEach((model, m) => {
      show(model, shownName, seconds);
      const found = corners(model.root);
      if (wanted.length !== found.length) throw new Error(`has ${found.length / 3} triangles for ${wanted.length / 3}`);
      wanted.forEach((place, i) => { if (isPlaced[i]) largest[m] = Math.max(largest[m], place.distanceTo(found[i])); });
    });
  }
  return largest.map((distance) => distance / size);
}

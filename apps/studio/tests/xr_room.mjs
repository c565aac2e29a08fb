// The room in which emulated devices stand: a floor that goes on for ever, and a table. Runs in the page.

/** Metres: a level box top. */
export const table = { height: 0.7, x: [0.6, 1.6], z: [-2, -1] };

/** What a device's hit tests meet. */
export function furnish(device, { height, x: wide, z: deep }) {
  const room = { floor: true };
  /** By a ray, the nearest first. */
  function meets(origin, direction) {
    const found = [];
    const onLevel = (level, inside) => {
      const t = (level - origin[1]) / direction[1], at = origin.map((value, i) => value + t * direction[i]);
      if (t > 0 && Number.isFinite(t) && inside(at)) found.push({ t, at });
    };
    if (room.floor) onLevel(0, () => true);
    if (room.floor) onLevel(height, ([x, , z]) => x > wide[0] && x < wide[1] && z > deep[0] && z < deep[1]);
    return found.sort((a, b) => a.t - b.t).map(({ at: [x, y, z] }) => new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1]));
  }
  device.installSEM(class {
    trackedPlanes = new Set();
    trackedMeshes = new Set();
    environmentCanvas = Object.assign(document.createElement('canvas'), { hidden: true });
    render() {}
    computeHitTestResults(m) { return meets([m[12], m[13], m[14]], [-m[8], -m[9], -m[10]]); }
  });
  return { room, meets };
}

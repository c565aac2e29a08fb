// What joints do, taken apart: how each turns, and how it stretches before that.

const rigid = 1e-5; // largest entry of what a rotation's matrix has beside that, by the rounding of 32 bits
const steps = 12; // of Newton's method at most; rotations with ordinary scales take five

/** Three columns of three, of a matrix of 16 numbers. */
type Columns = [number, number, number, number, number, number, number, number, number];

const cofactors = ([a, b, c, d, e, f, g, h, i]: Columns): Columns => [
  e * i - f * h, f * g - d * i, d * h - e * g, c * h - b * i, a * i - c * g, b * g - a * h, b * f - c * e, c * d - a * f, a * e - b * d,
];
const dot = (a: Columns, i: number, b: Columns, k: number) => a[i]! * b[k]! + a[i + 1]! * b[k + 1]! + a[i + 2]! * b[k + 2]!;

/** How far its columns are from unit vectors at right angles. */
function skewness(m: Columns): number {
  let most = 0;
  for (let i = 0; i < 3; ++i) for (let k = i; k < 3; ++k) most = Math.max(most, Math.abs(dot(m, 3 * i, m, 3 * k) - (i === k ? 1 : 0)));
  return most;
}

/** The rotation of the polar decomposition, by Newton's method (Higham 1986); no turn where the matrix is flat. */
function rotationOf(m: Columns): Columns {
  let x = m;
  for (let step = 0; step < steps; ++step) {
    const c = cofactors(x), determinant = dot(x, 0, c, 0);
    if (!(Math.abs(determinant) > 1e-9)) return [1, 0, 0, 0, 1, 0, 0, 0, 1];
    x = x.map((value, i) => 0.5 * (value + c[i]! / determinant)) as Columns;
    if (skewness(x) < 1e-9) break;
  }
  return dot(x, 0, cofactors(x), 0) < 0 ? x.map((value) => -value) as Columns : x; // a mirror's is part of its stretch
}

/** x, y, z, w (Shepperd 1978). */
function quaternionOf([m00, m10, m20, m01, m11, m21, m02, m12, m22]: Columns): [number, number, number, number] {
  const trace = m00 + m11 + m22;
  if (trace >= Math.max(m00, m11, m22)) {
    const s = 2 * Math.sqrt(Math.max(0, 1 + trace));
    return [(m21 - m12) / s, (m02 - m20) / s, (m10 - m01) / s, s / 4];
  }
  if (m00 >= m11 && m00 >= m22) {
    const s = 2 * Math.sqrt(1 + m00 - m11 - m22);
    return [s / 4, (m01 + m10) / s, (m02 + m20) / s, (m21 - m12) / s];
  }
  if (m11 >= m22) {
    const s = 2 * Math.sqrt(1 + m11 - m00 - m22);
    return [(m01 + m10) / s, s / 4, (m12 + m21) / s, (m02 - m20) / s];
  }
  const s = 2 * Math.sqrt(1 + m22 - m00 - m11);
  return [(m02 + m20) / s, (m12 + m21) / s, s / 4, (m10 - m01) / s];
}

/** Of each joint's matrix of 16 numbers 16 others: its rotation as a quaternion; then the three columns of its stretch less
 *  the identity, each with a 0 behind. */
export function jointMotions(matrices: Float32Array, motions: Float32Array) {
  for (let at = 0; at < matrices.length; at += 16) {
    const m = [0, 1, 2, 4, 5, 6, 8, 9, 10].map((i) => matrices[at + i]!) as Columns;
    const isRigid = skewness(m) < rigid && dot(m, 0, cofactors(m), 0) > 0, rotation = isRigid ? m : rotationOf(m);
    motions.set(quaternionOf(rotation), at);
    for (let column = 0; column < 3; ++column) {
      for (let row = 0; row < 3; ++row) {
        motions[at + 4 + 4 * column + row] = isRigid ? 0 : dot(rotation, 3 * row, m, 3 * column) - (row === column ? 1 : 0);
      }
    }
  }
}

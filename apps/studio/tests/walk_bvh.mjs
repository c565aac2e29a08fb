// A person of 1.7 m who walks on the spot, as the text of a BVH file: for the tests and for the pictures.
const tree = ['hips', [0, 0.95, 0], [
  ['spine', [0, 0.12, 0], [['chest', [0, 0.16, 0], [
    ['neck', [0, 0.22, 0], [['head', [0, 0.1, 0], []]]],
    ['leftShoulder', [0.04, 0.18, 0], [['leftUpperArm', [0.12, 0, 0], [['leftLowerArm', [0.27, 0, 0], [['leftHand', [0.25, 0, 0], []]]]]]]],
    ['rightShoulder', [-0.04, 0.18, 0], [['rightUpperArm', [-0.12, 0, 0], [['rightLowerArm', [-0.27, 0, 0], [['rightHand', [-0.25, 0, 0], []]]]]]]],
  ]]]],
  ['leftUpperLeg', [0.09, -0.04, 0], [['leftLowerLeg', [0, -0.42, 0], [['leftFoot', [0, -0.41, 0], [['leftToes', [0, -0.06, 0.13], []]]]]]]],
  ['rightUpperLeg', [-0.09, -0.04, 0], [['rightLowerLeg', [0, -0.42, 0], [['rightFoot', [0, -0.41, 0], [['rightToes', [0, -0.06, 0.13], []]]]]]]],
]];

/** Angles in degrees about z, x, y at a share of the stride. */
function turns(joint, share) {
  const swing = Math.sin(2 * Math.PI * share), lift = Math.cos(2 * Math.PI * share);
  const side = joint.startsWith('left') ? 1 : -1;
  if (joint.endsWith('UpperArm')) return [-68 * side, 0, 22 * swing];
  if (joint.endsWith('LowerArm')) return [0, 0, -25 * side];
  if (joint.endsWith('UpperLeg')) return [0, -28 * swing * side - 8, 0];
  if (joint.endsWith('LowerLeg')) return [0, 12 + 34 * Math.max(0, lift * side), 0];
  if (joint === 'chest') return [0, 4, -7 * swing];
  return [0, 0, 0];
}

export function walkBvh(frames = 31, framesPerSecond = 30) {
  const order = [];
  const write = ([name, offset, children], depth) => {
    const pad = '  '.repeat(depth);
    order.push(name);
    const channels = (depth === 0 ? '6 Xposition Yposition Zposition ' : '3 ') + 'Zrotation Xrotation Yrotation';
    const inner = children.length > 0
      ? children.map((child) => write(child, depth + 1)).join('')
      : `${pad}  End Site\n${pad}  {\n${pad}    OFFSET 0 0.05 0\n${pad}  }\n`;
    return `${pad}${depth === 0 ? 'ROOT' : 'JOINT'} ${name}\n${pad}{\n${pad}  OFFSET ${offset.join(' ')}\n${pad}  CHANNELS ${channels}\n${inner}${pad}}\n`;
  };
  const hierarchy = write(tree, 0);
  const lines = Array.from({ length: frames }, (_, f) => {
    const share = f / (frames - 1), height = 0.93 + 0.015 * Math.cos(4 * Math.PI * share);
    return [0, height, 0, ...order.flatMap((joint) => turns(joint, share))].map((value) => value.toFixed(5)).join(' ');
  });
  return `HIERARCHY\n${hierarchy}MOTION\nFrames: ${frames}\nFrame Time: ${(1 / framesPerSecond).toFixed(6)}\n${lines.join('\n')}\n`;
}

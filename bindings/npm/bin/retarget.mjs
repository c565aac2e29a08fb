// npx limber retarget MODEL MOTION... -o OUT: limber retarget with its default options, by a session of the engine.
// The clips have the values of the native program's. A session knows a model by its bind pose and its surface: it turns no
// model upright, and moves no skeleton without a mesh.
import { basename } from 'node:path';
import { load } from '../dist/index.mjs';
import { Refused } from './rig_options.mjs';

export const retargetHelp = `Put motions onto a rigged character (the engine as WebAssembly)
Usage: limber retarget MODEL.glb MOTIONS... -o OUT.glb

Options:
  -o,--output FILE          the .glb to write; - is standard output
  -q,--quiet                print nothing but errors
  -h,--help                 Print this help message and exit

Motions: .bvh, and GLB and glTF in one file with animations; each becomes a clip named after it.
The native program has more options, reads other formats and moves skeletons without a mesh.

Example:
  npx limber retarget hero.glb walk.bvh -o walking.glb`;

function check([model, ...motions], options) {
  if (!model || motions.length === 0 || options.output === undefined) throw new Refused('retarget takes a rigged model, motions and -o OUT.glb');
  if (options.output !== '-' && !/\.glb$/i.test(options.output)) throw new Refused(`${options.output}: a .glb is written, or - for standard output`);
  for (const name of Object.keys(options)) {
    if (!['output', 'quiet'].includes(name)) throw new Refused(`--${name} is no option of retarget here; the native program has more`);
  }
}

/** All clips of a motion: the session takes the first by itself. */
function addClips(done, session, bytes, name) {
  const before = done(session.run({ do: 'reset_pose' })).state.motions.length;
  const motion = done(session.addMotion(bytes, name, true)).state.motions[before];
  for (const { name: clip } of motion.clips.slice(1)) done(session.run({ do: 'retarget', motion: motion.name, clip }));
}

/** files: { read, write }; failed(line) gives the error of a file or of the engine. */
export async function retarget(given, options, { read, write, failed, tellWarnings }) {
  check(given, options);
  const [model, ...motions] = given, { output, quiet } = options;
  const contents = given.map(read);
  const done = (result) => {
    if (result.ok) return result;
    const { where, message, remedy } = result.error;
    throw failed(`${where ? `${where}: ` : ''}${message}${remedy ? ` (${remedy})` : ''}`);
  };
  const session = (await load({ optionNames: 'program' })).createSession();
  if (!done(session.open(contents[0], basename(model))).state.own_rig) throw failed(`${basename(model)}: the model has no rig to move (limber rig makes one)`);
  motions.forEach((motion, i) => addClips(done, session, contents[i + 1], basename(motion)));
  const { state } = done(session.run({ do: 'reset_pose' }));
  const { bytes } = done(session.export('glb'));
  if (output === '-') process.stdout.write(bytes);
  else write([{ path: output, content: bytes }]);
  if (quiet) return;
  tellWarnings(state.warnings);
  if (output !== '-') console.log(`written: ${output}`);
}

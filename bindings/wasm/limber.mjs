// The engine as WebAssembly, for a page, a worker or Node.
//
//   const limber = await loadLimber(wasmBytes);
//   const result = limber.rig(glbBytes, 'dragon.glb', { handles: 20 });
//   if (result.ok) save(result.glb, result.report); else tell(result.error.message);
//
//   const session = limber.createSession();
//   session.run({ do: 'open_sample', name: 'biped' });
//   session.run({ do: 'set_turn', joint: 'handle_03.L', turn: [0, 0, 30], relative: true });
//   save(session.export('glb').bytes);
//
// A session is a scene: further models come beside the first by add() and the command add_sample, and what is done is done
// to the member that is chosen.
import createEngine from './limber_engine.mjs';

/**
 * As limber/actions/rig/rig_request.h has them. template: auto, a name, or a file with a skeleton (.json, .glb, .bvh, ...), by
 * its name and content; pins: where joints of a template must be, in world space.
 * @typedef {'x' | '+x' | '-x' | 'y' | '+y' | '-y' | 'z' | '+z' | '-z'} Axis
 * @typedef {{ handles?: number, maxInfluences?: number, rigger?: string, template?: string | { name: string, bytes: Uint8Array },
 *             skinning?: string, pieces?: 'auto' | 'rigid' | 'soft', existingRig?: 'refuse' | 'replace' | 'keep-skeleton',
 *             up?: Axis, front?: Axis, pins?: { [joint: string]: Vector }, upright?: boolean, chains?: boolean,
 *             target?: 'gltf' | 'unreal' | 'unity' | 'godot' | 'blender' | 'vrm' | 'mixamo' | 'metahuman' | 'rigify'
 *                     | 'actorcore' | 'roblox' }} RigOptions
 * @typedef {'nothing-to-undo' | 'nothing-to-redo' | 'joint-dragged' | 'no-model' | 'no-clip' | 'name-missing'
 *             | 'name-taken' | 'only-root' | 'joint-below-itself' | 'last-member' | 'holds-itself'
 *             | 'model-not-mirrored' | 'nothing-mirrored' | 'joint-locked' | 'pin-outside' | 'handle-count'
 *             | 'too-many-joints' | 'key-before-clip' | 'no-motion' | 'motion-too-long' | 'unlike-bodies'
 *             | 'nothing-matched' | 'match-without-joint' | 'matched-twice' | 'joint-matched-twice'
 *             | 'too-few-matched' | 'unlike-pose' | 'unfit-pose' | 'no-pose-file' | 'no-limits-file'
 *             | 'limits-of-other' | 'empty-file' | 'cut-file' | 'no-glb' | 'unknown-format' | 'no-surface'
 *             | 'out-of-memory' | 'no-bvh-name' | 'no-rig' | 'no-limbs' | 'unlike-rigs' | 'no-animation'} ErrorKind as limber/core/known_error.h has them
 * @typedef {{ code: string, message: string, where: string, remedy: string,
 *             kind?: ErrorKind, values?: { [name: string]: string } }} LimberError kind: where it is one of those that people meet
 * @typedef {{ ok: false, error: LimberError }} Failure
 * The report is the one of docs/report.md, from "methods" on.
 * @typedef {{ ok: true, glb: Uint8Array, report: object } | Failure} RigResult
 *
 * Vectors in world space, metres.
 * @typedef {[number, number, number]} Vector
 * @typedef {{ origin: Vector, direction: Vector }} Ray
 * @typedef {{ do: string, [field: string]: unknown }} Command as limber/session/command.h has them
 *
 * As limber/session/session_state.h describes it.
 * @typedef {{ name: string, parent: number, part: string | null, color: Vector, radius: number, rest: Vector }} SessionJoint
 * @typedef {{ name: string, vertices: number, triangles: number, box: { min: Vector, max: Vector }, own_rig: boolean,
 *             rigger: string, skinning: string, most_handles: number, suggestions: number[], joints: SessionJoint[],
 *             motions: { name: string, joints: { name: string, parent: number }[],
 *                        clips: { name: string, duration: number }[] }[],
 *             clips: { name: string, duration: number, recorded: boolean, keys: number[],
 *                      joint_keys: { joint: number, seconds: number[] }[], interpolation: 'step' | 'linear' | 'cubic',
 *                      source: { motion: string, clip: string, method: string, reach: number,
 *                                contacts: boolean } | null,
 *                      sequence: { seconds: number, clips: { clip: string, from: number, to: number }[] } | null,
 *                      feet: { foot: string, part: string | null, planted: [number, number][], edited: boolean }[] }[],
 *             clip: number | null, seconds: number, snap: { degrees: number, step: number },
 *             match: { part: string, source: string[], target: string[], confidence: number, by: string }[],
 *             limits: { [joint: string]: { type: string, [field: string]: unknown } },
 *             limit_outlines: { joint: number, length: number, closed: boolean, rim: Vector[] }[],
 *             solver: string, deformer: string, ik: boolean, limited: boolean,
 *             tasks: { task: string, outcome: string, met: boolean }[], targets: { joint: number, position: Vector }[],
 *             pins: { joint: string, position: Vector }[], doubts: number[], locked: number[], edited_rig: boolean,
 *             gaps: { rms: number, p95: number, worst: number, beyond: number, limit: number,
 *                     parts: { part: string, area: number, rms: number, beyond: number }[] } | null, animated: boolean,
 *             dragged: number | null,
 *             posed: boolean, undo: string | null, redo: string | null,
 *             warnings: { kind: string, message: string, where: string, count: number }[],
 *             member: number, members: SceneMember[] }} SessionState of the chosen member, as scene_state.h has it
 * @typedef {{ position: Vector, turn: Vector, scale: number }} Placement metres, a rotation vector in degrees
 * @typedef {{ name: string, source: string, joints: { name: string, part: string | null }[], placement: Placement,
 *             attached: { to: number, joint: string } | null, clip: string | null, duration: number,
 *             box: { min: Vector, max: Vector } }} SceneMember
 *
 * @typedef {'rigger' | 'skinning' | 'deformer' | 'solver' | 'retargeting'} MethodKind
 * @typedef {{ [kind in MethodKind]: { name: string, summary: string }[] }} Methods
 * @typedef {{ joints: number, influences: number, smoothness: number, stretch: number, volume: number,
 *             target_distance: number | null,
 *             motion: { bone_direction_degrees: number, end_effector_share: number,
 *                       sliding_centimetres_per_second: number, penetration_millimetres: number, jerk_ratio: number,
 *                       contact_agreement: number, [figure: string]: number | boolean } | null }} Measures
 *
 * Of docs/report.md, `rig_check`; advice: what to do, what matters most first, empty where nothing is in the way.
 * @typedef {{ kinds: { name: string, confidence: number }[], sure: boolean, pose: 'T' | 'A' | 'hanging' | 'other' | null,
 *             missing: string[], grown_together: { parts: [string, string], length: number }[], doubts: string[], upright: boolean,
 *             pieces: number, inner_shell_vertices: number, has_rig: boolean, advice: SessionState['warnings'],
 *             warnings: SessionState['warnings'] }} RigCheck
 *
 * skin: 16 numbers for each joint, a matrix column by column; state: null after a drag's update
 * or turn and a moment of a clip; pinned: joints that hold on to a place.
 * @typedef {{ ok: true, state: SessionState | null, skin: Float32Array, pinned: number[] } | Failure} StepResult
 * @typedef {{ joint: number, on_handle: boolean, position: Vector, distance: number,
 *             inside: Vector }} PickHit
 * @typedef {{ dab: [number, number, number], position: Vector, normal: Vector, joint: number,
 *             inside: Vector }} SurfaceHit dab: the same
 *   point as PaintWeights names it
 * @typedef {{ seconds: number, kind: 'auto' | 'flat' | 'free', turn: Vector, offset: Vector }} Tangent
 * @typedef {{ weights: Float32Array, joints: Uint16Array }} WeightArrays four influences for each vertex
 * @typedef {{ names: string[], partOf: Uint32Array }} SurfaceParts
 * @typedef {{ positions: Float32Array, normals: Float32Array, uvs: Float32Array, triangles: Uint32Array,
 *             weights: Float32Array, joints: Uint16Array,
 *             parts: { name: string, first: number, count: number, material: number | null }[],
 *             materials: { name: string, color: [number, number, number, number], texture: number | null }[],
 *             textures: Uint8Array[], deformation: Deformation }} SurfaceModel four influences for each vertex; the files of the textures
 *
 * How the surface bends in drawing: by its weights (linear blend); as the rows say (DeformRows in limber/deform/deformer.h);
 * or as the engine gives it in posed() for each frame. ranges: of each vertex its first entry and how many there are; entries:
 * 20 numbers each, the joints and their moments.
 * @typedef {{ form: 'weights' } | { form: 'engine' }
 *           | { form: 'rows', places: Float32Array, ranges: Float32Array, entries: Float32Array }} Deformation
 * @typedef {'glb' | 'obj' | 'stl' | 'ply' | 'usdz' | 'bvh' | 'session'} ExportFormat
 * @typedef {ReturnType<typeof createSession>} Session
 *
 * matrices: of each row (frame) and joint the first three rows of its matrix, 12 numbers. A body shows at frame f, of 0 to frames, row
 * `row` + f of its table; place: its matrix, column by column.
 * @typedef {{ frames: number, seconds: number, builds: SurfaceModel[],
 *             tables: { frames: number, joints: number, matrices: Float32Array }[],
 *             bodies: { build: number, table: number, row: number, place: number[] }[] }} Crowd
 *
 * Decoders of compressed glTF, which the engine asks while it opens a file; they answer at once. A file that needs one that
 * is not there is refused. Both give null for broken data.
 * @typedef {{ faces: number, points: number, indices: () => Uint32Array, components: (attribute: number) => number,
 *             values: (attribute: number, componentType: number) => Uint8Array | null, free: () => void }} DracoMesh
 *   by Draco's unique ids of attributes; components: 0 where there is none; values: of all points, as the type that glTF
 *   numbers so, one behind the other
 * @typedef {{ draco?: (data: Uint8Array) => DracoMesh | null,
 *             meshopt?: (data: Uint8Array, count: number, stride: number, mode: string, filter: string) => Uint8Array | null }} Codecs
 */

/**
 * @param {BufferSource | WebAssembly.Module} wasm limber_engine.wasm, or its first part, as its content or compiled
 * @param {{ onProgress?: (stage: string, fraction: number) => void, codecs?: Codecs, rest?: () => BufferSource | WebAssembly.Module,
 *           shapeWeights?: () => Uint8Array, onInstance?: (instance: WebAssembly.Instance) => void,
 *           optionNames?: 'javascript' | 'program' }} [given]
 *   codecs may be put in later; rest: gives the other part of an engine in two (split_engine.mjs), asked once, by the first
 *   call that needs it; shapeWeights: gives shapes.lrd, asked by the first call that fits a template or checks for one;
 *   optionNames: how errors name options, existingRig: 'replace' or --replace-rig; what onProgress and shapeWeights throw stops
 *   the call, and is thrown by it
 */
export async function loadLimber(wasm, given = {}) {
  const { rest, onInstance, optionNames, onProgress, shapeWeights, ...settings } = given;
  const thrown = []; // by the listener, during the call that runs
  if (onProgress) settings.onProgress = listening(onProgress, thrown);
  if (shapeWeights) settings.shapeWeights = giving(shapeWeights, thrown);
  const engine = await new Promise((resolve, reject) => {
    const instantiateWasm = (imports, done) => {
      instantiate(wasm, imports, rest).then((instance) => { onInstance?.(instance); done(instance); }).catch(reject);
      return {};
    };
    createEngine({ ...settings, instantiateWasm }).then(resolve, reject);
  });
  engine.thrown = thrown;
  if (optionNames === 'program') engine._limber_spell_options_as_program();
  return {
    /** @type {(file: Uint8Array, name: string, options?: RigOptions) => RigResult} */
    rig: (file, name, options = {}) => {
      const asked = rigInputs(options);
      if (!asked.ok) return asked;
      const result = call(engine, engine._limber_rig, [], file, name, ...asked.inputs);
      return result.ok ? { ok: true, glb: result.bytes, report: result.account } : result;
    },
    /** Networks of your own that read shapes (shapes.lrd), for all that is rigged from now on.
     *  @type {(file: Uint8Array, name?: string) => { ok: true } | Failure} */
    setShapeWeights: (file, name = 'shapes.lrd') => call(engine, engine._limber_set_shape_weights, [], file, name),
    /** The methods there are, by what they do. @type {() => Methods} */
    methods: () => call(engine, engine._limber_methods, []).account,
    /** Templates, how pieces that are joined to no other are bound, and other programs that saveModel knows.
     *  @type {() => { [kind in 'template' | 'pieces' | 'target']: { name: string, summary: string }[] }} */
    rigChoices: () => call(engine, engine._limber_rig_choices, []).account,
    /** The motions that the engine makes itself; the seconds are those of one repetition.
     *  @type {() => { name: string, summary: string, seconds: number }[]} */
    sampleMotions: () => call(engine, engine._limber_sample_motions, []).account,
    /** The poses that the engine makes itself, each as the text that apply_pose takes.
     *  @type {() => { name: string, summary: string, pose: string }[]} */
    samplePoses: () => call(engine, engine._limber_sample_poses, []).account,
    /** Is a PLY file whole? For readers that would not notice. @type {(file: Uint8Array, name: string) => { ok: true } | Failure} */
    checkPly: (file, name) => call(engine, engine._limber_check_ply, [], file, name),
    /** What draws a file of `limber crowd`: all bodies of a build at once, each by a row of matrices of its own. Another file has
     *  no bodies. @type {(file: Uint8Array, name: string) => { ok: true, crowd: Crowd } | Failure} */
    crowd: (file, name) => crowdOf(call(engine, engine._limber_crowd, [], file, name)),
    createSession: () => createSession(engine),
    /** Another session with the same document, to try something in; null during a drag.
     *  @type {(session: Session) => Session | null} */
    forkSession: (session) => {
      const handle = engine._limber_session_fork(session.handle);
      return handle === 0 ? null : createSession(engine, handle);
    },
  };
}

/** What the engine asks how far it is: a listener that throws stops the call, which throws that in the end. */
const listening = (onProgress, thrown) => (stage, fraction) => {
  if (thrown.length > 0) return true;
  try {
    onProgress(stage, fraction);
    return false;
  } catch (error) {
    thrown.push(error);
    return true;
  }
};

/** The bytes that the engine asks for, or nothing. */
const giving = (bytes, thrown) => () => {
  try {
    return bytesOf(bytes());
  } catch (error) {
    thrown.push(error);
    return null;
  }
};

const wrongCall = (message, where = '') => ({ ok: false, error: { code: 'bad-argument', message, where, remedy: '' } });

/** Bytes of a file however they are given; null where it is something else. */
function bytesOf(given) {
  if (given instanceof Uint8Array) return given;
  if (ArrayBuffer.isView(given)) return new Uint8Array(given.buffer, given.byteOffset, given.byteLength);
  if (Array.isArray(given)) return Uint8Array.from(given);
  const tag = Object.prototype.toString.call(given);
  return tag === '[object ArrayBuffer]' || tag === '[object SharedArrayBuffer]' ? new Uint8Array(given) : null;
}

/** Options of rig() as the engine takes them: JSON, and the file of a template. */
function rigInputs(options) {
  if (options === null || typeof options !== 'object') return wrongCall('must be an object', 'options');
  const { template, ...others } = options, isFile = template !== null && typeof template === 'object';
  if (isFile && (typeof template.name !== 'string' || template.name === '' || !bytesOf(template.bytes))) {
    return wrongCall("takes a name, or a file as { name: 'own.bvh', bytes }", 'template');
  }
  try {
    const json = JSON.stringify(isFile ? others : options);
    return { ok: true, inputs: isFile ? [json, template.bytes, template.name] : [json, new Uint8Array(), ''] };
  } catch (error) {
    return wrongCall(error.message.split('\n')[0], 'options');
  }
}

const compiled = (wasm) => (wasm instanceof WebAssembly.Module ? wasm : new WebAssembly.Module(wasm));

// The first part of an engine in two imports a placeholder for each function of the rest that it names: a number, its place
// in the table. Once the rest is there, it has put its functions in these places.
async function instantiate(wasm, imports, rest) {
  let instance = null, whole = false;
  const table = () => Object.values(instance.exports).find((one) => one instanceof WebAssembly.Table);
  const complete = () => {
    if (whole) return;
    new WebAssembly.Instance(compiled(rest()), { ...imports, primary: instance.exports });
    whole = true;
  };
  const placeholder = new Proxy({}, { get: (_, place) => (...values) => {
    complete();
    return table().get(Number(place))(...values);
  } });
  const first = wasm instanceof WebAssembly.Module ? wasm : await WebAssembly.compile(wasm);
  instance = await WebAssembly.instantiate(first, { ...imports, placeholder });
  return instance;
}

// Copies into the engine's memory; 0 where it has no more. The views on it are taken anew each time: memory that grows
// replaces them.
function put(engine, bytes) {
  const at = engine._malloc(Math.max(bytes.length, 1));
  if (at !== 0) engine.HEAPU8.set(bytes, at);
  return at;
}

const copyOut = (engine, at, size) => engine.HEAPU8.slice(at, at + size);

const outOfMemory = () => ({
  ok: false,
  error: { code: 'limit', kind: 'out-of-memory', values: {}, message: 'not enough memory', where: '', remedy: 'try a smaller model' },
});

// Calls with `leading` arguments as they are, then bytes and texts, each as a place and a size. Throws what a listener threw.
function call(engine, method, leading, ...inputs) {
  const text = new TextEncoder();
  const blocks = inputs.map((input) => (typeof input === 'string' ? text.encode(input) : bytesOf(input)));
  if (blocks.includes(null)) return wrongCall('takes files as their bytes, a Uint8Array, and all else as text');
  const places = [];
  let result = 0;
  try {
    for (const bytes of blocks) {
      const at = put(engine, bytes);
      if (at === 0) return outOfMemory();
      places.push(at);
    }
    result = method(...leading, ...blocks.flatMap((bytes, i) => [places[i], bytes.length]));
    if (engine.thrown.length > 0) throw engine.thrown.pop();
    if (result === 0) return outOfMemory();
    const account = JSON.parse(new TextDecoder().decode(
      copyOut(engine, engine._limber_account(result), engine._limber_account_size(result))));
    return engine._limber_ok(result)
      ? { ok: true, bytes: copyOut(engine, engine._limber_bytes(result), engine._limber_bytes_size(result)), account }
      : { ok: false, error: account };
  } finally {
    places.forEach((at) => engine._free(at));
    if (result !== 0) engine._limber_free_result(result);
  }
}

function createSession(engine, handle = engine._limber_session_new()) {
  if (handle === 0) throw new RangeError('the engine is out of memory');
  const step = (result) => {
    if (!result.ok) return result;
    const { account, bytes } = result, state = 'name' in account ? account : null;
    return { ok: true, state, skin: new Float32Array(bytes.buffer), pinned: state?.targets.map(({ joint }) => joint) ?? account.pinned };
  };
  return {
    /** The engine's own name for it. */
    handle,
    /** `limbsFollow`: as in the command open_file. @type {(file: Uint8Array, name: string, limbsFollow?: boolean) => StepResult} */
    open: (file, name, limbsFollow = false) =>
      step(call(engine, engine._limber_session_open, [handle, Number(limbsFollow)], file, name)),
    /** Another model beside those that are there, as the command add_file.
     *  @type {(file: Uint8Array, name: string, limbsFollow?: boolean, asProp?: boolean) => StepResult} */
    add: (file, name, limbsFollow = false, asProp = false) =>
      step(call(engine, engine._limber_session_add, [handle, Number(limbsFollow), Number(asProp)], file, name)),
    /** For each member the matrix that brings its own space to that of the scene, 16 numbers.
     *  @type {() => { ok: true, places: Float32Array } | Failure} */
    places: () => {
      const result = call(engine, engine._limber_session_places, [handle]);
      return result.ok ? { ok: true, places: new Float32Array(result.bytes.buffer) } : result;
    },
    /** As model() and skin(), of any member. @type {(member: number) => { ok: true, model: SurfaceModel } | Failure} */
    memberModel: (member) => {
      const result = call(engine, engine._limber_session_member_model, [handle, member]);
      return surfaceModel(result, deformation(call(engine, engine._limber_session_member_deformation, [handle, member])));
    },
    /** @type {(member: number) => { ok: true, posed: Float32Array } | Failure} */
    memberPosed: (member) => posed(call(engine, engine._limber_session_member_posed, [handle, member])),
    /** @type {(member: number) => { ok: true, skin: Float32Array } | Failure} */
    memberSkin: (member) => {
      const result = call(engine, engine._limber_session_member_skin, [handle, member]);
      return result.ok ? { ok: true, skin: new Float32Array(result.bytes.buffer) } : result;
    },
    /** The member whose surface a ray in the chosen one's space meets first.
     *  @type {(ray: Ray) => { ok: true, hit: { member: number, joint: number } | null } | Failure} */
    pickMember: (ray) => {
      const result = call(engine, engine._limber_session_pick_member, [handle, ...ray.origin, ...ray.direction]);
      return result.ok ? { ok: true, hit: result.account } : result;
    },
    /** Motions of a BVH file, of arrays in SMPL's form (.npz, not compressed) or of a model; `retarget`: as in the command add_motion.
     *  @type {(file: Uint8Array, name: string, retarget?: boolean) => StepResult} */
    addMotion: (file, name, retarget = false) =>
      step(call(engine, engine._limber_session_add_motion, [handle, Number(retarget)], file, name)),
    /** The rig of another model, or of a body in SMPL's layout (.npz), as the command transfer_rig.
     *  @type {(file: Uint8Array, name: string) => StepResult} */
    transferRig: (file, name) => step(call(engine, engine._limber_session_transfer_rig, [handle], file, name)),
    /** A motion that comes live, as the program sends it (limber/document/live/live_text.h): its skeleton, then its frames. Nothing of it is
     *  recorded, and the next command ends it. @type {(skeleton: string) => { ok: true } | Failure} */
    liveBegin: (skeleton) => call(engine, engine._limber_session_live_begin, [handle], skeleton),
    /** Seven numbers for each of its joints, at a moment in seconds.
     *  @type {(pose: Float32Array, seconds: number) => { ok: true, skin: Float32Array, pinned: number[] } | Failure} */
    liveFrame: (pose, seconds) =>
      step(call(engine, engine._limber_session_live_frame, [handle, seconds], new Uint8Array(pose.buffer, pose.byteOffset, pose.byteLength))),
    /** The character stands as it did before. @type {() => { ok: true, skin: Float32Array, pinned: number[] } | Failure} */
    liveEnd: () => step(call(engine, engine._limber_session_live_end, [handle])),
    /** What has come of it, as a BVH. @type {() => { ok: true, bytes: Uint8Array } | Failure} */
    liveRecorded: () => call(engine, engine._limber_session_live_recorded, [handle]),
    /** Where the joints stand that the chosen clip's motion was made for: x, y, z each; empty where there are none.
     *  @type {() => { ok: true, places: Float32Array } | Failure} */
    sourceJoints: () => {
      const result = call(engine, engine._limber_session_source_joints, [handle]);
      return result.ok ? { ok: true, places: new Float32Array(result.bytes.buffer) } : result;
    },
    /** The joints of the chosen clip at even moments: x, y, z each, moment after moment.
     *  @type {(framesPerSecond: number, most: number) => { ok: true, moments: number[], places: Float32Array } | Failure} */
    paths: (framesPerSecond, most) => {
      const result = call(engine, engine._limber_session_paths, [handle, framesPerSecond, most]);
      return result.ok ? { ok: true, moments: result.account.moments, places: new Float32Array(result.bytes.buffer) } : result;
    },
    /** One joint of the chosen clip at even moments and at its keys, from its rest pose: a turn about x, y and z in degrees, and an
     *  offset in metres; tangents: what these change by in a second at its keys, where they are cubic and can be edited.
     *  @type {(joint: number, framesPerSecond: number, most: number) => { ok: true, moments: number[], values: Float32Array,
     *          tangents: Tangent[] } | Failure} */
    curve: (joint, framesPerSecond, most) => {
      const result = call(engine, engine._limber_session_curve, [handle, joint, framesPerSecond, most]);
      return result.ok ? { ok: true, ...result.account, values: new Float32Array(result.bytes.buffer) } : result;
    },
    /** @type {(command: Command) => StepResult} */
    run: (command) => step(call(engine, engine._limber_session_run, [handle], JSON.stringify(command))),
    /** A handle, taken to be at least `slope` times its distance wide, or the surface.
     *  @type {(ray: Ray, slope: number) => { ok: true, hit: PickHit | null } | Failure} */
    pick: (ray, slope) => {
      const result = call(engine, engine._limber_session_pick, [handle, ...ray.origin, ...ray.direction, slope]);
      return result.ok ? { ok: true, hit: result.account } : result;
    },
    /** Where a brush meets the surface. @type {(ray: Ray) => { ok: true, hit: SurfaceHit | null } | Failure} */
    surface: (ray) => {
      const result = call(engine, engine._limber_session_surface, [handle, ...ray.origin, ...ray.direction]);
      return result.ok ? { ok: true, hit: result.account } : result;
    },
    /** @type {() => { ok: true, weights: WeightArrays } | Failure} */
    weights: () => weightArrays(call(engine, engine._limber_session_weights, [handle])),
    /** The weights that a stroke would leave; nothing changes.
     *  @type {(stroke: Command) => { ok: true, weights: WeightArrays } | Failure} */
    preview: (stroke) => weightArrays(call(engine, engine._limber_session_preview, [handle], JSON.stringify(stroke))),
    /** The limbs as the weights have them: a part for each triangle of model(), and what the parts are called.
     *  @type {() => { ok: true, parts: SurfaceParts } | Failure} */
    parts: () => {
      const result = call(engine, engine._limber_session_parts, [handle]);
      return result.ok ? { ok: true, parts: { names: result.account.names, partOf: new Uint32Array(result.bytes.buffer) } } : result;
    },
    /** The joints' matrices, as run() gives them. @type {() => { ok: true, skin: Float32Array } | Failure} */
    skin: () => {
      const result = call(engine, engine._limber_session_skin, [handle]);
      return result.ok ? { ok: true, skin: new Float32Array(result.bytes.buffer) } : result;
    },
    /** For each joint where it stands, and its radius: x, y, z, r.
     *  @type {() => { ok: true, handles: Float32Array } | Failure} */
    handles: () => {
      const result = call(engine, engine._limber_session_handles, [handle]);
      return result.ok ? { ok: true, handles: new Float32Array(result.bytes.buffer) } : result;
    },
    /** For each joint how it is turned: from its rest pose, in degrees about x, y and z as set_turn takes them, and in the
     *  world, as a quaternion x, y, z, w.
     *  @type {() => { ok: true, turns: Float32Array } | Failure} */
    turns: () => {
      const result = call(engine, engine._limber_session_turns, [handle]);
      return result.ok ? { ok: true, turns: new Float32Array(result.bytes.buffer) } : result;
    },
    /** For each joint how many times as large it is as in its rest pose, as set_scale takes it.
     *  @type {() => { ok: true, scales: Float32Array } | Failure} */
    scales: () => {
      const result = call(engine, engine._limber_session_scales, [handle]);
      return result.ok ? { ok: true, scales: new Float32Array(result.bytes.buffer) } : result;
    },
    /** The surface as bound. @type {() => { ok: true, model: SurfaceModel } | Failure} */
    model: () => {
      const result = call(engine, engine._limber_session_model, [handle]);
      return surfaceModel(result, deformation(call(engine, engine._limber_session_deformation, [handle])));
    },
    /** As in model(), where the weights or the deformer alone are others. @type {() => { ok: true, deformation: Deformation } | Failure} */
    deformation: () => deformation(call(engine, engine._limber_session_deformation, [handle])),
    /** The surface as it stands, positions, then normals, where the engine bends it; else nothing.
     *  @type {() => { ok: true, posed: Float32Array } | Failure} */
    posed: () => posed(call(engine, engine._limber_session_posed, [handle])),
    /** @type {(format: ExportFormat) => { ok: true, bytes: Uint8Array } | Failure} */
    export: (format) => call(engine, engine._limber_session_export, [handle], format),
    /** The rigged model with its clips, standing in the pose, as another program expects it: names of rigChoices().target. USD holds
     *  the named clip alone, or none. Formats of several files come as a ZIP archive of them.
     *  @type {(extension: '.glb' | '.gltf' | '.fbx' | '.vrm' | '.usda' | '.usdc' | '.usdz', target?: string, clip?: string)
     *           => { ok: true, bytes: Uint8Array, warnings: SessionState['warnings'] } | Failure} */
    saveModel: (extension, target = 'gltf', clip = '') => {
      const result = call(engine, engine._limber_session_save_model, [handle], extension, target, clip);
      return result.ok ? { ok: true, bytes: result.bytes, warnings: result.account.warnings } : result;
    },
    /** The pose that is shown, as the text of a file: for apply_pose, on this model or another.
     *  @type {(name: string) => { ok: true, pose: string } | Failure} */
    pose: (name) => {
      const result = call(engine, engine._limber_session_pose, [handle], name);
      return result.ok ? { ok: true, pose: result.account.pose } : result;
    },
    /** What was done since a model was opened, as a list that `limber session replay` runs.
     *  @type {() => { limber_commands: number, commands: Command[] }} */
    record: () => call(engine, engine._limber_session_record, [handle]).account,
    /** Whether the model can be rigged with a named skeleton, and what stands in the way; nothing changes. Asks for the networks
     *  that read shapes, as fitting a template does. @type {() => { ok: true, check: RigCheck } | Failure} */
    rigCheck: () => {
      const result = call(engine, engine._limber_session_rig_check, [handle]);
      return result.ok ? { ok: true, check: result.account } : result;
    },
    /** Figures by which methods are compared: limber/session/drag/measures.h.
     *  @type {() => { ok: true, measures: Measures } | Failure} */
    measures: () => {
      const result = call(engine, engine._limber_session_measures, [handle]);
      return result.ok ? { ok: true, measures: result.account } : result;
    },
    free: () => engine._limber_session_free(handle),
  };
}

function weightArrays(result) {
  if (!result.ok) return result;
  const { buffer, byteLength } = result.bytes, floats = (byteLength * 2) / 3;
  return { ok: true, weights: { weights: new Float32Array(buffer, 0, floats / 4), joints: new Uint16Array(buffer, floats) } };
}

function deformation(result) {
  if (!result.ok) return result;
  const { form, vertices, entries } = result.account, { buffer } = result.bytes;
  if (form !== 'rows') return { ok: true, deformation: { form } };
  const floats = (first, count) => new Float32Array(buffer, 4 * first, count);
  return { ok: true, deformation: { form, places: floats(0, 3 * vertices), ranges: floats(3 * vertices, 2 * vertices), entries: floats(5 * vertices, 20 * entries) } };
}

const posed = (result) => (result.ok ? { ok: true, posed: new Float32Array(result.bytes.buffer) } : result);

function surfaceModel(result, bent) {
  if (!result.ok) return result;
  if (!bent.ok) return bent;
  return { ok: true, model: surfaceIn(result.bytes, result.account, bent.deformation) };
}

/** Views of bytes that begin at a multiple of 4. */
function surfaceIn(bytes, { arrays, textures, ...rest }, deformation) {
  const view = (Type, { offset, size }) => new Type(bytes.buffer, bytes.byteOffset + offset, size / Type.BYTES_PER_ELEMENT);
  return {
    positions: view(Float32Array, arrays.positions),
    normals: view(Float32Array, arrays.normals),
    uvs: view(Float32Array, arrays.uvs),
    triangles: view(Uint32Array, arrays.triangles),
    weights: view(Float32Array, arrays.weights),
    joints: view(Uint16Array, arrays.joints),
    textures: textures.map(({ offset, size }) => bytes.slice(offset, offset + size)),
    deformation,
    ...rest,
  };
}

function crowdOf(result) {
  if (!result.ok) return result;
  const { bytes, account: { tables, builds, ...rest } } = result;
  const part = ({ offset, size }) => bytes.subarray(offset, offset + size);
  return { ok: true, crowd: {
    tables: tables.map(({ matrices, ...table }) => ({ ...table, matrices: new Float32Array(bytes.buffer, matrices.offset, matrices.size / 4) })),
    builds: builds.map((build) => surfaceIn(part(build.bytes), build.account, { form: 'weights' })),
    ...rest,
  } };
}

// Is the Kubernetes file an Indexed Job that a cluster would take? Its schema is that of npm kubernetes-models: values by its
// validator, fields that it does not know by the compiler of TypeScript. What fields have to do with each other is
// checked here; its script runs with a program that only ends.
//
//   node tests/kubernetes_job.mjs TSC OUTPUT_FOLDER
//
// Ends with "N passed, N failed".
import { spawn, spawnSync } from 'node:child_process';
import { chmodSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { load } from 'js-yaml';
import { Job } from 'kubernetes-models/batch/v1';

const [tsc, folder] = process.argv.slice(2);
const root = join(dirname(fileURLToPath(import.meta.url)), '..');
const file = join(root, 'integrations/kubernetes/limber-batch.yaml');
const job = load(readFileSync(file, 'utf8'));

let passed = 0, failed = 0;
function check(what, holds) {
  holds ? ++passed : ++failed;
  if (!holds) console.log(`FAILED: ${what}`);
}

function isValid(value) {
  try {
    new Job(value).validate();
    return true;
  } catch {
    return false;
  }
}

// Does the compiler find each field in the schema?
function isTyped(value) {
  // Inside the project, where the package is found.
  mkdirSync(folder, { recursive: true });
  const source = join(folder, 'job.ts');
  writeFileSync(source, `import type { IJob } from 'kubernetes-models/batch/v1';\nexport const job: IJob = ${JSON.stringify(value)};\n`);
  const options = ['--noEmit', '--strict', '--skipLibCheck', '--module', 'nodenext', '--moduleResolution', 'nodenext', source];
  return spawnSync(tsc, options, { cwd: root }).status === 0;
}

function changed(change) {
  const copy = structuredClone(job);
  change(copy.spec.template.spec.containers[0], copy.spec);
  return copy;
}

check('it is valid', isValid(job));
check('a wrong type is seen', !isValid(changed((_, spec) => { spec.completions = 'many'; })));
check('it has known fields alone', isTyped(job));
check('an unknown field is seen', !isTyped(changed((container) => { container.securityContext.readOnlyRoot = true; })));

const { spec } = job, pod = spec.template.spec, [container] = pod.containers;
check('it is Indexed, and a pod that fails is not started again in place',
  spec.completionMode === 'Indexed' && pod.restartPolicy === 'Never');
check('there is a shard for each index', container.args.join(' ').includes(`$((JOB_COMPLETION_INDEX + 1))/${spec.completions}"`));
check('a pod has the processors that its jobs ask for',
  new RegExp(`--jobs ${container.resources.requests.cpu}\\b`).test(container.args.join(' ')));
// Entries that failed are no reason for another try; all else is told to the cluster.
const program = join(folder, 'limber');
writeFileSync(program, '#!/bin/sh\nexit $EXIT_CODE\n'); // once: a program that was just written may still count as open
chmodSync(program, 0o755);
const endsWith = (code) => {
  const env = { ...process.env, PATH: `${folder}:${process.env.PATH}`, JOB_COMPLETION_INDEX: '0', EXIT_CODE: `${code}` };
  return spawnSync(container.command[0], [...container.command.slice(1), ...container.args], { env }).status;
};
check('exit codes of the program are those of the pod, but for 1',
  [0, 1, 2, 3, 4].map(endsWith).join() === '0,0,2,3,4');
const jobs = Number(/--jobs (\d+)/.exec(container.args.join(' '))[1]);
check('a pod has memory for its jobs at the default limit, and for the program itself',
  parseFloat(container.resources.limits.memory) > 4 * jobs && container.resources.limits.memory.endsWith('Gi'));
// The shell is the pod's first process: what it does not hand on, the program never hears.
const endedBy = await new Promise((done) => {
  writeFileSync(program, "#!/bin/sh\ntrap 'sleep 0.2; exit 4' TERM\necho begun\nwhile :; do sleep 0.05; done\n");
  const env = { ...process.env, PATH: `${folder}:${process.env.PATH}`, JOB_COMPLETION_INDEX: '0' };
  const shell = spawn(container.command[0], [...container.command.slice(1), ...container.args], { env });
  shell.stdout.once('data', () => shell.kill('SIGTERM'));
  shell.on('exit', (code, signal) => done(code ?? signal));
});
check('a pod that is ended waits for its program, and ends with its code', endedBy === 4);
check('policies of failure name a container of the pod',
  spec.podFailurePolicy.rules.every(({ onExitCodes }) => pod.containers.some(({ name }) => name === onExitCodes.containerName)));
check('no root', pod.securityContext.runAsNonRoot === true && pod.securityContext.runAsUser > 0);
check('nothing to write to but the volume', container.securityContext.readOnlyRootFilesystem === true &&
  container.volumeMounts.every(({ name }) => pod.volumes.some((volume) => volume.name === name)));
const image = readFileSync(join(root, 'integrations/kubernetes/Containerfile'), 'utf8');
check('the image runs as the same user', image.includes(`USER ${pod.securityContext.runAsUser}:${pod.securityContext.runAsGroup}`));

console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);

// limber studio --live: motion that another program sends to this machine moves the character in the page.
//
//   node apps/studio/tests/live_test.mjs PROGRAM OUTPUT_FOLDER
//
// The program has the page in it. Ends with "N passed, N failed", and says before it how long packets take to joints that stand.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { createSocket } from 'node:dgram';
import { mkdirSync } from 'node:fs';
import { connect } from 'node:net';
import { join, resolve } from 'node:path';
import { barriers, jointPosition, launch, openStudio, runCases, sessionState, settled } from './page.mjs';
import { walkBvh } from './walk_bvh.mjs';

const [program, output] = process.argv.slice(2).map((path) => resolve(path));
mkdirSync(output, { recursive: true });
const bare = join(output, 'live_bare.glb'), hero = join(output, 'live_hero.glb');
execFileSync(program, ['sample', 'biped', '-o', bare, '--quiet']);
execFileSync(program, ['rig', bare, '--rigger', 'template', '-o', hero, '--quiet']);

const server = spawn(program, ['studio', '--port', '0', '--live', '--vmc-port', '0', '--bvh-port', '0'], { stdio: ['ignore', 'pipe', 'inherit'] });
const [address, vmcPort, bvhPort] = await new Promise((found, failed) => {
  let said = '';
  server.stdout.on('data', (text) => {
    said += text;
    const page = /http:\S+/.exec(said), ports = /VMC by UDP to 127\.0\.0\.1:(\d+), BVH by TCP to 127\.0\.0\.1:(\d+)/.exec(said);
    if (page && ports) found([page[0], Number(ports[1]), Number(ports[2])]);
  });
  server.on('exit', (code) => failed(new Error(`ended at once: ${code}`)));
});

// Open Sound Control 1.0: texts end with zeros up to a multiple of four bytes, numbers come with their highest byte first.
const oscText = (text) => Buffer.from(text.padEnd(4 * (Math.floor(text.length / 4) + 1), '\0'), 'latin1');
function bone(name, place, rotation) {
  const numbers = Buffer.alloc(28);
  [...place, ...rotation].forEach((value, i) => numbers.writeFloatBE(value, 4 * i));
  return Buffer.concat([oscText('/VMC/Ext/Bone/Pos'), oscText(`,s${'f'.repeat(7)}`), oscText(name), numbers]);
}
function bundle(messages) {
  const sized = (bytes) => { const size = Buffer.alloc(4); size.writeUInt32BE(bytes.length); return [size, bytes]; };
  return Buffer.concat([oscText('#bundle'), Buffer.alloc(8), ...messages.flatMap(sized)]);
}

/** A person in Unity's T-pose whose left upper arm is turned about the axis ahead. */
const person = {
  Hips: [0, 0.95, 0], Spine: [0, 0.12, 0], Chest: [0, 0.16, 0], Neck: [0, 0.22, 0], Head: [0, 0.1, 0],
  LeftShoulder: [-0.04, 0.18, 0], LeftUpperArm: [-0.12, 0, 0], LeftLowerArm: [-0.27, 0, 0], LeftHand: [-0.25, 0, 0],
  RightShoulder: [0.04, 0.18, 0], RightUpperArm: [0.12, 0, 0], RightLowerArm: [0.27, 0, 0], RightHand: [0.25, 0, 0],
  LeftUpperLeg: [-0.09, -0.04, 0], LeftLowerLeg: [0, -0.42, 0], LeftFoot: [0, -0.41, 0],
  RightUpperLeg: [0.09, -0.04, 0], RightLowerLeg: [0, -0.42, 0], RightFoot: [0, -0.41, 0],
};
const packet = (degrees) => {
  const half = (degrees * Math.PI) / 360;
  return bundle(Object.entries(person).map(([name, place]) => bone(name, place, name === 'LeftUpperArm' ? [0, 0, Math.sin(half), Math.cos(half)] : [0, 0, 0, 1])));
};
const udp = createSocket('udp4');
const sendVmc = (degrees) => new Promise((done) => udp.send(packet(degrees), vmcPort, '127.0.0.1', done));

const browser = await launch();
const { page, errors } = await openStudio(browser, address);
await page.locator('#file').setInputFiles(hero);
await page.waitForFunction(() => globalThis.limberStudio.state()?.name === 'live_hero.glb');
await settled(page);
const hand = (await sessionState(page)).joints.find(({ name }) => /^left_?hand$/i.test(name)).name;
const stateShown = () => page.locator('#live-state').textContent();

/** Until the page follows what `send` sends again and again. */
async function followed(send) {
  for (const end = Date.now() + 60_000; Date.now() < end && await stateShown() !== 'Following live motion';) {
    await send();
    await new Promise((wait) => setTimeout(wait, 20));
  }
  assert.equal(await stateShown(), 'Following live motion');
}
/** Until the joint stands between two heights. */
const reaches = (joint, least, most) => page.waitForFunction(([name, low, high]) => {
  const height = globalThis.limberStudio.position(name)[1];
  return low <= height && height <= high;
}, [joint, least, most], { polling: 15 });

const cases = {
  async 'the page waits, and what it says can be reached and read'() {
    assert.equal(await stateShown(), 'Waiting for motion');
    assert.deepEqual(await barriers(page), []);
  },
  async 'packets of VMC raise and lower the hand of the character'() {
    await followed(() => sendVmc(0));
    await settled(page);
    const level = (await jointPosition(page, hand))[1], steps = (await sessionState(page)).undo;
    await sendVmc(-60); // in Unity, whose axes are a left hand's, that lifts an arm that points to -x
    await reaches(hand, level + 0.15, level + 2);
    await page.screenshot({ path: join(output, 'live_raised.png') });
    await sendVmc(60);
    await reaches(hand, level - 2, level - 0.15);
    assert.equal((await sessionState(page)).undo, steps, 'nothing to undo');
  },
  async 'packets come to joints quickly'() {
    await page.evaluate((name) => {
      globalThis.moved = [];
      const { port1, port2 } = new MessageChannel();
      let height = globalThis.limberStudio.position(name)[1];
      port1.onmessage = () => {
        const now = globalThis.limberStudio.position(name)[1];
        if (Math.abs(now - height) > 1e-4) globalThis.moved.push(performance.timeOrigin + performance.now());
        height = now;
        if (globalThis.moved) port2.postMessage(0);
      };
      port2.postMessage(0);
    }, hand);
    const taken = [];
    for (let i = 0; i < 60; ++i) {
      await page.evaluate(() => { globalThis.moved.length = 0; });
      const sent = performance.timeOrigin + performance.now();
      await sendVmc(i % 2 ? 20 : -20);
      await page.waitForFunction(() => globalThis.moved.length > 0, undefined, { polling: 15 });
      taken.push(await page.evaluate(() => globalThis.moved[0]) - sent);
    }
    await page.evaluate(() => { globalThis.moved = null; });
    taken.sort((a, b) => a - b);
    console.log(`packet to pose: median ${taken[30].toFixed(1)} ms, 90 % below ${taken[54].toFixed(1)} ms`);
    assert.equal(taken.length, 60); // told, not judged: they are by the clocks of two processes
  },
  async 'paused, the character stands as before; following again, it moves'() {
    await page.locator('#live-pause').click();
    await settled(page);
    const stood = await jointPosition(page, hand);
    await sendVmc(-60);
    await new Promise((wait) => setTimeout(wait, 200));
    assert.deepEqual(await jointPosition(page, hand), stood);
    await page.locator('#live-follow').click();
    await followed(() => sendVmc(-60));
  },
  async 'what has come is kept as a clip'() {
    for (let i = 0; i < 10; ++i) {
      await sendVmc(6 * i);
      await new Promise((wait) => setTimeout(wait, 30));
    }
    const before = (await sessionState(page)).clips.length;
    await page.locator('#live-keep').click();
    await page.waitForFunction((count) => globalThis.limberStudio.state().clips.length > count, before);
    const { clips, clip } = await sessionState(page);
    assert.ok(clips[clip].duration > 0.1, JSON.stringify(clips[clip]));
  },
  async 'a BVH line by line moves it, too'() {
    await page.keyboard.press('Escape');
    await page.locator('#live-follow').click();
    const [head, lines] = walkBvh().split(/Frame Time:.*\n/), frames = lines.trim().split('\n');
    const socket = connect(bvhPort, '127.0.0.1');
    socket.write(`${head}Frame Time: 0.033333\n`);
    let next = 0;
    const send = async () => { socket.write(`${frames[next++ % frames.length]}\n`); };
    await followed(send);
    const heights = new Set();
    for (let i = 0; i < 20; ++i) {
      await send();
      await new Promise((wait) => setTimeout(wait, 40));
      heights.add((await jointPosition(page, hand))[2].toFixed(4));
    }
    assert.ok(heights.size > 10, `${heights.size} places of the hand`);
    await page.screenshot({ path: join(output, 'live_walking.png') });
    socket.end();
  },
  async 'nothing was thrown'() { assert.deepEqual(errors, []); },
};

let failed = 1;
try {
  failed = await runCases(cases, page, output);
} finally {
  await browser.close();
  udp.close();
  server.kill('SIGINT');
}
process.exit(failed === 0 ? 0 : 1);

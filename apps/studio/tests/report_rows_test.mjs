// The rows of a study's report: which methods there are, with the medians of their figures, and which the page can do.
//   node apps/studio/tests/report_rows_test.mjs
import assert from 'node:assert/strict';
import { fileURLToPath } from 'node:url';
import { createServer } from 'vite';
import { runCases } from './page.mjs';

const server = await createServer({ root: fileURLToPath(new URL('..', import.meta.url)), server: { middlewareMode: true, hmr: false, watch: null }, appType: 'custom', logLevel: 'error' });
const { obstacleOf, reportRows, rigCommands } = await server.ssrLoadModule('/src/app/report_rows.ts');

const cell = (more) => ({
  kind: 'rig', group: 'people', model: 'anna', motion: '', rigger: 'template', skinning: 'bone-heat', options: '', retargeting: '', solver: '',
  outcome: 'done', problem: '', measure: null, value: null, ...more,
});
const moved = (more) => cell({ kind: 'retarget', rigger: '', skinning: '', motion: 'walk', retargeting: 'limb-ik', ...more });
const rows = (...cells) => reportRows(JSON.stringify({ title: 'A study', cells }));
const methods = Object.fromEntries(Object.entries({
  rigger: ['template', 'sphere-mesh'], skinning: ['bone-heat'], deformer: ['linear-blend', 'delta-mush'], solver: ['whole-body'], retargeting: ['limb-ik', 'copy'],
}).map(([kind, names]) => [kind, names.map((name) => ({ name, summary: '' }))]));

const failed = await runCases({
  'a method is a row, with the median over the models that have the figure'() {
    const [first, second, ...more] = rows(
      ...[5, 1, 3].map((value, i) => cell({ model: `m${i}`, measure: 'joint_to_joint', value })), cell({ model: 'm0', measure: 'seconds', value: 2 }),
      cell({ model: 'm3', outcome: 'crashed' }), ...[4, 2].map((value, i) => cell({ rigger: 'sphere-mesh', model: `m${i}`, measure: 'joint_to_joint', value })));
    assert.deepEqual(more, []);
    assert.equal(first.name, 'template + bone-heat');
    assert.deepEqual([first.cells, first.done], [4, 3]);
    assert.deepEqual(first.figures, [{ measure: 'joint_to_joint', median: 3 }, { measure: 'seconds', median: 2 }]);
    assert.equal(second.figures[0].median, 3);
  },
  'options, deformers and solvers tell rows apart'() {
    const found = rows(cell(), cell({ options: '2 influences' }), cell({ deformer: 'delta-mush' }), moved(), moved({ solver: 'fabrik' }), moved({ retargeting: 'copy' }));
    assert.deepEqual(found.map(({ name }) => name), ['template + bone-heat', 'template + bone-heat, 2 influences', 'template + bone-heat + delta-mush',
      'limb-ik', 'limb-ik + fabrik', 'copy']);
  },
  'models of two folders with one name, and a character with two motions, are counted apart'() {
    assert.equal(rows(cell(), cell({ group: 'animals' }))[0].cells, 2);
    assert.equal(rows(moved(), moved({ motion: 'run' }))[0].cells, 2);
  },
  'what the page lacks is said'() {
    const obstacle = (one, hasMotion = true) => obstacleOf(rows(one)[0], methods, hasMotion);
    assert.equal(obstacle(cell()), null);
    assert.equal(obstacle(cell({ deformer: 'delta-mush' })), null);
    assert.equal(obstacle(cell({ deformer: 'my-own' })), 'method');
    assert.equal(obstacle(cell({ rigger: 'unirig' })), 'method');
    assert.equal(obstacle(cell({ skinning: 'toString' })), 'method');
    assert.equal(obstacle(cell({ rigger: 'own' })), 'own');
    assert.equal(obstacle(moved()), null);
    assert.equal(obstacle(moved({ solver: 'two-bone' })), null);
    assert.equal(obstacle(moved({ solver: 'fabrik' })), 'solver');
    assert.equal(obstacle(moved({ retargeting: 'mine' })), 'method');
    assert.equal(obstacle(moved(), false), 'motion');
  },
  'a row is made by its methods'() {
    assert.deepEqual(rigCommands(rows(cell())[0]), [{ do: 'choose_methods', rigger: 'template', skinning: 'bone-heat' }]);
    assert.deepEqual(rigCommands(rows(cell({ deformer: 'delta-mush' }))[0]).at(-1), { do: 'set_deformer', deformer: 'delta-mush' });
  },
  'other files are no reports'() {
    for (const text of ['', '{', 'null', '[]', '{}', '{"cells":{}}', '{"cells":[1]}', '{"cells":[null]}']) assert.equal(reportRows(text), null, text);
    assert.deepEqual(reportRows('{"cells":[]}'), []);
    assert.deepEqual(rows({ kind: 'other' }, {}), []);
    assert.equal(rows({ kind: 'rig', rigger: 7, skinning: ['a'], measure: 3, value: 'b', outcome: null })[0].name, '');
  },
});
await server.close();
process.exit(failed ? 1 : 0);

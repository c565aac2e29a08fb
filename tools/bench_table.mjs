// Prints the results of Google Benchmark as a table, with how the cost grows when the size doubles.
//
//   node tools/bench_table.mjs RESULTS.json...
//
// Rows of one family (the name up to its first slash) stand together. The size is the counter `vertices` where a
// benchmark sets it, else the first number of its name; growth is that of the time between one row and the next of the
// same further arguments, brought to a doubling: 2.0 is linear, 2.2 is n log n at a million or so, 4.0 quadratic.
import { readFileSync } from 'node:fs';

const kMilliseconds = { ns: 1e-6, us: 1e-3, ms: 1, s: 1e3 };
const kBuiltIn = new Set(['name', 'family_index', 'per_family_instance_index', 'run_name', 'run_type', 'repetitions',
  'repetition_index', 'threads', 'iterations', 'real_time', 'cpu_time', 'time_unit', 'label', 'aggregate_name',
  'aggregate_unit', 'error_occurred', 'error_message', 'big_o', 'rms', 'cpu_coefficient', 'real_coefficient',
  'vertices', 'items_per_second', 'bytes_per_second', 'memory_growth']);

function rowOf(entry) {
  const [family, ...rest] = entry.name.split('/').filter((part) => !['real_time', 'process_time', 'manual_time'].includes(part)
    && !/^(iterations|repeats|min_time|min_warmup_time):/.test(part));
  const sizeAt = rest.findIndex((part) => /^\d+$/.test(part));
  const size = entry.vertices ?? (sizeAt < 0 ? undefined : Number(rest[sizeAt]));
  const others = rest.filter((_, at) => at !== sizeAt).join('/');
  const extras = Object.entries(entry).filter(([key, value]) => !kBuiltIn.has(key) && typeof value === 'number');
  return { family, arguments: rest.join('/'), label: entry.label ?? '', size, others,
    milliseconds: entry.real_time * kMilliseconds[entry.time_unit], extras };
}

function growthPerDoubling(before, row) {
  if (!before || !(row.size > before.size) || !(before.milliseconds > 0)) return '';
  return (2 ** (Math.log(row.milliseconds / before.milliseconds) / Math.log(row.size / before.size))).toFixed(2);
}

const figure = (value) => (value === 0 || Math.abs(value) >= 1000 ? value.toFixed(0) : value.toPrecision(3));

function print(family, rows) {
  const extraNames = [...new Set(rows.flatMap((row) => row.extras.map(([key]) => key)))];
  const header = ['', 'vertices', 'ms', 'per doubling', ...extraNames];
  const last = new Map();
  const lines = rows.map((row) => {
    const growth = growthPerDoubling(last.get(row.others), row);
    last.set(row.others, row);
    const extras = extraNames.map((name) => {
      const found = row.extras.find(([key]) => key === name);
      return found ? figure(found[1]) : '';
    });
    return [row.label || row.arguments, String(row.size ?? ''), figure(row.milliseconds), growth, ...extras];
  });
  const widths = header.map((name, i) => Math.max(name.length, ...lines.map((line) => line[i].length)));
  const format = (cells) => cells.map((cell, i) => (i === 0 ? cell.padEnd(widths[i]) : cell.padStart(widths[i]))).join('  ').trimEnd();
  console.log(`\n${family}\n${format(header)}`);
  lines.forEach((line) => console.log(format(line)));
}

const results = process.argv.slice(2).map((path) => readFileSync(path, 'utf8')).filter((text) => text.trim() !== '')
  .map((text) => JSON.parse(text));
const families = new Map();
for (const entry of results.flatMap(({ benchmarks }) => benchmarks)) {
  if (entry.error_occurred) {
    console.log(`${entry.name}: ${entry.error_message}`);
    continue;
  }
  if (entry.run_type === 'aggregate') continue;
  const row = rowOf(entry);
  families.set(row.family, [...(families.get(row.family) ?? []), row]);
}
if (results.length === 0) {
  console.error('no benchmark has such a name');
  process.exit(1);
}
const { context } = results[0];
console.log(`${context.num_cpus} processors at ${context.mhz_per_cpu} MHz`);
for (const [family, rows] of families) print(family, rows);

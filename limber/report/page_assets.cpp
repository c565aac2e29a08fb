#include "limber/report/page_assets.h"

namespace limber {

const std::string_view kPageStyle = R"css(
:root {
  color-scheme: light dark; --line: #c8ccd2; --soft: #f2f4f7; --ink: #1c2430; --page: #fff; --bad: #a3161f;
  --link: #0b57a4;
}
@media (prefers-color-scheme: dark) {
  :root { --line: #454c57; --soft: #232932; --ink: #e8ebef; --page: #15191f; --bad: #ff9a9f; --link: #8dc3ff; }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; max-width: 80rem; padding: 1rem; font: 1rem/1.5 system-ui, sans-serif; color: var(--ink);
  background: var(--page);
}
h1 { font-size: 1.6rem; line-height: 1.2; }
h2 { margin-top: 2.5rem; border-bottom: 1px solid var(--line); }
h3 { margin: 1.5rem 0 .5rem; }
a { color: var(--link); }
label { display: block; font-weight: 600; }
input[type=search] {
  font: inherit; width: min(100%, 24rem); padding: .5rem; color: inherit; background: var(--page);
  border: 1px solid #767e8a; border-radius: .3rem;
}
button {
  font: inherit; color: inherit; background: var(--soft); border: 1px solid #767e8a; border-radius: .3rem;
  padding: .3rem .7rem; min-height: 2rem; cursor: pointer;
}
:focus-visible { outline: 3px solid var(--link); outline-offset: 1px; }
.scroll { overflow-x: auto; margin: .5rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding: .3rem 0; }
th, td { padding: .25rem .6rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th.text, td.text { text-align: left; }
td.wrap { white-space: normal; min-width: 16rem; overflow-wrap: anywhere; }
thead th { background: var(--soft); vertical-align: bottom; min-width: 5rem; }
thead button {
  border: 0; background: none; font-weight: 600; text-align: inherit; white-space: normal; padding: .2rem;
}
th[aria-sort=ascending] button::after { content: " \25B2"; }
th[aria-sort=descending] button::after { content: " \25BC"; }
details { margin: .5rem 0; }
summary { cursor: pointer; padding: .3rem 0; }
.measure > summary { font-weight: 600; }
.bad { color: var(--bad); font-weight: 600; }
.cells { display: flex; flex-wrap: wrap; gap: 1rem; }
figure {
  margin: 0; padding: .6rem; width: 17rem; max-width: 100%; border: 1px solid var(--line);
  border-radius: .4rem;
}
figure img { width: 49%; height: auto; background: #fff; }
figure img.sheet { width: 100%; }
figure details img { width: 100%; max-width: 15rem; }
figcaption { font-weight: 600; overflow-wrap: anywhere; }
figure p { margin: .3rem 0; overflow-wrap: anywhere; font-size: .9rem; }
pre {
  overflow-x: auto; background: var(--soft); padding: .5rem; font-size: .8rem; white-space: pre-wrap;
  overflow-wrap: anywhere;
}
svg { max-width: 100%; height: auto; }
svg text { fill: var(--ink); font: 12px system-ui, sans-serif; }
svg .axis { stroke: var(--line); fill: none; }
[hidden] { display: none !important; }
)css";

// Tables sort by a cell's data-value, else by its text, what has none last; the filter hides whatever has data-words
// without all of the words.
const std::string_view kPageScript = R"js(
'use strict';
const valueOf = (row, column) => {
  const cell = row.cells[column];
  if (cell.dataset.value === undefined) return cell.textContent;
  return cell.dataset.value === '' ? undefined : Number(cell.dataset.value);
};
const compare = (a, b, sign) => {
  if (a === undefined || b === undefined) return (a === undefined) - (b === undefined);
  return sign * (typeof a === 'number' ? a - b || 0 : a.localeCompare(b));
};
for (const button of document.querySelectorAll('thead button')) {
  button.addEventListener('click', () => {
    const head = button.closest('th');
    const ascending = head.getAttribute('aria-sort') !== 'ascending';
    for (const other of head.parentElement.cells) other.setAttribute('aria-sort', 'none');
    head.setAttribute('aria-sort', ascending ? 'ascending' : 'descending');
    const body = head.closest('table').tBodies[0];
    const column = head.cellIndex;
    const sign = ascending ? 1 : -1;
    body.append(...[...body.rows].sort((a, b) => compare(valueOf(a, column), valueOf(b, column), sign)));
  });
}
const filter = document.getElementById('filter');
const shown = document.getElementById('shown');
const entries = [...document.querySelectorAll('[data-words]')];
filter.addEventListener('input', () => {
  const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
  let count = 0;
  for (const entry of entries) {
    entry.hidden = !words.every((word) => entry.dataset.words.includes(word));
    if (!entry.hidden && entry.tagName === 'FIGURE') count += 1;
  }
  for (const subject of document.querySelectorAll('.subject')) {
    subject.hidden = !subject.querySelector('figure:not([hidden])');
  }
  shown.textContent = words.length ? `${count} cells shown` : '';
});
const selectText = (element) => {
  const range = document.createRange();
  range.selectNodeContents(element);
  getSelection().removeAllRanges();
  getSelection().addRange(range);
};
for (const button of document.querySelectorAll('button.copy')) {
  button.addEventListener('click', async () => {
    const commands = button.parentElement.querySelector('pre');
    try {
      await navigator.clipboard.writeText(commands.textContent);
      button.textContent = 'Copied';
    } catch {
      selectText(commands);
      button.textContent = 'Selected: copy it with the keyboard';
    }
  });
}
)js";

}  // namespace limber

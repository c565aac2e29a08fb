#include "limber/study/report/ballot_page.h"

#include <fmt/format.h>

#include "limber/jobs/job_key.h"

namespace limber {

namespace {

// The same for as long as there are the same pictures of the same cells: their files are named by the cells' keys.
std::string picturesKey(const StudyResult& study) {
  JobKey key;
  for (std::size_t i = 0; i < study.cells.size(); ++i) {
    key.add(cellKindName(study.cells[i].kind)).add(study.cells[i].subject()).add(study.cells[i].method());
    for (const CellPicture& picture : study.results[i].pictures) key.add(picture.file.generic_string());
  }
  return key.hex();
}

}  // namespace

std::string ballotSection(const StudyResult& study) {
  return fmt::format(
      R"html(<section id="ballot" data-study="{}" hidden><h2>By eye</h2>
<p>Two results of one model by two methods, in random order and without names: which one is better? Save the votes when
you are done; <code>limber evaluate votes</code> ranks the methods by them.</p>
<div id="pair" role="group" tabindex="0" aria-labelledby="pair-subject" aria-describedby="pair-keys">
<h3 id="pair-subject"></h3>
<div class="sides"><div id="left"></div><div id="right"></div></div>
<div class="sides choices"><button type="button" data-choice="first">Left</button>
<button type="button" data-choice="alike">Alike</button>
<button type="button" data-choice="second">Right</button></div>
<p id="pair-keys">Keys, once you are here: left and right arrow, space for alike, backspace to undo.</p>
</div>
<p id="tally" role="status"></p>
<p><button type="button" id="undo">Undo</button>
<button type="button" id="save-votes">Save votes.csv</button>
<button type="button" id="play" hidden>Play motions</button></p>
<label for="voter">Your name, which goes into the file</label><input type="text" id="voter" maxlength="60" autocomplete="off">
<label class="check"><input type="checkbox" id="names"> Say which methods they were after each vote, which then stays</label>
<p id="unkept" hidden>This browser keeps no votes for pages from disk: save them before you close the page.</p>
</section>
)html",
      picturesKey(study));
}

const std::string_view kBallotStyle = R"css(
.sides { display: grid; grid-template-columns: 1fr 1fr; gap: .6rem; max-width: 64rem; }
.sides > div {
  display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 9rem), 1fr)); gap: .4rem; align-content: start;
  padding: .4rem; border: 1px solid var(--line); border-radius: .4rem; min-height: 10rem;
}
.sides img { display: block; width: 100%; max-width: 20rem; margin: 0 auto; height: auto; background: #fff; }
@media (pointer: coarse) { #pair-keys { display: none; } }
.choices { grid-template-columns: repeat(3, 1fr); margin-top: .6rem; }
.choices button { min-height: 3rem; font-weight: 600; }
button:disabled { opacity: .5; cursor: default; }
input[type=text] {
  font: inherit; width: min(100%, 24rem); padding: .5rem; color: inherit; background: var(--page);
  border: 1px solid #767e8a; border-radius: .3rem;
}
.check { display: flex; gap: .5rem; align-items: center; font-weight: 400; margin: .6rem 0; }
.check input { flex: none; width: 1.2rem; height: 1.2rem; }
)css";

// Pairs are shuffled by a generator of its own (mulberry32, from FNV-1a of the voter's name and the study); those of
// two methods that stood beside each other less often come first.
const std::string_view kBallotScript = R"js(
{
const ballot = document.getElementById('ballot');
const part = (id) => document.getElementById(id);
const buttons = [...ballot.querySelectorAll('[data-choice]')];
const storage = 'limber ballot ' + ballot.dataset.study;
const sameResults = (a, b) => JSON.stringify([a.kind, a.subject, ...[a.first, a.second].sort()]) ===
  JSON.stringify([b.kind, b.subject, ...[b.first, b.second].sort()]);

const picturesOf = (figure) => new Map([...figure.querySelectorAll('img[data-picture]')].map((one) => [one.dataset.picture, one]));
const allPairs = () => {
  const bySubject = new Map();
  for (const figure of document.querySelectorAll('figure[data-method]')) {
    const { kind, subject, method } = figure.dataset;
    const key = JSON.stringify([kind, subject]), pictures = picturesOf(figure);
    if (pictures.size) bySubject.set(key, [...(bySubject.get(key) ?? []), { kind, subject, method, pictures }]);
  }
  const pairs = [];
  for (const results of bySubject.values()) {
    results.forEach((a, i) => results.slice(i + 1).forEach((b) => {
      const names = [...a.pictures.keys()].filter((name) => b.pictures.has(name));
      if (names.length && a.method !== b.method) pairs.push({ a, b, names });
    }));
  }
  return pairs;
};

const generator = (text) => {
  let state = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(text)) state = Math.imul(state ^ byte, 0x01000193);
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let bits = Math.imul(state ^ (state >>> 15), state | 1);
    bits ^= bits + Math.imul(bits ^ (bits >>> 7), bits | 61);
    return ((bits ^ (bits >>> 14)) >>> 0) / 4294967296;
  };
};
const inOrder = (pairs, seed) => {
  const random = generator(seed), order = [...pairs];
  for (let i = order.length - 1; i > 0; --i) {
    const j = Math.floor(random() * (i + 1));
    [order[i], order[j]] = [order[j], order[i]];
  }
  const seen = new Map();
  const turns = order.map(({ a, b, names }) => {
    const key = JSON.stringify([a.kind, ...[a.method, b.method].sort()]), turn = seen.get(key) ?? 0;
    seen.set(key, turn + 1);
    const [left, right] = random() < 0.5 ? [a, b] : [b, a];
    return { turn, left, right, names, kind: a.kind, subject: a.subject, first: left.method, second: right.method };
  });
  return turns.sort((one, other) => one.turn - other.turn);
};

const quoted = (text) => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
const csvOf = (votes) => ['voter,kind,subject,first,second,choice', ...votes.map((vote) =>
  [vote.voter, vote.kind, vote.subject, vote.first, vote.second, vote.choice].map(quoted).join(','))].join('\r\n') + '\r\n';

const pairs = allPairs();
const readKept = () => {
  try {
    const { voter, votes } = JSON.parse(localStorage.getItem(storage));
    const known = new Set(pairs.map(({ a, b }) => JSON.stringify([a.kind, a.subject, ...[a.method, b.method].sort()])));
    return { voter: String(voter), votes: votes.filter((vote) => typeof vote.voter === 'string' &&
      ['first', 'second', 'alike'].includes(vote.choice) &&
      known.has(JSON.stringify([vote.kind, vote.subject, ...[vote.first, vote.second].sort()]))) };
  } catch {
    return { voter: '', votes: [] };
  }
};
const { voter: keptVoter, votes } = readKept();
const ownName = keptVoter || `voter ${[...crypto.getRandomValues(new Uint8Array(4))].map((byte) => byte.toString(16).padStart(2, '0')).join('')}`;
let voter = ownName, order = [], shown = null, told = '';
let plays = !matchMedia('(prefers-reduced-motion: reduce)').matches;
const keep = () => {
  try {
    localStorage.setItem(storage, JSON.stringify({ voter, votes }));
    return true;
  } catch {
    return false;
  }
};
const ownVotes = () => votes.filter((vote) => vote.voter === voter);

const show = (side, name, result, names) => {
  side.replaceChildren(...names.filter((one) => plays || one !== 'motion').map((one) => {
    const image = new Image(160, 160);
    image.src = result.pictures.get(one).src;
    image.alt = `${name}: ${one}`;
    return image;
  }));
};
const render = () => {
  const own = ownVotes();
  shown = order.find((pair) => !own.some((vote) => sameResults(vote, pair))) ?? null;
  for (const button of buttons) button.disabled = !shown;
  part('undo').disabled = own.length === 0 || own.at(-1).told === true;
  part('save-votes').disabled = votes.length === 0;
  part('play').hidden = !shown?.names.includes('motion');
  part('play').setAttribute('aria-pressed', String(plays));
  part('pair-subject').textContent = shown ? `Which one is better? ${shown.subject}` : 'You have judged all of them.';
  show(part('left'), 'Left', shown?.left, shown?.names ?? []);
  show(part('right'), 'Right', shown?.right, shown?.names ?? []);
  part('tally').textContent = `${told}${own.length} of ${order.length} judged.`;
  part('unkept').hidden = keep();
};
const vote = (choice) => {
  if (!shown) return;
  const { kind, subject, first, second } = shown;
  const tells = part('names').checked;
  votes.push({ voter, kind, subject, first, second, choice, ...(tells ? { told: true } : {}) });
  told = tells ? `Left was ${first}, right was ${second}. ` : '';
  render();
};
const undo = () => {
  if (part('undo').disabled) return;
  votes.splice(votes.lastIndexOf(ownVotes().at(-1)), 1);
  told = '';
  render();
};
const begin = () => {
  voter = part('voter').value.trim() || ownName;
  order = inOrder(pairs, `${voter}\n${ballot.dataset.study}`);
  told = '';
  render();
};

for (const button of buttons) button.addEventListener('click', () => vote(button.dataset.choice));
part('undo').addEventListener('click', undo);
part('play').addEventListener('click', () => {
  plays = !plays;
  render();
});
part('voter').addEventListener('change', begin);
part('save-votes').addEventListener('click', () => {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([csvOf(votes)], { type: 'text/csv' }));
  link.download = 'votes.csv';
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
});
ballot.addEventListener('keydown', (event) => {
  const { target, key } = event;
  if (event.repeat || event.ctrlKey || event.altKey || event.metaKey || target.tagName === 'INPUT') return;
  const choice = { ArrowLeft: 'first', ArrowRight: 'second' }[key] ?? (key === ' ' && target === part('pair') ? 'alike' : null);
  if (choice) vote(choice);
  else if (key === 'Backspace') undo();
  else return;
  event.preventDefault();
});
if (pairs.length) {
  ballot.hidden = false;
  for (const link of document.querySelectorAll('a[href="#ballot"]')) link.hidden = false;
  part('voter').value = voter;
  begin();
}
}
)js";

}  // namespace limber

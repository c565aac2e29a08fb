// Where limber is not sure of a skeleton that it made: the joints whose places would settle most are asked for, one by one.
import type { PageStore } from '../app/state';
import type { Studio } from '../app/studio';
import { button, element } from '../ui/dom';
import { jointTitle } from '../words/parts';
import { say } from '../words/say';

const mostQuestions = 3;

export function doubts(studio: Studio, page: PageStore): HTMLElement {
  let rightAsItIs = new Set<string>(), skeleton = '', lastAsked = '';
  const asked = () => {
    const { session } = page.now;
    if (!session || session.pins.length + rightAsItIs.size >= mostQuestions) return undefined;
    return session.doubts.find((joint) => !rightAsItIs.has(session.joints[joint]!.name));
  };

  const text = element('p', {});
  const show = button(say('Show where it is'), () => void (async () => {
    await studio.correct(true);
    page.set({ selected: asked() ?? null });
  })(), { kind: 'primary', id: 'show-doubt' });
  const right = button(say('It is right'), () => {
    const joint = asked();
    if (joint !== undefined) rightAsItIs.add(page.now.session!.joints[joint]!.name);
    page.set({ selected: page.now.correcting ? asked() ?? null : page.now.selected });
  }, { id: 'right-as-it-is' });
  const card = element('section', { class: 'card doubts', id: 'doubts', hidden: true }, text, element('div', { class: 'row' }, show, right));

  page.watch(({ session, correcting, selected }, before) => {
    const made = session ? `${session.member} ${session.name} ${session.rigger} ${session.joints.length}` : '';
    if (made !== skeleton) [skeleton, rightAsItIs] = [made, new Set()];
    const joint = asked();
    card.hidden = joint === undefined;
    if (!session || joint === undefined) return;
    // Where the last question was answered with a touch, the next one is asked for one.
    const isPinned = (of: typeof session | null) => of?.pins.some((pin) => pin.joint === lastAsked) === true;
    const answered = correcting && isPinned(session) && !isPinned(before.session);
    lastAsked = session.joints[joint]!.name;
    if (answered && selected !== joint) return page.set({ selected: joint });
    const title = jointTitle(session.joints[joint]);
    text.textContent = correcting && selected === joint ? say('Touch the model where this belongs: {joint}', { joint: title })
      : say('Not sure of the skeleton. Is this in its place: {joint}?', { joint: title });
    show.hidden = correcting && selected === joint;
  });
  return card;
}

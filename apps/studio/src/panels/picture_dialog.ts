// Pictures and films that leave the page, and what is behind the model in them.
import { button, element } from '../ui/dom';
import { say } from '../words/say';

export interface Pictures {
  /** On nothing where there is no background. */
  picture(background: string | null): Promise<void>;
  clip(background: string): Promise<void>;
  /** The clip as one picture that repeats, on nothing where there is no background. */
  moving(background: string | null): Promise<void>;
  turn(background: string): Promise<void>;
}

export function pictureDialog(make: Pictures): { dialog: HTMLDialogElement; open(hasClip: boolean): void } {
  const color = element('input', { type: 'color', id: 'background', value: '#ffffff' });
  const none = element('input', { type: 'checkbox', id: 'no-background', checked: true });
  const after = (act: () => Promise<void>) => () => {
    dialog.close();
    void act();
  };
  const clip = button(say('Film of the clip'), after(() => make.clip(color.value)), { id: 'film-clip' });
  const moving = button(say('Moving picture'), after(() => make.moving(none.checked ? null : color.value)), {
    id: 'moving-picture', label: say('Moving picture of the clip: an animated PNG, which repeats'),
  });
  const dialog: HTMLDialogElement = element('dialog', { id: 'pictures', class: 'ask', 'aria-label': say('Pictures and films') },
    element('h2', {}, say('Pictures and films')),
    element('div', { class: 'field' }, element('label', { for: 'background' }, say('Background')), color),
    element('label', { class: 'check', title: say('It can be laid on anything; the shadow stays') }, none, say('None in a picture')),
    element('div', { class: 'row' }, button(say('Picture'), after(() => make.picture(none.checked ? null : color.value)), { id: 'picture', kind: 'primary' }),
      button(say('Film of a turn'), after(() => make.turn(color.value)), { id: 'film-turn' }), clip, moving, button(say('Cancel'), () => dialog.close(), { id: 'close-pictures' })));
  return {
    dialog,
    open(hasClip) {
      clip.disabled = moving.disabled = !hasClip;
      dialog.showModal();
    },
  };
}

// A row of a list that becomes a field of text.
import { element } from './dom';

/** Enter and leaving the field take the new name, Escape the old one. */
export function renameIn(row: HTMLElement, label: string, before: string, take: (name: string) => void) {
  const field = element('input', { class: 'rename', id: 'rename', 'aria-label': label, value: before });
  const children = [...row.childNodes];
  let open = true;
  const close = (taken: boolean) => {
    if (!open) return;
    open = false;
    const name = field.value.trim();
    row.replaceChildren(...children);
    row.closest<HTMLElement>('[tabindex]')?.focus();
    if (taken && name !== '' && name !== before) take(name);
  };
  field.addEventListener('keydown', (event) => {
    event.stopPropagation();
    if (event.key === 'Enter' || event.key === 'Escape') close(event.key === 'Enter');
  });
  field.addEventListener('blur', () => close(true));
  row.replaceChildren(field);
  field.focus();
  field.select();
}

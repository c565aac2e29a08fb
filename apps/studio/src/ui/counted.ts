/** "1 joint", "3 joints"; `many` where an s behind `one` does not make it. */
export function counted(count: number, one: string, many = `${one}s`): string {
  return `${count.toLocaleString('en')} ${count === 1 ? one : many}`;
}

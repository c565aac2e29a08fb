// A value that panels watch.
export class Store<T extends object> {
  private listeners = new Set<(now: T, before: T) => void>();

  constructor(private value: T) {}

  get now(): Readonly<T> { return this.value; }

  set(change: Partial<T>) {
    const before = this.value;
    this.value = { ...before, ...change };
    this.listeners.forEach((listener) => listener(this.value, before));
  }

  /** Calls at once, and after each change, until what it gives is called. */
  watch(listener: (now: T, before: T) => void): () => void {
    this.listeners.add(listener);
    listener(this.value, this.value);
    return () => { this.listeners.delete(listener); };
  }
}

// What fingers do between touching and lifting.
export interface Finger {
  readonly id: number;
  /** Pixels of what is looked through. */
  x: number;
  y: number;
  readonly from: { readonly x: number; readonly y: number };
}

export interface Gesture {
  /** More than a tap: something has moved. */
  readonly begun: boolean;
  /** The fingers, the device or both are elsewhere. */
  frame(): void;
  /** What it did stays; nothing where it has not begun. */
  end(): void;
}

// The card that the camera looks for: a marker of 4 x 4 bits in a black frame of one cell, on a white rim of one cell.
export const dictionary = 'ARUCO_MIP_16h3';
/** The one marker that counts; all others are taken for something else. */
export const cardId = 11;
/** Cells along a side of the black square. */
export const cellsAcross = 6;
/** Metres along the black square's side, as it is printed and shown. */
export const cardSide = 0.08;

/** A corner in the picture, in pixels: x to the right, y down, the middle of the first pixel at (0.5, 0.5). */
export interface Corner { x: number; y: number }
/** As they are printed: upper left, upper right, lower right, lower left. */
export type Corners = [Corner, Corner, Corner, Corner];

/** Brightness of a picture, row by row. */
export interface Grey { width: number; height: number; data: Uint8ClampedArray }

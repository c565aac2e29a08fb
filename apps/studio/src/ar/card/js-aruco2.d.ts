declare module 'js-aruco2/src/aruco.js' {
  interface Marker { id: number; corners: { x: number; y: number }[] }
  export const AR: {
    Detector: new (config: { dictionaryName: string; maxHammingDistance: number }) => {
      detectImage(width: number, height: number, data: Uint8ClampedArray): Marker[];
    };
    DICTIONARIES: Record<string, { nBits: number; codeList: number[] }>;
  };
}
declare module 'js-aruco2/src/dictionaries/aruco_mip_16h3.js';

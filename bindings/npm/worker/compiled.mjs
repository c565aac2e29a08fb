/** The engine's code, compiled once for all threads. */
export async function compiled(code) {
  return code instanceof WebAssembly.Module ? code : WebAssembly.compile(code);
}

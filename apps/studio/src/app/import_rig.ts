// A file whose rig another model is to get, as the engine reads it. Loaded when the first one is chosen.

export async function rigFile(file: File): Promise<{ bytes: Uint8Array; name: string }> {
  const { name } = file, bytes = new Uint8Array(await file.arrayBuffer());
  if (/\.(npz|glb|gltf|vrm|fbx)$/i.test(name)) return { bytes, name };
  const { toGlb } = await import('./import_model');
  return { bytes: await toGlb(bytes, name, new Map()), name };
}

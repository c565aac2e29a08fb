// How far the surface is stretched or squeezed as it stands, as heat: worked out by the graphics card for each frame.
import type { MeshStandardMaterial } from 'three';

const full = 1; // above the size at rest: twice as long, or half, is as hot as can be

// The singular values of the map from the triangle at rest to the posed one are the roots of the eigenvalues of one's metric
// by the other's; any two directions on the triangle will do for these, so the screen's do. The larger of the one value and
// one by the other is the distortion (limber/evaluate/skin/surface_stretch.h).
const heat = `
  #ifdef SHOW_STRETCH
    vec3 restX = dFdx(stretchRest), restY = dFdy(stretchRest), posedX = dFdx(stretchPosed), posedY = dFdy(stretchPosed);
    vec3 was = vec3(dot(restX, restX), dot(restX, restY), dot(restY, restY));
    vec3 is = vec3(dot(posedX, posedX), dot(posedX, posedY), dot(posedY, posedY));
    float area = was.x * was.z - was.y * was.y;
    float half_ = 0.5 * (was.z * is.x - 2.0 * was.y * is.y + was.x * is.z) / area;
    float most = half_ + sqrt(max(0.0, half_ * half_ - (is.x * is.z - is.y * is.y) / area));
    float least = max(1e-6, 2.0 * half_ - most);
    float hot = area > 0.0 ? clamp((sqrt(max(most, 1.0 / least)) - 1.0) / float(${full}), 0.0, 1.0) : 0.0;
    vec3 hue = clamp(abs(mod(6.0 * 0.62 * (1.0 - hot) + vec3(0.0, 4.0, 2.0), 6.0) - 3.0) - 1.0, 0.0, 1.0);
    float light = 0.42 + 0.1 * hot;
    diffuseColor.rgb = light + 0.75 * (1.0 - abs(2.0 * light - 1.0)) * (hue - 0.5);
  #endif`;

/** A material of a surface that is moved; after what else changes its shader. */
export function readyForStretch(material: MeshStandardMaterial) {
  const earlier = material.onBeforeCompile, name = material.customProgramCacheKey();
  material.onBeforeCompile = (shader, renderer) => {
    earlier.call(material, shader, renderer);
    const declared = '\n#ifdef SHOW_STRETCH\nvarying highp vec3 stretchRest, stretchPosed;\n#endif\n';
    const after = (code: string, chunk: string, lines: string) => code.replace(`#include <${chunk}>`, `#include <${chunk}>${lines}`);
    shader.vertexShader = after(shader.vertexShader, 'common', declared).replace('#include <project_vertex>',
      '#ifdef SHOW_STRETCH\nstretchRest = position;\nstretchPosed = transformed;\n#endif\n#include <project_vertex>');
    shader.fragmentShader = after(after(shader.fragmentShader, 'common', declared), 'color_fragment', heat);
  };
  material.customProgramCacheKey = () => `${name} stretch`;
}

export function showStretch(material: MeshStandardMaterial, shown: boolean) {
  const { SHOW_STRETCH: _, ...defines } = material.defines as Record<string, string>;
  material.defines = shown ? { ...defines, SHOW_STRETCH: '' } : defines;
}

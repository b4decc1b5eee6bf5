// One light for everything: a key light over the viewer's left shoulder, a fill from the right, a darker rim. Both sides of a surface are lit alike.

import { directionColourGlsl } from './colours';
import { DataTexture, DoubleSide, GLSL3, LinearFilter, RGBAFormat, ShaderMaterial, SRGBColorSpace, UnsignedByteType, Vector3, Vector4 } from 'three';

const light = /* glsl */ `
vec3 shade(vec3 base, vec3 normal, vec3 toEye) {
  vec3 n = normalize(normal), v = normalize(toEye);
  if (dot(n, v) < 0.0) n = -n;
  vec3 key = normalize(vec3(-0.45, 0.65, 0.75)), fill = normalize(vec3(0.85, -0.1, 0.45));
  float wrapped = max(0.0, (dot(n, key) + 0.25) / 1.25);
  float diffuse = 0.40 + 0.09 * n.y + 0.60 * wrapped + 0.16 * max(0.0, dot(n, fill));
  float facing = max(0.0, dot(n, v));
  float rim = pow(1.0 - facing, 3.0);
  float gloss = pow(max(0.0, dot(n, normalize(key + v))), 56.0);
  return base * diffuse * (1.0 - 0.45 * rim) + (0.012 + 0.14 * base) * gloss;
}
vec3 srgb(vec3 c) { return mix(1.055 * pow(max(c, vec3(0.0)), vec3(0.4166667)) - 0.055, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308)))); }
`;

const clipping = /* glsl */ `
uniform vec4 clip;
void cut(vec3 p) { if (dot(clip.xyz, p) > clip.w) discard; }
`;

/** What lies beyond (normal . x > offset) is cut away. */
export interface ClipPlane {
  normal: [number, number, number];
  offset: number;
}

/** How a surface gets its colour: one colour, a number through the colour map, or a direction. */
export enum Mode {
  plain = 0,
  scalar = 1,
  direction = 2,
}

export const plainColour = new Vector3(0.55, 0.62, 0.70);
export const neutralColour = new Vector3(0.42, 0.42, 0.42);

/** Linear colours; `opacity` below 1 shows what is inside. */
export function surfaceMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    side: DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1.5,
    polygonOffsetUnits: 2,
    uniforms: {
      mode: { value: Mode.plain },
      plain: { value: plainColour.clone() },
      neutral: { value: neutralColour.clone() },
      map: { value: null },
      range: { value: new Vector3(0, 1, 0) },
      opacity: { value: 1 },
      clip: { value: new Vector4(0, 0, 0, 1) },
    },
    vertexShader: /* glsl */ `
in vec2 scalar;
in vec3 direction;
out vec3 vNormal;
out vec3 vEye;
out vec3 vWorld;
out vec2 vScalar;
out vec3 vDirection;
void main() {
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  vNormal = normalMatrix * normal;
  vEye = isOrthographic ? vec3(0.0, 0.0, 1.0) : -p.xyz;
  vWorld = position;
  vScalar = scalar;
  vDirection = direction;
  gl_Position = projectionMatrix * p;
}`,
    fragmentShader: /* glsl */ `
${light}${clipping}${directionColourGlsl}
uniform int mode;
uniform vec3 plain, neutral, range;
uniform float opacity;
uniform sampler2D map;
in vec3 vNormal;
in vec3 vEye;
in vec3 vWorld;
in vec2 vScalar;
in vec3 vDirection;
out vec4 colour;
void main() {
  cut(vWorld);
  vec3 base = plain;
  if (mode == 1) {
    float x = range.z > 0.5 ? log(max(vScalar.x, 1e-37)) : vScalar.x;
    float s = clamp((x - range.x) / (range.y - range.x), 0.0, 1.0);
    base = vScalar.y > 0.999 ? texture(map, vec2((0.5 + 255.0 * s) / 256.0, 0.5)).rgb : neutral;
  } else if (mode == 2) {
    float n = length(vDirection);
    base = n > 1e-6 && vScalar.y > 0.999 ? directionColour(vDirection / n) : neutral;
  }
  colour = vec4(srgb(shade(base, vNormal, vEye)), opacity);
}`,
  });
}

/** Instanced glyphs: `axes` (three columns) and `place` for each instance; normals by the inverse transpose, so that ellipsoids are lit rightly. */
export function glyphMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    side: DoubleSide,
    uniforms: { clip: { value: new Vector4(0, 0, 0, 1) } },
    vertexShader: /* glsl */ `
in vec3 paint;
in vec3 axis0;
in vec3 axis1;
in vec3 axis2;
in vec3 place;
in vec3 tint;
out vec3 vNormal;
out vec3 vEye;
out vec3 vWorld;
out vec3 vColour;
void main() {
  mat3 m = mat3(axis0, axis1, axis2);
  vec3 world = place + m * position;
  vec4 p = modelViewMatrix * vec4(world, 1.0);
  vec3 n = mat3(cross(axis1, axis2), cross(axis2, axis0), cross(axis0, axis1)) * normal;
  vNormal = normalMatrix * (dot(n, m * normal) < 0.0 ? -n : n);
  vEye = isOrthographic ? vec3(0.0, 0.0, 1.0) : -p.xyz;
  vWorld = place;
  vColour = paint * tint;
  gl_Position = projectionMatrix * p;
}`,
    fragmentShader: /* glsl */ `
${light}${clipping}
in vec3 vNormal;
in vec3 vEye;
in vec3 vWorld;
in vec3 vColour;
out vec4 colour;
void main() {
  cut(vWorld);
  colour = vec4(srgb(shade(vColour, vNormal, vEye)), 1.0);
}`,
  });
}

/** Lines of a given width in device pixels: every segment is an instance of a strip that faces the viewer. */
export function lineMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    transparent: true,
    depthWrite: false,
    side: DoubleSide,
    uniforms: {
      clip: { value: new Vector4(0, 0, 0, 1) },
      ink: { value: new Vector4(0, 0, 0, 0.5) },
      width: { value: 1 },
      screen: { value: new Vector3(1, 1, 1) },
    },
    vertexShader: /* glsl */ `
uniform float width;
uniform vec3 screen;
in vec3 from;
in vec3 to;
out vec3 vWorld;
void main() {
  vec4 a = projectionMatrix * modelViewMatrix * vec4(from, 1.0), b = projectionMatrix * modelViewMatrix * vec4(to, 1.0);
  vec2 d = (b.xy / b.w - a.xy / a.w) * screen.xy;
  float n = length(d);
  d = n > 1e-6 ? d / n : vec2(1.0, 0.0);
  vec4 p = position.x < 0.5 ? a : b;
  p.xy += (vec2(-d.y, d.x) * position.y + d * (position.x - 0.5) * 0.5) * width * p.w / screen.xy;
  vWorld = position.x < 0.5 ? from : to;
  gl_Position = p;
}`,
    fragmentShader: /* glsl */ `
${clipping}
uniform vec4 ink;
in vec3 vWorld;
out vec4 colour;
void main() {
  cut(vWorld);
  colour = ink;
}`,
  });
}

export function mapTexture(pixels: Uint8Array): DataTexture {
  const texture = new DataTexture(pixels, pixels.length / 4, 1, RGBAFormat, UnsignedByteType);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = LinearFilter;
  texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

export function setClip(material: ShaderMaterial, plane: ClipPlane): void {
  (material.uniforms.clip.value as Vector4).set(plane.normal[0], plane.normal[1], plane.normal[2], plane.offset);
}

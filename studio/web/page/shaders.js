// Surfaces lit from the sky and by one lamp with a soft shadow. What is coloured by temperature is shaded less, so that
// its colour can be read off the legend.

export const VERTEX = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform vec3 place;
uniform vec4 turn;  // (w, x, y, z)
uniform mat4 camera, lamp;
out vec3 at, facing;
out vec4 inLamp;
vec3 turned(vec3 v) { vec3 t = 2.0 * cross(turn.yzw, v); return v + turn.x * t + cross(turn.yzw, t); }
void main() {
  at = turned(position) + place;
  facing = turned(normal);
  inLamp = lamp * vec4(at, 1.0);
  gl_Position = camera * vec4(at, 1.0);
}`;

// taps: of the shadow's edge, 4 for a soft one or 1.
export const fragment = (taps) => `#version 300 es
precision highp float;
precision highp sampler2DShadow;
in vec3 at, facing;
in vec4 inLamp;
uniform vec3 colour, eye, light;  // colour: linear
uniform float gloss, flatness, alpha;
uniform sampler2DShadow dark;
out vec4 result;
float lit() {
  vec3 p = inLamp.xyz / inLamp.w * 0.5 + 0.5;
  if (any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)))) return 1.0;
  float sum = 0.0;
  for (int i = 0; i < ${taps}; i++) {
    vec2 off = ${taps === 1 ? "vec2(0.0)" : "vec2(float(i % 2) - 0.5, float(i / 2) - 0.5) * 1.6 / 1024.0"};
    sum += texture(dark, vec3(p.xy + off, p.z - 0.0015));
  }
  return sum / ${taps.toFixed(1)};
}
void main() {
  vec3 n = normalize(facing), to = normalize(eye - at), half_ = normalize(light + to);
  float shade = lit() * max(dot(n, light), 0.0);
  vec3 sky = mix(vec3(0.30, 0.29, 0.28), vec3(0.62, 0.64, 0.68), n.z * 0.5 + 0.5);
  float fill = 0.16 * max(dot(n, normalize(vec3(-0.7, 0.5, 0.2))), 0.0);
  vec3 shaded = colour * (sky + fill + 0.85 * shade) + gloss * 0.35 * shade * pow(max(dot(n, half_), 0.0), 42.0);
  vec3 plain = colour * (0.72 + 0.28 * shade);
  result = vec4(pow(mix(shaded, plain, flatness), vec3(1.0 / 2.2)), alpha);
}`;

export const SHADOW = `#version 300 es
precision highp float;
void main() {}`;

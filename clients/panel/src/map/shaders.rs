//! The three programs that draw what lies on the floor. Map coordinates are metres; `eye` makes clip coordinates of them, from straight
//! above as from an orbit; `pixel` is the size of a device pixel in clip units.

/// One rectangle over the whole picture: what is outside, the floor plan, and the swept area.
pub(crate) const GROUND_VERTEX: &str = "#version 300 es
uniform mat3 floor_from_clip;
out vec3 spot;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  spot = floor_from_clip * vec3(corner, 1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}";

pub(crate) const GROUND_FRAGMENT: &str = "#version 300 es
precision highp float;
in vec3 spot;
uniform sampler2D plan;
uniform sampler2D swept;
uniform vec4 plan_pose;
uniform vec2 plan_size;
uniform vec4 swept_box;
uniform vec3 outside_colour;
uniform vec3 grid_colour;
uniform vec3 swept_colour;
out vec4 colour;
float inside(vec2 p) { vec2 s = step(vec2(0.0), p) * step(p, vec2(1.0)); return s.x * s.y; }
void main() {
  vec2 place = spot.xy / spot.z;
  float scale = 1.0 / max(length(dFdx(place)), length(dFdy(place)));
  vec2 nearest = abs(fract(place + 0.5) - 0.5) * scale;
  float line = 1.0 - smoothstep(0.4, 1.1, min(nearest.x, nearest.y));
  vec3 ground = mix(outside_colour, grid_colour, line * smoothstep(12.0, 30.0, scale));
  vec2 d = place - plan_pose.xy;
  vec2 p = vec2(dot(d, plan_pose.zw), dot(d, vec2(-plan_pose.w, plan_pose.z))) / plan_size;
  vec4 cell = texture(plan, p) * inside(p);
  ground = ground * (1.0 - cell.a) + cell.rgb;
  vec2 s = (place - swept_box.xy) / swept_box.zw;
  float done = texture(swept, s).r * inside(s);
  float light = dot(ground, vec3(0.3, 0.59, 0.11));
  float floor_light = dot(outside_colour, vec3(0.3, 0.59, 0.11));
  colour = vec4(mix(ground, swept_colour, done * (abs(light - floor_light) < 0.22 ? 0.75 : 0.3)), 1.0);
}";

/// One instance a segment: a bar with soft edges, a little longer than the segment so that corners close.
pub(crate) const LINE_VERTEX: &str = "#version 300 es
layout(location = 0) in vec2 from;
layout(location = 1) in vec2 to;
uniform mat4 eye;
uniform vec2 pixel;
uniform float half_width;
out float across;
const float NEAR = 0.02;
void main() {
  vec4 first = eye * vec4(from, 0.0, 1.0);
  vec4 last = eye * vec4(to, 0.0, 1.0);
  if (max(first.w, last.w) <= NEAR) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  if (first.w < NEAR) first = mix(first, last, (NEAR - first.w) / (last.w - first.w));
  if (last.w < NEAR) last = mix(last, first, (NEAR - last.w) / (first.w - last.w));
  vec2 a = first.xy / first.w / pixel;
  vec2 b = last.xy / last.w / pixel;
  vec2 way = b - a;
  float size = length(way);
  vec2 along = size > 0.0 ? way / size : vec2(1.0, 0.0);
  float end = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  float side = gl_VertexID < 2 ? -1.0 : 1.0;
  across = side * (half_width + 1.0);
  vec2 at = (end < 0.0 ? a : b) + along * end * 0.5 * half_width + vec2(-along.y, along.x) * across;
  vec4 deep = end < 0.0 ? first : last;
  gl_Position = vec4(at * pixel, deep.z / deep.w, 1.0);
}";

pub(crate) const LINE_FRAGMENT: &str = "#version 300 es
precision highp float;
in float across;
uniform float half_width;
uniform vec3 line_colour;
out vec4 colour;
void main() {
  float cover = clamp(half_width + 0.5 - abs(across), 0.0, 1.0);
  colour = vec4(line_colour * cover, cover);
}";

/// One instance a mark: bumps (kind 0), cliffs (1), the robot (2), its true place (3), the dock (4), a door (5), where the
/// robot may be (6), and its shadow (7). Bumps and cliffs face the eye and are as large everywhere; what belongs to the robot lies
/// on top of it, `lift` above the floor.
pub(crate) const MARK_VERTEX: &str = "#version 300 es
layout(location = 0) in vec4 body;
layout(location = 1) in float kind;
uniform mat4 eye;
uniform vec2 pixel;
uniform float lift;
out vec2 p;
flat out float k;
void main() {
  p = (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0) * 1.5;
  k = kind;
  if (kind < 1.5) {
    vec4 middle = eye * vec4(body.xy, 0.5 * lift, 1.0);
    gl_Position = middle + vec4(p * body.w * pixel * middle.w, 0.0, 0.0);
    return;
  }
  float c = cos(body.z), s = sin(body.z);
  vec2 at = body.xy + vec2(c * p.x - s * p.y, s * p.x + c * p.y) * body.w;
  gl_Position = eye * vec4(at, kind < 3.5 ? lift : 0.0, 1.0);
}";

pub(crate) const MARK_FRAGMENT: &str = "#version 300 es
precision highp float;
in vec2 p;
flat in float k;
uniform float lift;
uniform float fade;
uniform vec3 mark_colour;
uniform vec3 body_colour;
uniform vec3 front_colour;
uniform vec3 halo_colour;
uniform vec3 thought_colour;
out vec4 colour;
float soft;
float under(float edge, float d) { return 1.0 - smoothstep(edge - soft, edge + soft, d); }
float band(float low, float high, float d) { return under(high, d) * (1.0 - under(low, d)); }
void paint(inout vec4 c, vec3 rgb, float a) { c = c * (1.0 - a) + vec4(rgb * a, a); }
void main() {
  soft = 0.75 * max(length(dFdx(p)), length(dFdy(p)));
  float d = length(p);
  float angle = abs(atan(p.y, p.x));
  vec4 c = vec4(0.0);
  if (k < 1.5) {
    float shape = k < 0.5 ? d : (abs(p.x) + abs(p.y)) * 0.8;
    paint(c, halo_colour, 0.9 * under(1.0, shape));
    paint(c, mark_colour, under(0.68, shape));
  } else if (k < 2.5) {
    if (lift == 0.0) {
      c = vec4(0.0, 0.0, 0.0, 0.28 * (1.0 - smoothstep(0.85, 1.35, d)));
      paint(c, halo_colour, under(1.06, d));
    }
    paint(c, body_colour, under(lift > 0.0 ? 1.0 : 0.98, d));
    paint(c, front_colour, band(0.70, 0.88, d) * under(1.15, angle));
    paint(c, halo_colour, band(0.26, 0.36, length(p + vec2(0.08, 0.0))) * 0.9);
  } else if (k < 3.5) {
    float dashes = step(0.4, fract(atan(p.y, p.x) * 2.228));
    paint(c, mark_colour, band(0.90, 1.02, d) * dashes * 0.75);
    float needle = step(0.35, p.x) * step(p.x, 0.78) * under(0.06, abs(p.y));
    paint(c, mark_colour, needle * 0.75);
  } else if (k > 6.5) {
    c = vec4(0.0, 0.0, 0.0, 0.4 * (1.0 - smoothstep(0.8, 1.4, d)));
  } else if (k > 5.5) {
    paint(c, thought_colour, 0.16 * under(1.0, d));
    paint(c, thought_colour, 0.55 * band(1.0 - 2.0 * soft, 1.0, d));
  } else if (k > 4.5) {
    paint(c, halo_colour, 0.35 * under(1.0, d));
    paint(c, body_colour, 0.3 * band(1.0 - 2.0 * soft, 1.0, d));
  } else {
    vec2 q = abs(p) - vec2(0.55, 0.85);
    float box = length(max(q, 0.0)) + min(max(q.x, q.y), 0.0) - 0.12;
    paint(c, halo_colour, under(0.07, box));
    paint(c, body_colour, under(0.0, box));
    float contact = step(abs(abs(p.y) - 0.36), 0.14) * step(abs(p.x), 0.32);
    paint(c, front_colour, contact);
  }
  colour = c * fade;
}";

//! The two shader programs for things above the floor in the orbit view: blocks, and the body of the robot.

/// One instance a block: walls and furniture in the frame of their plan, and the parts of the dock in its. Thirty corners: the top,
/// then the sides.
pub(crate) const BLOCK_VERTEX: &str = "#version 300 es
layout(location = 0) in vec4 sides;
uniform mat4 eye;
uniform vec4 pose;
uniform float height;
flat out vec2 facing;
out float rise;
void main() {
  int corner = int[](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
  int face = gl_VertexID / 6;
  float u = float(corner & 1), v = float(corner >> 1);
  vec3 share = vec3(u, v, 1.0);
  vec2 normal = vec2(0.0);
  if (face == 1) { share = vec3(u, 0.0, v); normal = vec2(0.0, -1.0); }
  if (face == 2) { share = vec3(1.0, u, v); normal = vec2(1.0, 0.0); }
  if (face == 3) { share = vec3(1.0 - u, 1.0, v); normal = vec2(0.0, 1.0); }
  if (face == 4) { share = vec3(0.0, 1.0 - u, v); normal = vec2(-1.0, 0.0); }
  mat2 turn = mat2(pose.z, pose.w, -pose.w, pose.z);
  facing = turn * normal;
  rise = share.z;
  vec2 at = pose.xy + turn * mix(sides.xy, sides.zw, share.xy);
  gl_Position = eye * vec4(at, share.z * height, 1.0);
}";

/// The top has a colour of its own; a side is the brighter the more it faces the light, and darker towards the floor.
pub(crate) const BLOCK_FRAGMENT: &str = "#version 300 es
precision highp float;
flat in vec2 facing;
in float rise;
uniform vec3 top_colour;
uniform vec3 side_colour;
out vec4 colour;
void main() {
  float light = 0.86 + 0.14 * dot(facing, vec2(-0.8, -0.6));
  vec3 side = side_colour * light * mix(0.82, 1.0, rise);
  colour = vec4(dot(facing, facing) > 0.5 ? side : top_colour, 1.0);
}";

/// The side of the robot's body; of other marks nothing. Its front is where its bumper is.
pub(crate) const DRUM_VERTEX: &str = "#version 300 es
layout(location = 0) in vec4 body;
layout(location = 1) in float kind;
uniform mat4 eye;
uniform float height;
out float angle;
out float rise;
void main() {
  angle = float(gl_VertexID >> 1) * 0.19634954 - 3.14159265;
  rise = 1.0 - float(gl_VertexID & 1);
  float heading = angle + body.z;
  float size = abs(kind - 2.0) < 0.5 ? body.w : 0.0;
  vec2 at = body.xy + vec2(cos(heading), sin(heading)) * size;
  gl_Position = eye * vec4(at, rise * height, 1.0);
}";

pub(crate) const DRUM_FRAGMENT: &str = "#version 300 es
precision highp float;
in float angle;
in float rise;
uniform vec3 body_colour;
uniform vec3 front_colour;
out vec4 colour;
void main() {
  float bumper = step(abs(angle), 1.45) * step(0.2, rise) * step(rise, 0.8);
  vec3 side = mix(body_colour * 0.8, front_colour, bumper * 0.85);
  colour = vec4(side * mix(0.75, 1.0, rise), 1.0);
}";

/// Corners of [`BLOCK_VERTEX`], and of the strip of [`DRUM_VERTEX`].
pub(crate) const BLOCK_CORNERS: i32 = 30;
pub(crate) const DRUM_CORNERS: i32 = 66;

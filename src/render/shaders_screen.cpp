#include "render/shaders.h"

namespace calot {

std::string screen_vertex_shader() {
  return R"(#version 330 core
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0);
}
)";
}

std::string occlusion_fragment_shader() {
  return R"(#version 330 core
uniform sampler2D depth_map;
uniform vec2 tangent;       // of the half angles of the undistorted picture
uniform vec2 planes;        // near, far (m)
out vec4 colour;
vec3 place_at(vec2 at) {
  // The texel's own centre: a place between texels would lie off the surface.
  ivec2 size = textureSize(depth_map, 0);
  ivec2 texel = clamp(ivec2(at * vec2(size)), ivec2(0), size - 1);
  at = (vec2(texel) + 0.5) / vec2(size);
  float ndc = 2.0 * texelFetch(depth_map, texel, 0).r - 1.0;
  float z = 2.0 * planes.x * planes.y / (planes.y + planes.x - ndc * (planes.y - planes.x));
  return vec3((2.0 * at - 1.0) * tangent * z, z);
}
const vec2 taps[6] = vec2[](vec2(0.28, 0.12), vec2(-0.22, 0.38), vec2(-0.50, -0.26), vec2(0.16, -0.66),
                            vec2(0.80, 0.36), vec2(-0.58, 0.78));
void main() {
  const float reach = 7e-3;  // m
  vec2 here = (2.0 * floor(gl_FragCoord.xy) + 0.5) / vec2(textureSize(depth_map, 0));
  vec3 p = place_at(here);
  vec3 n = normalize(cross(dFdx(p), dFdy(p)));
  if (n.z > 0.0) n = -n;
  // Every pixel of a 2 x 2 block turns the taps; an average over such a block follows.
  int turn = (int(gl_FragCoord.x) & 1) + 2 * (int(gl_FragCoord.y) & 1);
  float angle = 0.3927 * float(turn);
  mat2 rotation = mat2(cos(angle), sin(angle), -sin(angle), cos(angle));
  vec2 scale = reach / (p.z * tangent) * 0.5;
  float sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    vec3 d = place_at(here + rotation * taps[i] * scale) - p;
    float squared = dot(d, d);
    sum += max(0.0, dot(d, n) * inversesqrt(squared + 1e-8) - 0.12) * reach * reach / (reach * reach + 2.0 * squared);
  }
  // Across a silhouette the normal from depths means nothing.
  float jump = max(abs(dFdx(p.z)), abs(dFdy(p.z)));
  colour = vec4(clamp(1.0 - 0.46 * sum * smoothstep(2.5e-3, 1e-3, jump), 0.0, 1.0));
}
)";
}

std::string average_fragment_shader() {
  return R"(#version 330 core
in vec2 uv;
uniform sampler2D picture;
uniform vec2 texel;
out vec4 colour;
void main() { colour = texture(picture, uv + 0.5 * texel); }
)";
}

std::string glow_fragment_shader() {
  return R"(#version 330 core
in vec2 uv;
uniform sampler2D picture;
uniform vec2 texel;
out vec4 colour;
void main() {
  float a = texture(picture, uv + texel * vec2(-1.0, -1.0)).a + texture(picture, uv + texel * vec2(1.0, -1.0)).a +
            texture(picture, uv + texel * vec2(-1.0, 1.0)).a + texture(picture, uv + texel * vec2(1.0, 1.0)).a;
  colour = vec4(0.25 * a);
}
)";
}

std::string blur_fragment_shader() {
  return R"(#version 330 core
in vec2 uv;
uniform sampler2D picture;
uniform vec2 texel;  // along the blurred direction only
out vec4 colour;
void main() {
  float sum = 0.227 * texture(picture, uv).r;
  sum += 0.316 * (texture(picture, uv + 1.385 * texel).r + texture(picture, uv - 1.385 * texel).r);
  sum += 0.0703 * (texture(picture, uv + 3.231 * texel).r + texture(picture, uv - 3.231 * texel).r);
  colour = vec4(sum);
}
)";
}

std::string lens_fragment_shader() {
  return "#version 330 core\n" + film_functions() + R"(
in vec2 uv;
uniform sampler2D picture;
uniform sampler2D occlusion;
uniform sampler2D glow;
uniform sampler2D exposure;
uniform vec2 field;    // half the picture over the round field's radius
uniform vec2 extent;   // of the undistorted picture over the tangent at the field's edge
uniform float barrel;
uniform float alive;   // 1: what shades itself is tissue, and shines red; 0: a training box
out vec4 colour;
// Bright light rolls off by how bright it is, not a colour channel: yellow stays yellow. Light above 0.5 nears 1 (d).
vec3 rolled_off(vec3 light) {
  float bright = dot(light, vec3(0.3, 0.5, 0.2)), above = max(bright - 0.5, 0.0);
  return light * (bright - above + above / (1.0 + 2.0 * above)) / max(bright, 1e-6);
}
void main() {
  vec2 d = (2.0 * uv - 1.0) * field;
  float squared = dot(d, d);
  if (squared >= 1.0) {
    colour = vec4(0.0, 0.0, 0.0, 1.0);
    return;
  }
  vec2 at = d * (1.0 - barrel + barrel * squared) / extent * 0.5 + 0.5;
  vec4 seen = texture(picture, at);
  float ao = texture(occlusion, at).r;
  float scale = texelFetch(exposure, ivec2(0), 0).r;
  vec3 light = scale * light_on(seen.rgb);
  vec3 shade = mix(mix(vec3(1.0), mix(vec3(ao), vec3(ao, ao * ao, ao * ao), alive), 0.85), vec3(1.0), seen.a);
  vec3 c = film(mix(rolled_off(light), light, seen.a)) * shade;
  c += 0.55 * min(scale, 1.0) * texture(glow, at).r * vec3(1.0, 0.94, 0.90);
  float grey = dot(c, vec3(0.30, 0.59, 0.11));
  c = grey + 1.08 * (c - grey);
  c *= 1.0 - 0.42 * squared * squared;
  float edge = smoothstep(1.0, 0.955, sqrt(squared));
  colour = vec4(clamp(c, 0.0, 1.0) * edge, 1.0);
}
)";
}

}  // namespace calot

#include <fmt/format.h>

#include "render/shaders.h"

namespace calot {
namespace {

// Light is 1 of white that is lit as what the laparoscope looks at (d, all of these).
constexpr double well_lit = 0.40;       // bright parts of a picture that is exposed as usual
constexpr double adapts = 0.80;         // exponent: of twice the light a picture still gets somewhat brighter
constexpr double least_exposure = 0.3;  // before something that nearly touches the lens
constexpr double most_exposure = 1.12;  // in the dark: noise would show with more

}  // namespace

std::string film_functions() {
  return R"(
// Light to a picture's values: a shoulder that never ends, and gamma 2. Even light of 20 stays below 0.99.
vec3 film(vec3 light) {
  vec3 x = 1.35 * light;
  return sqrt(x * (2.51 * x + 0.03) / (x * (2.51 * x + 0.53) + 0.14));
}
// The light that has these values; 0.995 is what is kept of more.
vec3 light_on(vec3 film) {
  vec3 y = min(film * film, 0.995 * 0.995);
  vec3 b = 0.03 - 0.53 * y, a = 2.51 * (1.0 - y);
  return (sqrt(b * b + 0.56 * a * y) - b) / (2.7 * a);
}
)";
}

std::string meter_fragment_shader() {
  return fmt::format("#version 330 core\n#define METER_CELLS {}\n", meter_cells) + film_functions() + R"(
in vec2 uv;                // of the square about the round field
uniform sampler2D picture;
uniform vec2 extent;       // of the undistorted picture over the tangent at the field's edge
uniform float barrel;
out vec4 colour;           // weight * light^4, weight
void main() {
  vec2 cell = 1.0 / vec2(METER_CELLS);
  colour = vec4(0.0);
  for (int i = 0; i < 16; ++i) {
    vec2 d = 2.0 * (uv + (vec2(i & 3, i >> 2) - 1.5) * 0.25 * cell) - 1.0;
    float squared = dot(d, d);
    if (squared >= 1.0) continue;
    vec4 seen = textureLod(picture, d * (1.0 - barrel + barrel * squared) / extent * 0.5 + 0.5, 0.0);
    // A few brilliant pixels are not to darken all.
    float light = min(dot(light_on(seen.rgb), vec3(0.3, 0.5, 0.2)), 3.0);
    // Glints do not count: wet tissue has them in any light.
    float weight = (1.0 - 0.7 * squared) * (1.0 - smoothstep(0.0, 0.1, seen.a));
    colour += vec4(weight * light * light * light * light, weight, 0.0, 0.0);
  }
}
)";
}

std::string exposure_fragment_shader() {
  return fmt::format(
             "#version 330 core\n#define METER_CELLS {}\n#define WELL_LIT {:.3f}\n#define ADAPTS {:.3f}\n"
             "#define LEAST_EXPOSURE {:.3f}\n#define MOST_EXPOSURE {:.3f}\n",
             meter_cells, well_lit, adapts, least_exposure, most_exposure) +
         R"(
uniform sampler2D picture;  // meter_fragment_shader()'s
uniform float asked;        // how many times as bright as usual the picture is to be
out vec4 colour;
void main() {
  vec2 sum = vec2(0.0);
  for (int y = 0; y < METER_CELLS; ++y)
    for (int x = 0; x < METER_CELLS; ++x) sum += texelFetch(picture, ivec2(x, y), 0).rg;
  float light = sqrt(sqrt(sum.x / max(sum.y, 1e-6))) / max(asked, 1e-3);
  colour = vec4(clamp(pow(WELL_LIT / max(light, 1e-6), ADAPTS), LEAST_EXPOSURE, MOST_EXPOSURE));
}
)";
}

}  // namespace calot

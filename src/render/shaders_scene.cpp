#include <fmt/format.h>

#include "render/noise_volume.h"
#include "render/shaders.h"

namespace calot {
namespace {

// Places are relative to the camera (m); rest positions are in mm.
// The broadest noise varies slowly enough to be looked up at vertices: a lookup a pixel saved.
const char* const vertex_shader = R"(
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 outward;
layout(location = 2) in vec3 at_rest;
layout(location = 3) in float share_burnt;
uniform mat4 clip_from_place;
uniform sampler3D noise_volume;
out vec3 place;
out vec3 normal;
out vec3 rest;
out vec4 broad;
out float burnt;
void main() {
  place = at;
  normal = outward;
  rest = 1000.0 * at_rest;
  burnt = share_burnt;
  broad = textureLod(noise_volume, rest * (1.0 / (CELLS * BROAD_CELL)), 0.0) * 2.0 - 1.0;
  gl_Position = clip_from_place * vec4(at, 1.0);
}
)";

const char* const prelude = R"(
in vec3 place;
in vec3 normal;
in vec3 rest;
in vec4 broad;             // noise of the cell BROAD_CELL
in float burnt;            // share: 0.5 is whitened, 1 charred
uniform mat4 shadow_from_place;
uniform vec3 light;        // place of the light
uniform vec3 view_axis;    // where the laparoscope looks
uniform float intensity;
uniform float alive;       // 1: what lies around is tissue, and its light red; 0: a training box' walls
uniform sampler3D noise_volume;
uniform sampler2DShadow shadow_map;
#ifdef SHINES_THROUGH
layout(location = 0, index = 0) out vec4 colour;   // what it adds
layout(location = 0, index = 1) out vec4 covered;  // share of what is below it that it hides, a colour channel
#else
out vec4 colour;
#endif

// Gradient a cell in rgb (scaled to about [-1, 1]), value in a; features are about `cell` mm large.
vec4 noise(vec3 mm, float cell) {
  return texture(noise_volume, mm * (1.0 / (CELLS * cell))) * 2.0 - 1.0;
}
// Distance (mm) to the surface where a noise vanishes, to first order.
float distance_to_zero(vec4 n, float cell) {
  return abs(n.a) * cell / (GRADIENT_RANGE * length(n.rgb) + 0.15);
}

struct Surface {
  vec3 albedo;
  vec3 scatter;    // how far light wraps into the shadow side, a colour channel
  vec3 slope;      // of the wet film's height by rest position
  float relief;    // share of that slope the tissue below follows
  float gloss;     // exponent of the film's highlight
  float film;      // strength of the film
};
)";

const char* const gallbladder_material = R"(
uniform sampler3D vessel_map;
uniform vec3 vessel_lower, vessel_scale;
// The gallbladder's wall: bile shows bluish green through the serosa, the serosa is a whitish pink veil.
Surface surface_at(vec3 p) {
  vec4 middle = noise(p * vec3(1.0, 1.0, 0.75) + 3.0 * broad.rgb, 4.6);
  vec4 fine = noise(p, 1.5);
  float vessel = texture(vessel_map, (p + 0.25 * middle.rgb - vessel_lower) * vessel_scale).r;

  // Seen along the wall there is more of it: bile shows in the middle, the wall towards the outline.
  float facing = abs(dot(normalize(normal), normalize(place)));
  float thick = smoothstep(-0.55, 0.65, broad.a + 0.45 * middle.a + 0.15 * fine.a);
  thick = 0.08 + 0.55 * thick + 0.37 * (1.0 - facing) * (1.0 - facing);
  vec3 albedo = mix(BILE, vec3(0.385, 0.305, 0.225), thick);
  albedo = mix(albedo, vec3(0.44, 0.17, 0.12), 0.45 * smoothstep(-0.05, 0.55, broad.g + 0.5 * middle.r));
  albedo = mix(albedo, vec3(0.26, 0.036, 0.040), VESSELS * vessel);

  float fat = smoothstep(0.05, 0.40, middle.a + 0.8 * broad.a + 0.3 * fine.a + FAT_BIAS);
  albedo = mix(albedo, vec3(0.66, 0.44, 0.15), 0.85 * fat);

  vec3 slope = 0.30 * broad.rgb + 0.52 * middle.rgb + (0.42 + 0.2 * fat) * fine.rgb;
  return Surface(albedo, vec3(0.42, 0.24, 0.18), slope, 0.16, 300.0, 1.5);
}
)";

const char* const liver_material = R"(
Surface surface_at(vec3 p) {
  vec4 middle = noise(p, 6.0);
  vec4 lobules = noise(p, 1.3);
  vec3 albedo = mix(vec3(0.150, 0.038, 0.027), vec3(0.215, 0.064, 0.041), smoothstep(-0.5, 0.5, broad.a));
  albedo *= 1.0 + 0.16 * middle.a + 0.20 * lobules.a;
  vec3 slope = 0.40 * broad.rgb + 0.40 * middle.rgb + 0.34 * lobules.rgb;
  return Surface(albedo, vec3(0.20, 0.06, 0.04), slope, 0.15, 170.0, 2.4);
}
)";

const char* const capsule_material = R"(
// Smooth and dark: a broad soft sheen, and a mirrored light where the surface faces it, for the capsule has no relief
// of its own but the faint one of the lobules below it.
Surface surface_at(vec3 p) {
  vec4 middle = noise(p, 7.0);
  vec4 lobules = noise(p, 1.3);
  vec3 albedo = mix(vec3(0.098, 0.026, 0.019), vec3(0.150, 0.043, 0.028), smoothstep(-0.5, 0.5, broad.a));
  albedo *= 1.0 + 0.10 * middle.a + 0.13 * lobules.a;
  vec3 slope = 0.06 * broad.rgb + 0.05 * middle.rgb + 0.03 * lobules.rgb;
  return Surface(albedo, vec3(0.20, 0.06, 0.04), slope, 0.3, 700.0, 0.33);
}
)";

const char* const bowel_material = R"(
// Pale pink serosa; its vessels run around the tube, whose axis is z.
Surface surface_at(vec3 p) {
  vec4 middle = noise(p + 4.0 * broad.rgb, 8.0);
  vec4 around = noise(vec3(0.4 * p.xy, p.z) + 2.0 * broad.rgb, 5.0);
  vec4 fine = noise(p, 1.4);
  vec3 albedo = mix(vec3(0.25, 0.105, 0.075), vec3(0.34, 0.18, 0.125), smoothstep(-0.5, 0.6, broad.a + 0.5 * middle.a));
  float vessel = smoothstep(0.34, 0.06, distance_to_zero(around, 5.0)) * smoothstep(-0.1, 0.6, broad.r + 0.5 * middle.r);
  albedo = mix(albedo, vec3(0.25, 0.04, 0.035), 0.5 * vessel);
  vec3 slope = 0.12 * broad.rgb + 0.13 * middle.rgb + 0.08 * fine.rgb;
  return Surface(albedo, vec3(0.38, 0.17, 0.12), slope, 0.5, 260.0, 0.8);
}
)";

const char* const fat_material = R"(
// Omentum: soft yellow lobules, reddish where thin, with veins in their furrows.
Surface surface_at(vec3 p) {
  vec4 lobes = noise(p + 2.0 * broad.rgb, 3.6);
  vec4 fine = noise(p, 1.2);
  vec3 albedo = mix(vec3(0.60, 0.29, 0.105), vec3(0.78, 0.51, 0.20), smoothstep(-0.7, 0.5, lobes.a + 0.3 * fine.a));
  albedo = mix(albedo, vec3(0.46, 0.15, 0.10), 0.75 * smoothstep(-0.05, 0.55, broad.a + 0.25 * lobes.a));
  float vein = smoothstep(0.8, 0.1, distance_to_zero(broad, BROAD_CELL)) * smoothstep(0.0, 0.6, broad.r);
  albedo = mix(albedo, vec3(0.24, 0.035, 0.03), 0.6 * vein);
  vec3 slope = 0.15 * broad.rgb + 0.44 * lobes.rgb + 0.20 * fine.rgb;
  return Surface(albedo, vec3(0.50, 0.34, 0.18), slope, 0.7, 200.0, 1.2);
}
)";

const char* const artery_material = R"(
// Blood through a whitish sheath.
Surface surface_at(vec3 p) {
  vec4 middle = noise(p, 4.0);
  vec4 fine = noise(p, 1.1);
  vec3 albedo = mix(vec3(0.36, 0.060, 0.048), vec3(0.52, 0.23, 0.18), smoothstep(-0.5, 0.7, broad.a + 0.5 * middle.a));
  vec3 slope = 0.10 * broad.rgb + 0.22 * middle.rgb + 0.16 * fine.rgb;
  return Surface(albedo, vec3(0.40, 0.12, 0.09), slope, 0.3, 260.0, 1.4);
}
)";

// A liquid's own surface is a mirror without relief. Tissue shines through it by Beer and Lambert's law: ABSORBS is what
// a colour channel loses in 1 mm.
const char* const liquid_material = R"(
#define SHINE 1.0
Surface surface_at(vec3 p) {
  return Surface(ALBEDO, SCATTER, vec3(0.0), 0.0, 900.0, 1.6);
}
vec3 hidden_share(vec3 p) { return 1.0 - exp(-ABSORBS * max(p.z, 0.0)); }
)";

// A leaf of peritoneum: a whitish veil that is denser seen along it, with fine vessels and, where fat lies below it, a
// yellow tinge. p is along, across and 1 where it is whole, 2 where it is full of fat.
const char* const leaf_material = R"(
#define SHINE smoothstep(0.0, 0.6, rest.z)
float vessel_share(vec3 p) {
  vec3 q = vec3(p.xy, 0.0);
  vec4 course = noise(q + 1.6 * noise(q, 2.2).rgb, 5.5);
  vec4 twigs = noise(q + 0.6 * course.rgb, 2.2);
  float trunk = smoothstep(0.17, 0.06, distance_to_zero(course, 5.5)) * smoothstep(-0.35, 0.25, twigs.a);
  float twig = smoothstep(0.10, 0.03, distance_to_zero(twigs, 2.2)) * smoothstep(-0.1, 0.5, course.g);
  return max(trunk, 0.6 * twig);
}
float yellow_share(vec3 p) { return smoothstep(-0.25, 0.45, noise(vec3(p.xy, 7.0), 3.4).a + 0.5 * broad.g); }
Surface surface_at(vec3 p) {
  vec4 folds = noise(vec3(p.xy * vec2(1.0, 0.45), 3.0), 2.6);
  vec3 albedo = mix(vec3(0.50, 0.30, 0.225), vec3(0.66, 0.43, 0.17), yellow_share(p));
  albedo = mix(albedo, vec3(0.30, 0.035, 0.03), 0.85 * vessel_share(p));
  return Surface(albedo, vec3(0.42, 0.24, 0.17), 0.20 * broad.rgb + 0.34 * folds.rgb, 0.5, 200.0, 0.55);
}
vec3 hidden_share(vec3 p) {
  float along_it = 1.0 - abs(dot(normalize(normal), normalize(place)));
  float veil = 0.22 + 0.30 * yellow_share(p) + 0.35 * along_it * along_it + 0.45 * vessel_share(p);
  veil += (0.15 + 0.35 * yellow_share(p)) * clamp(p.z - 1.0, 0.0, 1.0);
  return vec3(clamp(veil, 0.0, 0.9) * smoothstep(0.05, 0.9, p.z));
}
)";

// Fibres of loose tissue: a yellowish felt while slack, whitish and glistening when taut, with what is left of fine
// vessels. p.z is how taut, and -1 on lobules of fat.
const char* const areolar_material = R"(
Surface surface_at(vec3 p) {
  vec4 patches = noise(vec3(p.xy, 5.0), 2.8);
  float taut = smoothstep(0.0, 0.8, p.z), fat = smoothstep(0.0, -0.5, p.z);
  vec3 slack = mix(vec3(0.62, 0.47, 0.29), vec3(0.72, 0.62, 0.46), smoothstep(-0.5, 0.5, patches.a));
  slack = mix(slack, vec3(0.50, 0.20, 0.15), 0.6 * smoothstep(0.15, 0.5, patches.r));
  vec3 albedo = mix(slack, vec3(0.80, 0.76, 0.69), taut);
  albedo = mix(albedo, vec3(0.70, 0.46, 0.17), fat);
  return Surface(albedo, vec3(0.50, 0.42, 0.34), 0.2 * patches.rgb, 0.3, 140.0, 0.5 + taut);
}
)";

// Films of loose tissue: a yellowish felt while slack, thin and whitish with holes when taut.
const char* const cobweb_material = R"(
#define SHINE 0.6
Surface surface_at(vec3 p) {
  vec4 folds = noise(vec3(p.xy, 3.0), 1.6);
  vec3 albedo = mix(mix(vec3(0.60, 0.45, 0.28), vec3(0.68, 0.56, 0.40), smoothstep(-0.4, 0.4, folds.a)),
                    vec3(0.76, 0.70, 0.62), smoothstep(0.0, 0.7, p.z));
  return Surface(albedo, vec3(0.55, 0.42, 0.33), 0.3 * folds.rgb, 0.6, 120.0, 0.7);
}
vec3 hidden_share(vec3 p) {
  float holes = smoothstep(-0.25, 0.35, noise(vec3(p.xy, 9.0), 1.3).a + 0.35 * (0.5 - p.z));
  return vec3(mix(0.62, 0.30, clamp(p.z, 0.0, 1.0)) * (0.25 + 0.75 * holes));
}
)";

const char* const peritoneum_material = R"(
Surface surface_at(vec3 p) {
  vec4 middle = noise(p + 6.0 * broad.rgb, 9.0);
  vec3 albedo = mix(vec3(0.40, 0.13, 0.095), vec3(0.55, 0.25, 0.18), smoothstep(-0.4, 0.5, broad.a + 0.4 * middle.a));
  float vessel = smoothstep(0.42, 0.08, distance_to_zero(middle, 9.0)) * smoothstep(0.0, 0.5, broad.r);
  albedo = mix(albedo, vec3(0.28, 0.03, 0.03), 0.4 * vessel);
  vec3 slope = 0.12 * broad.rgb + 0.14 * middle.rgb;
  return Surface(albedo, vec3(0.38, 0.16, 0.12), slope, 0.5, 300.0, 0.9);
}
)";

// What is not alive: neither wet nor red within.
const char* const dry_material = R"(
Surface surface_at(vec3 p) {
  vec4 grain = noise(p, 1.3);
  vec3 albedo = COLOUR * (1.0 + GRAIN * grain.a);
  return Surface(albedo, vec3(0.12), GRAIN * grain.rgb, 0.5, GLOSS, FILM);
}
)";

// Noise, light and shadow on wet tissue.
const char* const tissue_lighting = R"(
// The normal of a surface raised by a height whose gradient by rest position is `slope` (Mikkelsen 2010, with
// the height's screen derivatives from the chain rule).
vec3 raised(vec3 n, vec3 slope) {
  vec3 px = dFdx(place), py = dFdy(place);
  float hx = dot(slope, dFdx(rest)) * 1e-3, hy = dot(slope, dFdy(rest)) * 1e-3;
  vec3 rx = cross(py, n), ry = cross(n, px);
  float det = dot(px, rx);
  return normalize(abs(det) * n - sign(det) * (hx * rx + hy * ry));
}

// Heat makes tissue whitish and dry, then brown, then black, in blotches.
Surface heated(Surface s) {
  float blotch = textureLod(noise_volume, rest * (1.0 / (CELLS * 1.3)), 0.0).a * 2.0 - 1.0;
  float b = clamp(burnt * (1.0 + 0.25 * blotch), 0.0, 1.0);
  s.albedo = mix(s.albedo, vec3(0.60, 0.53, 0.43), smoothstep(0.04, 0.45, b));
  s.albedo = mix(s.albedo, BROWNED, smoothstep(0.45, 0.75, b));
  s.albedo = mix(s.albedo, vec3(0.024, 0.018, 0.015), smoothstep(0.75, 0.98, b));
  s.film *= 1.0 - 0.85 * smoothstep(0.1, 0.8, b);
  s.scatter *= 1.0 - 0.8 * smoothstep(0.4, 0.9, b);
  return s;
}

void main() {
  Surface s = surface_at(rest);
  if (burnt > 0.0) s = heated(s);
  vec3 n = normalize(normal);
  vec3 v = normalize(-place);
  vec3 film_n = raised(n, s.slope);
  vec3 tissue_n = normalize(mix(n, film_n, s.relief));
  Light l = light_at(n);

  vec3 wrapped = clamp((dot(tissue_n, l.towards) + s.scatter) / (1.0 + s.scatter), 0.0, 1.0);
  vec3 shaded = mix(s.scatter * vec3(0.35, 0.12, 0.08), vec3(1.0), l.seen);
  vec3 lit = s.albedo * (wrapped * wrapped * shaded * l.strength + l.around);

  vec3 h = normalize(l.towards + v);
  float nh = clamp(dot(film_n, h), 0.0, 1.0);
  float facing = clamp(dot(n, v), 0.0, 1.0);  // smooth: bumps hide each other at grazing angles
  float away = 1.0 - facing;
  float fresnel = 0.028 + 0.972 * away * away * away * away * away;
  // Powers of a cosine near 1 as exponentials: cheaper in software.
  float spot = 0.028 * (s.gloss + 2.0) / 8.0 * exp2(1.4427 * s.gloss * (nh - 1.0));
  float sheen = 0.055 * exp2(32.0 * (dot(tissue_n, h) - 1.0));
  vec3 mirrored = s.film * l.strength * l.seen * (spot + sheen) * vec3(1.0, 0.97, 0.93);
#ifdef SHINES_THROUGH
  mirrored += s.film * fresnel * 2.2 * l.around;
  vec3 hides = hidden_share(rest);
  mirrored *= SHINE;
  vec4 inner = exposed(lit, vec3(0.0)), outer = exposed(mirrored, mirrored);
  // What it mirrors is screened over the rest: sums of a film's values would be far more light than both.
  covered = 1.0 - (1.0 - vec4(hides, hides.g)) * (1.0 - outer);
  colour = vec4(inner.rgb * hides + outer.rgb * (1.0 - inner.rgb * hides), outer.a);
#else
  lit += mirrored;
  lit += s.film * fresnel * 2.2 * l.around;
  colour = exposed(lit, mirrored);
#endif
}
)";

const char* const light_functions = R"(
struct Light {
  vec3 towards;    // unit
  float strength;  // 1 at 90 mm on the axis
  float seen;      // 0 in shadow
  vec3 around;     // light that the cavity scatters back
};

float lit_share(vec3 n, vec3 towards) {
  vec4 s = shadow_from_place * vec4(place + 0.8e-3 * n, 1.0);
  vec3 c = s.xyz / s.w * 0.5 + 0.5;
  c.z -= 2e-4;
  return texture(shadow_map, c);
}

Light light_at(vec3 n) {
  Light l;
  vec3 to_light = light - place;
  float squared = dot(to_light, to_light);
  l.towards = to_light * inversesqrt(squared);
  float cone = clamp(dot(-l.towards, view_axis), 0.0, 1.0);
  l.strength = intensity * 0.0081 / squared * cone * cone;
  l.seen = lit_share(n, l.towards);
  l.around = intensity * 0.0081 / (squared + 0.006) * mix(vec3(0.08), vec3(0.115, 0.055, 0.040), alive);
  return l;
}

// What is kept of light: the alpha is how much of a glint it is, of which the sensor glows.
vec4 exposed(vec3 lit, vec3 mirrored) {
  return vec4(film(lit), clamp(0.35 * (dot(mirrored, vec3(0.3, 0.5, 0.2)) - 0.9), 0.0, 1.0));
}
)";

const char* const metal_lighting = R"(
// What a polished surface mirrors: the red cavity, yellowish below, dark behind, the scope's light in front.
vec3 cavity(vec3 r, vec3 around) {
  float front = dot(r, -view_axis);
  vec4 blotch = noise(r * 30.0, 24.0);
  around = mix(around, vec3(dot(around, vec3(0.4))), 0.75);
  vec3 tissue = mix(vec3(0.8, 0.42, 0.32), vec3(3.2, 2.7, 2.2), smoothstep(-0.25, 0.35, blotch.a));
  tissue = mix(vec3(dot(tissue, vec3(0.4))), tissue, alive);
  float lamp = max(front, 0.0);
  return around * (tissue * (0.9 - 0.75 * front) + 4.0 * lamp * lamp * lamp * lamp);
}

void main() {
  vec3 n = normalize(normal);
  vec3 v = normalize(-place);
  Light l = light_at(n);
  vec4 brush = noise(rest * vec3(1.0, 1.0, 0.15), 0.5);
  n = normalize(n + BRUSH * brush.rgb);
  vec3 h = normalize(l.towards + v);
  float nh = clamp(dot(n, h), 0.0, 1.0);
  float nl = clamp(dot(n, l.towards), 0.0, 1.0);
  float away = 1.0 - clamp(dot(n, v), 0.0, 1.0);
  vec3 mirror = METAL + EDGE * away * away * away * away * away;
  float spot = SHARP * exp2(11.5 * SHARP * (nh - 1.0)) + BROAD * exp2(20.0 * (nh - 1.0));
  vec3 lit = BASE * nl * l.strength * l.seen + mirror * (nl * spot * l.strength * l.seen + cavity(reflect(-v, n), l.around));
  colour = exposed(lit, lit);
}
)";

/// Size of the broadest noise's features, mm.
double broad_cell(Material material) {
  switch (material) {
    case Material::gallbladder:
    case Material::membrane:
    case Material::hydrops:
      return 14;
    case Material::liver:
    case Material::capsule:
      return 23;
    case Material::fat:
    case Material::bowel:
      return 19;
    case Material::peritoneum:
      return 29;
    case Material::artery:
    case Material::leaf:
    case Material::areolar:
    case Material::cobweb:
      return 9;
    case Material::steel:
    case Material::insulation:
    case Material::board:
    case Material::plastic:
    case Material::bile:
    case Material::blood:
      return 10;
  }
  return 10;
}

/// What heat makes of it before it is black: of the liver's capsule, raw red-brown parenchyma.
const char* browned(Material material) {
  const bool is_liver = material == Material::liver || material == Material::capsule;
  return is_liver ? "vec3(0.095, 0.028, 0.018)" : "vec3(0.20, 0.085, 0.030)";
}

/// What the gallbladder's wall shows: what is in it, its vessels, its patches of fat.
std::string wall_of(const char* bile, double vessels, const char* fat_bias) {
  return fmt::format("#define BILE {}\n#define VESSELS {:.2f}\n#define FAT_BIAS ({})\n", bile, vessels,
                     fat_bias) +
         gallbladder_material;
}

std::string header(Material material) {
  return fmt::format(
      "#version 330 core\n#define CELLS {:.1f}\n#define GRADIENT_RANGE {:.3f}\n"
      "#define BROAD_CELL {:.1f}\n#define BROWNED {}\n",
      static_cast<double>(noise_volume_cells), noise_gradient_range, broad_cell(material), browned(material));
}

}  // namespace

std::string scene_vertex_shader(Material material) { return header(material) + vertex_shader; }

std::string scene_fragment_shader(Material material) {
  const std::string common = header(material) + (shines_through(material) ? "#define SHINES_THROUGH\n" : "") +
                             prelude + film_functions() + light_functions;
  const char* const bile = "vec3(0.130, 0.172, 0.132)";
  switch (material) {
    case Material::gallbladder:
      return common + wall_of(bile, 0.75, "0.30 - 0.028 * p.z") + tissue_lighting;
    case Material::membrane:
      return common + wall_of(bile, 0.75, "-2.0") + tissue_lighting;
    case Material::hydrops:
      return common + wall_of("vec3(0.34, 0.315, 0.25)", 0.25, "-0.15 - 0.028 * p.z") + tissue_lighting;
    case Material::bile:
      return common +
             "#define ALBEDO vec3(0.190, 0.142, 0.010)\n#define ABSORBS vec3(0.35, 0.55, 2.6)\n"
             "#define SCATTER vec3(0.40, 0.30, 0.06)\n" +
             liquid_material + tissue_lighting;
    case Material::blood:
      return common +
             "#define ALBEDO vec3(0.150, 0.006, 0.005)\n#define ABSORBS vec3(0.9, 7.0, 7.0)\n"
             "#define SCATTER vec3(0.15, 0.01, 0.008)\n" +
             liquid_material + tissue_lighting;
    case Material::leaf:
      return common + leaf_material + tissue_lighting;
    case Material::capsule:
      return common + capsule_material + tissue_lighting;
    case Material::bowel:
      return common + bowel_material + tissue_lighting;
    case Material::liver:
      return common + liver_material + tissue_lighting;
    case Material::fat:
      return common + fat_material + tissue_lighting;
    case Material::areolar:
      return common + areolar_material + tissue_lighting;
    case Material::cobweb:
      return common + cobweb_material + tissue_lighting;
    case Material::peritoneum:
      return common + peritoneum_material + tissue_lighting;
    case Material::artery:
      return common + artery_material + tissue_lighting;
    case Material::board:
      return common +
             "#define COLOUR vec3(0.30, 0.31, 0.32)\n#define GRAIN 0.10\n#define GLOSS 60.0\n#define FILM "
             "0.15\n" +
             dry_material + tissue_lighting;
    case Material::plastic:
      return common +
             "#define COLOUR vec3(0.035, 0.13, 0.34)\n#define GRAIN 0.02\n#define GLOSS 120.0\n#define FILM "
             "0.8\n" +
             dry_material + tissue_lighting;
    case Material::steel:
      return common +
             "#define METAL vec3(0.60, 0.59, 0.57)\n#define EDGE 0.2\n#define BASE vec3(0.03)\n#define BRUSH "
             "0.07\n"
             "#define SHARP 8.0\n#define BROAD 0.30\n" +
             metal_lighting;
    case Material::insulation:
      return common +
             "#define METAL vec3(0.035)\n#define EDGE 0.08\n#define BASE vec3(0.018)\n#define BRUSH 0.02\n"
             "#define SHARP 20.0\n#define BROAD 0.8\n" +
             metal_lighting;
  }
  return {};
}

std::string shadow_vertex_shader() {
  return R"(#version 330 core
layout(location = 0) in vec3 at;
uniform mat4 clip_from_place;
void main() { gl_Position = clip_from_place * vec4(at, 1.0); }
)";
}

std::string shadow_fragment_shader() { return "#version 330 core\nvoid main() {}\n"; }

}  // namespace calot

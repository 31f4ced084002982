#include "render/offscreen.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "render/gl_objects.h"
#include "render/noise_volume.h"
#include "render/osmesa_context.h"
#include "render/scene_arrays.h"
#include "render/shaders.h"

namespace calot {
namespace {

constexpr std::array all_materials{
    Material::gallbladder, Material::membrane,   Material::liver,  Material::fat,     Material::peritoneum,
    Material::steel,       Material::insulation, Material::artery, Material::capsule, Material::bowel,
    Material::hydrops,     Material::bile,       Material::blood,  Material::leaf,    Material::board,
    Material::plastic,     Material::areolar,    Material::cobweb};

/// Omentum, bowel, boards and walls lie behind all else: their shadows are never seen. Light goes through a leaf, and
/// round fibres.
bool casts_shadow(Material material) {
  return material != Material::fat && material != Material::peritoneum && material != Material::bowel &&
         material != Material::leaf && material != Material::board && material != Material::areolar &&
         material != Material::cobweb;
}

/// What lies around is no tissue.
bool is_training_box(const SceneArrays& arrays) {
  return std::any_of(arrays.parts.begin(), arrays.parts.end(),
                     [](const ScenePart& part) { return part.material == Material::board; });
}

/// A vessel map on the card's side. Holding the map keeps its address from being given to another one.
struct VesselTexture {
  std::shared_ptr<const VesselMap> map;
  GLuint texture;
};

}  // namespace

struct OffscreenRenderer::Impl {
  std::unique_ptr<GlContext> context;
  GlFunctions gl;
  Lens lens;
  int width, height;
  DrawQuality quality;
  Target shadow, drawn, resolved, occlusion, smooth_occlusion, glow, blurred, meter, exposure, picture;
  GLuint noise = 0, vertices = 0, indices = 0, vertex_array = 0, empty_array = 0;
  std::array<GLuint, all_materials.size()> scene_programs{};
  GLuint shadow_program = 0, occlusion_program = 0, average_program = 0, glow_program = 0, blur_program = 0,
         meter_program = 0, exposure_program = 0, lens_program = 0;
  SceneArrays arrays;
  std::vector<VesselTexture> vessel_textures;
  const std::shared_ptr<const VesselMap> no_vessels =
      std::make_shared<VesselMap>(VesselMap{Vec3::Zero(), 1.0, {1, 1, 1}, {0}});

  Impl(std::unique_ptr<GlContext> owner, const GlFunctions& functions, int w, int h,
       const DrawQuality& wanted)
      : context(std::move(owner)), gl(functions), width(w), height(h), quality(wanted) {}

  std::optional<Failure> build();
  std::optional<Failure> build_programs();
  std::optional<Failure> build_targets();
  void build_noise();
  GLuint vessel_texture(const std::shared_ptr<const VesselMap>& map);
  void drop_unused_vessels();
  void upload(const Scene& scene);
  void draw_part(const ScenePart& part) const;
  void bind_vessels(GLuint program, const ScenePart& part);
  void draw_shadow(const SceneCamera& camera);
  void draw_scene(const SceneCamera& camera);
  void draw_screen(const SceneCamera& camera);
  void set_lens(GLuint program);
  void expose(const SceneCamera& camera);
  void full_screen(GLuint program, const Target& target, std::initializer_list<GLuint> textures);
  Image read(GLuint framebuffer, int x, int y, int w, int h) const;

  GLint at(GLuint program, const char* name) const { return gl.GetUniformLocation(program, name); }
  void set(GLuint program, const char* name, const Vec2& v) const {
    gl.Uniform2f(at(program, name), static_cast<float>(v.x()), static_cast<float>(v.y()));
  }
  void set(GLuint program, const char* name, const Vec3& v) const {
    gl.Uniform3f(at(program, name), static_cast<float>(v.x()), static_cast<float>(v.y()),
                 static_cast<float>(v.z()));
  }
  void set(GLuint program, const char* name, const Eigen::Matrix4d& m) const {
    const Eigen::Matrix4f f = m.cast<float>();
    gl.UniformMatrix4fv(at(program, name), 1, GL_FALSE, f.data());
  }
};

std::optional<Failure> OffscreenRenderer::Impl::build() {
  if (auto failure = build_programs()) return failure;
  if (auto failure = build_targets()) return failure;
  build_noise();
  gl.GenVertexArrays(1, &vertex_array);
  gl.GenVertexArrays(1, &empty_array);
  gl.GenBuffers(1, &vertices);
  gl.GenBuffers(1, &indices);
  gl.BindVertexArray(vertex_array);
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
  for (GLuint i = 0; i < 4; ++i) {  // three of three floats, and one of one
    gl.EnableVertexAttribArray(i);
    gl.VertexAttribPointer(i, i < 3 ? 3 : 1, GL_FLOAT, GL_FALSE, floats_each * sizeof(float),
                           reinterpret_cast<const void*>(i * 3 * sizeof(float)));
  }
  if (const std::string error = pending_error(gl); !error.empty())
    return fail(FailureKind::internal, "setting up OpenGL raised " + error);
  return {};
}

std::optional<Failure> OffscreenRenderer::Impl::build_programs() {
  struct Wanted {
    GLuint* program;
    std::string name, vertex, fragment;
  };
  std::vector<Wanted> wanted{
      {&shadow_program, "shadow", shadow_vertex_shader(), shadow_fragment_shader()},
      {&occlusion_program, "occlusion", screen_vertex_shader(), occlusion_fragment_shader()},
      {&average_program, "average", screen_vertex_shader(), average_fragment_shader()},
      {&glow_program, "glow", screen_vertex_shader(), glow_fragment_shader()},
      {&blur_program, "blur", screen_vertex_shader(), blur_fragment_shader()},
      {&meter_program, "meter", screen_vertex_shader(), meter_fragment_shader()},
      {&exposure_program, "exposure", screen_vertex_shader(), exposure_fragment_shader()},
      {&lens_program, "lens", screen_vertex_shader(), lens_fragment_shader()}};
  for (std::size_t i = 0; i < all_materials.size(); ++i)
    wanted.push_back({&scene_programs[i], fmt::format("material {}", i),
                      scene_vertex_shader(all_materials[i]), scene_fragment_shader(all_materials[i])});
  for (const Wanted& w : wanted) {
    const Result<GLuint> program = build_program(gl, w.name, w.vertex, w.fragment);
    if (!program) return program.failure();
    *w.program = program.value();
    gl.UseProgram(program.value());
    // Texture units: 0 and 1 as each pass binds them; names a program does not have are ignored by OpenGL.
    const char* const units[4][3] = {{"noise_volume", "picture", "depth_map"},
                                     {"shadow_map", "occlusion", ""},
                                     {"glow", "vessel_map", ""},
                                     {"exposure", "", ""}};
    for (int unit = 0; unit < 4; ++unit)
      for (const char* name : units[unit])
        if (const GLint place = at(program.value(), name); place >= 0) gl.Uniform1i(place, unit);
  }
  return {};
}

std::optional<Failure> OffscreenRenderer::Impl::build_targets() {
  const Vec2 inner =
      quality.detail * 2 * lens.field_radius(height) * lens.inner_scale * lens.inner_extent(width, height);
  const int w = static_cast<int>(std::ceil(inner.x())), h = static_cast<int>(std::ceil(inner.y()));
  const std::pair<Target*, Result<Target>> made[] = {
      {&shadow, make_shadow_target(gl, quality.shadow)},
      {&drawn, make_multisample_target(gl, w, h, quality.samples)},
      {&resolved, make_resolved_target(gl, w, h)},
      {&occlusion, make_colour_target(gl, (w + 1) / 2, (h + 1) / 2)},
      {&smooth_occlusion, make_colour_target(gl, (w + 1) / 2, (h + 1) / 2)},
      {&glow, make_colour_target(gl, (w + 3) / 4, (h + 3) / 4)},
      {&blurred, make_colour_target(gl, (w + 3) / 4, (h + 3) / 4)},
      {&meter, make_measured_target(gl, meter_cells, meter_cells)},
      {&exposure, make_measured_target(gl, 1, 1)},
      {&picture, make_colour_target(gl, width, height)}};
  for (const auto& [place, target] : made) {
    if (!target) return target.failure();
    *place = target.value();
  }
  return {};
}

void OffscreenRenderer::Impl::build_noise() {
  const std::vector<unsigned char> texels = noise_volume();
  gl.GenTextures(1, &noise);
  gl.BindTexture(GL_TEXTURE_3D, noise);
  gl.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, noise_volume_size, noise_volume_size, noise_volume_size, 0,
                GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

GLuint OffscreenRenderer::Impl::vessel_texture(const std::shared_ptr<const VesselMap>& map) {
  for (const VesselTexture& known : vessel_textures)
    if (known.map == map) return known.texture;
  VesselTexture made{map, 0};
  gl.GenTextures(1, &made.texture);
  gl.BindTexture(GL_TEXTURE_3D, made.texture);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.TexImage3D(GL_TEXTURE_3D, 0, GL_R8, map->size[0], map->size[1], map->size[2], 0, GL_RED,
                GL_UNSIGNED_BYTE, map->share.data());
  gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TexParameteri(GL_TEXTURE_3D, axis, GL_CLAMP_TO_EDGE);
  vessel_textures.push_back(std::move(made));
  return vessel_textures.back().texture;
}

void OffscreenRenderer::Impl::drop_unused_vessels() {
  std::erase_if(vessel_textures, [&](const VesselTexture& known) {
    if (known.map.use_count() > 1) return false;
    gl.DeleteTextures(1, &known.texture);
    return true;
  });
}

void OffscreenRenderer::Impl::bind_vessels(GLuint program, const ScenePart& part) {
  if (at(program, "vessel_map") < 0) return;
  const auto& map = part.vessels ? part.vessels : no_vessels;
  gl.ActiveTexture(GL_TEXTURE2);
  gl.BindTexture(GL_TEXTURE_3D, vessel_texture(map));
  set(program, "vessel_lower", Vec3(1e3 * map->lower));
  const Vec3 size = 1e3 * map->voxel * Vec3(map->size[0], map->size[1], map->size[2]);
  set(program, "vessel_scale", Vec3(size.cwiseInverse()));
}

void OffscreenRenderer::Impl::draw_part(const ScenePart& part) const {
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(part.count), GL_UNSIGNED_INT,
                  reinterpret_cast<const void*>(part.first * sizeof(std::uint32_t)));
}

void OffscreenRenderer::Impl::upload(const Scene& scene) {
  arrays = {};  // lets go of the vessel maps of the frame before
  drop_unused_vessels();
  arrays = scene_arrays(scene, lens, width, height);
  const auto bytes = [](const auto& array) {
    return static_cast<GLsizeiptr>(array.size() * sizeof(array[0]));
  };
  gl.BindVertexArray(vertex_array);
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices);  // others may draw in this context too
  gl.BufferData(GL_ARRAY_BUFFER, bytes(arrays.vertices), arrays.vertices.data(), GL_STREAM_DRAW);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(arrays.indices), arrays.indices.data(), GL_STREAM_DRAW);
}

void OffscreenRenderer::Impl::draw_shadow(const SceneCamera& camera) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, shadow.framebuffer);
  gl.Viewport(0, 0, shadow.width, shadow.height);
  gl.Enable(GL_DEPTH_TEST);
  gl.Enable(GL_CULL_FACE);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  gl.UseProgram(shadow_program);
  set(shadow_program, "clip_from_place", shadow_projection(camera));
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.5f, 4.0f);
  for (const ScenePart& part : arrays.parts)
    if (casts_shadow(part.material)) draw_part(part);
  gl.Disable(GL_POLYGON_OFFSET_FILL);
}

void OffscreenRenderer::Impl::draw_scene(const SceneCamera& camera) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, drawn.framebuffer);
  gl.Viewport(0, 0, drawn.width, drawn.height);
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl.UseProgram(shadow_program);
  set(shadow_program, "clip_from_place", Eigen::Matrix4d(Eigen::Matrix4d::Identity()));
  gl.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_part(arrays.mask);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.ActiveTexture(GL_TEXTURE0);
  gl.BindTexture(GL_TEXTURE_3D, noise);
  gl.ActiveTexture(GL_TEXTURE1);
  gl.BindTexture(GL_TEXTURE_2D, shadow.depth);
  const Eigen::Matrix4d projection = inner_projection(camera, lens, width, height);
  const Eigen::Matrix4d to_shadow = shadow_projection(camera);
  const Vec3 light = camera_axes(camera).transpose() * camera.light_offset;
  GLuint current = 0;
  const auto draw = [&](const ScenePart& part) {
    const GLuint program = scene_programs[static_cast<std::size_t>(part.material)];
    if (program != current) {
      gl.UseProgram(program);
      set(program, "clip_from_place", projection);
      set(program, "shadow_from_place", to_shadow);
      set(program, "light", light);
      set(program, "view_axis", camera.direction.normalized());
      gl.Uniform1f(at(program, "intensity"), static_cast<float>(camera.light_intensity));
      gl.Uniform1f(at(program, "alive"), is_training_box(arrays) ? 0.0f : 1.0f);
      current = program;
    }
    bind_vessels(program, part);
    draw_part(part);
  };
  for (const ScenePart& part : arrays.parts)
    if (!shines_through(part.material)) draw(part);
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_ONE, GL_ONE_MINUS_SRC1_COLOR);
  for (const ScenePart& part : arrays.parts)
    if (shines_through(part.material)) draw(part);
  gl.Disable(GL_BLEND);
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, drawn.framebuffer);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved.framebuffer);
  gl.BlitFramebuffer(0, 0, drawn.width, drawn.height, 0, 0, drawn.width, drawn.height,
                     GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

void OffscreenRenderer::Impl::full_screen(GLuint program, const Target& target,
                                          std::initializer_list<GLuint> textures) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl.Viewport(0, 0, target.width, target.height);
  GLenum unit = GL_TEXTURE0;
  for (const GLuint texture : textures) {
    gl.ActiveTexture(unit++);
    gl.BindTexture(GL_TEXTURE_2D, texture);
  }
  gl.UseProgram(program);
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

/// The lens' distortion: from the round field to the undistorted picture.
void OffscreenRenderer::Impl::set_lens(GLuint program) {
  set(program, "extent", lens.inner_extent(width, height));
  gl.Uniform1f(at(program, "barrel"), static_cast<float>(lens.barrel));
}

/// What the camera makes of the light is a matter of this one picture: the same scene, the same exposure. Nothing is read
/// back for it.
void OffscreenRenderer::Impl::expose(const SceneCamera& camera) {
  gl.UseProgram(meter_program);
  set_lens(meter_program);
  full_screen(meter_program, meter, {resolved.colour});
  gl.UseProgram(exposure_program);
  gl.Uniform1f(at(exposure_program, "asked"), static_cast<float>(camera.compensation));
  full_screen(exposure_program, exposure, {meter.colour});
}

void OffscreenRenderer::Impl::draw_screen(const SceneCamera& camera) {
  gl.Disable(GL_DEPTH_TEST);
  gl.Disable(GL_CULL_FACE);
  gl.BindVertexArray(empty_array);
  const Vec2 extent = lens.inner_extent(width, height);
  gl.UseProgram(occlusion_program);
  set(occlusion_program, "tangent", Vec2(std::tan(0.5 * camera.field_of_view) * extent));
  set(occlusion_program, "planes", Vec2(near_plane, far_plane));
  full_screen(occlusion_program, occlusion, {resolved.depth});
  gl.UseProgram(average_program);
  set(average_program, "texel", Vec2(1.0 / occlusion.width, 1.0 / occlusion.height));
  full_screen(average_program, smooth_occlusion, {occlusion.colour});
  gl.UseProgram(glow_program);
  set(glow_program, "texel", Vec2(1.0 / resolved.width, 1.0 / resolved.height));
  full_screen(glow_program, glow, {resolved.colour});
  gl.UseProgram(blur_program);
  set(blur_program, "texel", Vec2(1.0 / glow.width, 0));
  full_screen(blur_program, blurred, {glow.colour});
  set(blur_program, "texel", Vec2(0, 1.0 / glow.height));
  full_screen(blur_program, glow, {blurred.colour});
  expose(camera);
  gl.UseProgram(lens_program);
  const double radius = lens.field_radius(height);
  set(lens_program, "field", Vec2(0.5 * width / radius, 0.5 * height / radius));
  set_lens(lens_program);
  gl.Uniform1f(at(lens_program, "alive"), is_training_box(arrays) ? 0.0f : 1.0f);
  // In software a pixel outside the round field costs as much as one inside, though its shader returns at once.
  gl.BindFramebuffer(GL_FRAMEBUFFER, picture.framebuffer);
  gl.ClearColor(0, 0, 0, 1);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  const int half = static_cast<int>(std::ceil(radius)) + 1;
  gl.Enable(GL_SCISSOR_TEST);
  gl.Scissor(width / 2 - half, 0, 2 * half + 1, height);
  full_screen(lens_program, picture,
              {resolved.colour, smooth_occlusion.colour, glow.colour, exposure.colour});
  gl.Disable(GL_SCISSOR_TEST);
}

Image OffscreenRenderer::Impl::read(GLuint framebuffer, int left, int lower, int w, int h) const {
  std::vector<unsigned char> rgba(static_cast<std::size_t>(w) * h * 4);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.ReadPixels(left, lower, w, h, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  Image image{w, h, {}};
  image.rgb.resize(static_cast<std::size_t>(w) * h * 3);
  unsigned char* out = image.rgb.data();
  for (int y = h - 1; y >= 0; --y)  // OpenGL's rows go up
    for (int x = 0; x < w; ++x) {
      const unsigned char* in = &rgba[(static_cast<std::size_t>(y) * w + x) * 4];
      *out++ = in[0], *out++ = in[1], *out++ = in[2];
    }
  return image;
}

OffscreenRenderer::OffscreenRenderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OffscreenRenderer::OffscreenRenderer(OffscreenRenderer&&) noexcept = default;
OffscreenRenderer& OffscreenRenderer::operator=(OffscreenRenderer&&) noexcept = default;
OffscreenRenderer::~OffscreenRenderer() = default;

Result<OffscreenRenderer> OffscreenRenderer::create(int width, int height, const DrawQuality& quality) {
  if (width < 16 || height < 16 || width > 4096 || height > 4096)
    return fail(FailureKind::usage, fmt::format("a picture of {} x {} cannot be drawn", width, height),
                "choose sides of 16 to 4096 pixels");
  Result<OsmesaContext> context = OsmesaContext::create();
  if (!context) return context.failure();
  return create(std::make_unique<OsmesaContext>(std::move(context).value()), width, height, quality);
}

Result<OffscreenRenderer> OffscreenRenderer::create(std::unique_ptr<GlContext> context, int width, int height,
                                                    const DrawQuality& quality) {
  const Result<GlFunctions> gl = load_gl(context->loader());
  if (!gl) return gl.failure();
  auto impl = std::make_unique<Impl>(std::move(context), gl.value(), width, height, quality);
  if (auto failure = impl->build()) return *failure;
  return OffscreenRenderer(std::move(impl));
}

Result<Image> OffscreenRenderer::render(const Scene& scene) {
  const Result<bool> drawn = draw(scene);
  if (!drawn) return drawn.failure();
  Image image = impl_->read(impl_->picture.framebuffer, 0, 0, impl_->width, impl_->height);
  if (const std::string error = pending_error(impl_->gl); !error.empty())
    return fail(FailureKind::internal, "reading a picture raised " + error);
  return image;
}

Result<bool> OffscreenRenderer::draw(const Scene& scene) {
  if (const std::string problem = scene_problem(scene); !problem.empty())
    return fail(FailureKind::internal, "the scene cannot be drawn: " + problem);
  if (!impl_->context->make_current()) return fail(FailureKind::internal, "the OpenGL context was refused");
  impl_->upload(scene);
  impl_->draw_shadow(scene.camera);
  impl_->draw_scene(scene.camera);
  impl_->draw_screen(scene.camera);
  if (const std::string error = pending_error(impl_->gl); !error.empty())
    return fail(FailureKind::internal, "drawing raised " + error);
  return true;
}

void OffscreenRenderer::show(int x, int y, int width, int height) const {
  const GlFunctions& gl = impl_->gl;
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, impl_->picture.framebuffer);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  const bool scaled = width != impl_->width || height != impl_->height;
  gl.BlitFramebuffer(0, 0, impl_->width, impl_->height, x, y, x + width, y + height, GL_COLOR_BUFFER_BIT,
                     scaled ? GL_LINEAR : GL_NEAREST);
}

Image OffscreenRenderer::shown(int x, int y, int width, int height) const {
  return impl_->read(0, x, y, width, height);
}

const Lens& OffscreenRenderer::lens() const { return impl_->lens; }

const DrawQuality& OffscreenRenderer::quality() const { return impl_->quality; }

std::string OffscreenRenderer::description() const {
  const auto text = [&](GLenum name) { return reinterpret_cast<const char*>(impl_->gl.GetString(name)); };
  impl_->context->make_current();
  return fmt::format("{}, {}", text(GL_RENDERER), text(GL_VERSION));
}

}  // namespace calot

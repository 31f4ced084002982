#pragma once
// GLSL sources. A scene program's fragment stage is prelude + one material + lighting.

#include <string>

#include "render/scene.h"

namespace calot {

std::string scene_vertex_shader(Material material);
std::string scene_fragment_shader(Material material);

std::string shadow_vertex_shader();
std::string shadow_fragment_shader();

std::string screen_vertex_shader();       ///< one triangle over the whole target
std::string occlusion_fragment_shader();  ///< ambient occlusion from the depth, half size
std::string average_fragment_shader();    ///< over 2 x 2 pixels, so that the occlusion's turned taps blend
std::string glow_fragment_shader();       ///< what is too bright for the sensor, quarter size
std::string blur_fragment_shader();       ///< one direction of the glow's blur

/// film(light) and light_on(film), its inverse: how the scene's light is kept in pictures between passes.
std::string film_functions();
/// Cells along a side of the square about the round field, in each of which light is metered.
inline constexpr int meter_cells = 24;
std::string meter_fragment_shader();     ///< the light of each, bright parts and the middle first
std::string exposure_fragment_shader();  ///< one pixel: by how much the lens scales the light
std::string lens_fragment_shader();      ///< distortion, glow, occlusion, vignette and the round field

}  // namespace calot

#pragma once
// How clips are set, and how they slip off.
//
// Firing squeezes the clip's legs shut, whatever the angle of the jaws: the applier's mechanism does, in less than a
// step. The legs lie on the jaws up to their tip; a duct or a vessel that passes between them is flat then, pi times
// its radius wide, and the clip holds what of that width is between its legs. It stays where it is on the tube, and
// what is divided takes its clips along. Where it does not reach the middle of any, or in the air, the clip falls
// (spill.h), and lies where it fell.
//
// Jaws that close on a clip hold it and not the wall beside it, which it keeps them off. Pulled along the tube harder
// than it holds there, it slides along and falls where it comes to an open end. A clip in its way stops it until both are
// pulled harder than both hold, and is pushed along then, past an open end before it. Jaws that would slip first slide
// over it.

#include "field/field.h"

namespace calot {

/// Pull along a tube at which a clip begins to slide on it, N: the mean of the 4.1 and 4.8 N at which two makes of
/// titanium clip came off (Arch Surg 127:718, 1992).
inline constexpr double clip_hold = 4.4;

/// Sets a clip on a tube, which is held flat there from now on.
void set_clip(Field& field, OrganIndex organ, const Clip& clip);
/// Refuses (scenario) what takes `width` m of a tube's length about a share of it, if a clip lies there; `done`: what the
/// tube cannot be. An organ that is no tube has none.
Result<bool> free_of_clips(const Organ& organ, double share, double width, const std::string& done);
/// Sets one that shuts it at a share of its length, 0 to 1, with its legs across. Fails (scenario) where it is no tube,
/// the share is none, or another clip lies there.
Result<bool> clip_body(Field& field, OrganIndex organ, double share, ClipSize size);

/// Of each tool in which the action begins (`actions`: one a tool, or none) one clip, while it has some. Adds the
/// events clip and clip_dropped.
void fire_clips(Field& field, const std::vector<InstrumentAction>& actions, std::vector<WorldEvent>& events);

/// Pull that the clips hold which a tool has between its pads, and those that touch them where the pull draws them, on
/// what it holds, N: clip_hold each; infinite without any between them.
double hold_of_clips(const Field& field, ToolIndex instrument);

/// Keeps the clips between a tool's pads there, as the tubes slide along the pads by `way` (m, patient's frame). The
/// bodies are told by let_clips_fall().
void draw_clips(Field& field, ToolIndex instrument, const Vec3& way);

/// Holds tubes flat where their clips have been drawn to. Those that have come off an end fall: adds clip_dropped.
void let_clips_fall(Field& field, ToolIndex instrument, std::vector<WorldEvent>& events);

}  // namespace calot

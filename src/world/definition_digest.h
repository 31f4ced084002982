#pragma once
// What a rest state is a function of, as a digest.

#include <string>

#include "field/field.h"

namespace calot {

/// Of a scene's anatomy and solver, each of their members, and of the field that was built of them before it comes to
/// rest: nodes and skins tell apart what files hold that the definition only names. 64 hexadecimal digits. Instruments,
/// ports and the laparoscope come after the rest state and are not in it.
std::string rest_key(const SceneDefinition& scene, const Field& field);

}  // namespace calot

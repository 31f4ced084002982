#pragma once

#include "anatomy/definitions.h"

namespace calot::test {

/// The standard anatomy, two graspers and a scope: nothing is wrong with it.
inline SceneDefinition sound_scene() {
  SceneDefinition scene;
  scene.anatomy = named_anatomy("standard").value();
  scene.anatomy.support = SupportDefinition{};
  scene.instruments.resize(2);
  scene.instruments[0].name = "left";
  scene.instruments[0].port = "right_subcostal";
  scene.instruments[1].name = "right";
  scene.instruments[1].port = "epigastric";
  return scene;
}

}  // namespace calot::test

// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/scene.h"

#include "core/error.h"

namespace greatx::scene {

uint32_t Scene::body_index(const std::string& body_name) const {
  for (uint32_t index = 0; index < bodies.size(); ++index) {
    if (bodies[index].name == body_name) return index;
  }
  GREATX_CHECK(false, "the scene has no body '{}'", body_name);
  return 0;
}

}  // namespace greatx::scene

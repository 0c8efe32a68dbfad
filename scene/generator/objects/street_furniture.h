// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What stands along streets: lamps with their photometry, signals, signs, shelters. Foot at the origin, z up.
#pragma once

#include "scene/generator/mesh/scene_writer.h"

namespace greatx::scene::generator {

enum class LampKind { avenue, street, park, yard };

/// A lamp: its mesh, with the arm (if any) along +x, and the light that its glass gives off.
struct Lamp {
  MeshBuilder mesh;
  dvec3 light_position{0.0};  ///< just below the glass
  LightSpec light;            ///< a spot that looks down
};
Lamp make_lamp(LampKind kind);

/// A signal on its pole that looks along +x; `green` or red.
MeshBuilder make_signal(bool green);
/// A sign for a crossing, looking along +x.
MeshBuilder make_sign();
/// A shelter, open towards +x, with a poster that is lit by night; 4.2 m along y.
MeshBuilder make_shelter();
MeshBuilder make_bin();

}  // namespace greatx::scene::generator

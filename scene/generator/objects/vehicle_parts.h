// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parts that many vehicles have: wheels, lamps, plates, mirrors.
#pragma once

#include <string>
#include <vector>

#include "scene/generator/mesh/scene_writer.h"
#include "scene/generator/objects/shapes.h"

namespace greatx::scene::generator {

/// The body of a vehicle and the middles of its lamps on the left side. The right side mirrors them.
struct VehicleBody {
  MeshBuilder mesh;
  MeshBuilder
      inside;  ///< what one sees behind the panes; follows the rest (renderer/surface/closed_bodies.h)
  std::vector<dvec3> head_lamps, tail_lamps;
  double beam_cd = 12000.0;  ///< peak of one head lamp
};

/// Makes a wheel about its hub that rolls about y. Its outer face looks to +y if `left`, and shows the
/// picture of `face`, a material.
MeshBuilder make_wheel(double radius, double width, int face, bool left);
/// Makes a motorcycle's wheel, which shows a picture on both sides.
MeshBuilder make_motor_wheel(double radius, double width);
/// Adds a pair of parked wheels as one prism from side to side.
void add_axle(MeshBuilder& mesh, const dvec3& left_hub, double radius, double width, int face);

/// Adds a box and its mirror image in y.
void add_boxes(MeshBuilder& mesh, int material, const dvec3& low, const dvec3& high);
/// Adds a direction indicator on the left side, and its mirror image.
void add_indicators(MeshBuilder& mesh, const dvec3& low, const dvec3& high);
/// Adds a number plate whose outer face is at x, in front of a body (`front`) or behind it.
void add_plate(MeshBuilder& mesh, double x, double z, bool front);

/// Adds the lights of a driving vehicle (KHR_lights_punctual) as children of `root`.
void add_vehicle_lights(SceneWriter& writer, const VehicleBody& body, int root);

}  // namespace greatx::scene::generator

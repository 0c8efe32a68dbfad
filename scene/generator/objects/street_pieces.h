// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the small pieces of streets: bollards, racks, boxes, plants, signs, tables. The foot is at the origin
// on the pavement, z is up. All are closed solids, but for sprays of leaves.
#pragma once

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

MeshBuilder make_bollard();
/// Makes three hoops along x with parked bicycles. A bicycle is a thin sheet with the picture of one, and
/// radio does not see it: its tubes are much thinner than the sheet is high.
MeshBuilder make_bicycle_rack(uint32_t draw);
MeshBuilder make_post_box();
MeshBuilder make_hydrant();
/// Makes a trough of 1.6 m along x with shrubs.
MeshBuilder make_planter(uint32_t draw);
/// Makes a column of 3.5 m for posters.
MeshBuilder make_advertising_column();
/// Makes a cabinet for power or telephones, 1.2 m along x, whose doors face +y.
MeshBuilder make_cabinet();
/// Makes two tables and their chairs within 4.4 m along x and 1.1 m along y.
MeshBuilder make_cafe();
/// Makes a grate of 1.5 m around the foot of a tree.
MeshBuilder make_tree_grate();

/// Numbers of the pictures of signs, as `signs` of paint/street_textures.cpp has them.
enum class SignKind { crossing, no_parking, parking, priority, yield, stop, speed_30, one_way };
/// Makes a sign on its pole that faces +x.
MeshBuilder make_traffic_sign(SignKind kind);
/// Makes the pole of a bus stop, with its sign and its timetable, facing +x.
MeshBuilder make_stop_pole();
/// Makes a fence of a building site: one element of 3.4 m along x with its feet.
MeshBuilder make_site_fence();

}  // namespace greatx::scene::generator

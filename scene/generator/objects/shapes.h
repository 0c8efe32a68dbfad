// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The tables of generated vehicles and people. They give the dimensions and joints that their glTF nodes
// have, so that others can let wheels roll and limbs swing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"

namespace greatx::scene {

/// One variant of the generator's kind "vehicle". The origin is on the ground below the middle of the length,
/// x points forward, y to the left. Dimensions are those of typical European vehicles of the kind.
struct VehicleShape {
  std::string variant;
  /// Size of the body. The width is without mirrors, as registration papers give it. Of two-wheelers it is
  /// the width over everything, and the height is that of their rider.
  double length_m = 0, width_m = 0, height_m = 0;
  /// From the front axle to the middle of the rear axles. Of a tram: between the middles of its bogies. An
  /// articulated lorry is one rigid body; its rear axles are those of the trailer.
  double wheelbase_m = 0;
  double rear_axle_x_m = 0;  ///< x of the middle of the rear axles
  struct Wheel {
    std::string node;  ///< "wheel_0"...: a child of the root, about its hub
    double radius_m = 0;
    dvec3 hub_m{0.0};
  };
  /// Pairs left, right from the front to the rear; one wheel per axle of two-wheelers. Twin tyres are one
  /// wheel.
  std::vector<Wheel> wheels;
  bool two_wheeler = false;
};

/// One variant of the generator's kind "person". The origin is on the ground between the feet, x forward.
struct PersonShape {
  std::string variant;
  double height_m = 0;                    ///< stature, in shoes
  double hip_m = 0;                       ///< height of the hip joints: thigh_m + shank_m
  double thigh_m = 0;                     ///< hip to knee
  double shank_m = 0;                     ///< knee to sole
  double upper_arm_m = 0, forearm_m = 0;  ///< shoulder to elbow, elbow to wrist
  double shoulder_m = 0;                  ///< height of the shoulder joints
};

/// The drive and the rider of a bicycle, in the frame of its VehicleShape.
struct BicycleShape {
  double thigh_m = 0, shank_m = 0;  ///< of the rider
  dvec3 hip_m{0.0};                 ///< the middle of the hip joints
  dvec3 bracket_m{0.0};             ///< the middle of the cranks' axle
  double crank_m = 0.17;            ///< from this axle to those of the pedals
  double ball_m = 0.07;             ///< of the foot, ahead of the shank: over the axle of the pedal
  double pedal_m = 0.012;           ///< from that axle up to the sole
  double rest = 0;                  ///< rad: the left crank points forward at 0, down at pi / 2
  double gear = 0;                  ///< turns of the rear wheel for one of the cranks
  double wheel_m = 0;               ///< radius of the rear wheel
  /// Returns the way of one turn of the cranks.
  double development_m() const { return gear * 2.0 * 3.14159265358979323846 * wheel_m; }
};
/// Returns it for the variants that are bicycles.
std::optional<BicycleShape> bicycle_shape(const std::string& variant);
/// Returns the shape of the rider of a two-wheeler.
PersonShape rider_shape(double stature_m);

/// Returns the variants of "vehicle" with four and more wheels, then the two-wheelers. The order is fixed.
const std::vector<VehicleShape>& vehicle_shapes();

/// Returns the variants of "person". The lengths of segments are shares of the stature as Drillis and Contini
/// (Body Segment Parameters, 1966) give them (Winter, Biomechanics and Motor Control of Human Movement, 4th
/// edition, Fig. 4.1): hip 0.530, knee 0.285, shoulder 0.818, upper arm 0.186, forearm 0.146. A child of six
/// has shorter legs: hip 0.495, knee 0.270.
const std::vector<PersonShape>& person_shapes();

/// Return the shape of a variant. Throw UserError, which names the variants, if there is none.
const VehicleShape& vehicle_shape(const std::string& variant);
const PersonShape& person_shape(const std::string& variant);

}  // namespace greatx::scene

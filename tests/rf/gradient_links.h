// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares the slopes of a path with differences of path_field(), whose path is solved again at every step.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rf/gradient/path_slopes.h"
#include "tests/rf/scenes.h"

namespace greatx::rf::testing {

/// Solves the path of a link between two points.
using SolveLink = std::function<GeometricPath(const FacetWorld&, const std::vector<scene::Wedge>&,
                                              const dvec3& transmitter, const dvec3& receiver)>;

/// Describes a path by all that it depends on.
struct Link {
  HandScene hand;
  SolveLink solve;
  dvec3 transmitter{0.0}, receiver{0.0};
  dvec3 transmitter_velocity{3.0, -2.0, 1.0}, receiver_velocity{-1.0, 4.0, 0.5};
  double carrier_hz = 3.5e9;
  FieldEffects effects;
  Weather weather;
  std::vector<Motion> motions;  ///< of the bodies from 1 on
  bool free_edges = false;
  DiffractingEdges diffracting;           ///< of finite reflectors
  std::optional<scene::Foliage> foliage;  ///< of effects.foliage
};

/// Returns the path of a link after one parameter has changed by `step`.
Path path_of(const Link& link, const ChannelParameter& parameter, double step);
/// Returns its slopes by path_slopes().
std::vector<PathSlope> slopes_of(const Link& link, const std::vector<ChannelParameter>& parameters);

/// Lists every parameter of a link: all layers of the materials that facets have, both ends, and the carrier.
/// K_x and 1 - Lambda are listed for materials that scatter.
std::vector<ChannelParameter> every_parameter(const Link& link);
std::string text_of(const ChannelParameter& parameter);

/// Expects that the slopes by every parameter are those of path_field(), within 1e-7 of each, and that the
/// values beside them are its values, bit by bit. The differences are Ridders' (C. J. F. Ridders, "Accurate
/// computation of F'(x) and F'(x)F''(x)", Adv. Eng. Software 4(2), 1982). `position_m`: scale on which the
/// path changes with its ends, metres.
void expect_true_slopes(const Link& link, double position_m = 1.0);

/// Times of one path, seconds: of its field, and of its slopes by a list of parameters.
struct Cost {
  double field_s = 0.0, slopes_s = 0.0;
};
Cost cost_of(const Link& link, const std::vector<ChannelParameter>& parameters);

/// Solves paths that reflect at these facets in this order.
SolveLink reflecting(FacetSequence facets);
/// Adds to a path the walls through which it passes, in ascending order of their facets on each segment.
SolveLink through(SolveLink path, std::vector<uint32_t> walls);
/// The path over a point that does not move: a patch, or an end of an edge.
SolveLink over(std::vector<Interaction> interactions, std::vector<dvec3> points, double area_m2 = 1.0,
               double second_area_m2 = 0.0);
/// The path over an edge, after the reflections `before` and before the reflections `after`.
SolveLink over_edge(uint32_t wedge, FacetSequence before = {}, FacetSequence after = {});
SolveLink over_edges(uint32_t first, uint32_t second);
/// The same path, whose field is computed from the receiver on.
SolveLink backwards(SolveLink path);

}  // namespace greatx::rf::testing

// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws scenes from a seed, writes them as users do (a scenario and a glTF file), in a form that must not
// change the result, and runs them. Data flows one way:
//
//   seed ─► DrawnCase ─► (DrawnCase, Form) ─► files ─► experiment ─► Links
//
// A property compares the links of one case in two forms. If it fails, shrink.h makes the case smaller, and
// the files of the small case replay the failure.
#pragma once

#include <complex>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/vec.h"

namespace greatx::property {

/// A closed box on a parallelogram: base u x v, upright. All coordinates are multiples of 2^-10 m, which fp32
/// holds exactly in every form.
struct DrawnBox {
  dvec3 corner{0.0};
  dvec2 u{1.0, 0.0}, v{0.0, 1.0};
  double height = 1.0;
  uint32_t material = 0;  ///< into the table of drawn_case.cpp
};

struct DrawnCase {
  uint64_t seed = 0;
  bool ground = true;
  std::vector<DrawnBox> boxes;
  dvec3 transmitter{0.0};
  std::vector<dvec3> receivers;  ///< at least one
  uint32_t depth = 2;
  bool transmission = true, diffraction = false, scattering = false, dispersion = false;
  bool two_edges = false;          ///< max_diffractions: 2
  uint32_t reflections_after = 0;  ///< max_reflections_after
  bool every_tick = false;         ///< search: every_tick
  uint32_t rays = 0;               ///< of `candidates: rays`; 0: beams
  bool transmitter_moves = false, receivers_move = false;
  double carrier_hz = 3.5e9;
};

/// Changes that must not change the links.
struct Form {
  dvec3 shift{0.0};       ///< of the world: the scene and all nodes, metres
  double turn_deg = 0.0;  ///< of the world about z, before the shift
  bool split = false;     ///< each triangle into four
  bool reversed = false;  ///< materials, objects, triangles, corners and nodes in the other order
  double unit_m = 1.0;    ///< length of the file's unit, made good by the scale of its nodes
  bool swapped = false;   ///< the receivers send and the transmitter receives
  bool slant = false;     ///< antennas have two polarizations
  uint32_t ticks = 1;
  std::vector<uint32_t> only;  ///< indices of the receivers that are there; empty: all
};

/// Holds a path of a link with isotropic, vertical antennas.
struct LinkPath {
  double length_m = 0.0;
  std::complex<float> amplitude{0.0f};
};
struct Link {
  std::vector<LinkPath> paths;           ///< ascending by length
  std::vector<std::complex<float>> cfr;  ///< [subcarriers]
};
using Links = std::vector<Link>;  ///< [receivers that are there]

DrawnCase draw_case(uint64_t seed);

/// Writes scenario.yaml and scene.glb into `folder`, which it creates.
void write_case(const DrawnCase& drawn, const Form& form, const std::filesystem::path& folder);
/// Runs the files that write_case has written.
Links run_case(const std::filesystem::path& folder);
/// Writes into a temporary folder and runs.
Links run_case(const DrawnCase& drawn, const Form& form = {});

/// Returns the case in words, for messages.
std::string describe(const DrawnCase& drawn);

}  // namespace greatx::property

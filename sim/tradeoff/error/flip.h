// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures how different two pictures look to an observer who alternates between them: LDR-FLIP (P.
// Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "FLIP: A Difference
// Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), HPG 2020), implemented
// from the formulas of the paper.
#pragma once

#include <vector>

#include "core/record.h"

namespace greatx::sim {

struct Flip {
  std::vector<float> error;  ///< [h, w], 0: equal, 1: as different as black and white
  double mean = 0.0;
};

/// Compares two u8 [h, w, 3] sRGB pictures of equal shape. The default of 67 pixels per degree is that of a
/// monitor with a width of 0.7 m and 3840 pixels, seen from a distance of 0.7 m.
Flip flip(const Array& reference, const Array& test, double pixels_per_degree = 67.0);

}  // namespace greatx::sim

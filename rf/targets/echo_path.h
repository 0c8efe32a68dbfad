// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Joins the two legs of an echo to one path.
#pragma once

#include <cstdint>

#include "rf/geometry/path.h"
#include "rf/targets/target_model.h"

namespace greatx::rf {

/// Returns the path from its receiver to its transmitter: the same places, with the transposed transfer.
Path reversed(const Path& path);

/// Returns the product of the transfers of two legs and the matrix between them, as Path::transfer. With legs
/// in free space, |product|^2 (lambda/4 pi)^2 is the radar equation lambda^2 sigma/((4 pi)^3 r_1^2 r_2^2).
void join(const Complex (&out)[4], const ScatterMatrix& s, const Complex (&home)[4], Complex (&product)[4]);

/// Returns the distance from the end of a leg to the point that its wave is a sphere about: the length of a
/// leg that is only reflected and passes walls. A leg with another interaction is taken for a plane wave.
double sphere_of_leg(const Path& leg);

/// Returns the path over a target: from the transmitter by `out`, whose last vertex is the target, and by
/// `home`, whose first vertex is the target, to the receiver. Lengths, delays and Doppler shifts add up. `s`
/// is in world axes.
Path echo_path(const Path& out, const Path& home, uint32_t instance, const ScatterMatrix& s);

}  // namespace greatx::rf

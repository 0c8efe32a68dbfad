// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts arrays of runs to pictures that fit into a PNG.
#pragma once

#include <string>

#include "tests/support/kept_run.h"

namespace greatx::test {

/// Returns one array of a run as u8 [h, w, 3], u8 or u16 [h, w]:
///   rgb, difference_picture       unchanged
///   instance, semantic, material  unchanged
///   depth, depth_ray  cm, at most 65535 (sky)
///   hdr      red above green above blue, [3 h / 2, w / 2]: 128 (30 + log2 of cd/m^2), 0: none
///   normals  127.5 (1 + n)
///   flow     u above v, [2 h, w]: 32768 + 64 px, 0: not visible (the coding of KITTI's flow pictures)
///   boxes    [2 h, 2 w, 3]: each object in the colour of its id: the visible part with the opacity of its
///            visibility, the frame of the whole object within the picture and the edges of the 3D box
///   events   sums by pixel in colours (io::event_picture)
///   range    of a LiDAR, [ring, azimuth]: cm, 0: no return
/// Throws std::runtime_error if the run has no packet at `tick` or no such array.
Array picture_of(const KeptRun& run, int64_t tick, const std::string& sensor, const std::string& array);

}  // namespace greatx::test

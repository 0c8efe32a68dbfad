// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Arrays of runs as pictures that a PNG keeps.
#pragma once

#include <string>

#include "tests/support/kept_run.h"

namespace greatx::test {

/// One array of a run as u8 [h, w, 3], u8 or u16 [h, w]:
///   rgb, difference_picture            as they are
///   instance, semantic, material       as they are
///   depth, depth_ray                   cm, at most 65535 (sky)
///   hdr      red above green above blue, [3 h / 2, w / 2]: 128 (30 + log2 of cd/m^2), 0: none
///   normals  127.5 (1 + n)
///   flow     u above v, [2 h, w]: 32768 + 64 px, 0: out of sight (the coding of KITTI's flow pictures)
///   boxes    [2 h, 2 w, 3]: of each object the colour of its id, in it the visible part, filled by its visibility, the
///            frame of all of it within the picture, and the edges of the box in space
///   events   summed by pixel in colours (io::event_picture)
///   range    of a LiDAR, [ring, azimuth]: cm, 0: no return
Array picture_of(const KeptRun& run, int64_t tick, const std::string& sensor, const std::string& array);

}  // namespace greatx::test

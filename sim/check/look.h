// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Simulates some moments of a scenario and looks at the records: links without a path, pictures that are
// white or black.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/check/finding.h"
#include "sim/experiment/experiment.h"

namespace greatx::gpu {
class Device;
}

namespace greatx::sim {

/// A link of a channel, at the moments that were looked at.
struct LinkFigures {
  std::string channel, transmitter, receiver;
  uint64_t moments = 0, without_path = 0, line_of_sight = 0;
};

/// A picture: the mean shares of pixels whose three values are all 255, or all below 3.
struct PictureFigures {
  std::string name;
  uint64_t moments = 0;
  double white = 0.0, black = 0.0;
  uint64_t all_white = 0, all_black = 0;  ///< moments at which these are more than 95 % of the pixels
};

struct LookFigures {
  std::vector<LinkFigures> links;
  std::vector<PictureFigures> pictures;
};

/// Simulates `moments` moments, spread evenly over the sequences and over the ticks of each. Event cameras
/// are left out, since they would have to see every tick before.
///   no_path   a link has no path at any moment (fault), or at some (doubt)
///   exposure  a picture is all white or all black at every moment (fault), or at some (doubt)
/// `moment_done` is called after each moment. Throws as the simulator does.
std::vector<Finding> look(const Experiment& experiment, gpu::Device& device, uint32_t moments,
                          LookFigures& figures, const std::function<void(uint32_t)>& moment_done);

}  // namespace greatx::sim

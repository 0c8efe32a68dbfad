// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses the links of channels that a sheet shows. The ends of a channel have the names of their antennas in
// its metadata ("bs/panel"). A wish names a link: "TX:RX", or "CHANNEL:TX:RX" if several channels have such
// ends. An end is the name of an antenna, that of a node with one antenna in the channel, or a number in the
// channel's list. Without a wish a channel shows its strongest link.
#pragma once

#include <string>
#include <vector>

#include "draw/sheet/panels.h"

namespace greatx::io {

struct ChannelEnds {
  std::vector<std::string> transmitters, receivers;  ///< names; those without one have their number
};
/// Reads the ends from the metadata of the channel. A channel that does not name them has the extents of its
/// arrays.
ChannelEnds channel_ends(const PanelSource& source);

/// Returns the links of the channel that wishes name, in their order and each once; without wishes the
/// strongest one: that with the largest sum of `path_gain` over up to 64 records, equally spaced. Throws
/// UserError if a wish has another form.
std::vector<ChannelLink> links_to_show(const PanelSource& source, const std::vector<std::string>& wishes);
/// Throws UserError if a wish fits no channel of the records; the message lists the ends of each.
void check_links(const RecordSource& records, const std::vector<std::string>& wishes);

/// Says which link is shown: "bs to van", with whole names where the node's are not enough.
std::string link_text(const ChannelEnds& ends, const ChannelLink& link);

}  // namespace greatx::io

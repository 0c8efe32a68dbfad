// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/channel_links.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include <fmt/ranges.h>

#include "core/text.h"

namespace greatx::io {

namespace {

constexpr size_t most_ends = 1'000'000, most_records = 64, most_listed = 8;

/// Returns the names of the antennas under `key`, or as many numbers as the first array of the channel has
/// places along `axis`.
std::vector<std::string> ends_called(const PanelSource& source, const JsonValue& metadata, const char* key,
                                     size_t axis) {
  std::vector<std::string> names;
  if (metadata.has(key)) {
    for (const JsonValue& end : metadata.at(key).list(most_ends))
      names.push_back(end.has("name") ? end.at("name").text() : std::to_string(names.size()));
    return names;
  }
  const ArraySpec* shaped = nullptr;
  for (const ArraySpec& array : source.spec().arrays)
    if (array.name == "cfr" && array.shape.size() == 6) shaped = &array;
  const int64_t count = shaped ? std::clamp<int64_t>(shaped->shape[axis], 1, most_ends) : 1;
  for (int64_t i = 0; i < count; ++i) names.push_back(std::to_string(i));
  return names;
}

std::string node_part(const std::string& name) { return name.substr(0, name.find('/')); }

/// Returns the place of the end that a wish names, or nothing. A node is enough if it has one antenna.
std::optional<size_t> end_called(const std::vector<std::string>& ends, const std::string& wish) {
  if (const auto found = std::ranges::find(ends, wish); found != ends.end())
    return static_cast<size_t>(found - ends.begin());
  const auto of_node = [&](const std::string& name) { return node_part(name) == wish; };
  if (std::ranges::count_if(ends, of_node) == 1)
    return static_cast<size_t>(std::ranges::find_if(ends, of_node) - ends.begin());
  size_t number = 0;
  const auto [end, error] = std::from_chars(wish.data(), wish.data() + wish.size(), number);
  if (error != std::errc{} || end != wish.data() + wish.size() || number >= ends.size()) return std::nullopt;
  return number;
}

struct LinkWish {
  std::string channel, tx, rx;  ///< channel: empty: any
};

LinkWish parse_wish(const std::string& text) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == ':')
      parts.emplace_back();
    else
      parts.back() += c;
  if (parts.size() == 2) parts.insert(parts.begin(), "");
  if (parts.size() != 3 || parts[1].empty() || parts[2].empty())
    throw_user_error("link: expected TX:RX or CHANNEL:TX:RX, as in bs:uav, found '{}'", printable(text));
  return {parts[0], parts[1], parts[2]};
}

std::optional<ChannelLink> link_wished(const PanelSource& source, const ChannelEnds& ends,
                                       const LinkWish& wish) {
  if (!wish.channel.empty() && wish.channel != source.spec().name) return std::nullopt;
  const std::optional<size_t> tx = end_called(ends.transmitters, wish.tx),
                              rx = end_called(ends.receivers, wish.rx);
  if (!tx || !rx) return std::nullopt;
  return ChannelLink{*rx, *tx};
}

ChannelLink strongest_link(const PanelSource& source, const ChannelEnds& ends) {
  const size_t links = ends.receivers.size() * ends.transmitters.size();
  const std::vector<IndexRow> rows = source.records.records_of(source.sequence, source.sensor);
  if (links < 2 || rows.empty() || !source.has("path_gain")) return {};
  std::vector<double> sums(links);
  const size_t count = std::min(rows.size(), most_records);
  for (size_t i = 0; i < count; ++i) {
    const Array gains = source.load(
        rows[i * rows.size() / count], "path_gain", {DType::f32, DType::f64},
        {static_cast<int64_t>(ends.receivers.size()), static_cast<int64_t>(ends.transmitters.size())});
    for (size_t k = 0; k < links; ++k) {
      const double gain = gains.dtype == DType::f64 ? gains.as<double>()[k] : gains.as<float>()[k];
      if (std::isfinite(gain)) sums[k] += gain;
    }
  }
  const auto best = static_cast<size_t>(std::ranges::max_element(sums) - sums.begin());
  return {best / ends.transmitters.size(), best % ends.transmitters.size()};
}

std::string listed(const std::vector<std::string>& names) {
  const size_t shown = std::min(names.size(), most_listed);
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<ptrdiff_t>(shown), ", "));
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return printable(text);
}

}  // namespace

ChannelEnds channel_ends(const PanelSource& source) {
  const JsonDocument metadata = metadata_of(source);
  return {ends_called(source, metadata.root(), "transmitters", 2),
          ends_called(source, metadata.root(), "receivers", 0)};
}

std::vector<ChannelLink> links_to_show(const PanelSource& source, const std::vector<std::string>& wishes) {
  const ChannelEnds ends = channel_ends(source);
  if (wishes.empty()) return {strongest_link(source, ends)};
  std::vector<ChannelLink> links;
  for (const std::string& wish : wishes)
    if (const std::optional<ChannelLink> link = link_wished(source, ends, parse_wish(wish));
        link && std::ranges::find(links, *link) == links.end())
      links.push_back(*link);
  return links;
}

void check_links(const RecordSource& records, const std::vector<std::string>& wishes) {
  for (const std::string& text : wishes) {
    const LinkWish wish = parse_wish(text);
    std::string there;
    bool found = false;
    for (size_t s = 0; s < records.sensors().size() && !found; ++s) {
      if (records.sensors()[s].kind != "csi") continue;
      const PanelSource channel{records, 0, s, {}};
      const ChannelEnds ends = channel_ends(channel);
      found = link_wished(channel, ends, wish).has_value();
      there += fmt::format("; channel {} has the transmitters {} and the receivers {}",
                           printable(channel.spec().name), listed(ends.transmitters), listed(ends.receivers));
    }
    if (!found)
      throw_user_error("{}: no channel has the link '{}'{}", records.place(), printable(text),
                       there.empty() ? ": there is no channel" : there);
  }
}

std::string link_text(const ChannelEnds& ends, const ChannelLink& link) {
  const auto short_name = [](const std::vector<std::string>& names, size_t i) {
    const std::string node = i < names.size() ? node_part(names[i]) : std::to_string(i);
    const auto same =
        std::ranges::count_if(names, [&](const std::string& n) { return node_part(n) == node; });
    return same > 1 ? names[i] : node;
  };
  return fmt::format("{} to {}", short_name(ends.transmitters, link.tx), short_name(ends.receivers, link.rx));
}

}  // namespace greatx::io

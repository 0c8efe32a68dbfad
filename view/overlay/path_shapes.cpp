// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/path_shapes.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/text.h"
#include "core/units.h"
#include "view/overlay/path_records.h"
#include "view/overlay/record_arrays.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

using apps::GainScale;
using rf::InteractionType;

constexpr io::Color transmitter_color{255, 92, 92}, receiver_color{96, 200, 255};
constexpr size_t most_end_names = 12;  // more would hide the picture

struct ShownPath {
  size_t number = 0;  ///< in the record
  rf::Path path;      ///< what the record says of it; vertices in the world
  double gain_db = 0.0;
  bool shown = true;
};

PointShape::Mark mark_of(InteractionType type) {
  switch (type) {
    case InteractionType::none:
    case InteractionType::reflection:
      return PointShape::Mark::dot;
    case InteractionType::transmission:
      return PointShape::Mark::diamond;
    case InteractionType::diffraction:
      return PointShape::Mark::triangle;
    case InteractionType::scattering:
    case InteractionType::target:
      return PointShape::Mark::cross;
  }
  return PointShape::Mark::dot;
}

std::string decibels_of(double gain_db) {
  return std::isfinite(gain_db) ? fmt::format("{:.2f} dB", gain_db) : std::string("none");
}

std::string angles_text(std::span<const double> angles) {
  return fmt::format("azimuth {:.2f} deg, zenith {:.2f} deg", degrees(angles[1]), degrees(angles[0]));
}

std::string text_of(const ShownPath& shown, const PathArrays& arrays, const RecordTables& tables,
                    const ChannelFacts& channel) {
  const size_t i = shown.number, depth = static_cast<size_t>(arrays.depth);
  const rf::Path& path = shown.path;
  std::string text = fmt::format(
      "{} ({}), {} interaction{}, {:.1f} dB, {:.1f} m\nid {}\nfrom {} to {}\nlength {:.3f} m, delay {:.3f} "
      "ns\n"
      "gain {}, phase {:.2f} deg\ndeparture: {}\narrival: {}\nDoppler {:.3f} Hz",
      apps::chain_of(path), apps::kind_name(apps::kind_of(path)), path.interactions.size(),
      path.interactions.size() == 1 ? "" : "s", shown.gain_db, path.length_m, apps::id_text(arrays.id[i]),
      printable(channel.transmitters[static_cast<size_t>(arrays.tx[i])].place.name),
      printable(channel.receivers[static_cast<size_t>(arrays.rx[i])].place.name), path.length_m,
      1e9 * path.delay_s, decibels_of(shown.gain_db),
      degrees(std::arg(apps::vertical_amplitude(path, channel.carrier_hz))),
      angles_text(arrays.departure.subspan(2 * i, 2)), angles_text(arrays.arrival.subspan(2 * i, 2)),
      path.doppler_hz);
  for (size_t k = 0; k < path.interactions.size(); ++k)
    text += fmt::format("\n{}: {} {} ({})", k + 1, apps::letter_of(path.interactions[k].type),
                        tables.instance_name(arrays.object[i * depth + k]),
                        tables.material_name(arrays.material[i * depth + k]));
  return text;
}

void add_gain_legend(Shapes& shapes, const GainScale& scale) {
  const int steps = std::max(1, static_cast<int>(std::lround((scale.high_db - scale.low_db) / 20.0)));
  for (int i = 0; i <= steps; ++i) {
    const double gain_db = scale.high_db + (scale.low_db - scale.high_db) * i / steps;
    shapes.legend.emplace_back(
        fmt::format("{}{:.0f} dB", i == steps && scale.weaker ? "at most " : "", gain_db),
        apps::color_of_gain(scale, gain_db));
  }
}

void add_kind_legend(Shapes& shapes, const std::vector<ShownPath>& paths) {
  std::array<size_t, apps::path_kinds.size()> counts{};
  for (const ShownPath& path : paths)
    if (path.shown) ++counts[static_cast<size_t>(apps::kind_of(path.path))];
  for (const InteractionType kind : apps::path_kinds)
    if (const size_t count = counts[static_cast<size_t>(kind)]; count > 0)
      shapes.legend.emplace_back(fmt::format("{} ({})", apps::kind_name(kind), count),
                                 apps::color_of_kind(kind));
}

/// Draws one record.
class PathDrawing {
 public:
  PathDrawing(const RecordTables& tables, const SensorSpec& spec, const Record& record,
              const ChannelFacts& channel, const NodePoses& poses, const PathOptions& options)
      : tables_(tables),
        spec_(spec),
        record_(spec, record),
        channel_(channel),
        options_(options),
        transmitters_(positions_of(channel.transmitters, poses)),
        receivers_(positions_of(channel.receivers, poses)) {}

  void draw(Shapes& shapes) {
    arrays_ = path_arrays(record_, spec_);
    choose();
    filter();
    ends(shapes);
    for (const ShownPath& path : paths_)
      if (path.shown) add(shapes, path);
    const auto shown = static_cast<size_t>(std::ranges::count(paths_, true, &ShownPath::shown));
    shapes.note(fmt::format("{}: {} of {} paths{}", spec_.name, shown, paths_.size(), left_out()));
    if (unplaced_ > 0)
      shapes.note(fmt::format("{}: {} paths have ends that the run does not place", spec_.name, unplaced_));
    if (shown == 0) return;
    if (options_.colors == PathColors::gain)
      add_gain_legend(shapes, scale_);
    else
      add_kind_legend(shapes, paths_);
  }

 private:
  bool is_chosen(size_t receiver, size_t transmitter) const {
    const PathFilter& filter = options_.filter;
    return filter.receiver.value_or(static_cast<uint32_t>(receiver)) == receiver &&
           filter.transmitter.value_or(static_cast<uint32_t>(transmitter)) == transmitter;
  }

  /// The paths of the links chosen, the weakest first.
  void choose() {
    for (size_t i = 0; i < static_cast<size_t>(arrays_.count); ++i) {
      const auto rx = static_cast<size_t>(arrays_.rx[i]), tx = static_cast<size_t>(arrays_.tx[i]);
      if (arrays_.rx[i] < 0 || rx >= receivers_.size())
        record_.fail("rx", fmt::format("one of {} receivers", receivers_.size()),
                     fmt::format("{} in row {}", arrays_.rx[i], i));
      if (arrays_.tx[i] < 0 || tx >= transmitters_.size())
        record_.fail("tx", fmt::format("one of {} transmitters", transmitters_.size()),
                     fmt::format("{} in row {}", arrays_.tx[i], i));
      if (!is_chosen(rx, tx)) continue;
      ShownPath shown{i, path_of(record_, arrays_, i)};
      shown.gain_db = apps::gain_db(apps::path_gain(shown.path, channel_.carrier_hz));
      if (!receivers_[rx] || !transmitters_[tx]) {
        ++unplaced_;
        continue;
      }
      shown.path.vertices.insert(shown.path.vertices.begin(), *transmitters_[tx]);
      shown.path.vertices.push_back(*receivers_[rx]);
      paths_.push_back(std::move(shown));
    }
    std::ranges::stable_sort(paths_, {}, &ShownPath::gain_db);
    if (options_.scale) {
      scale_ = *options_.scale;
      return;
    }
    apps::PathLink all;
    for (const ShownPath& shown : paths_) all.paths.push_back(shown.path);
    scale_ = apps::gain_scale(std::span(&all, 1), channel_.carrier_hz);
  }

  void filter() {
    if (paths_.empty()) return;
    const PathFilter& filter = options_.filter;
    const double least_db = paths_.back().gain_db - filter.within_db;
    for (ShownPath& shown : paths_) {
      const size_t order = shown.path.interactions.size();
      shown.shown = filter.kinds[static_cast<size_t>(apps::kind_of(shown.path))] &&
                    order >= filter.min_order && order <= filter.max_order && !(shown.gain_db < least_db);
    }
  }

  void ends(Shapes& shapes) const {
    for (const bool transmits : {true, false}) {
      const std::vector<AntennaFacts>& ends = transmits ? channel_.transmitters : channel_.receivers;
      const std::vector<std::optional<dvec3>>& positions = transmits ? transmitters_ : receivers_;
      const std::optional<uint32_t>& one = transmits ? options_.filter.transmitter : options_.filter.receiver;
      const io::Color color = transmits ? transmitter_color : receiver_color;
      for (size_t i = 0; i < ends.size(); ++i) {
        if (one.value_or(static_cast<uint32_t>(i)) != i || !positions[i]) continue;
        const std::string name = printable(ends[i].place.name);
        const uint32_t row = shapes.add_row(
            fmt::format("{} {} of {}\n({:.3f}, {:.3f}, {:.3f}) m", transmits ? "transmitter" : "receiver",
                        name, spec_.name, positions[i]->x, positions[i]->y, positions[i]->z),
            row_id(spec_.name + (transmits ? " tx" : " rx"), i));
        shapes.points.push_back({*positions[i], color, 6.0f,
                                 transmits ? PointShape::Mark::triangle : PointShape::Mark::circle, row,
                                 true});
        if (one || ends.size() <= most_end_names) shapes.labels.push_back({*positions[i], name, color});
      }
    }
  }

  void add(Shapes& shapes, const ShownPath& shown) const {
    const rf::Path& path = shown.path;
    const io::Color color = options_.colors == PathColors::gain ? apps::color_of_gain(scale_, shown.gain_db)
                                                                : apps::color_of_kind(apps::kind_of(path));
    const auto link = static_cast<uint64_t>(arrays_.rx[shown.number]) * transmitters_.size() +
                      static_cast<uint64_t>(arrays_.tx[shown.number]);
    const uint32_t row = shapes.add_row(text_of(shown, arrays_, tables_, channel_),
                                        path_row_id(arrays_.id[shown.number], link));
    shapes.rows[row].is_path = true;
    const auto width = static_cast<float>(1.2 + 1.8 * scale_.at(shown.gain_db));
    for (size_t k = 0; k + 1 < path.vertices.size(); ++k)
      shapes.lines.push_back({path.vertices[k], path.vertices[k + 1], color, width, row});
    for (size_t k = 0; k < path.interactions.size(); ++k)
      shapes.points.push_back({path.vertices[k + 1], white, 3.5f, mark_of(path.interactions[k].type), row});
  }

  /// What the search and max_paths left out of the links chosen.
  std::string left_out() const {
    uint64_t paths = 0, sequences = 0;
    const auto links = static_cast<int64_t>(transmitters_.size());
    for (const auto& [name, sum] :
         {std::pair("paths_left_out", &paths), std::pair("sequences_left_out", &sequences)}) {
      if (!record_.has(name)) continue;
      const auto counts = record_.get<uint64_t>(name, {static_cast<int64_t>(receivers_.size()), links});
      for (size_t i = 0; i < counts.size(); ++i)
        if (is_chosen(i / transmitters_.size(), i % transmitters_.size())) *sum += counts[i];
    }
    std::string text;
    if (paths > 0) text += fmt::format(", {} left out by max_paths", paths);
    if (sequences > 0) text += fmt::format(", the search left out {} sequences or more", sequences);
    return text;
  }

  const RecordTables& tables_;
  const SensorSpec& spec_;
  RecordArrays record_;
  const ChannelFacts& channel_;
  const PathOptions& options_;
  std::vector<std::optional<dvec3>> transmitters_, receivers_;
  PathArrays arrays_;
  std::vector<ShownPath> paths_;
  GainScale scale_;
  size_t unplaced_ = 0;
};

}  // namespace

Shapes path_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                   const NodePoses* poses, const PathOptions& options) {
  Shapes shapes;
  const SensorFacts& facts = tables.facts(spec);
  if (!facts.channel) throw_user_error("{}: expected the metadata of a channel", spec.name);
  if (!RecordArrays(spec, record).has("id")) {
    shapes.note(fmt::format("{}: its paths are not recorded: add 'paths' to its outputs", spec.name));
    return shapes;
  }
  const NodePoses* const known = poses_for(shapes, spec, record, poses);
  if (known == nullptr) return shapes;
  PathDrawing(tables, spec, record, *facts.channel, *known, options).draw(shapes);
  return shapes;
}

}  // namespace greatx::view

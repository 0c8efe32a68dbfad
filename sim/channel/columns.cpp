// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "rf/antenna/antenna.h"
#include "rf/channel/received.h"

namespace greatx::sim {

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// Returns a column of type T; `fill(view, T* row)` writes one row.
template <typename T, typename View, typename Fill>
Column<View> column(const char* name, std::vector<int64_t> row, const char* unit, const char* description,
                    Fill fill) {
  return {name,
          DTypeOf<T>::value,
          std::move(row),
          unit,
          description,
          [fill](const View& view, std::byte* bytes) { fill(view, reinterpret_cast<T*>(bytes)); }};
}
template <typename T, typename Fill>
PathColumn of_path(const char* name, std::vector<int64_t> row, const char* unit, const char* text,
                   Fill fill) {
  return column<T, PathView>(name, std::move(row), unit, text, fill);
}
/// Returns a column of one number per link.
template <typename T, typename Value>
LinkColumn of_link(const char* name, const char* unit, const char* text, Value value) {
  return column<T, LinkView>(name, {}, unit, text,
                             [value](const LinkView& link, T* out) { *out = static_cast<T>(value(link)); });
}

/// Identifies what an interaction touches by ids as on disk: index + 1, 0: none.
struct Where {
  uint8_t type = 0;
  uint32_t facet = 0, element = 0, object = 0, material = 0;
  uint8_t end = 0;  ///< of a wedge
};

Where where_of(const rf::Interaction& interaction, const ColumnContext& context) {
  Where where;
  where.type = static_cast<uint8_t>(interaction.type);
  if (interaction.type == rf::InteractionType::target) {
    where.object = interaction.element + 1;
    return where;
  }
  uint32_t facet = interaction.element;
  if (interaction.type == rf::InteractionType::diffraction) {
    facet = context.model->wedges[interaction.element].facet_0;
    where.element = interaction.element + 1;
    where.end = static_cast<uint8_t>(interaction.patch);
  } else if (interaction.type == rf::InteractionType::scattering) {
    where.element = interaction.patch + 1;
  }
  where.facet = facet + 1;
  where.object = context.scene->facets[facet].instance + 1;
  where.material = context.scene->facets[facet].material + 1;
  return where;
}

/// Returns a column with one member of Where for each of up to `depth` interactions.
template <typename T>
PathColumn of_interactions(const char* name, const char* text, const ColumnContext& context, int64_t depth,
                           T Where::*member) {
  return of_path<T>(name, {depth}, "1", text, [&context, depth, member](const PathView& view, T* out) {
    const std::vector<rf::Interaction>& interactions = view.path->interactions;
    for (size_t i = 0; i < static_cast<size_t>(depth); ++i)
      out[i] = i < interactions.size() ? where_of(interactions[i], context).*member : T{0};
  });
}

PathColumn angles(const char* name, const char* text, dvec3 rf::Path::*direction) {
  return of_path<double>(name, {2}, "rad", text, [direction](const PathView& view, double* out) {
    const dvec2 angles = rf::theta_phi(view.path->*direction);
    out[0] = angles.x;
    out[1] = angles.y;
  });
}

void fill_vertices(const PathView& view, const dvec3& origin, size_t depth, double* out) {
  for (size_t i = 0; i < depth; ++i) {
    const dvec3 point =
        i < view.path->interactions.size() ? view.path->vertices[i + 1] + origin : dvec3(missing);
    for (int c = 0; c < 3; ++c) *out++ = point[c];
  }
}

/// Returns the columns of rms values at a given transmit power: the field at the receiver, V/m, and the
/// voltage at its ports, V.
std::vector<PathColumn> received_columns(const ColumnContext& context) {
  const double volts =
      2.0 * std::sqrt(context.config->resistance_ohm * rf::watts(context.config->power_dbm.value()));
  return {
      of_path<std::complex<float>>(
          "field", {context.tx_ports, 2}, "V/m",
          "[path, tx_ant, (theta, phi) at the arrival] rms, with e^{-j 2 pi f_c tau}, power_dbm into tx_ant",
          [](const PathView& view, std::complex<float>* out) {
            std::copy(view.field.begin(), view.field.end(), out);
          }),
      of_path<std::complex<float>>("voltage", {context.rx_ports, context.tx_ports}, "V",
                                   "[path, rx_ant, tx_ant] open circuit, rms: sqrt(4 R P_t) * amplitude",
                                   [volts](const PathView& view, std::complex<float>* out) {
                                     for (const std::complex<float>& a : view.amplitude)
                                       *out++ = std::complex<float>(volts * std::complex<double>(a));
                                   }),
  };
}

std::vector<PathColumn> field_columns(const ColumnContext& context) {
  return {
      of_path<std::complex<float>>("amplitude", {context.rx_ports, context.tx_ports}, "1",
                                   "[path, rx_ant, tx_ant] with e^{-j 2 pi f_c tau}",
                                   [](const PathView& view, std::complex<float>* out) {
                                     std::copy(view.amplitude.begin(), view.amplitude.end(), out);
                                   }),
      of_path<double>("delay", {}, "s", "[path] not normalised",
                      [](const PathView& view, double* out) { *out = view.path->delay_s; }),
      of_path<double>("doppler", {}, "Hz", "[path] approaching: positive",
                      [](const PathView& view, double* out) { *out = view.path->doppler_hz; }),
      angles("departure", "[path, (zenith, azimuth)] leaving the transmitter, world axes",
             &rf::Path::departure),
      angles("arrival", "[path, (zenith, azimuth)] from the receiver back along the path, world axes",
             &rf::Path::arrival),
      of_path<std::complex<float>>(
          "transfer", {2, 2}, "1/m",
          "[path, (theta, phi) at rx, (theta, phi) at tx] without the phase of the delay",
          [](const PathView& view, std::complex<float>* out) {
            for (const rf::Complex& t : view.path->transfer) *out++ = std::complex<float>(t);
          }),
  };
}

}  // namespace

template <typename View>
size_t Column<View>::row_bytes() const {
  return static_cast<size_t>(std::accumulate(row.begin(), row.end(), int64_t{1}, std::multiplies<>())) *
         size_of(dtype);
}
template struct Column<PathView>;
template struct Column<LinkView>;

uint32_t most_interactions(const ChannelConfig& config) {
  return config.targets.empty() ? config.limits.max_depth
                                : std::max(config.limits.max_depth, 2 * config.legs.max_depth + 1);
}

std::vector<PathColumn> path_columns(const ColumnContext& context) {
  const int64_t depth = std::max<uint32_t>(1, most_interactions(*context.config));
  std::vector<PathColumn> columns{
      of_path<int32_t>("rx", {}, "1", "[path] receiver",
                       [](const PathView& view, int32_t* out) { *out = view.link->receiver; }),
      of_path<int32_t>("tx", {}, "1", "[path] transmitter",
                       [](const PathView& view, int32_t* out) { *out = view.link->transmitter; }),
  };
  for (PathColumn& of_field : field_columns(context)) columns.push_back(std::move(of_field));
  if (context.config->power_dbm)
    for (PathColumn& of_received : received_columns(context)) columns.push_back(std::move(of_received));
  columns.push_back(of_path<uint64_t>(
      "id", {}, "1", "[path] its identity across ticks: a function of its interactions alone",
      [](const PathView& view, uint64_t* out) { *out = view.path->id(); }));
  columns.push_back(of_path<double>("foliage", {}, "m", "[path] of its length inside foliage",
                                    [](const PathView& view, double* out) { *out = view.path->foliage_m; }));
  columns.push_back(
      of_interactions("interaction",
                      "[path, i] 0: none, 1: reflection, 2: transmission, 3: diffraction, 4: scattering, "
                      "5: target",
                      context, depth, &Where::type));
  columns.push_back(
      of_path<double>("vertex", {depth, 3}, "m", "[path, i, xyz] of each interaction, world; NaN: none",
                      [&context, depth](const PathView& view, double* out) {
                        fill_vertices(view, context.scene->origin, static_cast<size_t>(depth), out);
                      }));
  columns.push_back(of_interactions("facet",
                                    "[path, i] facet + 1 (diffraction: the wedge's first face); 0: none, "
                                    "target",
                                    context, depth, &Where::facet));
  columns.push_back(of_interactions("element",
                                    "[path, i] wedge + 1, or the scattering facet's patch + 1; 0: none",
                                    context, depth, &Where::element));
  if (context.model->effects.corner_diffraction)
    columns.push_back(of_interactions("end",
                                      "[path, i] 1, 2: diffraction at this end of the wedge; 0: not so",
                                      context, depth, &Where::end));
  columns.push_back(of_interactions("object", "[path, i] index into instances + 1; 0: none", context, depth,
                                    &Where::object));
  columns.push_back(of_interactions("object_material", "[path, i] index into materials + 1; 0: none", context,
                                    depth, &Where::material));
  return columns;
}

std::vector<LinkColumn> link_columns(const ColumnContext& context) {
  using Statistics = rf::LinkStatistics;
  const auto statistic = [](const char* name, const char* unit, const char* text,
                            double Statistics::*member) {
    return of_link<double>(name, unit, text,
                           [member](const LinkView& link) { return link.statistics->*member; });
  };
  std::vector<LinkColumn> columns{
      of_link<int32_t>("path_count", "1", "[rx, tx] visible paths",
                       [](const LinkView& link) { return link.statistics->paths; }),
      of_link<uint8_t>("line_of_sight", "1", "[rx, tx] 1: the direct path is free",
                       [](const LinkView& link) { return link.statistics->line_of_sight; }),
      of_link<uint8_t>("every_element", "1",
                       "[rx, tx] 1: cfr by paths between every two elements; 0: by paths of the whole arrays",
                       [](const LinkView& link) { return link.every_element; }),
      of_link<uint64_t>("sequences_left_out", "1",
                        "[rx, tx] facet sequences beyond those that a search keeps, at least; 0: the "
                        "guarantee of the candidates holds",
                        [](const LinkView& link) { return link.sequences_left_out; }),
      of_link<uint64_t>("paths_left_out", "1", "[rx, tx] geometric paths beyond max_paths",
                        [](const LinkView& link) { return link.paths_left_out; }),
      statistic("path_gain", "1", "[rx, tx] sum over paths of |a|^2, mean over port pairs",
                &Statistics::path_gain),
      statistic("path_gain_deviation", "1",
                "[rx, tx] estimate of the standard deviation of path_gain by the draws of scatterings "
                "(scattering_budget); 0: nothing was drawn",
                &Statistics::path_gain_deviation),
      statistic("mean_delay", "s", "[rx, tx] weighted by power; NaN: no path", &Statistics::mean_delay_s),
      statistic("delay_spread", "s", "[rx, tx] rms, weighted by power; NaN: no path",
                &Statistics::delay_spread_s),
      statistic("k_factor", "1",
                "[rx, tx] power of the line of sight over that of all others; inf: nothing else",
                &Statistics::k_factor),
      statistic("departure_azimuth_spread", "rad", "[rx, tx] circular, TR 38.901 eq. A-1; NaN: no path",
                &Statistics::departure_azimuth_spread),
      statistic("departure_zenith_spread", "rad", "[rx, tx] the same of the zenith",
                &Statistics::departure_zenith_spread),
      statistic("arrival_azimuth_spread", "rad", "[rx, tx] circular, TR 38.901 eq. A-1; NaN: no path",
                &Statistics::arrival_azimuth_spread),
      statistic("arrival_zenith_spread", "rad", "[rx, tx] the same of the zenith",
                &Statistics::arrival_zenith_spread),
      statistic("doppler_spread", "Hz", "[rx, tx] rms, weighted by power; NaN: no path",
                &Statistics::doppler_spread_hz),
  };
  const ChannelConfig& config = *context.config;
  if (config.outputs.coherence) {
    columns.push_back(of_link<double>("coherence_bandwidth", "Hz",
                                      "[rx, tx] correlation over frequency falls to 0.5; inf: it does not",
                                      [](const LinkView& link) { return link.coherence_bandwidth_hz; }));
    columns.push_back(of_link<double>("coherence_time", "s",
                                      "[rx, tx] correlation over time falls to 0.5; inf: it does not",
                                      [](const LinkView& link) { return link.coherence_time_s; }));
  }
  if (config.taps)
    columns.push_back(of_link<double>("taps_power_outside", "1",
                                      "[rx, tx] share of the power that the window of taps leaves out",
                                      [](const LinkView& link) { return link.taps_power_outside; }));
  if (config.power_dbm)
    columns.push_back(of_link<double>("received_power", "dBm",
                                      "[rx, tx] transmit power * path_gain, at a matched load; -inf: none",
                                      [power_w = rf::watts(*config.power_dbm)](const LinkView& link) {
                                        return rf::dbm(power_w * link.statistics->path_gain);
                                      }));
  return columns;
}

}  // namespace greatx::sim

// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/paths/text.h"

#include <cmath>

#include <fmt/format.h>

#include "core/geodesy.h"
#include "core/units.h"
#include "rf/antenna/antenna.h"

namespace greatx::apps {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const dvec3& v) { return Json::array({v.x, v.y, v.z}); }
Json json_of(const Geodetic& place) {
  return Json::array({place.latitude_deg, place.longitude_deg, place.height_m});
}
Json json_of(const rf::Complex& z) { return Json::array({z.real(), z.imag()}); }

/// Returns the gain in dB, or null if there is no power, because JSON has no infinity.
Json json_of_decibels(double gain) { return gain > 0.0 ? Json(gain_db(gain)) : Json(); }

Json json_of_direction(const dvec3& direction) {
  const dvec2 angles = rf::theta_phi(direction);
  return {{"zenith_rad", angles.x}, {"azimuth_rad", angles.y}};
}

Json json_of(const rf::Interaction& interaction, const PathScene& scene) {
  const Touched names = touched(interaction, scene);
  Json json{{"type", rf::name_of(interaction.type)}};
  if (interaction.type == rf::InteractionType::diffraction) {
    json["wedge"] = interaction.element;
    if (interaction.patch != 0) json["end"] = interaction.patch;
  }
  if (interaction.type == rf::InteractionType::scattering) json["patch"] = interaction.patch;
  json["facets"] = names.facets;
  json["objects"] = names.objects;
  json["materials"] = names.materials;
  return json;
}

Json json_of(const rf::Path& path, const PathScene& scene) {
  Json json{{"id", id_text(path.id())},
            {"chain", chain_of(path)},
            {"length_m", path.length_m},
            {"foliage_m", path.foliage_m},
            {"delay_s", path.delay_s},
            {"doppler_hz", path.doppler_hz},
            {"gain_db", json_of_decibels(path_gain(path, scene.carrier_hz))},
            {"amplitude_vertical", json_of(vertical_amplitude(path, scene.carrier_hz))},
            {"phase_rad", std::arg(vertical_amplitude(path, scene.carrier_hz))},
            {"departure", json_of_direction(path.departure)},
            {"arrival", json_of_direction(path.arrival)},
            {"transfer_per_m", Json::array()},
            {"vertices_m", Json::array()},
            {"interactions", Json::array()}};
  for (const rf::Complex& t : path.transfer) json["transfer_per_m"].push_back(json_of(t));
  for (const dvec3& vertex : path.vertices)
    json["vertices_m"].push_back(json_of(vertex + scene.scene->origin));
  for (const rf::Interaction& interaction : path.interactions)
    json["interactions"].push_back(json_of(interaction, scene));
  return json;
}

std::string decibels_text(double gain) { return gain > 0.0 ? fmt::format("{:.2f}", gain_db(gain)) : "none"; }

/// Returns the angle in degrees with two decimals, never "-0.00".
std::string angle_text(double rad) {
  const double rounded = std::round(degrees(rad) * 100.0) / 100.0;
  return fmt::format("{:.2f}", rounded == 0.0 ? 0.0 : rounded);
}

std::string row_of(size_t number, const rf::Path& path, const PathScene& scene) {
  const dvec2 departure = rf::theta_phi(path.departure), arrival = rf::theta_phi(path.arrival);
  const double gain = path_gain(path, scene.carrier_hz);
  return fmt::format("  {:>4} {}{:>11.3f}{:>12.3f}{:>10}{:>10}{:>9}{:>9}{:>9}{:>9}{:>11.3f}  {}\n", number,
                     id_text(path.id()), path.length_m, 1e9 * path.delay_s, decibels_text(gain),
                     angle_text(std::arg(vertical_amplitude(path, scene.carrier_hz))),
                     angle_text(departure.y), angle_text(departure.x), angle_text(arrival.y),
                     angle_text(arrival.x), path.doppler_hz, describe_interactions(path, scene));
}

}  // namespace

std::string table_of(const PathLink& link, const PathScene& scene) {
  const LinkFigures figures = figures_of(link, scene.carrier_hz);
  std::string text = fmt::format(
      "{} at ({:.3f}, {:.3f}, {:.3f}) m, {:.3f} m from the transmitter: {} path{}, {} line of sight",
      link.name, link.receiver_m.x, link.receiver_m.y, link.receiver_m.z, link.distance_m, figures.paths,
      figures.paths == 1 ? "" : "s", figures.line_of_sight ? "with" : "no");
  if (figures.delay_spread_s)
    text += fmt::format(", gain {:.2f} dB, rms delay spread {:.2f} ns", gain_db(figures.gain),
                        1e9 * *figures.delay_spread_s);
  if (figures.gain_deviation > 0.0)
    text += fmt::format(", drawn scatterings: {:.2g} dB rms",
                        gain_db(1.0 + figures.gain_deviation / figures.gain));
  text += '\n';
  if (link.paths.empty()) return text;
  text += fmt::format("  {:>4} {:<16}{:>11}{:>12}{:>10}{:>10}{:>9}{:>9}{:>9}{:>9}{:>11}  {}\n", "#", "id",
                      "length m", "delay ns", "gain dB", "phase deg", "AoD deg", "ZoD deg", "AoA deg",
                      "ZoA deg", "Doppler Hz", "interactions: object (material)");
  for (size_t i = 0; i < link.paths.size(); ++i) text += row_of(i + 1, link.paths[i], scene);
  return text;
}

std::string brief_head() {
  return fmt::format("{:<20}{:>12}{:>12}{:>10}{:>11}{:>7}{:>5}{:>11}{:>12}{:>11}\n", "receiver", "x m", "y m",
                     "z m", "distance m", "paths", "LoS", "gain dB", "delay ns", "spread ns");
}

std::string brief_row(const PathLink& link, double carrier_hz) {
  const LinkFigures figures = figures_of(link, carrier_hz);
  const auto nanoseconds = [](const std::optional<double>& seconds) {
    return seconds ? fmt::format("{:.2f}", 1e9 * *seconds) : std::string("-");
  };
  return fmt::format("{:<20}{:>12.2f}{:>12.2f}{:>10.2f}{:>11.2f}{:>7}{:>5}{:>11}{:>12}{:>11}\n", link.name,
                     link.receiver_m.x, link.receiver_m.y, link.receiver_m.z, link.distance_m, figures.paths,
                     figures.line_of_sight ? "yes" : "no", decibels_text(figures.gain),
                     nanoseconds(figures.first_delay_s), nanoseconds(figures.delay_spread_s));
}

nlohmann::ordered_json json_of(const PathLink& link, const PathScene& scene) {
  const LinkFigures figures = figures_of(link, scene.carrier_hz);
  Json json{{"index", link.index},
            {"name", link.name},
            {"position_m", json_of(link.receiver_m)},
            {"transmitter_m", json_of(link.transmitter_m)},
            {"distance_m", link.distance_m},
            {"line_of_sight", figures.line_of_sight},
            {"gain_db", json_of_decibels(figures.gain)},
            {"gain_deviation", figures.gain_deviation},
            {"first_delay_s", figures.first_delay_s ? Json(*figures.first_delay_s) : Json()},
            {"delay_spread_s", figures.delay_spread_s ? Json(*figures.delay_spread_s) : Json()},
            {"paths", Json::array()}};
  if (const auto& reference = scene.scene->georeference) {
    const LocalFrame frame(*reference);
    json["geodetic"] = json_of(frame.place(link.receiver_m));
    json["transmitter_geodetic"] = json_of(frame.place(link.transmitter_m));
  }
  for (const rf::Path& path : link.paths) json["paths"].push_back(json_of(path, scene));
  return json;
}

std::string csv_head(const PathScene& scene) {
  return fmt::format(
      "receiver,x_m,y_m,z_m,distance_m,paths,line_of_sight,path_gain_db,first_delay_ns,delay_spread_ns{}\n",
      scene.scene->georeference ? ",latitude_deg,longitude_deg,height_m" : "");
}

std::string csv_row(const PathLink& link, const PathScene& scene) {
  const LinkFigures figures = figures_of(link, scene.carrier_hz);
  const auto cell = [](bool there, double value) { return there ? fmt::format("{}", value) : std::string(); };
  std::string row =
      fmt::format("{},{},{},{},{},{},{},{},{},{}", link.index, link.receiver_m.x, link.receiver_m.y,
                  link.receiver_m.z, link.distance_m, figures.paths, figures.line_of_sight ? 1 : 0,
                  cell(figures.gain > 0.0, gain_db(figures.gain)),
                  cell(figures.first_delay_s.has_value(), 1e9 * figures.first_delay_s.value_or(0.0)),
                  cell(figures.delay_spread_s.has_value(), 1e9 * figures.delay_spread_s.value_or(0.0)));
  if (const auto& reference = scene.scene->georeference) {
    const Geodetic place = LocalFrame(*reference).place(link.receiver_m);
    row += fmt::format(",{},{},{}", place.latitude_deg, place.longitude_deg, place.height_m);
  }
  return row + '\n';
}

}  // namespace greatx::apps

// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/session/environment.h"

#include <functional>
#include <map>

#include "scene/georeference/georeference.h"

namespace greatx::engine {

void change_environment(sim::Environment& to, const sim::Environment& from, const std::string& key) {
  using E = sim::Environment;
  static const std::map<std::string, std::function<void(E&, const E&)>> copies{
      {"sun.azimuth_deg", [](E& a, const E& b) { a.sun_azimuth = b.sun_azimuth, a.place = b.place; }},
      {"sun.elevation_deg", [](E& a, const E& b) { a.sun_elevation = b.sun_elevation, a.place = b.place; }},
      {"sun.illuminance_lux", [](E& a, const E& b) { a.sun_illuminance_lux = b.sun_illuminance_lux; }},
      {"place", [](E& a, const E& b) { a.place = b.place, a.moon.reset(); }},
      {"time", [](E& a, const E& b) { a.place = b.place, a.moon.reset(); }},
      {"moon", [](E& a, const E& b) { a.moon = b.moon, a.moon_illuminance_lux = b.moon_illuminance_lux; }},
      {"sky", [](E& a, const E& b) { a.sky = b.sky; }},
      {"sky_illuminance_lux", [](E& a, const E& b) { a.sky_illuminance_lux = b.sky_illuminance_lux; }},
      {"sky_glow_cd_m2", [](E& a, const E& b) { a.sky_glow_cd_m2 = b.sky_glow_cd_m2; }},
      {"turbidity", [](E& a, const E& b) { a.turbidity = b.turbidity; }},
      {"clouds", [](E& a, const E& b) { a.clouds = b.clouds; }},
      {"horizon", [](E& a, const E& b) { a.horizon = b.horizon; }},
      {"temperature_k", [](E& a, const E& b) { a.temperature_k = b.temperature_k; }},
      {"pressure_hpa", [](E& a, const E& b) { a.pressure_hpa = b.pressure_hpa; }},
      {"water_vapour_g_m3", [](E& a, const E& b) { a.water_vapour_g_m3 = b.water_vapour_g_m3; }},
      {"rain_mm_h", [](E& a, const E& b) { a.rain_mm_h = b.rain_mm_h; }},
      {"fog_g_m3", [](E& a, const E& b) { a.fog_g_m3 = b.fog_g_m3; }},
      {"fog_height_m", [](E& a, const E& b) { a.fog_height_m = b.fog_height_m; }},
      {"wetness", [](E& a, const E& b) { a.wetness = b.wetness; }},
      {"puddles", [](E& a, const E& b) { a.puddles = b.puddles; }},
      {"snow", [](E& a, const E& b) { a.snow = b.snow; }}};
  copies.at(key)(to, from);
}

nlohmann::ordered_json place_facts(const sim::Environment& environment) {
  const auto& place = environment.place;
  if (!place) return nullptr;
  return {{"latitude_deg", degrees(place->latitude)},
          {"longitude_deg", degrees(place->longitude)},
          {"height_m", place->height_m},
          {"time", place->time}};
}

nlohmann::ordered_json reference_facts(const sim::SceneConfig& scene) {
  if (!scene.georeference) return nullptr;
  return nlohmann::ordered_json::parse(scene::georeference_json(*scene.georeference));
}

}  // namespace greatx::engine

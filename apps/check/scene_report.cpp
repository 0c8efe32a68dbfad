// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/check/scene_report.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/text.h"

namespace greatx::apps {
namespace {

const char* word_of(scene::FaultSeverity severity) {
  return severity == scene::FaultSeverity::fault ? "fault" : "doubt";
}

/// Returns "12.5 m2", or an empty text if sizes have no meaning.
std::string size_words(double size, const std::string& unit) {
  if (unit == "of the rays") return fmt::format("{:.2g} % of the rays", 100.0 * size);
  return unit.empty() ? "" : fmt::format("{:.3g} {}", size, unit);
}

std::string place_words(const scene::SceneFault& fault, const scene::FaultPlace& place) {
  std::string words = place.object.empty() ? "" : fmt::format("'{}'", printable(place.object));
  if (fault.kind == "no_radio") {
    words = fmt::format("'{}', {:.3g} m2", printable(place.material), place.size);
    return place.other.empty() ? words : fmt::format("{}; perhaps {{ {} }}", words, place.other);
  }
  if (place.object.empty() && !place.material.empty()) return printable(place.material);
  if (!place.other.empty()) words += fmt::format(" and '{}'", printable(place.other));
  if (!place.material.empty()) words += fmt::format(" ({})", printable(place.material));
  words += fmt::format("{}at ({:.3f}, {:.3f}, {:.3f})", words.empty() ? "" : " ", place.at.x, place.at.y,
                       place.at.z);
  return fault.unit.empty() ? words : fmt::format("{}: {}", words, size_words(place.size, fault.unit));
}

std::string figures_words(const scene::CheckFigures& figures) {
  std::string text = fmt::format("  {} triangles, {} facets, {} objects, {} materials\n", figures.triangles,
                                 figures.facets, figures.objects, figures.materials);
  text += fmt::format("  {} closed parts, {} nearly closed, {} sheets; {} of {} open edges meet a surface\n",
                      figures.closed_parts, figures.nearly_closed_parts, figures.sheets,
                      figures.closed_by_others, figures.open_edges);
  if (figures.rays > 0)
    text += fmt::format("  {} of {} rays from inside met nothing\n", figures.rays_out, figures.rays);
  if (figures.crowds > 0)
    text += fmt::format("  {} triangles and edges have so many neighbours that only 1024 were looked at\n",
                        figures.crowds);
  if (figures.bounds.empty()) return text;
  const dvec3 size = figures.bounds.size(), center = figures.bounds.center();
  return text + fmt::format("  {:.2f} x {:.2f} x {:.2f} m around ({:.2f}, {:.2f}, {:.2f})\n", size.x, size.y,
                            size.z, center.x, center.y, center.z);
}

}  // namespace

std::string scene_check_text(const std::string& file, const scene::SceneFaults& faults, size_t places,
                             bool figures) {
  std::string text;
  for (const scene::SceneFault& fault : faults.faults) {
    text += fmt::format("{}: {}: {} {} ({})", printable(file), word_of(fault.severity), fault.count,
                        fault.text, fault.kind);
    if (!fault.unit.empty() && fault.count > 1)
      text += fmt::format(", the worst {}", size_words(fault.worst, fault.unit));
    if ((fault.unit == "m2" || fault.kind == "hole") && fault.count > 1)
      text += fmt::format(", {} in all", size_words(fault.total, fault.unit));
    text += '\n';
    const size_t shown = std::min(places, fault.places.size());
    for (size_t i = 0; i < shown; ++i) text += fmt::format("    {}\n", place_words(fault, fault.places[i]));
    if (shown > 0 && shown < fault.count) text += fmt::format("    and {} more\n", fault.count - shown);
  }
  return figures ? text + figures_words(faults.figures) : text;
}

nlohmann::json scene_check_json(const std::string& file, const scene::SceneFaults& faults) {
  using nlohmann::json;
  const scene::CheckFigures& figures = faults.figures;
  const auto vector = [](const dvec3& p) { return json{p.x, p.y, p.z}; };
  json result{{"file", file},
              {"faults", faults.count(scene::FaultSeverity::fault)},
              {"doubts", faults.count(scene::FaultSeverity::doubt)},
              {"triangles", figures.triangles},
              {"facets", figures.facets},
              {"objects", figures.objects},
              {"materials", figures.materials},
              {"closed_parts", figures.closed_parts},
              {"nearly_closed_parts", figures.nearly_closed_parts},
              {"sheets", figures.sheets},
              {"open_edges", figures.open_edges},
              {"closed_by_others", figures.closed_by_others},
              {"rays", figures.rays},
              {"rays_out", figures.rays_out},
              {"crowds", figures.crowds},
              {"findings", json::array()}};
  if (!figures.bounds.empty()) {
    result["min_m"] = vector(figures.bounds.min);
    result["max_m"] = vector(figures.bounds.max);
  }
  for (const scene::SceneFault& fault : faults.faults) {
    json places = json::array();
    for (const scene::FaultPlace& place : fault.places) {
      json one = json::object();
      if (!place.object.empty()) one["object"] = place.object, one["at_m"] = vector(place.at);
      if (!place.other.empty()) one[fault.kind == "no_radio" ? "suggestion" : "other"] = place.other;
      if (!place.material.empty()) one[fault.kind == "lost_picture" ? "error" : "material"] = place.material;
      if (!fault.unit.empty()) one["size"] = place.size;
      places.push_back(std::move(one));
    }
    json finding{{"severity", word_of(fault.severity)},
                 {"kind", fault.kind},
                 {"text", fault.text},
                 {"count", fault.count},
                 {"places", std::move(places)}};
    if (!fault.unit.empty())
      finding["unit"] = fault.unit, finding["worst"] = fault.worst, finding["total"] = fault.total;
    result["findings"].push_back(std::move(finding));
  }
  return result;
}

}  // namespace greatx::apps

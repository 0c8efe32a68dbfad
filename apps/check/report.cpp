// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/check/report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace greatx::apps {
namespace {

const char* name_of(sim::Severity severity) { return severity == sim::Severity::fault ? "fault" : "doubt"; }

std::string clearance_words(double clearance_m) {
  return std::isfinite(clearance_m) ? fmt::format("{:.3g} m", clearance_m) : "more than 50 m";
}

}  // namespace

nlohmann::json json_of(const CheckedScenario& checked) {
  nlohmann::json json{{"name", checked.name},
                      {"sequences", checked.courses.sequences},
                      {"ticks", checked.courses.ticks},
                      {"faults", faults_of(checked)}};
  for (const char* list : {"findings", "nodes", "views", "links", "pictures"})
    json[list] = nlohmann::json::array();
  for (const sim::Finding& finding : checked.findings)
    json["findings"].push_back({{"severity", name_of(finding.severity)},
                                {"kind", finding.kind},
                                {"subject", finding.subject},
                                {"text", finding.text}});
  for (const sim::NodeFigures& node : checked.courses.nodes) {
    nlohmann::json row{{"node", node.name},
                       {"most_speed_m_s", node.most_speed},
                       {"most_acceleration_m_s2", node.most_acceleration}};
    if (std::isfinite(node.least_clearance)) row["least_clearance_m"] = node.least_clearance;
    if (node.draws > 0) row["draws"] = node.draws;
    json["nodes"].push_back(std::move(row));
  }
  for (const sim::ViewFigures& view : checked.courses.views)
    json["views"].push_back({{"sensor", view.name},
                             {"moments", view.moments},
                             {"sky", view.sky},
                             {"ground", view.ground},
                             {"only_sky", view.only_sky},
                             {"only_ground", view.only_ground}});
  for (const sim::LinkFigures& link : checked.looks.links)
    json["links"].push_back({{"channel", link.channel},
                             {"tx", link.transmitter},
                             {"rx", link.receiver},
                             {"moments", link.moments},
                             {"without_path", link.without_path},
                             {"line_of_sight", link.line_of_sight}});
  for (const sim::PictureFigures& picture : checked.looks.pictures)
    json["pictures"].push_back({{"sensor", picture.name},
                                {"moments", picture.moments},
                                {"white", picture.white},
                                {"black", picture.black}});
  return json;
}

std::string text_of(const CheckedScenario& checked, bool figures) {
  std::string text;
  for (const sim::Finding& finding : checked.findings)
    text += fmt::format("{}: {}: {} {}\n", checked.name, name_of(finding.severity), finding.subject,
                        finding.text);
  if (!figures) return text;
  for (const sim::NodeFigures& node : checked.courses.nodes)
    text += fmt::format("  {}: at most {:.3g} m/s and {:.3g} m/s2; {} to the static world{}\n", node.name,
                        node.most_speed, node.most_acceleration, clearance_words(node.least_clearance),
                        node.draws > 0 ? fmt::format("; drawn {} times for {} sequences", node.draws,
                                                     checked.courses.sequences)
                                       : "");
  for (const sim::ViewFigures& view : checked.courses.views)
    text += fmt::format("  {}: {:.0f} % sky, {:.0f} % ground\n", view.name, 100.0 * view.sky,
                        100.0 * view.ground);
  for (const sim::PictureFigures& picture : checked.looks.pictures)
    text += fmt::format("  {}: {:.2g} % of the pixels are white, {:.2g} % black\n", picture.name,
                        100.0 * picture.white, 100.0 * picture.black);
  for (const sim::LinkFigures& link : checked.looks.links)
    text += fmt::format("  {}: {} to {}: paths at {} of {} moments, line of sight at {}\n", link.channel,
                        link.transmitter, link.receiver, link.moments - link.without_path, link.moments,
                        link.line_of_sight);
  return text;
}

size_t faults_of(const CheckedScenario& checked) {
  return static_cast<size_t>(
      std::ranges::count(checked.findings, sim::Severity::fault, &sim::Finding::severity));
}

}  // namespace greatx::apps

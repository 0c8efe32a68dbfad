// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/campaign/stats.h"
#include "apps/console/json_text.h"
#include "core/hash.h"
#include "io/dataset/dataset_format.h"
#include "io/files/file.h"
#include "io/files/untrusted_json.h"
#include "io/formats/png.h"

namespace greatx::apps {
namespace {

/// Returns what the data set of the first cell says of its run.
nlohmann::json run_of(const OpenCampaign& open) {
  const std::filesystem::path file = open.data(0) / io::dataset_file;
  return nlohmann::json::parse(io::read_text_file(file, io::JsonLimits{}.bytes)).at("run");
}

std::string stated(const std::string& text) { return text.empty() ? "not stated" : text; }

std::string table_of(const CampaignStats& stats) {
  std::string text = "| quantity | split | records | 5 % | median | 95 % |\n|---|---|---|---|---|---|\n";
  for (const Quantity& quantity : stats.quantities)
    for (const auto& [split, figures] : stats.json["quantities"][quantity.name].items())
      text += fmt::format("| {} | {} | {} | {:.4g} | {:.4g} | {:.4g} |\n", quantity.label, split,
                          figures["count"].get<uint64_t>(), figures["p5"].get<double>(),
                          figures["median"].get<double>(), figures["p95"].get<double>());
  return text;
}

/// Returns a table of the classes that a kind of sensor sees.
std::string classes_of(const CampaignStats& stats) {
  std::string text;
  for (const ClassBalance& balance : stats.balances) {
    text += fmt::format("\n## Classes of the {}\n\n| class |",
                        balance.kind == "camera" ? "pixels" : "LiDAR's returns");
    for (const char* split : sim::split_names) text += fmt::format(" {} |", split);
    text += "\n|---|---|---|---|\n";
    for (size_t c = 0; c < balance.classes.size(); ++c) {
      text += fmt::format("| {} |", balance.classes[c]);
      for (const auto& shares : balance.shares)
        text += shares.empty() ? " |" : fmt::format(" {:.2f} % |", 100.0 * shares[c]);
      text += '\n';
    }
  }
  return text;
}

std::string splits_of(const nlohmann::json& json) {
  const nlohmann::json none = nlohmann::json::object();
  const nlohmann::json &counts = json.contains("sequences") ? json["sequences"] : none,
                       &lit = json.contains("line_of_sight_share") ? json["line_of_sight_share"] : none;
  std::string text;
  for (const auto& [split, count] : counts.items()) {
    text += fmt::format("| {} | {:.0f} |", split, count.get<double>());
    text += lit.contains(split) ? fmt::format(" {:.1f} % |\n", 100.0 * lit[split].get<double>()) : " |\n";
  }
  return text;
}

}  // namespace

std::string data_card(const OpenCampaign& open, const CampaignStats& stats) {
  const sim::CampaignCard& card = open.campaign.card;
  const nlohmann::json run = run_of(open);
  std::string text = fmt::format("# {}\n\n", open.campaign.name);
  if (!card.description.empty()) text += card.description + "\n\n";
  text += fmt::format("- License: {}\n- Creators: {}\n- Citation: {}\n", stated(card.license),
                      stated(fmt::format("{}", fmt::join(card.creators, ", "))), stated(card.citation));
  text += fmt::format(
      "- Made by greatx {} on {} ({}), from campaign.yaml; simulated, without recordings of people or "
      "places\n",
      run["greatx"].get<std::string>(), run["device"].get<std::string>(), run["driver"].get<std::string>());
  text += fmt::format("- {} cells:", open.cells.size());
  for (const sim::CampaignAxis& axis : open.campaign.axes) {
    std::vector<std::string> names;
    for (const sim::CampaignValue& value : axis.values) names.push_back(value.name);
    text += fmt::format(" {} ({})", axis.name, fmt::join(names, ", "));
  }
  text += "\n\n## Splits\n\n| split | sequences | links in line of sight |\n|---|---|---|\n";
  text += splits_of(stats.json);
  text += fmt::format(
      "\nPoses of a sensor that are in more than one split: {:.0f} (sensors at rest count, too).\n",
      stats.json["poses_in_two_splits"].get<double>());
  text += "\n## Figures\n\n![histograms](stats.png)\n\n" + table_of(stats) + classes_of(stats);
  text +=
      "\n## Files\n\n`data/CELL/` are data sets, `index.sqlite` and `index.csv` list every record, "
      "`splits.csv` "
      "every sequence.\n";
  return text;
}

nlohmann::json croissant(const OpenCampaign& open, const CampaignStats& stats) {
  const sim::CampaignCard& card = open.campaign.card;
  const std::string csv = io::read_text_file(open.folder / "index.csv");
  nlohmann::json fields = nlohmann::json::array();
  const std::string header = csv.substr(0, csv.find('\n'));
  for (size_t from = 0; from <= header.size();) {
    const size_t comma = std::min(header.find(',', from), header.size());
    const std::string column = header.substr(from, comma - from);
    const bool words = column == "cell" || column == "split" || column == "sensor" || column == "kind" ||
                       column == "data" || column == "file" || column.starts_with("axis_");
    fields.push_back(
        {{"@type", "cr:Field"},
         {"@id", "records/" + column},
         {"name", column},
         {"dataType", words ? "sc:Text" : "sc:Float"},
         {"source", {{"fileObject", {{"@id", "index.csv"}}}, {"extract", {{"column", column}}}}}});
    from = comma + 1;
  }
  nlohmann::json json{
      {"@context",
       {{"@vocab", "https://schema.org/"},
        {"sc", "https://schema.org/"},
        {"cr", "http://mlcommons.org/croissant/"}}},
      {"@type", "sc:Dataset"},
      {"conformsTo", "http://mlcommons.org/croissant/1.0"},
      {"name", open.campaign.name},
      {"description", card.description},
      {"license", card.license},
      {"citeAs", card.citation},
      {"distribution",
       {{{"@type", "cr:FileObject"},
         {"@id", "index.csv"},
         {"name", "index.csv"},
         {"contentUrl", "index.csv"},
         {"contentSize", fmt::format("{} B", csv.size())},
         {"encodingFormat", "text/csv"},
         {"sha256", Sha256().update(csv).hex()}}}},
      {"recordSet",
       {{{"@type", "cr:RecordSet"}, {"@id", "records"}, {"name", "records"}, {"field", fields}}}}};
  for (const std::string& creator : card.creators)
    json["creator"].push_back({{"@type", "sc:Person"}, {"name", creator}});
  json["greatx:statistics"] = stats.json;
  return json;
}

std::string write_stats(const OpenCampaign& open, const CampaignStats& stats) {
  io::write_file_atomically(open.folder / "stats.json", json_text(stats.json));
  io::write_file_atomically(open.folder / "stats.png", io::encode_png(draw_stats(open, stats)));
  io::write_file_atomically(open.folder / "card.md", data_card(open, stats));
  io::write_file_atomically(open.folder / "croissant.json", json_text(croissant(open, stats)));
  return table_of(stats);
}

}  // namespace greatx::apps

// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The page of the report, with everything in itself.
#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/tradeoff/report_parts.h"
#include "io/files/file.h"
#include "io/formats/html_text.h"
#include "io/formats/png.h"

namespace greatx::apps {

namespace {

using Json = nlohmann::json;
using io::base64;
using io::Bytes;

constexpr const char* style = R"(
:root { color-scheme: light dark; --paper: #f7f8fa; --panel: #ffffff; --ink: #1c2430; --dim: #667085;
  --grid: #e4e7ec; --own: #d92d20; --finest: #067647; --mark: #175cd3; }
@media (prefers-color-scheme: dark) { :root { --paper: #111318; --panel: #1a1d24; --ink: #e2e6ee;
  --dim: #969daa; --grid: #2c303a; --own: #ff8a7a; --finest: #5fd3a2; --mark: #7db1ff; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1120px; padding: 24px 16px 80px; background: var(--paper);
  color: var(--ink);
  font: 16px/1.55 system-ui, sans-serif; }
h1 { font-size: 28px; margin: 8px 0; } h2 { margin: 56px 0 8px; font-size: 22px; } h3 { margin: 0 0 4px; }
p { max-width: 78ch; } .dim { color: var(--dim); font-size: 14px; }
section { background: var(--panel); border: 1px solid var(--grid); border-radius: 10px; padding: 18px;
  margin: 18px 0; }
svg { max-width: 100%; min-width: 480px; height: auto; }
nav { display: flex; flex-wrap: wrap; gap: 2px 14px; }
a { color: var(--mark); }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-size: 14px; margin-top: 10px; }
th, td { padding: 4px 12px 4px 0; text-align: right; white-space: nowrap;
  border-bottom: 1px solid var(--grid); }
th:first-child, td:first-child { text-align: left; } .own td { color: var(--own); }
.finest td { color: var(--finest); }
.pictures { display: flex; flex-wrap: wrap; gap: 12px; margin-top: 12px; }
figure { margin: 0; flex: 1 1 240px; max-width: 420px; } figure img { width: 100%; border-radius: 6px;
  image-rendering: auto; } figcaption { font-size: 13px; color: var(--dim); }
.maps figure { flex: 0 1 200px; } .maps img { image-rendering: pixelated; }
)";

/// Lets a narrow window scroll what cannot become narrower.
std::string in_scroller(const std::string& html) { return "<div class=\"scroll\">" + html + "</div>\n"; }

std::string picture_tag(const Bytes& png, const std::string& caption) {
  return fmt::format(
      R"(<figure><img alt="{0}" src="data:image/png;base64,{1}"/><figcaption>{0}</figcaption></figure>)",
      escaped(caption), base64(png));
}

/// Returns |a - b| four times as strong; empty if the pictures have other sizes.
Array difference_of(const Array& a, const Array& b) {
  if (a.shape != b.shape) return {};
  Array result(DType::u8, a.shape);
  for (size_t i = 0; i < result.bytes.size(); ++i) {
    const int difference =
        std::abs(static_cast<int>(a.as<uint8_t>()[i]) - static_cast<int>(b.as<uint8_t>()[i]));
    result.as<uint8_t>()[i] = static_cast<uint8_t>(std::min(255, 4 * difference));
  }
  return result;
}

class Page {
 public:
  Page(const Json& report, const std::filesystem::path& folder) : report_(report), folder_(folder) {}

  std::string text() {
    html_ = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
        "<title>greatx tradeoff: {}</title><style>{}</style></head><body>\n",
        escaped(text_of(report_, "scenario")), style);
    head();
    for (const char* const modality : {"csi", "map", "camera", "events", "lidar", "radar"}) part(modality);
    absent();
    html_ += "</body></html>\n";
    return std::move(html_);
  }

 private:
  static std::string text_of(const Json& json, const char* key) { return json[key].get<std::string>(); }

  void head() {
    html_ += fmt::format("<h1>What accuracy costs: {}</h1>\n", escaped(text_of(report_, "scenario")));
    html_ +=
        fmt::format("<p class=\"dim\">greatx {} on {} ({}), {} cores; {:.1f} minutes{}.</p>\n",
                    escaped(text_of(report_, "greatx")), escaped(text_of(report_, "device")),
                    escaped(text_of(report_, "driver")), report_["cores"].get<uint32_t>(),
                    report_["minutes"].get<double>(), report_["quick"].get<bool>() ? ", a quick study" : "");
    html_ += fmt::format("<p>{}</p>\n", escaped(text_of(report_, "how")));
    html_ += "<nav>";
    for (const Json& knob : report_["knobs"])
      html_ += fmt::format("<a href=\"#{0}\">{1}</a>", anchor(knob), escaped(text_of(knob, "name")));
    html_ += "</nav>\n<section><h3>All knobs</h3>" + in_scroller(overview_plot(report_)) + "</section>\n";
  }
  static std::string anchor(const Json& knob) {
    std::string name = text_of(knob, "modality") + "-" + text_of(knob, "name");
    std::ranges::replace(name, ' ', '_');
    return escaped(name);
  }

  void part(const std::string& modality) {
    bool any = false;
    for (const Json& knob : report_["knobs"]) {
      if (knob["modality"] != modality) continue;
      if (!std::exchange(any, true)) html_ += fmt::format("<h2>{}</h2>\n", escaped(modality));
      add_knob(knob);
    }
    for (const Json& front : report_["fronts"])
      if (front["modality"] == modality && !front["points"].empty()) add_front(front);
  }

  void add_knob(const Json& knob) {
    html_ += fmt::format("<section id=\"{}\"><h3>{}</h3><p class=\"dim\">{}{}</p><p>{}</p>\n", anchor(knob),
                         escaped(text_of(knob, "name")), escaped(text_of(knob, "about")),
                         knob["context"].empty() || text_of(knob, "context").empty()
                             ? ""
                             : escaped("; " + text_of(knob, "context")),
                         escaped(words_of_knob(knob)));
    if (!knob["settings"].empty()) {
      html_ += in_scroller(plot_of_knob(knob, device_line(report_)));
      table(knob);
      timed_of(knob) == "map" ? maps(knob) : pictures(knob);
    }
    html_ += "</section>\n";
  }

  void table(const Json& knob) {
    html_ += fmt::format(
        "<div class=\"scroll\"><table><tr><th>setting</th><th>{}, ms</th><th>quartiles</th>"
        "<th>processor, ms</th><th>start, ms</th>",
        timed_of(knob));
    const Json* widest = nullptr;
    for (const Json& setting : knob["settings"])
      if (widest == nullptr || setting["errors"].size() > (*widest)["errors"].size()) widest = &setting;
    for (const Json& error : (*widest)["errors"])
      html_ += fmt::format("<th title=\"{}\">{}</th>",
                           escaped(text_of(error, "sensor") + ": " + text_of(error, "meaning")),
                           escaped(text_of(error, "name") +
                                   (error["unit"] == "1" ? std::string() : ", " + text_of(error, "unit"))));
    html_ += "</tr>\n";
    for (const Json& setting : knob["settings"]) {
      const char* const kind = setting["label"] == knob["default"]     ? " class=\"own\""
                               : setting["label"] == knob["reference"] ? " class=\"finest\""
                                                                       : "";
      html_ += fmt::format("<tr{}><td>{}</td><td>{}</td><td>{} to {}</td><td>{}</td><td>{}</td>", kind,
                           escaped(text_of(setting, "label")), short_number(setting["tick_ms"]["median"]),
                           short_number(setting["tick_ms"]["low"]), short_number(setting["tick_ms"]["high"]),
                           short_number(setting["cpu_ms"]["median"]), short_number(setting["start_ms"]));
      for (const Json& wanted : (*widest)["errors"]) html_ += "<td>" + cell(setting, wanted) + "</td>";
      html_ += "</tr>\n";
    }
    html_ += "</table></div>\n";
  }
  static std::string cell(const Json& setting, const Json& wanted) {
    if (setting["exact"].get<bool>()) return "exact";
    for (const Json& error : setting["errors"])
      if (error["name"] == wanted["name"] && error["sensor"] == wanted["sensor"])
        return error["value"].is_null() ? "&minus;&infin;" : short_number(error["value"]);
    return "";
  }

  Bytes file(const std::string& name) const { return io::read_file(folder_ / name); }

  void pictures(const Json& knob) {
    std::string reference;
    for (const Json& setting : knob["settings"])
      if (setting["label"] == knob["reference"]) reference = text_of(setting, "picture");
    if (reference.empty()) return;
    const Bytes finest = file(reference);
    const Array finest_picture = io::decode_png(finest, reference);
    html_ += "<div class=\"pictures\">" + picture_tag(finest, text_of(knob, "reference") + ", the reference");
    // The first setting is the coarsest one; the default is what users get.
    std::vector<const Json*> shown;
    for (const Json& setting : knob["settings"])
      if (!setting["exact"].get<bool>() && (shown.empty() || setting["label"] == knob["default"]))
        shown.push_back(&setting);
    for (const Json* const setting : shown) {
      const std::string name = text_of(*setting, "picture"), label = text_of(*setting, "label");
      if (name.empty()) continue;
      const Bytes png = file(name);
      html_ += picture_tag(png, label);
      const Array difference = difference_of(io::decode_png(png, name), finest_picture);
      if (!difference.bytes.empty())
        html_ += picture_tag(io::encode_png(difference), label + " less the reference, four times as strong");
    }
    html_ += "</div>\n";
  }

  /// All maps side by side, from coarse to fine.
  void maps(const Json& knob) {
    html_ += "<div class=\"pictures maps\">";
    for (const Json& setting : knob["settings"])
      if (const std::string name = text_of(setting, "picture"); !name.empty())
        html_ +=
            picture_tag(file(name), text_of(setting, "label") +
                                        (setting["label"] == knob["reference"] ? ", the reference" : ""));
    html_ += fmt::format("</div><p class=\"dim\">{}</p>\n", escaped(knob.value("legend", "")));
  }

  void add_front(const Json& front) {
    const std::string context = front.value("context", "");
    html_ += fmt::format("<section><h3>Joint settings of {}{}</h3><p>{}</p>\n",
                         escaped(text_of(front, "modality")), escaped(context.empty() ? "" : ", " + context),
                         escaped(text_of(front, "how")));
    if (const Json costly = front.value("costly", Json::array()); !costly.empty())
      html_ += fmt::format(
          "<p>These costly knobs go no further than the scenario's own setting, and the reference here has "
          "that: {}.</p>\n",
          escaped(fmt::format("{}", fmt::join(costly.get<std::vector<std::string>>(), ", "))));
    html_ += in_scroller(plot_of_front(front, device_line(report_)));
    html_ += fmt::format(
        "<div class=\"scroll\"><table><tr><th>point</th><th>tick, ms</th><th>predicted</th>"
        "<th>{}</th><th>predicted</th><th style=\"text-align:left\">other than the default</th></tr>\n",
        escaped(text_of(front, "figure") + ", " + text_of(front, "unit")));
    size_t number = 0;
    for (const Json& point : front["points"]) {
      std::string other;
      for (const auto& [name, label] : point["settings"].items())
        other += (other.empty() ? "" : ", ") + name + ": " + label.get<std::string>();
      const auto value = [](const Json& json) {
        return json.is_null() ? std::string("exact") : short_number(json);
      };
      html_ += fmt::format(
          "<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
          "<td style=\"text-align:left;white-space:normal\">{}</td></tr>\n",
          point["default"].get<bool>()     ? " class=\"own\""
          : point["reference"].get<bool>() ? " class=\"finest\""
                                           : "",
          ++number, short_number(point["tick_ms"]["median"]), short_number(point["predicted_ms"]),
          value(point["error"]), value(point["predicted_error"]), escaped(other));
    }
    html_ += "</table></div></section>\n";
  }

  void absent() {
    html_ += "<h2>Not among the knobs</h2>\n<ul>";
    for (const Json& row : report_["absent"])
      html_ +=
          fmt::format("<li><b>{}</b>: {}.</li>", escaped(text_of(row, "name")), escaped(text_of(row, "why")));
    html_ += "</ul>\n";
  }

  const Json& report_;
  const std::filesystem::path folder_;
  std::string html_;
};

}  // namespace

std::string html_of(const nlohmann::json& report, const std::filesystem::path& folder) {
  return Page(report, folder).text();
}

}  // namespace greatx::apps

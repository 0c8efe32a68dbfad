// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/fit/materials_file.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/budget.h"
#include "core/fields/edit_yaml.h"
#include "core/input_file.h"
#include "core/text.h"

namespace greatx::apps {
namespace {

std::string medium_fields(const scene::RadioMedium& medium) {
  const scene::RadioRow& first = medium.rows[0];
  if (medium.rows.size() == 1 && first.b == 0.0 && first.d == 0.0 && std::isinf(first.max_hz))
    return fmt::format("relative_permittivity: {}, conductivity: {}", first.a, first.c);
  std::vector<std::string> rows;
  for (const scene::RadioRow& row : medium.rows)
    rows.push_back(fmt::format("{{a: {}, b: {}, c: {}, d: {}, min_hz: {}, max_hz: {}}}", row.a, row.b, row.c,
                               row.d, row.min_hz, row.max_hz));
  return fmt::format("rows: [{}]{}", fmt::join(rows, ", "), medium.extrapolate ? ", extrapolate: true" : "");
}

std::string layers_list(const std::vector<scene::RadioLayer>& layers) {
  std::vector<std::string> all;
  for (const scene::RadioLayer& layer : layers)
    all.push_back(fmt::format("{{{}, thickness_m: {}}}", medium_fields(layer.medium), layer.thickness_m));
  return fmt::format("[{}]", fmt::join(all, ", "));
}

std::string clutter_fields(const scene::SurfaceClutter& clutter) {
  for (const std::string& name : scene::clutter_names())
    if (scene::clutter_called(name) == clutter) return name;
  switch (clutter.form) {
    case scene::ClutterForm::kulemin:
      return fmt::format("{{level_db: {}, angle_db: {}, frequency_db: {}, cross_db: {}}}", clutter.level_db,
                         clutter.angle_db, clutter.frequency_db, clutter.cross_db);
    case scene::ClutterForm::constant_gamma:
      return fmt::format("{{gamma_db: {}, frequency_db: {}, cross_db: {}}}", clutter.level_db,
                         clutter.frequency_db, clutter.cross_db);
    case scene::ClutterForm::sea:
      break;
  }
  return fmt::format("{{sea_state: {}, cross_db: {}}}", clutter.sea_state, clutter.cross_db);
}

/// Returns what is said of a fitted value in a comment.
std::string comment_of(const sim::FitVariable& variable, const sim::FitEstimate& estimate) {
  std::string text = fmt::format("#   {}: {:.6g}", printable(variable.name), estimate.value);
  if (variable.unit != "1") text += fmt::format(" {}", variable.unit);
  if (std::isfinite(estimate.deviation))
    text += fmt::format(", one deviation: {:.6g} to {:.6g}", estimate.low, estimate.high);
  if (estimate.verdict != sim::FitVerdict::determined)
    text += fmt::format(" ({})", sim::name_of(estimate.verdict));
  return text + "\n";
}

}  // namespace

std::string radio_fields_line(const scene::Material& material) {
  constexpr const char* patterns[] = {"lambertian", "directive", "backscattering"};
  const scene::RadioMaterial& radio = *material.radio;
  std::vector<std::string> fields;
  if (radio.layers.size() == 1) {
    fields.push_back(medium_fields(radio.layers[0].medium));
    if (radio.layers[0].thickness_m > 0.0)
      fields.push_back(fmt::format("thickness_m: {}", radio.layers[0].thickness_m));
  } else {
    fields.push_back(fmt::format("layers: {}", layers_list(radio.layers)));
  }
  if (radio.windows)
    fields.push_back(fmt::format("windows: {{share: {}, layers: {}}}", radio.windows->share,
                                 layers_list(radio.windows->layers)));
  fields.push_back(fmt::format("scattering_coefficient: {}, pattern: {}, pattern_exponent: {}",
                               radio.scattering_coefficient, patterns[static_cast<size_t>(radio.pattern)],
                               radio.pattern_exponent));
  fields.push_back(fmt::format("backscatter_exponent: {}, backscatter_share: {}, cross_polarization: {}",
                               radio.backscatter_exponent, radio.backscatter_share,
                               radio.cross_polarization));
  fields.push_back(fmt::format("roughness_m: {}, deviation_m: {}", radio.roughness_m, radio.deviation_m));
  if (radio.clutter) fields.push_back(fmt::format("clutter: {}", clutter_fields(*radio.clutter)));
  if (material.reflectance_905nm)
    fields.push_back(fmt::format("reflectance_905nm: {}", *material.reflectance_905nm));
  if (material.reflectance_1550nm)
    fields.push_back(fmt::format("reflectance_1550nm: {}", *material.reflectance_1550nm));
  return fmt::format("{{{}}}", fmt::join(fields, ", "));
}

std::string fitted_sidecar(const std::filesystem::path& before, const scene::Scene& scene,
                           const sim::FitModel& model, const sim::FitAssessment& assessment,
                           const std::string& title) {
  std::string text = "materials: {}\n";
  if (!before.empty())
    text = InputFile(before, "expected readable radio materials", budget::yaml_file).text();
  std::vector<double> values;
  for (const sim::FitEstimate& estimate : assessment.estimates) values.push_back(estimate.value);
  std::vector<std::string> written;
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    const scene::Material& material = scene.materials[i];
    if (model.materials().parameters_of()[i].empty() ||
        std::ranges::find(written, material.name) != written.end())
      continue;
    scene::Material fitted = material;
    fitted.radio = model.materials().material(i, values);
    YamlChange change;
    change.path = {YamlStep("materials"), YamlStep(material.name)};
    change.value = radio_fields_line(fitted);
    text = edit_yaml(text, change).text;
    written.push_back(material.name);
  }
  std::string head = fmt::format("# Materials fitted by greatx calibrate: {}.\n", printable(title));
  for (size_t p = 0; p < model.problem().parameters.size(); ++p)
    head += comment_of(model.variables()[p], assessment.estimates[p]);
  return head + text;
}

}  // namespace greatx::apps

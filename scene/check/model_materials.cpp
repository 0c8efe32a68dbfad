// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/model_materials.h"

#include <algorithm>

#include "scene/material/material_words.h"

namespace greatx::scene::check {
namespace {

SceneFault fault_of(FaultSeverity severity, const char* kind, const char* text, const char* unit = "") {
  SceneFault fault;
  fault.severity = severity, fault.kind = kind, fault.text = text, fault.unit = unit;
  return fault;
}

void finish(SceneFault fault, std::vector<SceneFault>& list) {
  if (fault.places.empty()) return;
  std::ranges::stable_sort(fault.places, std::greater{}, &FaultPlace::size);
  fault.count = fault.places.size();
  fault.worst = fault.places.front().size;
  for (const FaultPlace& place : fault.places) fault.total += place.size;
  list.push_back(std::move(fault));
}

}  // namespace

std::vector<SceneFault> find_material_faults(const Model& model, const std::vector<double>& area_of_material,
                                             bool radio) {
  std::vector<SceneFault> list;
  SceneFault missing = fault_of(FaultSeverity::fault, "no_radio", "materials without radio properties", "m2");
  for (size_t m = 0; m < model.materials.size() && radio; ++m)
    if (const Material& material = model.materials[m]; !material.radio)
      missing.places.push_back(
          {dvec3(0.0), "", suggested_radio(material.name), material.name, area_of_material[m]});
  finish(std::move(missing), list);
  SceneFault lost = fault_of(FaultSeverity::fault, "lost_picture", "pictures that cannot be read");
  for (const std::string& message : model.lost_pictures)
    lost.places.push_back({dvec3(0.0), "", "", message, 0.0});
  finish(std::move(lost), list);
  SceneFault unused = fault_of(FaultSeverity::doubt, "unused_material", "materials that no mesh uses");
  for (const std::string& name : model.unused_materials)
    unused.places.push_back({dvec3(0.0), "", "", name, 0.0});
  finish(std::move(unused), list);
  return list;
}

}  // namespace greatx::scene::check

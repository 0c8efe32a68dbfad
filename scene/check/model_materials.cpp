// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/model_materials.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/text.h"

namespace greatx::scene::check {
namespace {

struct Hint {
  const char* word;
  const char* radio;
};
// Longer words come before words that they contain.
constexpr std::array hints{
    Hint{"plasterboard", "itu: plasterboard, thickness_m: 0.0125"},
    Hint{"plywood", "itu: plywood, thickness_m: 0.018"},
    Hint{"chipboard", "itu: chipboard, thickness_m: 0.018"},
    Hint{"floorboard", "itu: floorboard, thickness_m: 0.02"},
    Hint{"ceiling", "itu: ceiling_board, thickness_m: 0.015"},
    Hint{"brick", "itu: brick, thickness_m: 0.24"},
    Hint{"concrete", "itu: concrete, thickness_m: 0.3"},
    Hint{"cement", "itu: concrete, thickness_m: 0.3"},
    Hint{"beton", "itu: concrete, thickness_m: 0.3"},
    Hint{"facade", "itu: concrete, thickness_m: 0.3"},
    Hint{"wall", "itu: concrete, thickness_m: 0.3"},
    Hint{"glass", "itu: glass, thickness_m: 0.006"},
    Hint{"window", "itu: glass, thickness_m: 0.006"},
    Hint{"wood", "itu: wood, thickness_m: 0.04"},
    Hint{"timber", "itu: wood, thickness_m: 0.04"},
    Hint{"metal", "itu: metal"},
    Hint{"steel", "itu: metal"},
    Hint{"iron", "itu: metal"},
    Hint{"chrome", "itu: metal"},
    Hint{"alumin", "conductor: aluminium"},
    Hint{"copper", "conductor: copper"},
    Hint{"plaster", "itu: plasterboard, thickness_m: 0.0125"},
    Hint{"marble", "itu: marble, thickness_m: 0.3"},
    Hint{"stone", "itu: marble, thickness_m: 0.3"},
    Hint{"carpet", "itu: carpet_tile, thickness_m: 0.006"},
    Hint{"vinyl", "itu: vinyl_tile, thickness_m: 0.003"},
    Hint{"asphalt", "itu: asphalt_concrete"},
    Hint{"road", "itu: asphalt_concrete"},
    Hint{"street", "itu: asphalt_concrete"},
    Hint{"pavement", "itu: concrete"},
    Hint{"sidewalk", "itu: concrete"},
    Hint{"grass", "itu: medium_dry_ground"},
    Hint{"ground", "itu: medium_dry_ground"},
    Hint{"terrain", "itu: medium_dry_ground"},
    Hint{"soil", "itu: medium_dry_ground"},
    Hint{"water", "itu: wet_ground"},
    Hint{"leaves", "foliage: weissberger"},
    Hint{"leaf", "foliage: weissberger"},
    Hint{"foliage", "foliage: weissberger"},
    Hint{"tree", "foliage: weissberger"},
};

std::string lower(const std::string& text) {
  std::string result = text;
  std::ranges::transform(result, result.begin(),
                         [](unsigned char character) { return static_cast<char>(std::tolower(character)); });
  return result;
}

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

std::string suggested_radio(const std::string& material_name) {
  const std::string name = lower(material_name);
  for (const Hint& hint : hints)
    if (name.find(hint.word) != std::string::npos) return hint.radio;
  return "";
}

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

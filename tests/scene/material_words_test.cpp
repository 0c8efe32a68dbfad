// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/material_words.h"

#include <string>

#include <gtest/gtest.h>

#include "core/fields/field.h"
#include "scene/material/radio_fields.h"

namespace greatx::scene {
namespace {

struct Named {
  const char* name;
  const char* medium;  ///< with which the suggested fields begin; empty: no suggestion
};

// Names as scenes of Blender, Sketchfab, Poly Haven, OpenStreetMap exports and game kits have them.
const Named names[] = {
    {"lawn", "itu: medium_dry_ground"},
    {"red_brick", "itu: brick"},
    {"glass_front", "itu: glass"},
    {"Tarmac_01", "itu: asphalt_concrete"},
    {"betonwand", "itu: concrete"},
    {"Window.001", "itu: glass"},
    {"WindowGlass_Tinted", "itu: glass"},
    {"Concrete_Wall_4K", "itu: concrete"},
    {"brick_wall_001_diffuse_2k", "itu: brick"},
    {"WoodenFloor", "itu: wood"},
    {"wood_planks_dirt", "itu: wood"},
    {"aerial_grass_rock", "itu: medium_dry_ground"},
    {"Grass_Lawn_Green", "itu: medium_dry_ground"},
    {"M_Leaves_Maple", "foliage: weissberger"},
    {"TreeBark", "itu: wood"},
    {"Baum", "foliage: weissberger"},
    {"hedge.003", "foliage: weissberger"},
    {"street", "itu: asphalt_concrete"},
    {"streetLamp_Metal", "itu: metal"},
    {"street lamp", "itu: metal"},
    {"AsphaltWet", "itu: asphalt_concrete"},
    {"environment", ""},
    {"steel_beam", "itu: metal"},
    {"Corrugated Iron Roof", "itu: metal"},
    {"rusty_container", "itu: metal"},
    {"CarPaint_Red", "itu: metal"},
    {"aluminium_frame", "conductor: aluminium"},
    {"Drywall", "itu: plasterboard"},
    {"Stucco_White", "itu: plasterboard"},
    {"ceiling_tiles", "itu: ceiling_board"},
    {"carpet_blue", "itu: carpet_tile"},
    {"marble_tiles", "itu: marble"},
    {"cobblestone_floor_08", "itu: marble"},
    {"sandstone_blocks", "itu: marble"},
    {"SandBeach", "itu: very_dry_ground"},
    {"gravel_road", "itu: very_dry_ground"},
    {"River_Water", "itu: wet_ground"},
    {"Rasenfläche", "itu: medium_dry_ground"},
    {"Dachziegel rot", "itu: brick"},
    {"Ziegelwand", "itu: brick"},
    {"Außenputz", "itu: plasterboard"},
    {"Glasscheibe", "itu: glass"},
    {"Straße", "itu: asphalt_concrete"},
    {"Holzboden", "itu: wood"},
    {"mur_béton_brut", "itu: concrete"},
    {"fenêtre", "itu: glass"},
    {"HORMIGÓN", "itu: concrete"},
    {"sidewalk", "itu: concrete"},
    {"roof_flat", "itu: brick"},
    {"building_facade_03", "itu: concrete"},
    {"outdoor_fabric", ""},
    {"textile", ""},
    {"Material.004", ""},
    {"lambert1", ""},
    {"", ""},
    {"\xc3", ""},
};

TEST(MaterialWords, FitNamesOfRealScenes) {
  for (const Named& named : names) {
    const std::string radio = suggested_radio(named.name);
    if (*named.medium == '\0')
      EXPECT_EQ(radio, "") << named.name;
    else
      EXPECT_TRUE(radio.starts_with(named.medium)) << named.name << ": " << radio;
  }
}

/// Every suggestion is one that the sidecar of a scene accepts.
TEST(MaterialWords, AreRadioFields) {
  for (const Named& named : names) {
    const std::string radio = suggested_radio(named.name);
    if (radio.empty()) continue;
    const RadioSources sources =
        read_radio_fields(Field::parse_yaml("{" + radio + "}", {"suggested.yaml", {}, {}}), {});
    EXPECT_TRUE(sources.radio.has_value()) << radio;
  }
}

}  // namespace
}  // namespace greatx::scene

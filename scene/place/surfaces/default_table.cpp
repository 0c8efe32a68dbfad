// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/surfaces/material_table.h"

namespace greatx::scene::place {

const std::string& MaterialTable::default_text() {
  // Media are those of ITU-R P.2040-4, Table 3. `glass` is the share of windows in the area of a wall: usual
  // values of housing (0.2 to 0.3), of offices (0.4) and of curtain walls (1, which their own material has).
  static const std::string text = R"(greatx_place_materials: 1
classes:
  facade/brick:
    - {like: facade_brick_red, glass: 0.22}
    - {like: facade_brick_yellow, glass: 0.22}
    - {like: facade_brick_brown, glass: 0.22}
  facade/plaster:
    - {like: facade_plaster_cream, glass: 0.22}
    - {like: facade_plaster_white, glass: 0.22}
    - {like: facade_plaster_ochre, glass: 0.22}
    - {like: facade_plaster_rose, glass: 0.22}
  facade/stone: [{like: facade_stone_light, glass: 0.25}, {like: facade_stone_grey, glass: 0.25}]
  facade/concrete:
    - {like: facade_concrete_grey, glass: 0.25}
    - {like: facade_balcony_white, glass: 0.3}
    - {like: facade_balcony_sand, glass: 0.3}
  facade/ribbon: [{like: facade_concrete_light, glass: 0.4}]
  facade/glass: [facade_glass_blue, facade_glass_green]
  facade/metal: [roof_sheet]
  facade/wood: [barn_boards_brown]
  facade/blind: [blind_plaster, concrete]
  blind/brick: [blind_brick]
  blind/plaster: [blind_plaster]
  blind/stone:
    - {name: stone_wall, like: blind_plaster, color: [0.6, 0.55, 0.46]}
  blind/concrete: [concrete]
  blind/ribbon: [concrete]
  blind/glass: [concrete]
  blind/metal: [roof_sheet]
  blind/wood: [barn_boards_brown]
  blind/blind: [blind_plaster]
  window:
    - name: window_glass
      like: skylight
      radio:
        layers:
          - {itu: glass, thickness_m: 0.006}
          - {relative_permittivity: 1.0, conductivity: 0.0, thickness_m: 0.016}
          - {itu: glass, thickness_m: 0.006}
        scattering_coefficient: 0.05
  party: [blind_brick]
  floor: [concrete]
  roof/flat: [roof_gravel, roof_dark]
  roof/felt: [roof_dark]
  roof/tiles: [roof_tiles, roof_tiles_old]
  roof/slate: [roof_slate]
  roof/sheet: [roof_zinc]
  roof/glass: [skylight]
  roof/green: [grass]
  roof/wood: [barn_boards_brown]
  roof/thatch:
    - name: thatch
      like: stubble
      roughness: 1.0
      radio: {itu: wood, thickness_m: 0.3, scattering_coefficient: 0.4}
  ground/base: [verge]
  ground/base_built: [asphalt_lot]
  ground/residential: [verge]
  ground/farmland: [crop_young]
  ground/meadow: [meadow]
  ground/grass: [grass]
  ground/wood:
    - {name: forest_floor, like: ploughed_soil, color: [0.09, 0.075, 0.04]}
  ground/scrub: [meadow]
  ground/sand:
    - {name: sand, like: ploughed_soil, color: [0.62, 0.52, 0.34]}
  ground/rock:
    - name: bare_rock
      like: concrete
      color: [0.5, 0.48, 0.45]
      radio: {itu: concrete, scattering_coefficient: 0.4, cross_polarization: 0.2, clutter: concrete}
  ground/wetland: [meadow]
  ground/pitch:
    - {name: pitch, like: grass, color: [0.7, 0.95, 0.6]}
  ground/water: [water]
  ground/parking: [asphalt_lot]
  ground/square: [paving]
  ground/rail:
    - name: ballast
      like: roof_gravel
      color: [0.42, 0.39, 0.36]
      radio: {itu: medium_dry_ground, extrapolate: true, scattering_coefficient: 0.5,
              cross_polarization: 0.2, clutter: soil}
  ground/path: [pavement]
  ground/road:
    - {name: road_asphalt, like: asphalt_lot}
  bridge: [concrete]
)";
  return text;
}

}  // namespace greatx::scene::place

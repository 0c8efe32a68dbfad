// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/traffic.h"

namespace greatx::sim {

const std::vector<TrafficVariant>& traffic_variants() {
  using enum TrafficMember::Kind;
  static const std::vector<TrafficVariant> list{{"saloon", vehicle, 5, 4.76},
                                                {"hatchback", vehicle, 7, 4.05},
                                                {"compact", vehicle, 7, 4.28},
                                                {"estate", vehicle, 5, 4.77},
                                                {"suv", vehicle, 5, 4.50},
                                                {"coupe", vehicle, 1, 4.64},
                                                {"cabriolet", vehicle, 1, 3.92},
                                                {"mini", vehicle, 3, 3.60},
                                                {"taxi", vehicle, 2, 4.88},
                                                {"mpv", vehicle, 3, 4.53},
                                                {"pickup", vehicle, 1, 5.33},
                                                {"van", vehicle, 2, 5.29},
                                                {"panel_van", vehicle, 2, 5.93},
                                                {"minibus", vehicle, 1, 6.95},
                                                {"ambulance", vehicle, 0, 6.10},
                                                {"box_truck", vehicle, 1, 7.50},
                                                {"lorry", vehicle, 1, 9.50},
                                                {"tipper", vehicle, 0, 8.00},
                                                {"articulated_lorry", vehicle, 0, 16.50},
                                                {"fire_engine", vehicle, 0, 7.60},
                                                {"city_bus", vehicle, 2, 12.00},
                                                {"double_decker", vehicle, 0, 10.90},
                                                {"coach", vehicle, 0, 12.20},
                                                {"tram", vehicle, 0, 20.00},
                                                {"motorcycle", vehicle, 1, 2.10},
                                                {"scooter", vehicle, 1, 1.87},
                                                {"bicycle", cyclist, 5, 1.78},
                                                {"cargo_bicycle", cyclist, 1, 2.50},
                                                {"man", pedestrian, 4, 0},
                                                {"woman", pedestrian, 4, 0},
                                                {"tall", pedestrian, 1, 0},
                                                {"broad", pedestrian, 2, 0},
                                                {"slim", pedestrian, 2, 0},
                                                {"dress", pedestrian, 2, 0},
                                                {"teenager", pedestrian, 1, 0},
                                                {"elder", pedestrian, 2, 0},
                                                {"child", pedestrian, 1, 0}};
  return list;
}

}  // namespace greatx::sim

// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/map/background.h"

#include <algorithm>
#include <cmath>

#include "draw/paths/render.h"

namespace greatx::apps {

MapBackground map_background(const sim::MapCells& cells, const sim::EffectPlan& plan,
                             sim::ChannelSnapshot& snapshot, uint32_t side) {
  const scene::Scene& scene = snapshot.experiment().scene();
  sim::Environment clear = snapshot.experiment().scenario.environment;
  // Fog and rain would hide the scene, because the camera may be tens of kilometres high.
  clear.fog_g_m3 = clear.rain_mm_h = 0.0;
  double low = INFINITY, high = -INFINITY;
  for (const double z : cells.z_m)
    if (!std::isnan(z)) low = std::min(low, z), high = std::max(high, z);
  MapBackground background;
  background.pixels = map_pixels(cells.grid, side);
  const PictureView view = top_view(
      background.pixels, scene.origin, 0.5 * (low + high), std::min(low, scene.bounds.min.z + scene.origin.z),
      std::max(high, scene.bounds.max.z + scene.origin.z), 0.25 * cells.grid.cell_m);
  PictureRenderer renderer(snapshot.gpu_scene(), snapshot.ring(), plan, clear, snapshot.moment());
  render::CameraImages images = renderer.picture(view, {});
  background.rgb = std::move(images.rgb);
  const double eye = view.local_from_sensor.position.z + scene.origin.z;
  background.z_m.reserve(images.depth.size());
  for (const float depth : images.depth)
    background.z_m.push_back(static_cast<float>(eye - static_cast<double>(depth)));
  return background;
}

}  // namespace greatx::apps

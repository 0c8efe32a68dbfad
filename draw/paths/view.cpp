// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/paths/view.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::apps {

namespace {

/// The horizontal field of view. It is so narrow that vertical edges of towers hardly converge.
constexpr double field_of_view = radians(40.0);

std::vector<dvec3> vertices_of(std::span<const PathLink> links, const PathScene& scene) {
  std::vector<dvec3> points;
  for (const PathLink& link : links) {
    points.push_back(link.transmitter_m - scene.scene->origin);
    points.push_back(link.receiver_m - scene.scene->origin);
    for (const rf::Path& path : link.paths)
      points.insert(points.end(), path.vertices.begin(), path.vertices.end());
  }
  return points;
}

/// Holds the visible and the total length of one segment in the picture, pixels.
struct Sight {
  double visible = 0.0, total = 0.0;
};

Sight sight_of(const PictureView& view, std::span<const float> depth, const dvec3& a, const dvec3& b) {
  const dvec3 from = view.project(a), to = view.project(b);
  if (from.z < view.near_m || to.z < view.near_m) return {};
  const double length = glm::distance(dvec2(from), dvec2(to));
  const int steps = std::max(1, static_cast<int>(std::ceil(length / 2.0)));
  Sight sight;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps;
    const dvec2 pixel = glm::mix(dvec2(from), dvec2(to), t);
    const auto x = static_cast<int64_t>(std::floor(pixel.x)), y = static_cast<int64_t>(std::floor(pixel.y));
    sight.total += length / steps;
    if (x < 0 || y < 0 || x >= view.width || y >= view.height) continue;
    // 1 / depth is linear in the picture.
    const double z = 1.0 / glm::mix(1.0 / from.z, 1.0 / to.z, t);
    if (!is_hidden(z, depth[static_cast<size_t>(y) * view.width + static_cast<size_t>(x)]))
      sight.visible += length / steps;
  }
  return sight;
}

}  // namespace

dvec3 PictureView::project_straight(const dvec3& local) const {
  const dvec3 p = local_from_sensor.inverse().apply(local);
  return {cx - fx * p.y / p.x, cy - fy * p.z / p.x, p.x};
}

dvec2 PictureView::bent(const dvec2& straight) const {
  if (!distortion.any()) return straight;
  const dvec2 center(cx, cy), focal(fx, fy);
  return center + focal * distortion.distort((straight - center) / focal);
}

dvec3 PictureView::project(const dvec3& local) const {
  const dvec3 straight = project_straight(local);
  if (!distortion.any() || straight.z < 0.0) return straight;
  const dvec2 direction = (dvec2(straight) - dvec2(cx, cy)) / dvec2(fx, fy);
  if (glm::any(glm::lessThan(direction, sees.least)) || glm::any(glm::greaterThan(direction, sees.most)))
    return {dvec2(straight), -straight.z};
  return {bent(dvec2(straight)), straight.z};
}

void PictureView::set_lens(const render::Distortion& lens, const std::string& name) {
  distortion = lens;
  if (lens.any()) sees = render::Lens({name, width, height, fx, fy, cx, cy, lens}).bounds();
}

PictureView PictureView::scaled(uint32_t new_width) const {
  PictureView view = *this;
  const double factor = static_cast<double>(new_width) / width;
  view.width = new_width;
  view.height = std::max(1u, static_cast<uint32_t>(std::lround(height * factor)));
  view.fx *= factor;
  view.fy *= factor;
  view.cx *= factor;
  view.cy *= factor;
  return view;
}

PictureView fit_view(std::span<const dvec3> points, double azimuth, double elevation, uint32_t width,
                     uint32_t height, const PictureMargins& margins, double least_extent_m) {
  GREATX_CHECK(!points.empty(), "nothing to look at");
  PictureView view;
  view.width = width;
  view.height = height;
  view.fx = view.fy = 0.5 * width / std::tan(0.5 * field_of_view);
  view.cx = 0.5 * width;
  view.cy = 0.5 * height;
  // Positive pitch turns the nose down.
  view.local_from_sensor.orientation = orientation_from_yaw_pitch_roll(azimuth + pi, elevation, 0.0);
  const Pose& pose = view.local_from_sensor;
  const dvec3 forward = pose.rotate({1, 0, 0}), left = pose.rotate({0, 1, 0}), up = pose.rotate({0, 0, 1});

  // These are the tangents of the angles between the forward direction and the planes through the margins.
  const double to_left = (view.cx - margins.left) / view.fx,
               to_right = (width - margins.right - view.cx) / view.fx,
               to_top = (view.cy - margins.top) / view.fy,
               to_bottom = (height - margins.bottom - view.cy) / view.fy;
  GREATX_CHECK(to_left + to_right > 0.0 && to_top + to_bottom > 0.0, "margins leave nothing of {} x {}",
               width, height);
  // A point p is to the left of the right margin if (p - e).left >= -to_right (p - e).forward, where e is the
  // eye; the other margins are similar. Each plane thus bounds one linear combination of the eye's
  // coordinates, and the most extreme point gives the bound.
  const double half = 0.5 * least_extent_m;
  double left_bound = -1e300, right_bound = -1e300, top_bound = -1e300, bottom_bound = -1e300,
         nearest = 1e300;
  for (const dvec3& p : points) {
    const double f = glm::dot(forward, p), l = glm::dot(left, p), u = glm::dot(up, p);
    for (const double d : {-half, half}) {
      left_bound = std::max(left_bound, l + d - to_left * f);
      right_bound = std::max(right_bound, -l + d - to_right * f);
      top_bound = std::max(top_bound, u + d - to_top * f);
      bottom_bound = std::max(bottom_bound, -u + d - to_bottom * f);
    }
    nearest = std::min(nearest, f);
  }
  const double eye_forward =
      std::min({-(left_bound + right_bound) / (to_left + to_right),
                -(top_bound + bottom_bound) / (to_top + to_bottom), nearest - 2.0 * view.near_m});
  // In the direction that does not limit the distance, the spare room is divided equally between both sides.
  const double eye_left = 0.5 * (left_bound + to_left * eye_forward - right_bound - to_right * eye_forward);
  const double eye_up = 0.5 * (top_bound + to_top * eye_forward - bottom_bound - to_bottom * eye_forward);
  view.local_from_sensor.position = eye_forward * forward + eye_left * left + eye_up * up;
  return view;
}

double visible_share(const PictureView& view, std::span<const float> depth, std::span<const PathLink> links,
                     const PathScene& scene) {
  double visible = 0.0, total = 0.0;
  for (const PathLink& link : links)
    for (const rf::Path& path : link.paths) {
      // A path that is 20 dB weaker has a tenth of the weight.
      const double weight = std::sqrt(std::max(path_gain(path, scene.carrier_hz), 1e-30));
      for (size_t i = 0; i + 1 < path.vertices.size(); ++i) {
        const Sight sight = sight_of(view, depth, path.vertices[i], path.vertices[i + 1]);
        visible += weight * sight.visible;
        total += weight * sight.total;
      }
    }
  return total > 0.0 ? visible / total : 0.0;
}

PictureView choose_view(std::span<const PathLink> links, const PathScene& scene, uint32_t width,
                        uint32_t height,
                        const std::function<std::vector<float>(const PictureView&)>& depth_of) {
  constexpr uint32_t trial_width = 320;
  constexpr int azimuths = 16;
  const std::vector<dvec3> points = vertices_of(links, scene);
  PictureView best;
  double best_score = -1e300;
  for (const double elevation : {radians(32.0), radians(45.0), radians(60.0)}) {
    for (int i = 0; i < azimuths; ++i) {
      const PictureView view =
          fit_view(points, 2.0 * pi * i / azimuths - 0.5 * pi, elevation, width, height, {});
      const PictureView trial = view.scaled(std::min(width, trial_width));
      const double share = visible_share(trial, depth_of(trial), links, scene);
      // Paths appear larger from a shorter distance.
      const double distance = glm::length(view.local_from_sensor.position - points[0]);
      const double score = share - 0.05 * std::log2(std::max(distance, 1.0));
      if (score > best_score) best = view, best_score = score;
    }
  }
  return best;
}

}  // namespace greatx::apps

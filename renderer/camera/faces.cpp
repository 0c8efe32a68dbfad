// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/error.h"

namespace greatx::render {

namespace {

constexpr uint32_t group_pixels = shared::shade_group_width * shared::shade_group_height;

/// The axes forward, left, up of the faces of a cube, in the sensor's frame. Each turns the face before it.
dmat3 face_axes(size_t face) {
  switch (face) {
    case 0:
      return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // front
    case 1:
      return {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};  // left
    case 2:
      return {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};  // right
    case 3:
      return {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};  // up
    case 4:
      return {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};  // down
    default:
      return {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};  // back
  }
}
constexpr size_t face_count = 6;

/// Returns a direction of optical axes in the sensor's frame.
dvec3 in_sensor(const dvec3& optical) { return {optical.z, -optical.x, -optical.y}; }

/// Returns the face that a direction of the sensor's frame passes.
size_t face_of(const dvec3& d) {
  const dvec3 a(std::abs(d.x), std::abs(d.y), std::abs(d.z));
  if (a.x >= a.y && a.x >= a.z) return d.x > 0.0 ? 0 : 5;
  if (a.y >= a.z) return d.y > 0.0 ? 1 : 2;
  return d.z > 0.0 ? 3 : 4;
}

bool shown(const dvec3& direction) { return direction != dvec3(0.0); }

}  // namespace

uint32_t rows_of_band(const CameraDesc& desc) {
  constexpr uint32_t step = shared::shade_group_height;
  if (desc.bands == 0) return desc.height;
  const uint32_t steps = (desc.height + step - 1) / step;
  return (steps + desc.bands - 1) / desc.bands * step;
}

/// Collects the pixels of one view after the other.
struct FaceTable::Builder {
  explicit Builder(const CameraDesc& camera)
      : desc(camera), rays(lens_geometry(camera)), directions(rays.centers()) {
    focal = desc.wide.any() ? dvec2(cube_focal_length()) : dvec2(desc.fx, desc.fy);
  }

  /// Returns the focal length, pixels, with which every face has at least as many pixels per steradian as the
  /// lens has there. A face has f^2 / cos^3 of them at an angle from its axis.
  double cube_focal_length() const {
    double focal_length = 1.0;
    for (const dvec3& d : directions) {
      if (!shown(d)) continue;
      const double cosine = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
      focal_length = std::max(focal_length, rays.density(d) * std::pow(cosine, 1.5));
    }
    return focal_length;
  }

  /// Returns the direction of a pixel's centre, which may lie beyond the rim of the picture.
  dvec3 direction(uint32_t column, uint32_t row) const {
    if (column < desc.width && row < desc.height) return directions[size_t{row} * desc.width + column];
    // Undistorted rays of a pinhole camera beyond the rim need not exist.
    return desc.wide.any() ? rays.ray({column + 0.5, row + 0.5}) : dvec3(0.0);
  }

  size_t face_at(uint32_t column, uint32_t row) const {
    return desc.wide.any() ? face_of(in_sensor(directions[size_t{row} * desc.width + column])) : 0;
  }

  dvec2 place(const dmat3& axes, const dvec3& optical) const {
    const dvec3 d = in_sensor(optical);
    const double forward = glm::dot(axes[0], d);
    return {-focal.x * glm::dot(axes[1], d) / forward, -focal.y * glm::dot(axes[2], d) / forward};
  }

  /// Returns the place of the neighbour one pixel to the right or down. Where the lens shows nothing, the
  /// step is that from the neighbour on the other side.
  dvec2 next_place(const dmat3& axes, uint32_t column, uint32_t row, bool right, const dvec2& own) const {
    const auto usable = [&](const dvec3& d) { return shown(d) && glm::dot(axes[0], in_sensor(d)) > 0.1; };
    const dvec3 next = direction(column + (right ? 1 : 0), row + (right ? 0 : 1));
    if (usable(next)) return place(axes, next);
    if ((right ? column : row) > 0) {
      const dvec3 before = direction(column - (right ? 1 : 0), row - (right ? 0 : 1));
      if (usable(before)) return 2.0 * own - place(axes, before);
    }
    return own + (right ? dvec2(1.0, 0.0) : dvec2(0.0, 1.0));
  }

  void add_pixel(size_t face, uint32_t column, uint32_t row) {
    const dvec3& d = directions[size_t{row} * desc.width + column];
    if (!shown(d) || face_at(column, row) != face) return;
    const dmat3 axes = face_axes(face);
    const dvec2 own = place(axes, d);
    least = glm::min(least, own);
    most = glm::max(most, own);
    exact.push_back({column | row << 16, own, next_place(axes, column, row, true, own),
                     next_place(axes, column, row, false, own)});
  }

  /// Adds the view of a face by a band of rows, unless no pixel looks through it.
  void add(uint32_t band, uint32_t first_row, uint32_t end_row, size_t face, std::vector<CameraFace>& faces) {
    exact.clear();
    least = dvec2(std::numeric_limits<double>::infinity());
    most = -least;
    // Pixels of a group of the shading pass are neighbours.
    for (uint32_t top = first_row; top < end_row; top += shared::shade_group_height)
      for (uint32_t left = 0; left < desc.width; left += shared::shade_group_width)
        for (uint32_t row = top; row < std::min(top + shared::shade_group_height, end_row); ++row)
          for (uint32_t column = left; column < std::min(left + shared::shade_group_width, desc.width);
               ++column)
            add_pixel(face, column, row);
    if (exact.empty()) return;
    constexpr double margin = 2.0;  // a ray looks at the four pixels of the view around it
    const dvec2 origin = glm::floor(least - margin), size = glm::ceil(most + margin) - origin;
    CameraFace view;
    view.pinhole = {
        static_cast<uint32_t>(size.x), static_cast<uint32_t>(size.y), focal.x, focal.y, -origin.x, -origin.y};
    view.sensor_from_face = {dvec3(0.0), glm::normalize(glm::quat_cast(face_axes(face)))};
    view.band = band;
    view.pixels.offset = pixels.size() * sizeof(shared::FacePixel);
    for (const Exact& e : exact)
      pixels.push_back({e.at, vec2(e.own - origin), vec2(e.right - origin), vec2(e.down - origin)});
    while (pixels.size() % group_pixels != 0) pixels.push_back({~0u, vec2(0), vec2(0), vec2(0)});
    view.pixels.size = pixels.size() * sizeof(shared::FacePixel) - view.pixels.offset;
    faces.push_back(view);
  }

  struct Exact {
    uint32_t at;
    dvec2 own, right, down;
  };
  const CameraDesc& desc;
  LensRays rays;
  std::vector<dvec3> directions;
  dvec2 focal{0.0};
  std::vector<Exact> exact;  ///< of the current view, about its principal point
  dvec2 least{0.0}, most{0.0};
  std::vector<shared::FacePixel> pixels;
};

FaceTable::FaceTable(gpu::Device& device, const CameraDesc& desc) {
  Builder builder(desc);
  const uint32_t rows = rows_of_band(desc);
  for (uint32_t first = 0, band = 0; first < desc.height; first += rows, ++band)
    for (size_t face = 0; face < (desc.wide.any() ? face_count : 1); ++face)
      builder.add(band, first, std::min(first + rows, desc.height), face, faces_);
  const uint32_t most = device.limits().maxImageDimension2D;
  if (const PinholeView size = largest(); std::max(size.width, size.height) > most)
    throw_user_error("camera {}: lens: expected views of at most {} pixels along a side, found {} x {}",
                     desc.name, most, size.width, size.height);
  pixels_ = gpu::upload_buffer(device, std::as_bytes(std::span(builder.pixels)), desc.name + " faces");
  for (CameraFace& face : faces_) {
    const gpu::Slice bytes = face.pixels;
    face.pixels = pixels_.slice().part(bytes.offset, bytes.size);
  }
}

PinholeView FaceTable::largest() const {
  PinholeView size{1, 1, 1.0, 1.0, 0.0, 0.0};
  for (const CameraFace& face : faces_) {
    size.width = std::max(size.width, face.pinhole.width);
    size.height = std::max(size.height, face.pinhole.height);
  }
  return size;
}

}  // namespace greatx::render

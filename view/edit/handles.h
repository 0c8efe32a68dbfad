// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The places of a scenario that a person can drag: positions of nodes and objects, way-points, control
// points.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/fields/edit_yaml.h"
#include "core/vec.h"

namespace greatx::view {

struct Handle {
  std::string label;       ///< "car, way-point 1"
  std::string node;        ///< or the object's name
  YamlPath path;           ///< of the position, a list of three numbers
  dvec3 position{0.0};     ///< world, m
  YamlPath rotation_path;  ///< of yaw, pitch and roll; empty: it has no attitude of its own
  dvec3 rotation_deg{0.0};
};

/// Lists all handles of a scenario. Values that are not three numbers are left out.
std::vector<Handle> handles_of(const std::shared_ptr<const FieldValue>& scenario);

YamlChange move_handle(const Handle& handle, const dvec3& position);
YamlChange turn_handle(const Handle& handle, const dvec3& rotation_deg);
/// Returns the change that puts a way-point behind the one of `handle`: half-way to the next one, or one
/// step further behind the last. Nothing if the handle is no way-point.
std::optional<YamlChange> insert_behind(const std::shared_ptr<const FieldValue>& scenario,
                                        const YamlPath& path);

/// A ray of the cursor, world.
struct CursorRay {
  dvec3 origin{0.0}, direction{1.0, 0.0, 0.0};  ///< of length 1
};
/// Returns the distance along `axis` (length 1) from `point` to the place nearest to the ray. Nothing if the
/// ray runs along the axis.
std::optional<double> along_axis(const CursorRay& ray, const dvec3& point, const dvec3& axis);
/// Returns the angle, rad, of the place where the ray meets the plane through `point` across `axis`, counted
/// right-handed about the axis from some direction that depends on the axis alone. Nothing if the ray runs
/// along the plane, or meets it behind its origin.
std::optional<double> around_axis(const CursorRay& ray, const dvec3& point, const dvec3& axis);

/// The axes about which yaw, pitch and roll turn: R = Rz(yaw) Ry(pitch) Rx(roll).
std::vector<dvec3> turn_axes(const dvec3& rotation_deg);

}  // namespace greatx::view

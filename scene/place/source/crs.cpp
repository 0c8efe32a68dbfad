// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/crs.h"

#include <cmath>
#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>
#include <limits>
#include <mutex>
#include <ogr_srs_api.h>
#include <proj.h>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "scene/place/source/map_contents.h"

namespace greatx::scene::place {

namespace {

void CPL_STDCALL take_message(CPLErr kind, CPLErrorNum, const char* message) {
  if (kind >= CE_Warning)
    static_cast<GdalMessages*>(CPLGetErrorHandlerUserData())->note(kind >= CE_Failure, message);
}

}  // namespace

namespace {

struct EndProj {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* object) const { proj_destroy(object); }
  void operator()(PJ_OBJ_LIST* list) const { proj_list_destroy(list); }
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* factory) const {
    proj_operation_factory_context_destroy(factory);
  }
};

struct Accuracy {
  std::string name;
  double metres = std::numeric_limits<double>::infinity();
};

/// Returns the most accurate of PROJ's conversions, with those whose grids are missing or without.
Accuracy best_conversion(PJ_CONTEXT* context, const PJ* from, const PJ* to,
                         PROJ_GRID_AVAILABILITY_USE grids) {
  const std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, EndProj> factory(
      proj_create_operation_factory_context(context, nullptr));
  proj_operation_factory_context_set_spatial_criterion(context, factory.get(),
                                                       PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  proj_operation_factory_context_set_grid_availability_use(context, factory.get(), grids);
  const std::unique_ptr<PJ_OBJ_LIST, EndProj> list(proj_create_operations(context, from, to, factory.get()));
  Accuracy best;
  for (int i = 0; list && i < proj_list_get_count(list.get()); ++i) {
    const std::unique_ptr<PJ, EndProj> operation(proj_list_get(context, list.get(), i));
    const double metres = proj_coordoperation_get_accuracy(context, operation.get());
    if (metres >= 0.0 && metres < best.metres) best = {proj_get_name(operation.get()), metres};
  }
  return best;
}

}  // namespace

std::string Projection::missing_grid() const {
  const std::unique_ptr<PJ_CONTEXT, EndProj> context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  proj_context_set_enable_network(context.get(), 0);
  char* wkt = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2018", nullptr};
  const bool written = crs_.exportToWkt(&wkt, options) == OGRERR_NONE;
  const std::unique_ptr<PJ, EndProj> from(written ? proj_create(context.get(), wkt) : nullptr),
      to(proj_create(context.get(), "EPSG:4326"));
  CPLFree(wkt);
  if (!from || !to) return {};
  const Accuracy here = best_conversion(context.get(), from.get(), to.get(),
                                        PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID),
                 best = best_conversion(context.get(), from.get(), to.get(), PROJ_GRID_AVAILABILITY_IGNORED);
  if (!(best.metres < here.metres)) return {};
  return fmt::format(
      "PROJ converts '{}' by '{}', to {:g} m; '{}', to {:g} m, needs a grid that is not installed "
      "(projsync).",
      printable(crs_.GetName()), here.name, here.metres, best.name, best.metres);
}

void prepare_gdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    OSRSetPROJEnableNetwork(0);  // grids from a network would make results depend on it
    CPLSetConfigOption("GDAL_PAM_ENABLED", "YES");
    CPLSetConfigOption("GDAL_DISABLE_READDIR_ON_OPEN", "FALSE");
    CPLSetConfigOption("OGR_GEOJSON_MAX_OBJ_SIZE", "0");
    GDALAllRegister();
  });
}

GdalMessages::GdalMessages() { CPLPushErrorHandlerEx(take_message, this); }
GdalMessages::~GdalMessages() { CPLPopErrorHandler(); }
std::string GdalMessages::suffix() const {
  const std::string& message = error_.empty() ? warning_ : error_;
  return message.empty() ? "" : fmt::format(" ({})", printable(message));
}

double longitude_near(double longitude_deg, double near_deg) {
  return longitude_deg - 360.0 * std::round((longitude_deg - near_deg) / 360.0);
}

bool meets_turned(const Box& a, const Box& b) {
  for (const double turn : {0.0, 360.0, -360.0})
    if (a.meets({b.low + dvec2(turn, 0.0), b.high + dvec2(turn, 0.0)})) return true;
  return false;
}

Projection::Projection(std::string where, const std::string& given, const OGRSpatialReference* of_file)
    : where_(std::move(where)) {
  prepare_gdal();
  const GdalMessages messages;
  if (!given.empty()) {
    if (crs_.SetFromUserInput(given.c_str()) != OGRERR_NONE)
      throw_user_error("{}: crs: expected a coordinate system such as EPSG:25833, found '{}'{}", where_,
                       printable(given), messages.suffix());
  } else if (of_file != nullptr && !of_file->IsEmpty()) {
    crs_ = *of_file;
  } else {
    throw_user_error(
        "{}: the file states no coordinate system, and its source has no crs: add, for example, crs: "
        "\"EPSG:25833\"",
        where_);
  }
  if (crs_.IsCompound()) crs_.StripVertical();
  if (!crs_.IsGeographic() && !crs_.IsProjected())
    throw_user_error("{}: crs: expected a geographic or projected coordinate system, found '{}'", where_,
                     printable(crs_.GetName() != nullptr ? crs_.GetName() : "one without a name"));
  geographic_ = crs_.IsGeographic();
  crs_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference degrees;
  degrees.SetWellKnownGeogCS("WGS84");
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  to_.reset(OGRCreateCoordinateTransformation(&crs_, &degrees));
  from_.reset(OGRCreateCoordinateTransformation(&degrees, &crs_));
  if (!to_ || !from_)
    throw_user_error("{}: crs: PROJ knows no way from '{}' to WGS 84{}", where_, printable(crs_.GetName()),
                     messages.suffix());
}

std::string Projection::outside_use(const Box& degrees) const {
  constexpr double slack_deg = 3.0;  // zones are used beyond their edges where a country extends over them
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
  if (degrees.empty() || !crs_.GetAreaOfUse(&west, &south, &east, &north, nullptr) || west == -1000.0)
    return {};
  if (east < west) east += 360.0;
  const dvec2 middle = (degrees.low + degrees.high) / 2.0;
  const double longitude = longitude_near(middle.x, (west + east) / 2.0);
  if (longitude >= west - slack_deg && longitude <= east + slack_deg && middle.y >= south - slack_deg &&
      middle.y <= north + slack_deg)
    return {};
  return fmt::format(
      "It lies at latitude {:.3f}, longitude {:.3f}, but '{}' is made for latitudes {:g} to {:g}, longitudes "
      "{:g} to "
      "{:g}: is its crs right, and are x and y in order?",
      middle.y, longitude, printable(crs_.GetName()), south, north, west, east);
}

bool Projection::same_crs(const Projection& other) const { return crs_.IsSame(&other.crs_) != 0; }

Projection::~Projection() = default;
Projection::Projection(Projection&&) noexcept = default;

void Projection::to_degrees(std::span<dvec2> points) const {
  const GdalMessages messages;
  std::vector<double> x(points.size()), y(points.size());
  std::vector<int> good(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    if (geographic_ && std::abs(points[i].y) > 90.0 + 1e-9 && std::abs(points[i].x) <= 90.0)
      throw_user_error(
          "{}: found the latitude {} at longitude {}: latitudes end at 90 degrees; latitude and longitude "
          "seem to be swapped (greatx expects longitude first, as x)",
          where_, points[i].y, points[i].x);
    x[i] = points[i].x, y[i] = points[i].y;
  }
  to_->Transform(static_cast<int>(points.size()), x.data(), y.data(), nullptr, good.data());
  for (size_t i = 0; i < points.size(); ++i) {
    if (good[i] == 0 || !std::isfinite(x[i]) || !std::isfinite(y[i]) || std::abs(y[i]) > 90.0 + 1e-9 ||
        std::abs(x[i]) > 540.0)
      throw_user_error("{}: the point ({}, {}) has no place on the Earth in '{}': is its crs right?{}",
                       where_, points[i].x, points[i].y, printable(crs_.GetName()), messages.suffix());
    points[i] = {x[i], y[i]};
  }
}

dvec2 Projection::to_degrees(const dvec2& point) const {
  dvec2 result = point;
  to_degrees(std::span(&result, 1));
  return result;
}

void Projection::from_degrees(std::span<dvec2> degrees) const {
  const GdalMessages messages;
  std::vector<double> x(degrees.size()), y(degrees.size());
  std::vector<int> good(degrees.size());
  for (size_t i = 0; i < degrees.size(); ++i) x[i] = degrees[i].x, y[i] = degrees[i].y;
  from_->Transform(static_cast<int>(degrees.size()), x.data(), y.data(), nullptr, good.data());
  for (size_t i = 0; i < degrees.size(); ++i)
    degrees[i] = good[i] != 0 ? dvec2(x[i], y[i]) : dvec2(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace greatx::scene::place

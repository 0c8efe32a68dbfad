// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/car_body.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/car_cabin.h"
#include "scene/generator/objects/smooth_mesh.h"

namespace greatx::scene::generator {

namespace {

/// The shape of a car beyond VehicleShape. x is measured from the middle, z from the ground. Names follow the
/// side view from the front to the rear; a pillar has the x of its front and rear edge at the belt line.
struct CarStyle {
  const char* variant;
  double sill, nose, hood;  ///< z: underside, top of the grille, bonnet at the windscreen
  double cowl, screen_top;  ///< x: lower and upper edge of the windscreen
  double b_front;           ///< x of the B pillar
  double c_front, c_rear;   ///< x of the C pillar; its rear edge begins a rear quarter window
  double d_front, d_rear;   ///< x of the last pillar
  double c_lean, d_lean;    ///< the tops of C and the last pillar are that much farther forward
  double back_base, deck,
      tail;         ///< x and z of the lower edge of the rear window; z of the rear edge of the boot
  double belt;      ///< z of the lower edge of the side windows at the B pillar
  double roof_y;    ///< half width of the roof
  double roof_cut;  ///< the roof is that much below the height of the table
  enum class Kind { car, pickup, van, minibus } kind = Kind::car;
  double header = 0.0;  ///< vans: height of the roof above the windows
  bool flat() const { return kind == Kind::van || kind == Kind::minibus; }  ///< flat sides and roof
};

const std::vector<CarStyle>& styles() {
  static const std::vector<CarStyle> list{
      {"saloon", 0.20, 0.72, 0.94, 0.98, 0.16, -0.22, -1.10, -1.28, -1.28, -1.50, 0.28, 0.62, -1.78, 1.03,
       0.99, 0.92, 0.585, 0.0},
      {"hatchback", 0.21, 0.72, 0.96, 0.92, 0.22, -0.28, -1.14, -1.24, -1.24, -1.72, 0.18, 0.30, -1.90, 1.00,
       0.97, 0.94, 0.565, 0.0},
      {"compact", 0.20, 0.72, 0.96, 0.98, 0.25, -0.24, -1.18, -1.28, -1.28, -1.80, 0.18, 0.36, -1.99, 1.00,
       0.97, 0.93, 0.58, 0.0},
      {"estate", 0.20, 0.72, 0.94, 1.00, 0.18, -0.20, -1.06, -1.20, -1.96, -2.14, 0.10, 0.30, -2.22, 1.00,
       0.97, 0.93, 0.585, 0.0},
      {"suv", 0.27, 0.86, 1.09, 1.02, 0.32, -0.20, -1.10, -1.22, -1.72, -1.96, 0.10, 0.28, -2.08, 1.12, 1.06,
       1.06, 0.60, 0.0},
      {"coupe", 0.18, 0.68, 0.90, 0.92, 0.04, -0.50, -1.42, -1.46, -1.46, -1.62, 0.62, 0.86, -1.78, 0.99,
       0.95, 0.90, 0.54, 0.0},
      {"cabriolet", 0.16, 0.64, 0.84, 0.62, 0.12, -0.52, -1.02, -1.02, -1.02, -1.12, 0.30, 0.34, -1.22, 0.89,
       0.86, 0.84, 0.53, 0.0},
      {"mini", 0.19, 0.74, 0.98, 0.98, 0.38, -0.20, -1.06, -1.16, -1.16, -1.62, 0.12, 0.20, -1.72, 0.98, 0.94,
       0.95, 0.54, 0.0},
      {"taxi", 0.20, 0.73, 0.95, 1.02, 0.18, -0.24, -1.14, -1.32, -1.32, -1.56, 0.28, 0.62, -1.84, 1.04, 1.00,
       0.93, 0.59, 0.13},
      {"mpv", 0.22, 0.78, 1.04, 1.22, 0.34, -0.20, -1.08, -1.20, -1.86, -2.02, 0.08, 0.20, -2.12, 1.04, 1.00,
       1.00, 0.60, 0.0},
      {"pickup", 0.30, 0.92, 1.16,  1.14, 0.52, -0.02, -0.72, -0.78, -0.78,
       -0.94,    0.10, 0.12, -1.02, 1.18, 1.15, 1.12,  0.60,  0.0,   CarStyle::Kind::pickup},
      {"van", 0.24, 0.84, 1.16,  1.78, 0.98, 0.52, -2.30, -2.30, -2.30,
       -2.52, 0.04, 0.06, -2.58, 1.20, 1.10, 1.18, 0.84,  0.0,   CarStyle::Kind::van,
       0.42},
      {"panel_van", 0.26, 0.88, 1.26,  2.02, 1.22, 0.76, -2.62, -2.62, -2.62,
       -2.84,       0.03, 0.05, -2.90, 1.30, 1.20, 1.28, 0.90,  0.0,   CarStyle::Kind::van,
       0.66},
      {"minibus", 0.26, 0.88, 1.26,  2.52, 1.72, 1.26, -3.12, -3.12, -3.12,
       -3.35,     0.03, 0.05, -3.41, 1.30, 1.20, 1.28, 0.90,  0.0,   CarStyle::Kind::minibus,
       0.56},
      {"ambulance", 0.26, 0.88, 1.26,  2.10, 1.30, 0.84, -2.70, -2.70, -2.70,
       -2.93,       0.03, 0.05, -2.99, 1.30, 1.20, 1.28, 0.90,  0.17,  CarStyle::Kind::van,
       0.70}};
  return list;
}

// The columns of the left half, from the front to the rear. a0...a6 go around the front wheel arch, b0...b6
// around the rear one.
enum Column : size_t { f0, f1, f2, a0, a6 = a0 + 6, d0, d1, b0, b6 = b0 + 6, r2, r1, r0, column_count };
// The rows from the bottom up: underside, bumpers, widest line, shoulder and bonnet's edge, bonnet's front,
// lower and upper edge of the windows, roof.
enum RowName : size_t { floor_row, bumper, waist, shoulder, bonnet, belt_row, gutter, roof_row, row_count };

using HalfRow = std::vector<dvec3>;

/// Makes the contours of one car.
class CarContours {
 public:
  CarContours(const VehicleShape& shape, const CarStyle& style)
      : s_(style),
        front_(0.5 * shape.length_m),
        w_(0.5 * shape.width_m),
        top_(shape.height_m - style.roof_cut),
        radius_(shape.wheels[0].radius_m),
        arch_(radius_ + 0.045),
        axles_(shape.wheels.front().hub_m.x, shape.wheels.back().hub_m.x),
        waist_z_(std::max(0.66, radius_ + arch_ + 0.05)) {}

  std::vector<HalfRow> rows() const {
    return {floor_contour(),  bumper_contour(), waist_contour(),  shoulder_contour(),
            bonnet_contour(), belt_contour(),   gutter_contour(), roof_contour()};
  }

 private:
  double nose_x() const { return std::min(front_ - 0.32, axles_.x + arch_ + 0.05); }
  double tail_x() const { return std::max(-front_ + 0.32, axles_.y - arch_ - 0.05); }
  /// Returns corner `i` of an arch, from its front to its rear end on the sill.
  dvec2 arch(double axle, size_t i) const {
    const double start = std::asin((s_.sill - radius_) / arch_);
    const double angle = start + (pi - 2.0 * start) * static_cast<double>(i) / 6.0;
    return {axle + arch_ * std::cos(angle), radius_ + arch_ * std::sin(angle)};
  }
  void both_arches(HalfRow& row, const std::function<dvec3(double axle, size_t i)>& point) const {
    for (size_t i = 0; i <= 6; ++i) {
      row[a0 + i] = point(axles_.x, i);
      row[b0 + i] = point(axles_.y, i);
    }
  }
  /// Returns the height of the bonnet's edge or of the belt line below the windows.
  double shoulder_z(double x) const {
    if (x > s_.cowl - 0.2)
      return glm::mix(s_.hood - 0.05, s_.nose + 0.05,
                      std::clamp((x - s_.cowl + 0.2) / (nose_x() - s_.cowl + 0.2), 0.0, 1.0));
    return belt_z(x) - 0.035;
  }
  double belt_z(double x) const {
    if (s_.flat()) return s_.belt;
    const double rise = (s_.deck - 0.02 - s_.belt) / (s_.b_front - s_.d_rear);
    return s_.belt + rise * std::clamp(s_.b_front - x, -0.6, s_.b_front - s_.d_rear);
  }
  double roof_z(double x) const {
    const double middle = s_.b_front + 0.05, ahead = x - middle;
    const double reach = ahead > 0.0 ? s_.screen_top - middle : middle - (s_.back_base + s_.d_lean);
    const double share = std::abs(ahead) / std::max(0.3, reach);
    return top_ - (s_.flat() ? 0.0 : ahead > 0.0 ? 0.045 : 0.07) * share * share;
  }

  HalfRow floor_contour() const {
    HalfRow row(column_count);
    row[f0] = {front_ - 0.07, 0.40 * w_, s_.sill + 0.02};
    row[f1] = {front_ - 0.14, 0.76 * w_, s_.sill + 0.02};
    row[f2] = {nose_x(), w_ - 0.05, s_.sill};
    both_arches(row,
                [&](double axle, size_t i) { return dvec3(arch(axle, i).x, w_ - 0.012, arch(axle, i).y); });
    row[d0] = {s_.b_front, w_ - 0.06, s_.sill};
    row[d1] = {s_.b_front - 0.09, w_ - 0.06, s_.sill};
    row[r2] = {tail_x(), w_ - 0.05, s_.sill + 0.02};
    row[r1] = {-front_ + 0.14, 0.78 * w_, s_.sill + 0.06};
    row[r0] = {-front_ + 0.07, 0.42 * w_, s_.sill + 0.06};
    return row;
  }
  HalfRow bumper_contour() const {
    HalfRow row = floor_contour();
    const double z = s_.sill + 0.23;
    row[f0] = {front_ - 0.015, 0.42 * w_, z};
    row[f1] = {front_ - 0.10, 0.81 * w_, z};
    row[f2] = {nose_x(), w_ - 0.02, z};
    row[a0] = row[a0 + 1];
    row[a6] = row[a6 - 1];
    row[d0] = {s_.b_front, w_ - 0.02, arch(axles_.x, 1).y};
    row[d1] = {s_.b_front - 0.09, w_ - 0.02, arch(axles_.x, 1).y};
    row[b0] = row[b0 + 1];
    row[b6] = row[b6 - 1];
    row[r2] = {tail_x(), w_ - 0.02, z + 0.02};
    row[r1] = {-front_ + 0.09, 0.82 * w_, z + 0.04};
    row[r0] = {-front_ + 0.005, 0.44 * w_, z + 0.04};
    return row;
  }
  HalfRow waist_contour() const {
    HalfRow row(column_count);
    const double lamp = s_.nose - 0.13;
    row[f0] = {front_, 0.43 * w_, lamp};
    row[f1] = {front_ - 0.10, 0.82 * w_, lamp + 0.02};
    row[f2] = {nose_x(), w_ - 0.005, std::min(waist_z_ - 0.03, s_.nose - 0.06)};
    both_arches(row, [&](double axle, size_t i) {
      const double reach = i < 2 ? 0.8 : i > 4 ? -0.8 : 0.0;
      return dvec3(axle + reach * arch_, w_, waist_z_);
    });
    row[d0] = {s_.b_front, w_, waist_z_};
    row[d1] = {s_.b_front - 0.09, w_, waist_z_};
    row[r2] = {tail_x(), w_ - 0.005, waist_z_};
    row[r1] = {-front_ + 0.08, 0.83 * w_, s_.tail - 0.22};
    row[r0] = {-front_, 0.44 * w_, s_.tail - 0.24};
    return row;
  }
  HalfRow shoulder_contour() const {
    HalfRow row(column_count);
    row[f0] = {front_ - 0.07, 0.42 * w_, s_.nose};
    row[f1] = {front_ - 0.19, 0.81 * w_, s_.nose + 0.03};
    row[f2] = {nose_x() - 0.05, w_ - 0.05, s_.nose + 0.06};
    const double a_rear = s_.cowl - 0.30;
    both_arches(row, [&](double axle, size_t i) {
      const bool front = axle > 0.0;
      const double x = front ? (i < 4 ? axle - 0.08 : a_rear) : (i < 3 ? s_.c_front : s_.d_rear + 0.02);
      return dvec3(x, w_ - 0.05, shoulder_z(x));
    });
    row[d0] = {s_.b_front, w_ - 0.045, shoulder_z(s_.b_front)};
    row[d1] = {s_.b_front - 0.09, w_ - 0.045, shoulder_z(s_.b_front - 0.09)};
    row[r2] = {std::min(tail_x(), s_.d_rear) - 0.03, w_ - 0.055, s_.tail - 0.02};
    row[r1] = {-front_ + 0.11, 0.81 * w_, s_.tail - 0.03};
    row[r0] = {-front_ + 0.035, 0.44 * w_, s_.tail - 0.03};
    return row;
  }
  HalfRow bonnet_contour() const {
    HalfRow row = shoulder_contour();
    row[f0] = {front_ - 0.27, 0.42 * w_, s_.nose + 0.085};
    row[f1] = {front_ - 0.38, 0.75 * w_, s_.nose + 0.09};
    const bool boot = s_.back_base - -front_ > 0.35;
    if (boot) {
      row[r1] = {-front_ + 0.17, 0.77 * w_, s_.tail + 0.015};
      row[r0] = {-front_ + 0.10, 0.44 * w_, s_.tail + 0.02};
    }
    return row;
  }
  HalfRow belt_contour() const {
    HalfRow row(column_count);
    row[f0] = {s_.cowl, 0.40 * w_, s_.hood};
    row[f1] = {s_.cowl - 0.05, 0.66 * w_, s_.hood};
    const double a_rear = s_.cowl - 0.34;
    row[f2] = {s_.cowl - 0.17, w_ - 0.135, s_.hood + 0.005};
    const auto side = [&](double x) { return dvec3(x, w_ - 0.085, belt_z(x)); };
    both_arches(row, [&](double axle, size_t i) {
      if (axle > 0.0) return i < 4 ? row[f2] : side(a_rear);
      return i < 1 ? side(s_.c_front) : i < 3 ? side(s_.c_rear) : i < 5 ? side(s_.d_front) : last_pillar();
    });
    row[d0] = side(s_.b_front);
    row[d1] = side(s_.b_front - 0.09);
    row[r2] = last_pillar();
    row[r1] = {s_.back_base, 0.66 * w_, s_.deck};
    row[r0] = {s_.back_base - 0.03, 0.42 * w_, s_.deck + 0.005};
    return row;
  }
  dvec3 last_pillar() const {
    return s_.flat() ? dvec3(s_.d_rear, w_ - 0.085, s_.belt) : dvec3(s_.d_rear, w_ - 0.12, s_.deck);
  }
  HalfRow gutter_contour() const {
    HalfRow row(column_count);
    const double y = s_.roof_y, below = s_.flat() ? 0.0 : 0.05;
    const auto edge = [&](double x, double half, double drop) {
      return dvec3(x, half, roof_z(x) - drop - s_.header);
    };
    row[f0] = edge(s_.screen_top, 0.40 * w_, 0.24 * below);
    row[f1] = edge(s_.screen_top - 0.03, y - 0.11, 0.44 * below);
    row[f2] = edge(s_.screen_top - 0.10, y - 0.02, below);
    const double last = s_.d_rear + s_.d_lean;
    both_arches(row, [&](double axle, size_t i) {
      if (axle > 0.0) return i < 4 ? row[f2] : edge(s_.screen_top - 0.19, y, below);
      return i < 1   ? edge(s_.c_front + s_.c_lean, y, below)
             : i < 3 ? edge(s_.c_rear + s_.c_lean, y, below)
             : i < 5 ? edge(std::max(last + 0.03, std::min(s_.d_front + s_.d_lean, s_.c_rear + s_.c_lean)), y,
                            below)
                     : edge(last, s_.flat() ? y : y - 0.025, below);
    });
    row[d0] = edge(s_.b_front - 0.03, y, below);
    row[d1] = edge(s_.b_front - 0.11, y, below);
    row[r2] = row[b6];
    row[r1] = edge(last - 0.06, y - 0.12, 0.8 * below);
    row[r0] = edge(last - 0.08, 0.40 * w_, 0.6 * below);
    return row;
  }
  HalfRow roof_contour() const {
    HalfRow row = gutter_contour();
    const double first = s_.screen_top - 0.20, last = s_.d_rear + s_.d_lean + 0.05;
    if (s_.flat()) {  // the sides go on up to a level roof
      for (dvec3& p : row) p = {p.x - (p.x > first - 0.05 ? 0.25 : 0.0), p.y - 0.05, top_};
      return row;
    }
    for (dvec3& p : row) {
      p.x = std::clamp(p.x, std::min(last, first), first);
      p = {p.x, std::min(0.40 * w_, p.y), roof_z(p.x)};
    }
    return row;
  }

  const CarStyle& s_;
  double front_, w_, top_, radius_, arch_;
  dvec2 axles_;
  double waist_z_;
};

/// Says which material the shell has where.
struct CarPaint {
  const CarStyle& style;
  int paint, roof, plastic, glass, pillar, head, tail, stripe;

  /// `row` is below the cell; `from` and `to` are its columns; `column_count` stands for the other side.
  int cell(size_t row, size_t from, size_t to) const {
    const bool ahead = to <= f2, behind = from >= r2;
    if (row == floor_row) {
      if (ahead || behind) return plastic;
      return style.sill > 0.25 ? plastic : paint;
    }
    if (row == waist) {
      if (ahead && from == column_count) return plastic;
      if (ahead) return head;
      if (behind && to != column_count) return tail;
    }
    if (row == waist && !ahead && !behind) return stripe;
    if (row == bonnet && behind && style.kind == CarStyle::Kind::pickup) return plastic;  // over the load
    if (row == belt_row) return window(from, to);
    if (row >= gutter) return roof;
    return paint;
  }
  int window(size_t from, size_t to) const {
    if (to <= f2 || from >= r2) return glass;
    if (to <= a6) return paint;  // A pillar
    if (from == d0 && to == d1) return pillar;
    if (to <= b0) return style.kind == CarStyle::Kind::van && from >= d1 ? paint : glass;
    const bool quarter = style.d_front < style.c_rear - 0.05;
    if (from >= b0 + 2 && to <= b0 + 3 && quarter) return glass;
    return to <= b0 + 2 && quarter ? pillar : roof;
  }
};

/// Leaves out columns and rows that only a close view shows.
void thin_out(std::vector<HalfRow>& rows, std::vector<size_t>& columns, std::vector<size_t>& levels) {
  columns = {f1, f2, a6, b0, r2, r1};
  levels = {floor_row, waist, shoulder, belt_row, gutter};
  for (const size_t row : {belt_row, gutter}) {
    rows[row][f1] = rows[row][f2];
    rows[row][r1] = rows[row][r2];
  }
  for (const size_t row : {floor_row, waist, shoulder}) {
    rows[row][f1].x += 0.09;  // the middle of the bumpers, which is left out, is farther out
    rows[row][r1].x -= 0.07;
  }
  for (const size_t column : {a6, b0}) rows[shoulder][column] = rows[belt_row][column];
  std::vector<HalfRow> kept;
  for (const size_t level : levels) {
    HalfRow row;
    for (const size_t column : columns) row.push_back(rows[level][column]);
    kept.push_back(row);
  }
  rows = kept;
  levels[0] = bumper;  // for CarPaint: painted, not the plastic of the lip
}

const CarStyle* find_style(const std::string& variant) {
  for (const CarStyle& style : styles())
    if (variant == style.variant) return &style;
  return nullptr;
}

/// Returns where a body's sides lie in the picture `car_side`: doors from u = 0.30 over 0.50 to 0.70, the
/// sill at the lower and the belt line at the upper edge of the half for cars with four or with two doors.
/// The rest of a body lies at the blank corner.
SmoothMesh::Mapping side_mapping(const CarStyle& style, const VehicleShape& shape) {
  const double front = 0.5 * shape.length_m;
  const bool two_doors = style.kind != CarStyle::Kind::minibus && style.c_front > style.b_front - 0.75;
  const bool coupe = style.variant == std::string("coupe"), van = style.kind == CarStyle::Kind::van;
  const double half = two_doors || coupe || van ? 0.5 : 0.0;
  const double rear_door = van ? style.b_front - 1.3 : style.c_front + 0.06;
  const std::array<dvec2, 5> knots{dvec2(front, 0.02), dvec2(style.cowl - 0.40, 0.30),
                                   dvec2(style.b_front - 0.045, 0.50), dvec2(rear_door, 0.70),
                                   dvec2(-front, 0.98)};
  return [=](const dvec3& p, const dvec3& normal, const dvec3& middle) {
    if (std::abs(normal.y) < 0.75 || middle.z > style.belt - 0.02) return dvec2(0.0);
    size_t i = 0;
    while (i < 3 && p.x < knots[i + 1].x) ++i;
    const double share = (knots[i].x - p.x) / (knots[i].x - knots[i + 1].x);
    const double v = std::clamp((style.belt + 0.02 - p.z) / (style.belt + 0.02 - style.sill), 0.0, 1.0);
    return dvec2(glm::mix(knots[i].y, knots[i + 1].y, share), half + 0.02 + 0.46 * v);
  };
}

/// Returns the room of a cabin. In the thinned shell of a parked car the windscreen and the rear window are
/// flat from side to side.
CabinRoom cabin_of(const VehicleShape& shape, const CarStyle& style, bool detailed) {
  return {.front = detailed ? style.cowl : style.cowl - 0.14,
          .rear = detailed ? style.back_base + (style.flat() ? 0.20 : 0.08) : style.d_rear + 0.03,
          .seats = style.b_front,
          // above the wheel arches and the box between the wheels (add_car_details)
          .floor = std::max(style.belt - 0.30, 2.0 * shape.wheels[0].radius_m + 0.06),
          .belt = style.belt,
          .roof = shape.height_m - style.roof_cut,
          .half_width = 0.5 * shape.width_m - 0.085,
          .roof_y = style.roof_y,
          .rear_roof = style.d_rear + style.d_lean,
          .load = style.kind == CarStyle::Kind::van,
          .plain = !detailed};
}

void add_car_details(VehicleBody& body, const VehicleShape& shape, const CarStyle& style, int paint) {
  const double front = 0.5 * shape.length_m, w = 0.5 * shape.width_m, radius = shape.wheels[0].radius_m;
  MeshBuilder& mesh = body.mesh;
  const int plastic = material("bumper");
  // closes the view from wheel to wheel
  mesh.box(plastic, {shape.wheels.back().hub_m.x - 0.45, -w + 0.28, style.sill + 0.03},
           {shape.wheels.front().hub_m.x + 0.45, w - 0.28, 2.0 * radius + 0.01});
  add_plate(mesh, front + 0.004, style.sill + 0.31, true);
  add_plate(mesh, -front - 0.004, style.sill + 0.37, false);
  const double tall = style.flat() ? 0.22 : 0.11;
  add_boxes(mesh, style.flat() ? plastic : paint, {style.cowl - 0.46, w - 0.09, style.belt + 0.005},
            {style.cowl - 0.36, w + 0.10, style.belt + tall});
  const dvec3 head(front - 0.10, 0.63 * w, style.nose - 0.055);
  add_boxes(mesh, material("headlight"), head + dvec3(-0.1, -0.055, -0.04),
            head + dvec3(0.008, 0.055, 0.015));
  const dvec3 tail(-front, 0.66 * w, style.tail - 0.12);
  add_indicators(mesh, head + dvec3(-0.1, 0.06, -0.036), head + dvec3(0.004, 0.11, 0.011));
  add_indicators(mesh, tail + dvec3(-0.006, -0.06, -0.03), tail + dvec3(0.1, 0.06, 0.01));
  body.head_lamps = {head + dvec3(0.03, 0.0, 0.0)};
  body.tail_lamps = {tail};
  const double z = shape.height_m - style.roof_cut;
  if (shape.variant == "ambulance")
    mesh.box(material("blue_beacon"), {style.screen_top - 0.35, -0.7, z - 0.05},
             {style.screen_top - 0.1, 0.7, shape.height_m});
  else if (style.roof_cut > 0.0) {  // a taxi's sign
    mesh.box(material("taxi_sign"), {style.b_front - 0.06, -0.22, z - 0.03},
             {style.b_front + 0.08, 0.22, shape.height_m});
  }
}

}  // namespace

bool is_car(const std::string& variant) { return find_style(variant) != nullptr; }

VehicleBody make_car_body(const VehicleShape& shape, int paint, bool detailed) {
  const CarStyle& style = *find_style(shape.variant);
  std::vector<HalfRow> rows = CarContours(shape, style).rows();
  std::vector<size_t> columns, levels;
  for (size_t i = 0; i < column_count; ++i) columns.push_back(i);
  for (size_t i = 0; i < row_count; ++i) levels.push_back(i);
  if (!detailed) thin_out(rows, columns, levels);
  const int roof = shape.variant == "cabriolet" ? material("soft_top") : paint;
  const CarPaint colors{style,
                        paint,
                        roof,
                        material("bumper"),
                        material("car_glass"),
                        material("car_trim"),
                        material(detailed ? "lamp_cover" : "headlight_off"),
                        material(detailed ? "switched_stop" : "tail_light_off"),
                        shape.variant == "ambulance" ? material("car_paint_orange") : paint};
  SmoothMesh shell;
  const size_t last = columns.size();
  add_half_grid(shell, {.rows = rows,
                        .cell =
                            [&](size_t row, size_t cell) {
                              return colors.cell(levels[row], cell == 0 ? column_count : columns[cell - 1],
                                                 cell == last ? column_count : columns[cell]);
                            },
                        .bottom = material("bumper"),
                        .top = [&](size_t) { return roof; }});
  VehicleBody body;
  shell.add_to(body.mesh, 38.0 * pi / 180.0, side_mapping(style, shape));
  if (detailed) add_car_details(body, shape, style, paint);
  add_cabin(body.inside, cabin_of(shape, style, detailed));
  return body;
}

}  // namespace greatx::scene::generator

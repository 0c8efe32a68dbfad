// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/targets/tr38901_target.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.h"
#include "core/hash.h"
#include "core/random.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

/// Holds a row of Tables 7.9.2.1-2 to 7.9.2.1-6: a face of a target. Angles are in degrees.
struct Face {
  double phi_center, phi_3db;  ///< phi_3db = 0: the same at all azimuths
  double theta_center, theta_3db;
  double most_dbsm;     ///< G_max
  double most_fall_db;  ///< sigma_max
};

/// Holds the faces of a kind with an angular pattern: four around, then roof and bottom.
struct Faces {
  std::array<Face, 4> around;  ///< front, left, back, right
  double roof_to = 0.0;        ///< zenith where the roof ends; 0: there is none
  Face roof{};
  double bottom_from = 181.0;  ///< zenith where the bottom begins
  Face bottom{};
  double k1, k2;
};

// Table 7.9.2.1-2.
constexpr Faces uav_large{{{{0, 14.19, 90, 16.53, 1.02, 7.89},
                            {90, 7.13, 90, 8.68, 7.43, 14.30},
                            {180, 10.09, 90, 11.43, 3.99, 10.86},
                            {270, 7.13, 90, 8.68, 7.43, 14.30}}},
                          45.0,
                          {0, 0, 0, 4.93, 13.55, 20.42},
                          135.0,
                          {0, 0, 180, 4.93, 13.55, 20.42},
                          6.05,
                          1.33};
// Table 7.9.2.1-3: two faces of a half turn each.
constexpr Face human_front{0, 216.65, 90, 55.7, 2.14, 7.7}, human_back{180, 216.65, 90, 55.7, 2.14, 7.7};
constexpr double human_k1 = 0.5714, human_k2 = 0.1;
// Table 7.9.2.1-4.
constexpr Faces vehicle{{{{0, 40.54, 71.75, 29.13, 15.52, 8.45},
                          {90, 26.90, 79.70, 44.42, 20.75, 13.68},
                          {180, 36.32, 79.65, 36.73, 14.56, 7.50},
                          {270, 26.90, 79.70, 44.42, 20.75, 13.68}}},
                        30.0,
                        {0, 0, 0, 18.13, 21.26, 14.19},
                        181.0,
                        {},
                        6.0,
                        1.65};
// Table 7.9.2.1-6.
constexpr Faces agv{{{{0, 13.68, 90, 13.68, 13.02, 23.29},
                      {90, 15.53, 75, 20.03, 7.33, 17.60},
                      {180, 12.49, 90, 11.89, 11.01, 21.28},
                      {270, 15.53, 75, 20.03, 7.33, 17.60}}},
                    30.0,
                    {0, 0, 0, 11.44, 11.79, 22.06},
                    181.0,
                    {},
                    12.0,
                    1.45};

/// Returns the loss of a lobe, dB: 12 (off/width)^2, at most sigma_max.
double fall_db(double off, double width, double most) {
  return std::min(12.0 * (off / width) * (off / width), most);
}

double face_dbsm(const Face& face, double theta, double phi, double bistatic, double k1, double k2) {
  double fall = fall_db(theta - face.theta_center, face.theta_3db, face.most_fall_db);
  if (face.phi_3db > 0.0)
    fall += fall_db(std::remainder(phi - face.phi_center, 360.0), face.phi_3db, face.most_fall_db);
  const double floor = face.most_dbsm - face.most_fall_db;
  // Towards forward scattering the cosine vanishes, and the floor holds.
  const double cosine = std::max(std::cos(0.5 * bistatic), 1e-12);
  return std::max(face.most_dbsm - std::min(fall, face.most_fall_db) - k1 * std::sin(0.5 * k2 * bistatic) +
                      5.0 * std::log10(cosine),
                  floor);
}

const Face& face_at(const Faces& faces, double theta, double phi) {
  if (theta < faces.roof_to) return faces.roof;
  if (theta >= faces.bottom_from) return faces.bottom;
  const double turned = phi + 45.0 - 360.0 * std::floor((phi + 45.0) / 360.0);  // [0, 360): front from 0
  return faces.around[std::min<size_t>(3, static_cast<size_t>(turned / 90.0))];
}

double of_faces(const Faces& faces, double theta, double phi, double bistatic) {
  return face_dbsm(face_at(faces, theta, phi), theta, phi, bistatic, faces.k1, faces.k2);
}

/// Returns a normal number from two uniform ones in [0, 1) (Box, Muller, 1958).
double normal(RandomStream& random) {
  const double radius = std::sqrt(-2.0 * std::log1p(-random.uniform()));
  return radius * std::cos(2.0 * pi * random.uniform());
}

}  // namespace

double Tr38901Spread::small_scale_mean_db() const {
  return -std::log(10.0) / 20.0 * small_scale_db * small_scale_db;
}
double Tr38901Spread::small_scale_most_db() const { return small_scale_mean_db() + 3.0 * small_scale_db; }

Tr38901Spread tr38901_spread(Tr38901Kind kind) {
  // Tables 7.9.2.1-1 to 7.9.2.1-6 and 7.9.2.2-1.
  switch (kind) {
    case Tr38901Kind::uav_small:
      return {3.74, 13.75, 7.07};
    case Tr38901Kind::uav_large:
      return {2.50, 13.75, 7.07};
    case Tr38901Kind::human:
    case Tr38901Kind::human_2:
      return {3.94, 19.81, 4.25};
    case Tr38901Kind::vehicle:
      return {3.41, 21.12, 6.88};
    case Tr38901Kind::agv:
      return {2.51, 9.60, 6.85};
  }
  throw ContractError("kind of target without parameters");
}

double tr38901_pattern_dbsm(Tr38901Kind kind, const Aspect& aspect) {
  const double bistatic = aspect.bistatic_angle();
  const dvec2 angles = theta_phi(aspect.bisector());
  const double theta = degrees(angles.x), phi = degrees(angles.y);
  switch (kind) {
    case Tr38901Kind::uav_small:
      return -12.81 - 3.0 * std::sin(0.5 * bistatic);
    case Tr38901Kind::human:
      return -1.37 - 3.0 * std::sin(0.5 * bistatic);
    case Tr38901Kind::human_2:
      return face_dbsm(std::abs(phi) <= 90.0 ? human_front : human_back, theta, phi, bistatic, human_k1,
                       human_k2);
    case Tr38901Kind::uav_large:
      return of_faces(uav_large, theta, phi, bistatic);
    case Tr38901Kind::vehicle:
      return of_faces(vehicle, theta, phi, bistatic);
    case Tr38901Kind::agv:
      return of_faces(agv, theta, phi, bistatic);
  }
  throw ContractError("kind of target without a pattern");
}

struct Tr38901Target::Draw {
  double small_scale_db, xpr_db;
  std::array<double, 4> turns;  ///< theta theta, theta phi, phi theta, phi phi
};

Tr38901Target::Draw Tr38901Target::draw(const EchoKey& key) const {
  const Tr38901Spread spread = tr38901_spread(kind_);
  const uint64_t low = std::min(key.out, key.home), high = std::max(key.out, key.home);
  constexpr uint64_t step = 0x9e3779b97f4a7c15ull;
  RandomStream random(mix64(mix64(mix64(seed_ + step * (number_ + 1)) + low) + step + high),
                      fnv1a32("target of TR 38.901"), key.sequence);
  Draw draw{};
  draw.small_scale_db = std::min(spread.small_scale_mean_db() + spread.small_scale_db * normal(random),
                                 spread.small_scale_most_db());
  draw.xpr_db = spread.xpr_mean_db + spread.xpr_deviation_db * normal(random);
  for (double& turns : draw.turns) turns = random.uniform();
  if (low == high) draw.turns[2] = draw.turns[1];
  return draw;
}

double Tr38901Target::small_scale_db(const EchoKey& key) const { return draw(key).small_scale_db; }

ScatterMatrix Tr38901Target::scatter(const Aspect& aspect, const EchoKey& key) const {
  const Draw drawn = draw(key);
  const double dbsm = tr38901_pattern_dbsm(kind_, aspect) + drawn.small_scale_db;
  const double co = std::sqrt(std::pow(10.0, 0.1 * dbsm) / (4.0 * pi));
  const double cross = co * std::pow(10.0, -0.05 * drawn.xpr_db);
  const auto entry = [&](double amplitude, size_t i) {
    return std::polar(amplitude, 2.0 * pi * (drawn.turns[i] - 0.5));
  };
  const ScatterMatrix s{entry(co, 0), entry(cross, 1), entry(cross, 2), entry(co, 3)};
  return key.out <= key.home ? s : transposed(s);
}

}  // namespace greatx::rf

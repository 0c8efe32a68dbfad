// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/targets/echo_path.h"

#include <algorithm>
#include <utility>

namespace greatx::rf {

Path reversed(const Path& path) {
  Path turned = path;
  const size_t count = path.interactions.size();
  std::reverse(turned.interactions.begin(), turned.interactions.end());
  std::reverse(turned.vertices.begin(), turned.vertices.end());
  turned.edges_diffract = 0;
  for (size_t i = 0; i < count; ++i)
    turned.edges_diffract |= (path.edges_diffract >> i & 1u) << (count - 1 - i);
  // The field of a diffraction or a scattering stays that of the end which it was computed from.
  turned.from_receiver = !path.from_receiver;
  std::swap(turned.departure, turned.arrival);
  std::swap(turned.transfer[1], turned.transfer[2]);
  return turned;
}

void join(const Complex (&out)[4], const ScatterMatrix& s, const Complex (&home)[4], Complex (&product)[4]) {
  const Complex a = s[0] * out[0] + s[1] * out[2], b = s[0] * out[1] + s[1] * out[3],
                c = s[2] * out[0] + s[3] * out[2], d = s[2] * out[1] + s[3] * out[3];
  product[0] = home[0] * a + home[1] * c;
  product[1] = home[0] * b + home[1] * d;
  product[2] = home[2] * a + home[3] * c;
  product[3] = home[2] * b + home[3] * d;
}

double sphere_of_leg(const Path& leg) {
  const bool image = std::all_of(leg.interactions.begin(), leg.interactions.end(), [](const Interaction& i) {
    return i.type == InteractionType::reflection || i.type == InteractionType::transmission;
  });
  return image ? leg.length_m : far_away;
}

Path echo_path(const Path& out, const Path& home, uint32_t instance, const ScatterMatrix& s) {
  Path path;
  path.interactions = out.interactions;
  path.interactions.push_back({InteractionType::target, instance});
  path.interactions.insert(path.interactions.end(), home.interactions.begin(), home.interactions.end());
  path.vertices = out.vertices;
  path.vertices.insert(path.vertices.end(), home.vertices.begin() + 1, home.vertices.end());
  path.length_m = out.length_m + home.length_m;
  path.foliage_m = out.foliage_m + home.foliage_m;
  path.delay_s = out.delay_s + home.delay_s;
  path.doppler_hz = out.doppler_hz + home.doppler_hz;
  path.departure = out.departure;
  path.arrival = home.arrival;
  join(out.transfer, s, home.transfer, path.transfer);
  auto echo = std::make_shared<TargetEcho>();
  echo->out = out;
  echo->home = home;
  std::copy(s.begin(), s.end(), echo->scatter);
  path.echo = std::move(echo);
  return path;
}

}  // namespace greatx::rf

// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/targets/tubes/far_field.h"

#include <algorithm>
#include <cmath>

#include "core/phase.h"
#include "core/units.h"

namespace greatx::rf {

double far_distance_m(const PosedTarget& target, double wavelength_m) {
  // pi D^2/(4 lambda R) at each end.
  return std::max(100.0 * target.size_m, 100.0 * target.size_m * target.size_m / wavelength_m);
}

std::vector<TubeEcho> far_echoes(TubeTargets& tubes, scene::GpuScene& scene, gpu::TickRing& ring,
                                 const PosedTarget& target, const Aspect& aspect, double carrier_hz) {
  const double distance_m = far_distance_m(target, speed_of_light / carrier_hz);
  const dvec3 source = target.centre + distance_m * aspect.to_source,
              receiver = target.centre + distance_m * aspect.to_receiver;
  const dquat world(1.0, 0.0, 0.0, 0.0);
  EchoMotion motion;
  motion.transmitter = [&](double) { return Pose{source, world}; };
  motion.receiver = [&](double) { return Pose{receiver, world}; };
  motion.body = [&](uint32_t body, double) { return target.bodies[body]; };
  motion.slot_start_s = {0.0};
  gpu::TickSlot& slot = ring.begin();
  scene.record_update(slot, target.bodies);
  const TubeTargets::Pending pending = tubes.record(slot, source, receiver, target.bodies);
  ring.submit(slot);
  ring.wait(slot);
  const double at_rest[] = {0.0};
  return tubes.collect(pending, motion, at_rest);
}

ScatterMatrix far_field(TubeTargets& tubes, scene::GpuScene& scene, gpu::TickRing& ring,
                        const PosedTarget& target, const Aspect& aspect, double carrier_hz) {
  const double distance_m = far_distance_m(target, speed_of_light / carrier_hz),
               there_and_back_s = 2.0 * distance_m / speed_of_light;
  ScatterMatrix s{};
  // The ends look at the target, so that theta-hat is the same for their directions and for those from the
  // target, but phi-hat is opposite.
  for (const TubeEcho& echo : far_echoes(tubes, scene, ring, target, aspect, carrier_hz))
    s[2 * echo.received + echo.sent] +=
        (echo.received == echo.sent ? 1.0 : -1.0) * echo.transfer * distance_m * distance_m *
        unit_phasor(-turns_of(carrier_hz, echo.delay_s[0] - there_and_back_s));
  return s;
}

}  // namespace greatx::rf

// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Places two antennas in a generated city, computes all paths between them, and prints H(f)
// (docs/install.md#in-a-program-of-your-own).
#include <cstdio>
#include <greatx/greatx.h>

int main() try {
  using namespace greatx::embed;
  set_log([](const std::string& level, const std::string& text) {
    std::fprintf(stderr, "%s: %s\n", level.c_str(), text.c_str());
  });
  Simulation simulation = Simulation::from_text(R"(
greatx: 1
name: two_antennas
ticks: 1
scene: {generate: {kind: city, seed: 3, size_m: 120}}
)");
  const std::string mast = simulation.place_antenna("mast", {13.0, 13.0, 25.0});
  const std::string phone = simulation.place_antenna("phone", {0.0, -20.0, 1.5});
  simulation.add_channel("link", {mast}, {phone},
                         R"({"carrier_hz": 3.5e9, "bandwidth_hz": 20e6, "subcarriers": 8, "max_depth": 2})");

  const Paths paths = simulation.paths("link");
  const double* delay_s = paths.array("delay").data<double>();
  for (size_t i = 0; i < paths.size(); ++i) std::printf("path %zu: %.3f ns\n", i, 1e9 * delay_s[i]);

  const Array h = paths.frequency_response();
  const std::complex<float>* value = h.data<std::complex<float>>();
  for (size_t k = 0; k < h.size(); ++k)
    std::printf("H[%zu] = %+.8e %+.8ej\n", k, value[k].real(), value[k].imag());
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}

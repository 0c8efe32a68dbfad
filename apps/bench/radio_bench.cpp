// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/radio_bench.h"

#include <chrono>

#include <fmt/format.h>

#include "apps/bench/radio_rows.h"
#include "apps/bench/row_process.h"
#include "apps/bench/said_once.h"

namespace greatx::apps {

namespace {

nlohmann::json about_row(const ScenarioOptions& options, const RunOptions& run) {
  const sim::Scenario scenario = radio_only(options, tick_rows[0]);
  const sim::World world = sim::load_world(scenario);
  const gpu::Device device(run.device_options());
  return {{"scenario", scenario.name},
          {"device", device.info().name},
          {"driver", device.info().driver},
          {"facets", world.scene.facets.size()}};
}

}  // namespace

nlohmann::json radio_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const RadioBenchOptions& options) {
  const SaidOnce once;  // all rows load the same scene and log the same messages
  const auto since_start =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(process_age_s()));
  const Clock::time_point begin = Clock::now() - since_start;
  nlohmann::json first = in_own_process([&] { return first_cir_row(scenario, run, begin); });
  if (!first["from_cache"].get<bool>()) {
    const Clock::time_point again = Clock::now() - since_start;
    first = in_own_process([&] { return first_cir_row(scenario, run, again); });
  }
  nlohmann::json result = in_own_process([&] { return about_row(scenario, run); });
  result.erase("cpu_s"), result.erase("peak_rss_bytes");
  result["first_cir"] = std::move(first);
  result["search"] = in_own_process([&] { return search_row(scenario); });
  for (const TickRow& row : tick_rows)
    result["ticks"][row.name] = in_own_process([&] { return tick_row(scenario, run, options, row); });
  result["response"] = in_own_process([&] { return response_row(scenario, run); });
  result["gradient"] = in_own_process([&] { return gradient_row(scenario, run); });
  result["written_tick"] = in_own_process([&] { return written_tick_row(scenario, run, options); });
  result["many_responses"] =
      in_own_process([&] { return many_responses_row(scenario, run, options.receivers); });
  if (options.map_cells > 0)
    result["map"] = in_own_process([&] { return map_row(scenario, run, options.map_cells); });
  nlohmann::json many = in_own_process([&] { return many_row(scenario, run, options.receivers); });
  many["peak_rss_target_bytes"] = 1073741824.0;
  result["many"] = std::move(many);
  return result;
}

std::string radio_bench_text(const nlohmann::json& result) {
  constexpr double mebibyte = 1 << 20;
  std::string text = fmt::format("{}, radio alone, {} facets, on {} ({})\n",
                                 result["scenario"].get<std::string>(), result["facets"].get<size_t>(),
                                 result["device"].get<std::string>(), result["driver"].get<std::string>());
  text += fmt::format("  {:<42} {:>10} {:>10} {:>7} {:>9} {:>9}\n", "", "ms", "target", "ratio", "CPU s",
                      "peak MiB");
  const auto row = [&](const std::string& name, double ms, const nlohmann::json& of) {
    text += fmt::format("  {:<42} {:10.2f} {:10.1f} {:7.2f} {:9.2f} {:9.0f}\n", name, ms,
                        of.value("target", 0.0), of.value("ratio", 0.0), of["cpu_s"].get<double>(),
                        of["peak_rss_bytes"].get<double>() / mebibyte);
  };
  const nlohmann::json &first = result["first_cir"], &search = result["search"], &many = result["many"];
  row(first["from_cache"].get<bool>() ? "first CIR, search cached" : "first CIR, search not cached",
      first["ms"], first);
  row(fmt::format("search, {} candidates", search["candidates"].get<size_t>()), search["ms"], search);
  row(fmt::format("{} receivers, {} paths", many["receivers"].get<uint32_t>(), many["paths"].get<uint64_t>()),
      many["ms"], many);
  const nlohmann::json &response = result["response"], &responses = result["many_responses"],
                       &written = result["written_tick"];
  const std::string ports = fmt::format("{} ports x {} subcarriers", response["ports"].get<uint32_t>(),
                                        response["subcarriers"].get<uint32_t>());
  row(fmt::format("their H, {}, to disk", ports), responses["ms"], responses);
  if (result.contains("map"))
    row(fmt::format("radio map, {} cells of 1 m, {} solved", result["map"]["cells"].get<size_t>(),
                    result["map"]["solved"].get<size_t>()),
        result["map"]["ms"], result["map"]);
  row(fmt::format("one H, {} paths, one thread", response["paths"].get<size_t>()), response["ms"], response);
  const nlohmann::json& gradient = result["gradient"];
  row(fmt::format("its gradient by {} of materials, one thread", gradient["parameters"].get<size_t>()),
      gradient["ms"], gradient);
  text +=
      fmt::format("    {:<40} {:10.2f}\n", "fields of its paths and H", gradient["forward_ms"].get<double>());
  text += fmt::format("    {:<40} {:10.0e}\n", "relative error against differences",
                      gradient["error"].get<double>());
  if (written["tick_ms"]["count"] > 0)
    row("tick with H and record, written", written["tick_ms"]["median"], written);
  for (const TickRow& which : tick_rows) {
    const nlohmann::json& tick = result["ticks"][which.name];
    if (tick["tick_ms"]["count"] == 0) continue;
    row(fmt::format("tick, {}", which.name), tick["tick_ms"]["median"], tick);
    text += fmt::format("    {:.0f} geometric paths, {:.1f} paths{}\n", tick["geometric_paths"].get<double>(),
                        tick["paths"].get<double>(),
                        tick["path_overflow"] > 0
                            ? fmt::format(", {} beyond max_paths", tick["path_overflow"].get<uint64_t>())
                            : "");
    for (const char* stage : {"geometry", "crossings", "fields", "response"})
      if (const nlohmann::json& d = tick[fmt::format("{}_ms", stage)]; d["count"] > 0)
        text += fmt::format("    {:<40} {:10.2f}\n", stage, d["median"].get<double>());
  }
  text += fmt::format("  the search: {}\n", search["guarantee"].get<std::string>());
  return text + "  rows with diffraction or scattering stand beside Sionna RT 2.2.0's time for a position\n";
}

}  // namespace greatx::apps

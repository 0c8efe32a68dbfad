// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "apps/commands.h"
#include "apps/console/command_line.h"
#include "apps/console/progress.h"
#include "draw/report/report.h"
#include "draw/sheet/animation.h"
#include "draw/sheet/contact_sheet.h"
#include "io/dataset/summary.h"
#include "sim/scenario/scenario.h"

namespace greatx::apps {

namespace {

/// The options of the report, which belong together.
struct HtmlOptions {
  std::string file;
  double megabytes = io::ReportOptions{}.megabytes;
  size_t moments = io::ReportOptions{}.moments;
};

void add_html_options(CLI::App& command, HtmlOptions& options) {
  CLI::Option* const html =
      command.add_option("--html", options.file, "also write a page with everything in itself, FILE.html");
  command.add_option("--html-megabytes", options.megabytes, "size of the page, at most")
      ->capture_default_str()
      ->check(number_of(1.0, 1000.0))
      ->needs(html);
  command.add_option("--html-ticks", options.moments, "ticks of a sequence on the page, at most")
      ->capture_default_str()
      ->check(integer_of(1, 100'000))
      ->needs(html);
}

io::ReportFile write_html(const io::DatasetReader& reader, const HtmlOptions& options,
                          const std::optional<uint32_t>& sequence, bool quiet) {
  std::unique_ptr<Progress> shown;
  const io::ReportFile page = io::write_html_report(
      reader, options.file, {options.megabytes, options.moments, sequence}, [&](int64_t done, int64_t total) {
        if (!shown) shown = std::make_unique<Progress>("report", total, quiet, "");
        shown->update(done);
      });
  shown.reset();
  for (const std::string& note : page.notes) std::cerr << "note: " << note << '\n';
  return page;
}

struct InspectOptions {
  std::vector<std::string> folders;
  std::string picture, animation;
  size_t frames = 36;
  double rate_hz = 0.0;
  std::optional<uint32_t> sequence;  ///< none: the first; the page shows all
  std::string theme = "dark";
  int scale = 1;
  std::vector<std::string> sensors, links;
  std::string ids;
  HtmlOptions html;
  bool json = false;

  io::SheetOptions sheet() const {
    io::SheetOptions options;
    options.theme = io::theme_called(theme);
    options.factor = scale;
    options.sensors = sensors;
    options.panels = {ids, links};
    return options;
  }
};

io::AnimationFile animate(const io::DatasetReader& reader, const InspectOptions& options) {
  io::AnimationOptions animation{options.frames, options.rate_hz, options.sheet(), {}};
  std::unique_ptr<Progress> progress;
  animation.on_frame = [&](size_t done, size_t all) {
    if (!progress)
      progress = std::make_unique<Progress>("animation", static_cast<int64_t>(all), options.json, "frames");
    progress->update(static_cast<int64_t>(done));
  };
  return io::write_animation(reader, options.animation, animation, options.sequence.value_or(0));
}

void inspect(const InspectOptions& options) {
  std::vector<io::DatasetReader> readers;
  for (const std::string& folder : options.folders) readers.emplace_back(folder);
  if (readers.size() > 1 && options.picture.empty())
    throw_user_error("inspect: several data sets need --picture, for where their sheet goes");
  const std::filesystem::path picture = options.picture.empty()
                                            ? std::filesystem::path(options.folders[0]) / "contact_sheet.png"
                                            : std::filesystem::path(options.picture);
  if (readers.size() > 1 && !options.animation.empty())
    throw_user_error("inspect: --animation shows one data set, found {}", readers.size());
  if (readers.size() > 1 && !options.html.file.empty())
    throw_user_error("inspect: --html shows one data set, found {}", readers.size());
  // First, because it refuses to replace another file.
  std::optional<io::ReportFile> page;
  if (!options.html.file.empty()) page = write_html(readers[0], options.html, options.sequence, options.json);
  std::optional<io::AnimationFile> shown;
  if (!options.animation.empty()) shown = animate(readers[0], options);
  io::write_contact_sheet(readers, picture, options.sequence.value_or(0), options.sheet());
  for (const io::DatasetReader& reader : readers)
    std::cout << (options.json ? io::to_json(io::summarize(reader)) + "\n"
                               : io::to_text(io::summarize(reader)));
  if (options.json) return;
  if (page)
    std::cout << fmt::format("report: {}, {} moments, {:.2f} MB\n", options.html.file, page->moments,
                             1e-6 * static_cast<double>(page->bytes));
  std::cout << "contact sheet: " << picture.string() << '\n';
  if (shown)
    std::cout << fmt::format("animation: {}, {} frames of {} x {} pixels, {:.3g} s, {:.2f} MB\n",
                             options.animation, shown->frames, shown->width, shown->height,
                             1e-3 * shown->duration_ms, 1e-6 * static_cast<double>(shown->bytes));
}

}  // namespace

void add_inspect(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("inspect", "summarise a data set and draw its contact sheet; compare several");
  auto options = std::make_shared<InspectOptions>();
  command
      ->add_option("DIR", options->folders, "folder of the data set; of several, all are drawn side by side")
      ->required();
  command->add_option("--sequence", options->sequence, "the sequence to draw [0; --html shows all]")
      ->check(integer_of(0, sim::most_sequences));
  command->add_option("--picture", options->picture, "where the contact sheet goes [DIR/contact_sheet.png]");
  command->add_option("--theme", options->theme, "colours: dark for screens, light for paper")
      ->capture_default_str()
      ->check(one_of({"dark", "light"}));
  command
      ->add_option("--scale", options->scale, "pixels along a side for one, for print: 2 doubles both sides")
      ->capture_default_str()
      ->check(integer_of(1, io::Canvas::most_factor));
  command
      ->add_option("--sensor", options->sensors,
                   "draw this sensor or channel, or all sensors of this node, and no others; may be repeated")
      ->expected(1);
  command
      ->add_option(
          "--link", options->links,
          "draw this link of the channels, TX:RX or CHANNEL:TX:RX, by the names of antennas, of nodes, "
          "or numbers; may be repeated [of each channel the strongest]")
      ->expected(1);
  command
      ->add_option("--ids", options->ids, "of pictures of ids the one to draw [the first that a camera has]")
      ->check(one_of({"instance", "semantic", "material"}));
  CLI::Option* const animated = command->add_option(
      "--animation", options->animation,
      "also write an animation: FILE.webp, a video FILE.mp4, .mkv, .mov or .webm, or a folder of PNG files");
  command->add_option("--frames", options->frames, "of the animation, at most")
      ->capture_default_str()
      ->check(integer_of(1, 10'000))
      ->needs(animated);
  command
      ->add_option("--fps", options->rate_hz,
                   "frames of the animation a second [real time if that gives 7 to 40, else 10]")
      ->check(number_of(0.1, 120.0))
      ->needs(animated);
  add_html_options(*command, options->html);
  command->add_flag("--json", options->json, "print one JSON object a data set");
  command->callback([options] { inspect(*options); });
}

}  // namespace greatx::apps

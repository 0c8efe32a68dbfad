// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/exit.h"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "apps/console/terminal.h"
#include "core/activity.h"
#include "core/error.h"
#include "gpu/vulkan.h"

namespace greatx::apps {

int report_exception(const std::string& program) {
  try {
    throw;
  } catch (const Failed& failed) {
    return failed.code;
  } catch (const UserError& error) {
    std::cerr << program << ": error: " << error.what() << '\n';
    return exit_user;
  } catch (const Interrupted& interrupted) {
    std::cerr << program << ": interrupted: " << interrupted.what() << '\n';
    return exit_interrupted;
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << program << ": error: " << error.path1().string() << ": " << error.code().message() << '\n';
    return exit_user;
  } catch (const std::bad_alloc&) {
    std::cerr << program << ": error: " << out_of_memory() << '\n';
    return exit_internal;
  } catch (const gpu::VulkanError& error) {
    std::cerr << program << ": device error: " << error.what() << '\n';
    return exit_internal;
  } catch (const std::exception& error) {
    std::cerr << program << ": internal error: " << error.what() << '\n';
    return exit_internal;
  }
}

void set_up_logging(const std::string& program) {
  spdlog::set_default_logger(spdlog::stderr_color_mt(program));
  spdlog::set_formatter(safe_log_format());
  spdlog::set_level(std::getenv("GREATX_DEBUG") != nullptr ? spdlog::level::debug : spdlog::level::info);
}

}  // namespace greatx::apps

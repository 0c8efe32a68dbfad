// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "core/record.h"
#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// One picture to look at: for the first tick, the ones at a third and two thirds, and the last, what cameras
/// and LiDARs saw; below, the first channel over delay and frequency, and the trajectories. u8 [h, w, 3].
Array contact_sheet(const DatasetReader& reader, uint32_t sequence = 0);
/// Several data sets side by side, a column each with its title: the middle moment of every camera and LiDAR,
/// one below the other. u8 [h, w, 3].
Array comparison_sheet(std::span<const DatasetReader> readers, uint32_t sequence = 0);
/// A contact sheet of one, a comparison sheet of several, as a PNG file.
void write_contact_sheet(std::span<const DatasetReader> readers, const std::filesystem::path& file,
                         uint32_t sequence = 0);
void write_contact_sheet(const DatasetReader& reader, const std::filesystem::path& file,
                         uint32_t sequence = 0);

}  // namespace greatx::io

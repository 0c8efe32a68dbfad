// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the contact sheet of a data set, and the comparison sheet of several.
#pragma once

#include <filesystem>
#include <span>

#include "core/record.h"
#include "draw/sheet/sheet_tiles.h"
#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// Returns the contact sheet of a data set, u8 [h, w, 3]. It shows the records of the cameras, event cameras,
/// LiDARs and radars at up to four moments (moments_for()): the first, those at a third and at two thirds,
/// and the last (choose_moments()). Below are plots: trajectories, heights and speeds, and channels over
/// delay and frequency. Throws UserError if the sequence has no records, the options name what is not there,
/// or the sheet would have more than 2^28 pixels.
Array contact_sheet(const DatasetReader& reader, uint32_t sequence = 0, const SheetOptions& options = {});
/// The same as a canvas, whose texts tell what was written where.
Canvas drawn_contact_sheet(const DatasetReader& reader, uint32_t sequence = 0,
                           const SheetOptions& options = {});
/// Returns a picture of several data sets side by side, u8 [h, w, 3]. Each has a column with its title and,
/// one below the other, the frame panels of its sensors at one moment: the third of the four of
/// contact_sheet(). Throws UserError if a data set has no records in the sequence, or none has a frame panel.
Array comparison_sheet(std::span<const DatasetReader> readers, uint32_t sequence = 0,
                       const SheetOptions& options = {});
/// Writes a PNG file: the contact sheet of one data set, or the comparison sheet of several.
void write_contact_sheet(std::span<const DatasetReader> readers, const std::filesystem::path& file,
                         uint32_t sequence = 0, const SheetOptions& options = {});
void write_contact_sheet(const DatasetReader& reader, const std::filesystem::path& file,
                         uint32_t sequence = 0, const SheetOptions& options = {});

}  // namespace greatx::io

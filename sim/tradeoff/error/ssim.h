// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/record.h"

namespace greatx::sim {

/// Returns the mean structural similarity of two u8 [h, w, 3] sRGB pictures of equal shape: 1 for equal ones
/// (Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image Quality Assessment: From Error Visibility to
/// Structural Similarity", IEEE Trans. Image Processing 13(4), 2004, eq. 13). It compares luma (Rec. 601) in
/// windows of 11 x 11 pixels with Gaussian weights of 1.5 pixels, K1 = 0.01 and K2 = 0.03, where the window
/// lies within the picture. Pictures of fewer than 11 pixels in a direction are one window of equal weights.
double ssim(const Array& a, const Array& b);

}  // namespace greatx::sim

// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Weighs what the rays of rough mirrors see. A few rays cannot spread the image of a small bright source, so
// its specks are held down (B. Karis, "Tone Mapping", 2013: weights 1 / (1 + luminance)). An even image stays
// as it is. The highlights of lamps are not among the images.
#ifndef GREATX_CAMERA_MIRROR_WEIGHT_GLSL
#define GREATX_CAMERA_MIRROR_WEIGHT_GLSL
#include "camera/visibility_view.glsl"

/// cd/m^2: about a lit window.
const float plain_image = 30.0;

float image_weight(vec3 image) {
  float luminance = dot(image, vec3(0.2126, 0.7152, 0.0722));
  return 1.0 / (1.0 + luminance / (plain_image * camera.exposure));
}
#endif

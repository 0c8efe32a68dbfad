// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/fft.h"

#include <kiss_fft.h>

#include "core/error.h"

namespace greatx::rf {

static_assert(sizeof(kiss_fft_cpx) == sizeof(std::complex<float>));

struct Fft::Plan {
  kiss_fft_cfg config = nullptr;
  Plan(uint32_t size, bool backward)
      : config(kiss_fft_alloc(static_cast<int>(size), backward, nullptr, nullptr)) {
    GREATX_CHECK(config != nullptr, "a transform of {} points", size);
  }
  ~Plan() { kiss_fft_free(config); }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
};

Fft::Fft(uint32_t size, Direction direction)
    : size_(size), plan_(std::make_unique<Plan>(size, direction == Direction::backward)) {}
Fft::~Fft() = default;
Fft::Fft(Fft&&) noexcept = default;
Fft& Fft::operator=(Fft&&) noexcept = default;

void Fft::transform(const std::complex<float>* in, std::complex<float>* out) const {
  GREATX_CHECK(in != out, "a transform in place");
  kiss_fft(plan_->config, reinterpret_cast<const kiss_fft_cpx*>(in), reinterpret_cast<kiss_fft_cpx*>(out));
}

}  // namespace greatx::rf

# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What needs no training: principal components of equal size, and the mean."""
from __future__ import annotations

import dataclasses

import numpy as np


@dataclasses.dataclass
class Principal:
    """Principal components of channel matrices of norm 1.

    The codeword has M real numbers, the coefficients of the M strongest components of the 2 * angle * delay
    real and imaginary parts. They are the best that any linear encoder and decoder of this size reach on the
    set that they are fitted on (C. Eckart, G. Young, "The approximation of one matrix by another of lower
    rank", Psychometrika 1, 1936).
    """

    components: np.ndarray  #: float32 [component, entry], orthonormal, the strongest first
    variances: np.ndarray  #: float64 [component]
    shape: tuple

    @classmethod
    def fit(cls, matrices: np.ndarray) -> "Principal":
        """Fits the components to matrices [n, angle, delay] and to the same times j.

        The carrier's phase is uniform, so the channel times any phase is as likely. With both, the mean is
        zero, and the components come in pairs v, j v: this makes the most of few matrices.
        """
        both = _with_quadrature(matrices)
        if len(both) >= both.shape[1]:
            return cls.of(second_moment(matrices), matrices.shape[1:])
        _, singular, components = np.linalg.svd(both, full_matrices=False)
        return cls._known(np.square(singular, dtype=np.float64) / len(both), components, matrices.shape[1:])

    @classmethod
    def of(cls, moment: np.ndarray, shape: tuple) -> "Principal":
        """Returns the components of a second moment (of one set, or a mean of several)."""
        variances, vectors = np.linalg.eigh(moment)
        return cls._known(variances[::-1], vectors.T[::-1], shape)

    @classmethod
    def _known(cls, variances: np.ndarray, components: np.ndarray, shape: tuple) -> "Principal":
        known = variances > 1e-6 * variances[0]  # few matrices say nothing about the others
        return cls(components[known].astype(np.float32), variances[known], tuple(shape))

    def restored(self, matrices: np.ndarray, size: int) -> np.ndarray:
        """Returns matrices of norm 1 after they pass a codeword of `size` numbers, complex64 like them. Fewer
        components than `size` exist if they were fitted to few matrices."""
        flat = _real(unit(matrices).reshape(len(matrices), -1))
        basis = self.components[:size]
        return _complex(flat @ basis.T @ basis).reshape(-1, *self.shape)


def second_moment(matrices: np.ndarray) -> np.ndarray:
    """Returns the mean of x x^T over matrices of norm 1, float64 [entry, entry], and the same times j."""
    both = _with_quadrature(matrices)
    return (both.T @ both).astype(np.float64) / len(both)


def _with_quadrature(matrices: np.ndarray) -> np.ndarray:
    parts = unit(matrices).reshape(len(matrices), -1)
    return np.concatenate([_real(parts), _real(1j * parts)])


def unit(matrices: np.ndarray) -> np.ndarray:
    """Returns matrices [n, angle, delay] divided by their norms, complex64."""
    return (matrices / np.linalg.norm(matrices, axis=(1, 2), keepdims=True)).astype(np.complex64)


def mean_restored(train: np.ndarray, matrices: np.ndarray) -> np.ndarray:
    """Returns the mean of the training's matrices of norm 1 for each of `matrices`: what a base station knows
    without feedback."""
    return np.broadcast_to(unit(train).mean(0), matrices.shape)


def _real(flat: np.ndarray) -> np.ndarray:
    return np.concatenate([flat.real, flat.imag], axis=1).astype(np.float32)


def _complex(flat: np.ndarray) -> np.ndarray:
    re, im = np.split(flat, 2, axis=1)
    return (re + 1j * im).astype(np.complex64)

# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Networks that compress a channel matrix to M numbers and restore it.

Both take and give float32 [n, 2, angle, delay], real and imaginary part scaled into [0, 1] around 0.5
(data.images). They are written from the papers:

CsiNet  C.-K. Wen, W.-T. Shih, S. Jin, "Deep learning for massive MIMO CSI feedback", IEEE Wireless
        Communications Letters 7(5), 2018, figure 1
CRNet   Z. Lu, J. Wang, J. Song, "Multi-resolution CSI feedback with deep learning in massive MIMO system",
        IEEE ICC 2020, figures 1 and 2
"""
from __future__ import annotations

from collections import OrderedDict
from typing import Callable, Dict, Tuple

import torch
from torch import nn

from greatx.errors import Error

#: Slope of both papers' LeakyReLU for negative values.
SLOPE = 0.3


def _convolution(inputs: int, outputs: int, height: int, width: int) -> nn.Sequential:
    """Returns a convolution that keeps the size of the picture, and batch normalisation. The convolution has
    no bias, because the normalisation would subtract it."""
    kernel = nn.Conv2d(inputs, outputs, (height, width), padding=(height // 2, width // 2), bias=False)
    return nn.Sequential(kernel, nn.BatchNorm2d(outputs))


def _leaky() -> nn.LeakyReLU:
    return nn.LeakyReLU(SLOPE, inplace=True)


class RefineNet(nn.Module):
    """Refines a picture by three 3x3 convolutions to 8, 16 and 2 channels, added to it (CsiNet)."""

    def __init__(self) -> None:
        super().__init__()
        self.layers = nn.Sequential(
            _convolution(2, 8, 3, 3), _leaky(), _convolution(8, 16, 3, 3), _leaky(), _convolution(16, 2, 3, 3)
        )
        self.leaky = _leaky()

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return self.leaky(x + self.layers(x))


class CRBlock(nn.Module):
    """Refines a picture on two resolutions, 3x3 followed by 1x9 and 9x1, and 1x5 followed by 5x1. A 1x1
    convolution merges their 7 channels each, and the picture is added (CRNet)."""

    def __init__(self) -> None:
        super().__init__()
        self.coarse = nn.Sequential(
            _convolution(2, 7, 3, 3), _leaky(), _convolution(7, 7, 1, 9), _leaky(), _convolution(7, 7, 9, 1)
        )
        self.fine = nn.Sequential(_convolution(2, 7, 1, 5), _leaky(), _convolution(7, 7, 5, 1))
        self.merge = _convolution(14, 2, 1, 1)
        self.leaky = _leaky()

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        both = self.leaky(torch.cat([self.coarse(x), self.fine(x)], dim=1))
        return self.leaky(x + self.merge(both))


class Autoencoder(nn.Module):
    """An encoder [n, 2, angle, delay] -> [n, M] at the user, and a decoder back at the base station."""

    def __init__(self, encoder: nn.Module, decoder: nn.Module, shape: Tuple[int, int], size: int):
        super().__init__()
        self.shape = (2, *shape)
        entries = 2 * shape[0] * shape[1]
        self.encoder = nn.Sequential(OrderedDict(
            features=encoder, flat=nn.Flatten(), dense=nn.Linear(entries, size)
        ))  # fmt: skip
        self.dense = nn.Linear(size, entries)
        self.decoder = decoder

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        coarse = self.dense(self.encoder(x.contiguous())).reshape(-1, *self.shape)
        # The small kernels run faster on a CPU with the channels innermost; results differ by rounding.
        return self.decoder(coarse.contiguous(memory_format=torch.channels_last)).contiguous()


class _TwoPaths(nn.Module):
    """CRNet's encoder: 3x3, 1x9 and 9x1 beside 3x3, merged by 1x1."""

    def __init__(self) -> None:
        super().__init__()
        self.wide = nn.Sequential(
            _convolution(2, 2, 3, 3), _leaky(), _convolution(2, 2, 1, 9), _leaky(), _convolution(2, 2, 9, 1)
        )
        self.narrow = _convolution(2, 2, 3, 3)
        self.merge = nn.Sequential(_leaky(), _convolution(4, 2, 1, 1), _leaky())

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return self.merge(torch.cat([self.wide(x), self.narrow(x)], dim=1))


def csinet(size: int, shape: Tuple[int, int] = (32, 32)) -> Autoencoder:
    """Returns CsiNet with a codeword of `size` numbers."""
    encoder = nn.Sequential(_convolution(2, 2, 3, 3), _leaky())
    decoder = nn.Sequential(RefineNet(), RefineNet(), nn.Conv2d(2, 2, 3, padding=1), nn.Sigmoid())
    return Autoencoder(encoder, decoder, shape, size)


def crnet(size: int, shape: Tuple[int, int] = (32, 32)) -> Autoencoder:
    """Returns CRNet with a codeword of `size` numbers."""
    decoder = nn.Sequential(_convolution(2, 2, 5, 5), _leaky(), CRBlock(), CRBlock(), nn.Sigmoid())
    return Autoencoder(_TwoPaths(), decoder, shape, size)


NETWORKS: Dict[str, Callable[..., Autoencoder]] = {"csinet": csinet, "crnet": crnet}


def network(name: str, size: int, shape: Tuple[int, int] = (32, 32)) -> Autoencoder:
    """Returns a network by its name in NETWORKS. Raises Error for another name."""
    if name not in NETWORKS:
        raise Error(f"network: expected one of {', '.join(NETWORKS)}, found {name!r}")
    return NETWORKS[name](size, shape)

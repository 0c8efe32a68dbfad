# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""A start for trainings that are too short for random weights: the networks begin as principal components.

The structure stays that of the papers. The encoder's dense layer starts with the components of the training
split and the decoder's with their transpose; the convolutions before and behind them start as the identity.
The pictures are positive, so that the LeakyReLUs leave them alone, and the last layers of the residual blocks
start at zero (P. Goyal et al., "Accurate, large minibatch SGD", 2017, section 5.1). A network therefore
starts with the error of the components, up to what the sigmoid changes, and what a training reaches beyond it
is what the network learned.
"""
from __future__ import annotations

import numpy as np
import torch
from torch import nn

from greatx.errors import Error

from .floors import Principal
from .models import Autoencoder, CRBlock, RefineNet

#: Derivative of the sigmoid's inverse at 0.5.
_SLOPE = 4.0


def principal_start(net: Autoencoder, principal: Principal, pictures: torch.Tensor) -> None:
    """Sets the weights of a new CsiNet or CRNet, in place.

    principal  of the training split, with at least as many components as the codeword has numbers
    pictures   some of the training split, [n, 2, angle, delay]: batch normalisations start with their mean
    """
    size = net.encoder.dense.out_features
    if len(principal.components) < size:
        raise Error(
            f"start: principal: expected training data for {size} components, found it for "
            f"{len(principal.components)}: start: random needs none"
        )
    basis = torch.from_numpy(np.ascontiguousarray(principal.components[:size]))
    refine = isinstance(net.decoder[0], RefineNet)
    with torch.no_grad():
        (_start_csinet if refine else _start_crnet)(net, pictures)
        net.encoder.dense.weight.copy_(basis)
        net.encoder.dense.bias.copy_(-0.5 * basis.sum(1))
        # CRNet's last layer is a sigmoid of what a block gives, CsiNet's a sigmoid of a convolution.
        scale, middle = (1.0, 0.5) if refine else (_SLOPE, _SLOPE / 2)
        net.dense.weight.copy_(scale * basis.T)
        net.dense.bias.fill_(middle)


def principal_restart(net: Autoencoder, principal: Principal, pictures: torch.Tensor) -> None:
    """Sets the encoder and the decoder's dense layer of a trained CsiNet to components of another domain, and
    keeps what refines the pictures."""
    size = net.encoder.dense.out_features
    basis = torch.from_numpy(np.ascontiguousarray(principal.components[:size])).to(pictures.device)
    with torch.no_grad():
        _identity(net.encoder.features[0], pictures)
        net.encoder.dense.weight.copy_(basis)
        net.encoder.dense.bias.copy_(-0.5 * basis.sum(1))
        net.dense.weight.copy_(basis.T)
        net.dense.bias.fill_(0.5)


def _start_csinet(net: Autoencoder, pictures: torch.Tensor) -> None:
    _identity(net.encoder.features[0], pictures)
    for block in net.decoder[:2]:
        block.layers[-1][1].weight.zero_()
    last = net.decoder[2]
    last.weight.copy_(_SLOPE * _delta(last))
    last.bias.fill_(-_SLOPE / 2)


def _start_crnet(net: Autoencoder, pictures: torch.Tensor) -> None:
    paths = net.encoder.features
    x = pictures
    for layer in paths.wide[::2]:
        x = _identity(layer, x)
    _identity(paths.narrow, pictures)
    merge = paths.merge[1]
    _identity(merge, torch.cat([pictures, pictures], dim=1), _delta(merge[0]) / 2)
    # The decoder's pictures are logits above zero until its last block subtracts what they were raised by.
    # The LeakyReLU behind it flattens negative logits, which the block has to learn to undo.
    _identity(net.decoder[0], _SLOPE * pictures)
    first, last = (block for block in net.decoder if isinstance(block, CRBlock))
    first.merge[1].weight.zero_()
    last.merge[1].weight.zero_()
    last.merge[1].bias.fill_(-_SLOPE / 2)


def _delta(kernel: nn.Conv2d) -> torch.Tensor:
    """Returns weights that give channel i the channels i, i + 2, ... of the input."""
    weight = torch.zeros_like(kernel.weight)
    _, _, height, width = weight.shape
    for i in range(weight.shape[1]):
        weight[i % weight.shape[0], i, height // 2, width // 2] = 1
    return weight


def _identity(layer: nn.Sequential, x: torch.Tensor, weight: torch.Tensor = None) -> torch.Tensor:
    """Sets a convolution and its batch normalisation to pass pictures on, and returns what they give."""
    kernel, norm = layer
    kernel.weight.copy_(_delta(kernel) if weight is None else weight)
    y = kernel(x)
    mean, variance = y.mean((0, 2, 3)), y.var((0, 2, 3), unbiased=False)
    norm.running_mean.copy_(mean)
    norm.running_var.copy_(variance)
    norm.weight.copy_((variance + norm.eps).sqrt())
    norm.bias.copy_(mean)
    return y

# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Networks that several tasks use, and their sizes."""
from __future__ import annotations

from typing import Dict, List

import torch
from torch import nn

from greatx.errors import Error

#: Blocks of the four stages (K. He et al., "Deep Residual Learning for Image Recognition", CVPR 2016,
#: table 1).
_BLOCKS: Dict[int, List[int]] = {18: [2, 2, 2, 2], 34: [3, 4, 6, 3]}


def resnet(depth: int, width: float, channels: int, features: int) -> nn.Module:
    """Returns a ResNet of torchvision's basic blocks, [n, channels, height, width] -> [n, features].

    depth     18 or 34
    width     factor of the numbers of channels of its stages; 1: 64, 128, 256, 512
    features  a linear layer follows if the last stage has another number of channels
    """
    from torchvision.models.resnet import BasicBlock

    if depth not in _BLOCKS:
        raise Error(f"depth: expected one of {', '.join(map(str, _BLOCKS))}, found {depth}")
    planes = [max(1, round(width * base)) for base in (64, 128, 256, 512)]
    layers: List[nn.Module] = [
        nn.Conv2d(channels, planes[0], 7, stride=2, padding=3, bias=False),
        nn.BatchNorm2d(planes[0]),
        nn.ReLU(inplace=True),
        nn.MaxPool2d(3, stride=2, padding=1),
    ]
    before = planes[0]
    for stage, (count, now) in enumerate(zip(_BLOCKS[depth], planes)):
        for block in range(count):
            stride = 2 if stage > 0 and block == 0 else 1
            down = None
            if stride != 1 or before != now:
                down = nn.Sequential(
                    nn.Conv2d(before, now, 1, stride=stride, bias=False), nn.BatchNorm2d(now)
                )
            layers.append(BasicBlock(before, now, stride, down))
            before = now
    layers += [nn.AdaptiveAvgPool2d(1), nn.Flatten()]
    if before != features:
        layers.append(nn.Linear(before, features))
    net = nn.Sequential(*layers)
    for module in net.modules():
        if isinstance(module, nn.Conv2d):
            nn.init.kaiming_normal_(module.weight, mode="fan_out", nonlinearity="relu")
    return net


def parameters(model: nn.Module) -> int:
    """Returns the number of parameters that are trained."""
    return sum(p.numel() for p in model.parameters() if p.requires_grad)


def macs(model: nn.Module, *inputs) -> int:
    """Returns the multiply-adds of the convolutions and linear layers of a forward pass of `inputs`, divided
    by the length of their first axis, so that they are those of one item."""
    total = [0]

    def count(module, _, output):
        if isinstance(module, (nn.Conv1d, nn.Conv2d)):
            total[0] += output.numel() * module.weight[0].numel()
        elif isinstance(module, nn.Linear):
            total[0] += output.numel() * module.in_features

    hooks = [m.register_forward_hook(count) for m in model.modules()]
    training = model.training
    model.eval()
    try:
        with torch.no_grad():
            model(*inputs)
    finally:
        model.train(training)
        for hook in hooks:
            hook.remove()
    first = next(iter(inputs[0].values())) if isinstance(inputs[0], dict) else inputs[0]
    return total[0] // len(first)

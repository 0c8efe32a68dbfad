# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Recovers the materials of the embedded room from channels that were measured in it (docs/gradients.md).

    PYTHONPATH=build/release/python python3 python/examples/calibrate_materials.py

The measurement is synthetic: the channel with the true materials. The search starts a third away. A wall of
30 cm echoes within itself, so that the misfit ripples with the permittivity: a coarse scan leads into the
right basin. From there Gauss-Newton goes on with exact derivatives, and torch.optim if torch is installed.
"""
import itertools

import numpy as np

import greatx

# %% Eight places in the room measure a base station
greatx.print_errors_plainly()
places = np.array([[x, y, z] for x in (-3.1, 0.4, 2.7, 4.6) for y, z in ((-2.3, 1.4), (1.7, 0.9))])
paths = greatx.Simulation("room").paths("csi", receivers=places, array=greatx.Array(polarization="vh"))
names = [f"material:{m}.{p}" for m in ("blind_plaster", "concrete") for p in ("permittivity", "conductivity")]
true = np.array([3.4, 0.022, 6.1, 0.16])
measured = paths.cfr(parameters=dict(zip(names, true)))
scale = np.linalg.norm(measured)
print(f"{len(paths)} paths to {len(places)} places; measured H {measured.shape}")


# %% The search is over the logarithms: all of the values are positive, and their steps are relative
def values(x):
    return dict(zip(names, np.exp(x)))


def residual(x):
    return (paths.cfr(parameters=values(x)) - measured).ravel() / scale


def report(way, x):
    error = np.abs(np.exp(x) / true - 1).max()
    print(f"{way}: misfit {np.linalg.norm(residual(x)):.1e}, largest error of a value {error:.1e}")
    return error


start = np.log([float(paths.parameters()[name]) for name in names])
report("start", start)

# %% The scan: 13 values of each permittivity within a factor of 1.5
scan = np.log(np.geomspace(1 / 1.5, 1.5, 13))
tried = [start + [a, 0, b, 0] for a, b in itertools.product(scan, scan)]
start = min(tried, key=lambda x: np.linalg.norm(residual(x)))
report("scan", start)

# %% Gauss-Newton: the Jacobian is exact, so a few steps suffice
x, step, steps = start.copy(), np.ones(4), 0
while np.abs(step).max() > 1e-9 and steps < 30:
    slopes = paths.jacobian(names, parameters=values(x)).values.reshape(-1, 4) * np.exp(x) / scale
    parts = [np.concatenate([a.real, a.imag]) for a in (slopes, residual(x))]
    step = -np.linalg.lstsq(*parts, rcond=None)[0]
    x, steps = x + np.clip(step, -0.2, 0.2), steps + 1
assert report(f"Gauss-Newton, {steps} steps", x) < 1e-3

# %% The same by PyTorch: H is a tensor, and backward() asks the engine for the gradient
try:
    import torch
except ImportError:
    print("no torch")
    raise SystemExit from None
x, target = torch.tensor(start, requires_grad=True), torch.from_numpy(measured)
optimizer = torch.optim.LBFGS([x], max_iter=100, tolerance_change=1e-16, line_search_fn="strong_wolfe")


def closure():
    optimizer.zero_grad()
    loss = (paths.cfr(parameters=dict(zip(names, x.exp()))) - target).abs().square().sum() / scale**2
    loss.backward()
    return loss


optimizer.step(closure)
assert report("torch.optim.LBFGS", x.detach().numpy()) < 1e-3

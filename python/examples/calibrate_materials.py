# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Recovers the materials of the embedded room from channels that were measured in it (docs/gradients.md).

    PYTHONPATH=build/release/python python3 python/examples/calibrate_materials.py

The measurement is synthetic: the channel with the true materials. The search starts from the scenario's
own, a third away. A wall of 30 cm echoes within itself, so that the misfit ripples with the permittivity: a
coarse scan of both permittivities leads into the right basin. From there Gauss-Newton goes on with exact
derivatives, and torch.optim does if torch is installed.
"""

import itertools

import numpy as np

import greatx

# %% Eight places in the room measure a base station
greatx.print_errors_plainly()
sim = greatx.Simulation("room")
places = np.array([[x, y, z] for x in (-3.1, 0.4, 2.7, 4.6) for y, z in ((-2.3, 1.4), (1.7, 0.9))])
paths = sim.paths("csi", receivers=places, array=greatx.Array(polarization="vh"))
true = {
    "material:blind_plaster.permittivity": 3.4,
    "material:blind_plaster.conductivity": 0.022,
    "material:concrete.permittivity": 6.1,
    "material:concrete.conductivity": 0.16,
}
names = list(true)
measured = paths.cfr(parameters=true)
print(f"{len(paths)} paths to {len(places)} places; measured H {measured.shape}")

# %% The search is over the logarithms: all of the values are positive, and their steps are relative
known = paths.parameters()
start = np.log([float(known[name]) for name in names])
truth = np.log(list(true.values()))


def values(x):
    return dict(zip(names, np.exp(x)))


def residual(x):
    return (paths.cfr(parameters=values(x)) - measured).ravel() / np.linalg.norm(measured)


def report(way, x):
    error = np.abs(np.exp(x - truth) - 1)
    print(f"{way}: misfit {np.linalg.norm(residual(x)):.1e}, largest error of a value {error.max():.1e}")
    assert error.max() < 1e-3


print(
    f"start: misfit {np.linalg.norm(residual(start)):.2f}, "
    f"largest error {np.expm1(np.abs(start - truth)).max():.2f}"
)

# %% The scan: 13 values of each permittivity within a factor of 1.5
scan = np.log(np.geomspace(1 / 1.5, 1.5, 13))
tried = [start + [a, 0, b, 0] for a, b in itertools.product(scan, scan)]
start = min(tried, key=lambda x: np.linalg.norm(residual(x)))
print(f"scan: misfit {np.linalg.norm(residual(start)):.3f}, permittivities {np.round(np.exp(start[::2]), 2)}")

# %% Gauss-Newton by Levenberg and Marquardt: the Jacobian is exact, so a few steps suffice
x, damping, steps = start.copy(), 1e-2, 0
now = residual(x)
while steps < 30 and np.linalg.norm(now) > 1e-10:
    columns = paths.jacobian(names, parameters=values(x)).values.reshape(-1, len(names))
    columns = columns * np.exp(x) / np.linalg.norm(measured)
    a = np.concatenate([columns.real, columns.imag])
    b = np.concatenate([now.real, now.imag])
    normal = a.T @ a
    step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), -a.T @ b)
    after = residual(x + step)
    better = np.linalg.norm(after) < np.linalg.norm(now)
    if better:
        x, now = x + step, after
    damping *= 0.2 if better else 5
    steps += 1
report(f"Gauss-Newton, {steps} steps", x)

# %% The same by PyTorch: H is a tensor, and backward() asks the engine for the gradient
try:
    import torch
except ImportError:
    print("no torch")
else:
    x = torch.tensor(start, requires_grad=True)
    target = torch.from_numpy(measured)
    optimizer = torch.optim.LBFGS(
        [x], max_iter=100, tolerance_grad=1e-14, tolerance_change=1e-16, line_search_fn="strong_wolfe"
    )

    def closure():
        optimizer.zero_grad()
        h = paths.cfr(parameters=dict(zip(names, x.exp())))
        loss = (h - target).abs().square().sum() / target.abs().square().sum()
        loss.backward()
        return loss

    optimizer.step(closure)
    report(f"torch.optim.LBFGS, {optimizer.state[x]['func_evals']} evaluations", x.detach().numpy())

# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Learns the base station's best beam from its depth pictures; docs/tutorial.md explains every step.

    greatx generate assets/examples/tutorial.yaml -o street
    python3 python/examples/tutorial.py street

The pictures come from a camera on the mast, the best beam from the channel matrix of the same tick. Every
fourth drive is held out: the network never sees a tick of it.
"""
import sys

import greatx

try:
    import torch
    from torch import nn
except ImportError:
    print("this example needs PyTorch: pip install torch")
    sys.exit(0)

torch.manual_seed(1)

# %% Load: one item for every tick at which all three sensors have a record
ds = greatx.load(sys.argv[1])
data = ds.torch(["bs/view/depth", "csi/cfr", "poses/position"])
items = [data[i] for i in range(len(data))]
sequence = torch.tensor([item["sequence"] for item in items])
depth = torch.stack([item["bs/view/depth"] for item in items])     # metres [tick, row, column]
h = torch.stack([item["csi/cfr"] for item in items])      # [tick, rx, rx_ant, tx, tx_ant, time, subcarrier]
shapes = f"depth {list(depth.shape[1:])}, H {list(h.shape[1:])}"
print(f"{len(items)} ticks of {len(ds.sequences)} drives, {shapes}")

# %% The task: find the array's DFT beam with the most power, averaged over the subcarriers
h = h[:, 0, 0, 0, :, 0]                                            # [tick, tx_ant, subcarrier]
power = torch.fft.fftshift(torch.fft.fft(h, dim=1).abs().square().mean(-1), dim=1)      # [tick, beam]
best = power.argmax(1)

# %% The input: the decrease of depth against the empty street, the median picture of the training drives
held_out = sequence % 4 == 3
empty = depth[~held_out].median(0).values
nearer = (empty - depth).nan_to_num(0).clamp(0, 10)      # metres; the sky is at infinity, inf - inf is nan
pictures = nn.functional.max_pool2d(nearer[:, None], 4)              # [tick, 1, row / 4, column / 4]

# %% Print the scores on the held-out drives
def report(name, beam):
    chosen = power[held_out].gather(1, beam[:, None])[:, 0]
    loss_db = 10 * torch.log10(power[held_out].max(1).values / chosen)
    off = (beam - best[held_out]).abs()
    print(f"{name:16} best beam {100 * (off == 0).float().mean():5.1f} %, within one beam "
          f"{100 * (off <= 1).float().mean():5.1f} %, loss {loss_db.mean():5.2f} dB")


report("always the same", best[~held_out].mode().values.expand(int(held_out.sum())))

# %% For comparison: the beam of the car's true direction. The array's axis points to the south-east
car = torch.stack([item["poses/position"][1] for item in items]) + torch.tensor([0, 0, 1.6])
to_car = car - torch.tensor([13 - 2 ** 0.5, 13 - 2 ** 0.5, 25])
sine = (to_car @ to_car.new_tensor([0.5 ** 0.5, -(0.5 ** 0.5), 0])) / to_car.norm(dim=1)
report("true position", (16 * sine).round().long()[held_out] + 16)

# %% A small convolutional network, and its training
model = nn.Sequential(nn.Conv2d(1, 16, 3, padding=1), nn.ReLU(), nn.MaxPool2d(2),
                      nn.Conv2d(16, 32, 3, padding=1), nn.ReLU(), nn.MaxPool2d((2, 1)),
                      nn.Flatten(), nn.Dropout(0.5), nn.LazyLinear(power.shape[1]))
model(pictures[:1])                                                # sets the size of the lazy layer
optimizer = torch.optim.Adam(model.parameters(), lr=1e-3)
training = torch.utils.data.TensorDataset(pictures[~held_out], best[~held_out])
for epoch in range(15):
    model.train()
    for x, y in torch.utils.data.DataLoader(training, batch_size=32, shuffle=True):
        loss = nn.functional.cross_entropy(model(x), y)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
    if epoch % 5 == 4:
        model.eval()
        with torch.no_grad():
            report(f"epoch {epoch + 1}", model(pictures[held_out]).argmax(1))

# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Learns to remove noise from channel estimates by a torch Dataset, a DataLoader and one weight per delay.

    greatx generate room -o out/room
    python3 python/examples/train_torch.py out/room

The model weights every delay. It learns which delays hold the channel and which hold only noise.
"""
import sys

import greatx

try:
    import torch
except ImportError:
    print("this example needs PyTorch: pip install torch")
    sys.exit(0)

SNR_DB = 5.0


def links(item):
    """Returns complex64 [links, subcarrier] of unit mean power: all port pairs of a tick's first receiver and
    first transmitter."""
    h = item[name][0, :, 0].flatten(0, -2)
    return h / h.abs().square().mean().sqrt().clamp_min(1e-20)


# %% Load one item for each tick at which the channel has a record, complex64 as on disk
greatx.print_errors_plainly()
if len(sys.argv) != 2:
    sys.exit(__doc__)
ds = greatx.load(sys.argv[1])
name = ds.sequences[0].first("csi", ["cfr"]).name + "/cfr"
data = ds.torch(name, transform=links)
print(data.samples)

# %% Hold out every fifth tick, and train on the others
torch.manual_seed(1)
held_out = torch.stack([data[i] for i in range(4, len(data), 5)] or [data[len(data) - 1]])
training = torch.utils.data.Subset(data, [i for i in range(len(data)) if i % 5 != 4])
loader = torch.utils.data.DataLoader(training, batch_size=8, shuffle=True)  # any num_workers works


class DelayFilter(torch.nn.Module):
    """Multiplies every delay by a real weight from 0 to 1."""

    def __init__(self, subcarriers):
        super().__init__()
        self.logits = torch.nn.Parameter(torch.zeros(subcarriers))

    def forward(self, h):
        return torch.fft.fft(torch.fft.ifft(h) * torch.sigmoid(self.logits))


def noisy(h):
    return h + 10 ** (-SNR_DB / 20) * torch.randn_like(h)


def nmse(guess, h):
    return (guess - h).abs().square().mean() / h.abs().square().mean()


# %% Train with new noise at every step
model = DelayFilter(held_out.shape[-1])
optimizer = torch.optim.Adam(model.parameters(), lr=0.1)
test = noisy(held_out)
print(f"as estimated: {10 * torch.log10(nmse(test, held_out)):6.2f} dB")
for epoch in range(40):
    for h in loader:
        loss = nmse(model(noisy(h)), h)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
    if epoch % 10 == 9:
        with torch.no_grad():
            error = nmse(model(test), held_out)
        print(f"epoch {epoch + 1:3}:    {10 * torch.log10(error):6.2f} dB on ticks it never saw")

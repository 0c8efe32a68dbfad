# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""CSI feedback: networks that compress a channel over angle and delay (docs/learning.md).

Data flow: make (greatx), make_sionna (Sionna RT), impair, dichasus (measurements) -> sets -> experiment
(floors, models, transfer) -> report.
"""

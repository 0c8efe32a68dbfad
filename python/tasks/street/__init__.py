# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What the tasks of the campaign `street` share: a base station beside a street with cameras, a LiDAR and a
radar, and a car with an antenna (assets/campaigns/street.yaml).

Data flow: a campaign or a data set -> drives (its sequences and ticks) -> inputs (arrays for networks, made
once) and geometry (what the true poses say) -> networks.
"""

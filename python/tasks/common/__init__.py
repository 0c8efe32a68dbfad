# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""What all tasks share: configurations, the training loop, splits, statistics, networks, pictures, reports.

Data flow: command -> config -> (the task: data, splits, models) -> training.fit -> statistics -> plots and
report.
"""

# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Networks that learn from data of greatx (docs/learning.md).

Each folder is a task, which is run as `python3 python/tasks/NAME`. `common` has what the tasks share, and
knows none of them.
"""

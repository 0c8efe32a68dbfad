# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the package in the source folder, without the compiled module."""
import importlib.util
import unittest

import greatx


class Package(unittest.TestCase):
    def test_names(self):
        for name in greatx.__all__:
            self.assertTrue(hasattr(greatx, name), name)
        self.assertIn("Simulation", dir(greatx))
        with self.assertRaises(AttributeError):
            greatx.no_such_name

    def test_without_the_compiled_module(self):
        if importlib.util.find_spec("greatx._native") is not None:
            self.skipTest("it is here")
        with self.assertRaisesRegex(ImportError, "pip install ./python"):
            greatx.Simulation
        self.assertTrue(issubclass(greatx.DatasetError, greatx.Error))


if __name__ == "__main__":
    unittest.main()

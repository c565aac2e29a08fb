#!/usr/bin/env python3
"""Runs all tests of this folder; the last line says how many passed and failed."""
import os
import sys
import unittest

here = os.path.dirname(os.path.abspath(__file__))
result = unittest.TextTestRunner().run(unittest.defaultTestLoader.discover(here, "test_*.py"))
failed = len(result.failures) + len(result.errors)
print(f"{result.testsRun - failed} passed, {failed} failed")
sys.exit(failed > 0)

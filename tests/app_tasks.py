"""What the worker of the app is given in tests: functions that need next to no imports."""

from __future__ import annotations

import time

from epicyclic.errors import InputError, Problem


def doubled(value, progress):
    progress(1, 3)
    return 2 * value


def endless(progress):
    progress(0, 7)
    time.sleep(600)


def refused(progress):
    raise InputError([Problem("sun.teeth", "3", "is too few.", "Give more.")], "the test")


def broken(progress):
    raise ZeroDivisionError("no number")

"""Each case runs once per session; the tests assert many things about it."""

from functools import cache

import bars
import cylinders
import pytest


@pytest.fixture(scope="session")
def bars_run():
    return cache(bars.run)


@pytest.fixture(scope="session")
def cylinders_run():
    return cache(cylinders.run)

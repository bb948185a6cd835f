import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[4]

sys.path[:0] = [str(ROOT / "benchmarks"), str(ROOT / "tests" / "validation")]


@pytest.fixture(autouse=True)
def whatever_is_installed(monkeypatch):
    """These tests measure nothing of carom."""
    monkeypatch.setattr("claims.__main__.refuse_another_carom", lambda: None)

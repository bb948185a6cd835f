"""What tests of audits share."""

import pytest


@pytest.fixture(scope="module")
def without_pictures():
    """Drawing takes longer than these runs."""
    patch = pytest.MonkeyPatch()
    patch.setattr("carom.plot.draw", lambda _: [])
    yield
    patch.undo()

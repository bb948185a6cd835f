import pytest

from carom.display.si_prefix import prefixed


@pytest.mark.parametrize(
    ("unit", "largest", "shown"),
    [
        ("Pa", 3.6e8, ("MPa", 1e6)),
        ("Pa", 999.0, ("Pa", 1.0)),
        ("Pa", 1000.0, ("kPa", 1e3)),
        ("m", 0.2, ("m", 1.0)),
        ("m", 0.02, ("mm", 1e-3)),
        ("J", 2e-7, ("nJ", 1e-9)),
        ("J", 1e-30, ("pJ", 1e-12)),
        ("", 1e8, ("", 1.0)),
        ("J", 0.0, ("J", 1.0)),
        ("J", float("nan"), ("J", 1.0)),
    ],
)
def test_numbers_are_short_in_the_unit(unit, largest, shown):
    assert prefixed(unit, largest) == shown

import math

import pytest

from carom.display.time_unit import LEAST, UNITS, time_unit


@pytest.mark.parametrize("unit", UNITS)
def test_a_run_is_told_in_the_unit_of_which_it_lasts_a_tenth_or_more(unit):
    assert time_unit(LEAST * unit.seconds) == unit
    assert time_unit(50 * unit.seconds) == unit


def test_hours_stay_seconds_and_what_is_shorter_than_any_unit_has_the_last():
    assert time_unit(7200.0).symbol == "s"
    assert time_unit(1e-20) == UNITS[-1]


@pytest.mark.parametrize("longest", [0.0, math.nan, math.inf, -1.0])
def test_where_nothing_lasts_times_are_seconds(longest):
    assert time_unit(longest).symbol == "s"


def test_a_time_is_written_in_its_unit():
    assert time_unit(6e-5).text(1.23456e-5, 3) == "12.3 µs"

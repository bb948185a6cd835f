"""Which frame a picture of a film shows, and how fast time is said to run."""

import numpy as np
import pytest

from carom.errors import InputError
from carom.view.pace import pace, said

TIMES = np.linspace(0.0, 15.0, 301)


def test_without_a_wish_every_frame_is_shown_once():
    run = pace(TIMES)
    np.testing.assert_array_equal(run.frames, np.arange(301))
    assert run.rate == 25.0
    assert run.text(7) == "1.25 × real time"


def test_a_speed_chooses_the_rate_that_shows_every_frame_once():
    run = pace(TIMES, speed=1.0)
    np.testing.assert_array_equal(run.frames, np.arange(301))
    assert run.rate == pytest.approx(20.0)
    assert run.text(0) == "real time"


def test_a_duration_is_the_films_length():
    run = pace(TIMES, duration=3.0)
    assert len(run.frames) / run.rate == pytest.approx(3.0, abs=0.1)
    assert run.rate <= 60.0
    assert (run.frames[0], run.frames[-1]) == (0, 300)
    assert run.text(0) == "5 × real time"


def test_pictures_show_the_nearest_frame_where_frames_are_uneven():
    times = np.array([0.0, 0.1, 0.2, 1.0])
    run = pace(times, duration=1.0, rate=10.0)
    np.testing.assert_array_equal(run.frames, [0, 1, 2, 2, 2, 2, 2, 3, 3, 3, 3])


def test_a_part_is_shown():
    run = pace(TIMES, between=(2.5, 3.0))
    np.testing.assert_allclose(TIMES[run.frames], np.linspace(2.5, 3.0, 11))


def test_a_single_frame_is_a_film_of_one_picture():
    run = pace(np.array([0.0]), duration=2.0)
    assert run.frames.tolist() == [0]
    assert run.text(0) == ""


def test_stages_of_other_speeds_are_told_apart():
    preload, impact = np.linspace(0.0, 1.0, 11), 1.0 + np.linspace(1e-6, 1e-5, 10)
    run = pace(np.concatenate([preload, impact]))
    assert run.text(2) == "2.5 × real time"
    assert run.text(15) == "slow motion 1 : 40\u202f000"


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (1.01, "real time"),
        (0.05, "slow motion 1 : 20"),
        (2.7e-5, "slow motion 1 : 37\u202f000"),
        (0.4, "slow motion 1 : 2.5"),
        (0.0, ""),
        (float("nan"), ""),
    ],
)
def test_the_pace_is_told_in_words(seconds, words):
    assert said(seconds) == words


@pytest.mark.parametrize(
    ("wish", "message"),
    [
        ({"rate": 0.0}, "--fps 0: must be 0.02 to 1000 pictures per second"),
        ({"rate": 1e-9}, "--fps 1e-09: must be 0.02 to 1000 pictures per second"),
        ({"rate": np.nan}, "--fps nan: must be 0.02"),
        ({"speed": 5e-324}, "the film would have inf pictures, and 20000 at most can be"),
        ({"duration": 1e308}, "the film would have 5e"),
        ({"duration": -1.0}, "--duration -1: must be"),
        ({"speed": float("nan")}, "--speed nan: must be"),
        ({"speed": 1.0, "duration": 1.0}, "give one of them"),
        ({"between": (20.0, 30.0)}, "whose times are from 0 to 15 s, at most 0.05 s apart"),
        ({"between": (1.0, 0.5)}, "--between 1 0.5: give START END in seconds, END not less than"),
        ({"between": (np.nan, 0.5)}, "--between nan 0.5: give START END in seconds"),
        ({"speed": 1e-9, "rate": 25.0}, "20000 at most can be"),
    ],
)
def test_what_cannot_be_is_refused(wish, message):
    with pytest.raises(InputError, match=message.replace("--", "(--)?")):
        pace(TIMES, **wish)

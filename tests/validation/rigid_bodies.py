"""Rigid bodies that several tests throw, press and turn."""

import numpy as np

import carom

AXES = "xyz"


def run(tmp_path, scenario):
    """Run a scenario into a directory of its own."""
    number = sum(1 for _ in tmp_path.iterdir()) if tmp_path.exists() else 0
    return carom.run(scenario, out=tmp_path / str(number))


def flying(body, *, dimension, end_time, time_step, rows=20, track=None, **other):
    """A body that nothing touches."""
    tip = [] if track is None else [carom.Track(name="tip", body=body.name, point=track)]
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=end_time,
            time_step=time_step,
            scheme=other.pop("scheme", carom.Conserving()),
            gravity=other.pop("gravity", None),
        ),
        bodies=[body],
        output=carom.Output(
            history_every=max(end_time / rows, time_step),
            fields_every=max(end_time, time_step),
            track=tip,
        ),
        **other,
    )


def column(history, *names):
    """Columns of the history beside one another, shape [rows, columns]."""
    return np.stack([np.asarray(history[name]) for name in names], axis=-1)


def spin(history, name):
    """The angular velocity of a body over time."""
    return column(history, *(f"{name}.spin_{axis}" for axis in AXES))


def angular_momentum(history):
    """That of the model over time."""
    return column(history, *(f"angular_momentum_{axis}" for axis in AXES))

"""What tests of checkpoints share: a case, a process of its own for it, and a comparison."""

import json
import multiprocessing

import h5py
import numpy as np

import carom

CASE = {
    "title": "Restart",
    "analysis": {"end_time": 0.15, "time_step": 2e-3, "scheme": {"kind": "conserving"}},
    "output": {
        "history_every": 4e-3,
        "fields_every": 2.5e-2,
        "checkpoint_every": 2e-2,
        "audit": True,
        "track": [{"name": "tip", "body": "left", "point": [1.0, 1.06]}],
    },
    "materials": {
        "elastic": {
            "kind": "saint-venant-kirchhoff",
            "young": 2700.0,
            "poisson": 0.33,
            "density": 1.0,
        }
    },
    "bodies": [
        {
            "name": name,
            "material": "elastic",
            "mesh": {"kind": "disc", "centre": centre, "radius": 1.0, "divisions": 4},
            "velocity": velocity,
            "spin": spin,
        }
        for name, centre, velocity, spin in (
            ("left", [0.0, 1.06], [1.5, -1.0], 4.0),
            ("right", [2.05, 1.4], [-0.5, -2.0], 0.0),
        )
    ],
    "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}],
    "contact": {"friction": 0.3},
}
"""Two discs that meet above a floor and hit it; 75 steps, 7 checkpoints, 7 frames."""


def scenario(*overrides):
    return carom.Scenario.from_dict(CASE).with_overrides(overrides)


def started(function, *arguments):
    """Start a function in a process of its own, which has imported all there is to import."""
    process = multiprocessing.get_context("fork").Process(target=function, args=arguments)
    process.start()
    return process


def numbers(directory):
    """All that a run has written, as it must be the same in two runs."""
    summary = json.loads((directory / "summary.json").read_text())
    for key in ("wall_s", "wall_s_per_step"):
        del summary[key]
    # A checkpoint that was damaged is told of, and changes nothing.
    told = [one for one in summary["warnings"] if not one["code"].startswith("checkpoint-")]
    summary["warnings"] = told
    arrays = {}
    for name in ("fields.vtkhdf", "surface.vtkhdf", "audit.h5"):
        if not (directory / name).exists():
            continue
        with h5py.File(directory / name, "r") as file:
            file.visititems(
                lambda key, entry, file=name: arrays.update(
                    {f"{file}:{key}": entry[()]} if isinstance(entry, h5py.Dataset) else {},
                    **{f"{file}:{key}@{a}": value for a, value in entry.attrs.items()},
                )
            )
    texts = {
        name: (directory / name).read_bytes() for name in ("history.csv", "ledger.csv", "case.toml")
    }
    return summary, texts, arrays


def assert_same_results(directory, reference):
    summary, texts, arrays = numbers(directory)
    expected_summary, expected_texts, expected_arrays = numbers(reference)
    assert summary == expected_summary
    for name, text in expected_texts.items():
        assert texts[name] == text, name
    assert arrays.keys() == expected_arrays.keys()
    for name, array in expected_arrays.items():
        np.testing.assert_array_equal(arrays[name], array, err_msg=name, strict=True)
    assert sorted(p.name for p in directory.iterdir()) == sorted(
        p.name for p in reference.iterdir()
    )

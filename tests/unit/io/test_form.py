"""Files of the right name with the wrong content are refused, and what is wrong is named."""

import json
from typing import Literal

import h5py
import numpy as np
import pytest
from typing_extensions import NotRequired, TypedDict

import carom
from carom import InputError
from carom.io.checkpoint import DamagedError, read_checkpoint, signed
from carom.io.form import misfit
from carom.io.ledger import read_ledger
from carom.io.summary import read_summary
from restarting import scenario


class Pair(TypedDict):
    names: list[str]


class Form(TypedDict):
    time: float
    gap: float | None
    pairs: list[Pair]
    reason: NotRequired[str]
    end: NotRequired[Literal["good", "bad"]]
    counts: NotRequired[dict[str, int]]


@pytest.mark.parametrize(
    ("value", "wrong"),
    [
        ({"time": 1, "gap": None, "pairs": [{"names": ["a", "b"]}], "more": 0}, None),
        ([], "it is no table"),
        ({"time": 1.0, "gap": 0.5}, "pairs is missing"),
        ({"time": None, "gap": 0.5, "pairs": []}, "time is None"),
        ({"time": 1.0, "gap": 0.5, "pairs": {}}, "pairs is no list"),
        ({"time": 1.0, "gap": 0.5, "pairs": [{"names": [1]}]}, "pairs.0.names.0 is 1"),
        ({"time": 1.0, "gap": "x", "pairs": []}, "gap is 'x'"),
        ({"time": 1.0, "gap": 0.5, "pairs": [], "reason": 3}, "reason is 3"),
        ({"time": 1.0, "gap": 0.5, "pairs": [], "end": "ugly"}, "end is 'ugly'"),
        ({"time": 1.0, "gap": 0.5, "pairs": [], "counts": {"a": 0.5}}, "counts.a is 0.5"),
    ],
)
def test_what_does_not_fit_is_named(value, wrong):
    assert misfit(value, Form) == wrong


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """The results of a run that was stopped, with its checkpoint."""

    def stop(state):
        if state.time > 0.05:
            raise carom.Stop

    directory = tmp_path_factory.mktemp("results")
    carom.run(scenario(), out=directory, observers=[carom.Observer(stop)])
    return directory


def test_what_a_run_wrote_is_read(results):
    assert read_summary(results / "summary.json")["status"] == "stopped"
    assert set(read_ledger(results / "ledger.csv")) > {"left", "right"}
    assert read_checkpoint(results / "checkpoint.h5").time > 0.05


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"status": ', "not JSON"),
        ("[1, 2]", "not a summary of carom: it is no table"),
        ('{"status": "completed"}', r"not a summary of carom: \w+ is missing"),
    ],
)
def test_a_summary_of_another_form_is_refused(tmp_path, text, message):
    path = tmp_path / "summary.json"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_summary(path)


@pytest.mark.parametrize("key", ["energy", "certificate", "contacts", "steps"])
def test_a_summary_without_a_part_is_refused(results, tmp_path, key):
    summary = json.loads((results / "summary.json").read_text())
    summary[key] = "x"
    (tmp_path / "summary.json").write_text(json.dumps(summary))
    with pytest.raises(InputError, match=f"not a summary of carom: {key} is"):
        read_summary(tmp_path / "summary.json")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"time,entry\n0.0,a\n", "it has no column"),
        (b"\xff\xfe\n", "codec"),
    ],
)
def test_a_ledger_of_another_form_is_refused(tmp_path, content, message):
    path = tmp_path / "ledger.csv"
    path.write_bytes(content)
    with pytest.raises(InputError, match=f"not a ledger of carom: .*{message}"):
        read_ledger(path)


def test_a_ledger_with_a_number_that_is_none_is_refused(results, tmp_path):
    path = tmp_path / "ledger.csv"
    path.write_text((results / "ledger.csv").read_text().replace(",0.0,", ",0.0x,", 1))
    with pytest.raises(InputError, match=r"could not convert .*0\.0x"):
        read_ledger(path)


def remove(file, name):
    del file[name]


def other_text(file, name):
    del file[name]
    file[name] = np.frombuffer(b"[]", dtype=np.uint8)


@pytest.mark.parametrize(
    ("name", "spoil"),
    [
        ("case", remove),
        ("record", remove),
        ("record", other_text),
        ("simulation", remove),
        ("simulation", other_text),
    ],
)
def test_a_checkpoint_whose_checksum_is_right_and_whose_content_is_not_is_damaged(
    results, tmp_path, name, spoil
):
    path = tmp_path / "checkpoint.h5"
    path.write_bytes((results / "checkpoint.h5").read_bytes())
    with h5py.File(path, "r+") as file:
        spoil(file, name)
    path.write_bytes(signed(path.read_bytes()))
    with pytest.raises(DamagedError, match="does not hold what a checkpoint has"):
        read_checkpoint(path)

"""Spoilt input is answered by one line and an exit status; `make validate` tries far more of it."""

import os
import random
import time
from pathlib import Path

import pytest
import typer
from fuzz import watch
from fuzz.attempt import Defect, attempt
from fuzz.mutate import spoilt_bytes, spoilt_data
from fuzz.subjects import SUBJECTS

COUNTS = {
    "tables of cases": 150,
    "text of cases": 80,
    "meshes": 120,
    "contact problems": 100,
    "checkpoints": 30,
    "results": 60,
}

EVEN_IF_SPOILT = {"results"}
"""What is read by some commands only, or tells of itself what is wrong with it."""


@pytest.mark.parametrize("subject", SUBJECTS)
def test_bad_input_is_answered(subject, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tried = SUBJECTS[subject](tmp_path)
    answers = [attempt(tried.answer, tried.spoilt(seed)) for seed in range(COUNTS[subject])]
    refused = len(answers) / (6 if subject in EVEN_IF_SPOILT else 2)
    assert answers.count("exit 2") > refused
    assert answers.count("taken") > len(answers) / 50


@pytest.mark.parametrize("subject", SUBJECTS)
def test_valid_input_is_taken(subject, tmp_path, monkeypatch):
    """What nothing was done to, or the search would search nothing."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("fuzz.subjects.spoilt_bytes", lambda content, pick: content)
    monkeypatch.setattr("fuzz.subjects.spoilt_data", lambda data, pick: None)
    monkeypatch.setattr("fuzz.subjects.spoilt_content", lambda file, pick: None)
    monkeypatch.setattr("fuzz.subjects._spoil_file", lambda file, pick: None)
    tried = SUBJECTS[subject](tmp_path)
    seeds = range(5) if subject in ("checkpoints", "results") else range(20)
    answers = {attempt(tried.answer, tried.spoilt(seed)) for seed in seeds}
    assert answers <= {"taken", "large"}


@pytest.mark.parametrize(
    "answer",
    [
        lambda _: 1 / 0,
        lambda _: typer.echo("error: two\nlines", err=True) or _exit(2),
        lambda _: typer.echo("error: a status", err=True) or _exit(1),
        lambda _: print("chatter") or typer.echo("error: x", err=True) or _exit(2),
    ],
)
def test_what_no_user_should_get_is_a_defect(answer):
    with pytest.raises(Defect):
        attempt(answer, Path("file"))


def _exit(status):
    raise typer.Exit(status)


def test_spoiling_is_the_same_for_the_same_seed():
    data = {"a": [1, 2.5, "x"], "b": {"c": True}}
    made = []
    for _ in range(2):
        spoilt = {"a": list(data["a"]), "b": dict(data["b"])}
        spoilt_data(spoilt, random.Random(3))
        made.append((repr(spoilt), spoilt_bytes(b"some = 1\n" * 9, random.Random(3))))
    assert made[0] == made[1]
    assert made[0] != (repr(data), b"some = 1\n" * 9)


@pytest.mark.parametrize("end", ["hang", "die"])
def test_a_process_that_hangs_or_dies_is_a_defect_and_the_search_goes_on(monkeypatch, end):
    class Trap:
        def __init__(self, folder):
            pass

        def spoilt(self, seed):
            return seed

        def answer(self, seed):
            if seed == 2:
                time.sleep(60) if end == "hang" else os._exit(9)
            return "taken"

    monkeypatch.setitem(SUBJECTS, "trap", Trap)
    monkeypatch.setattr(watch, "PATIENCE", 1.5)
    monkeypatch.setattr(watch, "REPORT", 1)
    tally = watch.search("trap", range(5))
    assert list(tally.defects) == [2]
    assert set(tally.outcomes) == {"taken"}
    assert 2 <= tally.outcomes["taken"] <= 4  # what a process has not said before it dies is lost

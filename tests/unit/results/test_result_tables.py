"""The tables of a run as data frames."""

from pathlib import Path

import numpy as np
import pytest

from carom import InputError
from carom.running.run import drive
from stand_in import FallingSimulation


def test_the_history_is_by_time(impact):
    history = impact.to_pandas()
    assert history.index.name == "time"
    np.testing.assert_array_equal(history.index, impact.history["time"])
    np.testing.assert_array_equal(history["left.spin"], impact.history["left.spin"])


def test_the_ledger_is_by_entry_and_time(impact):
    ledger = impact.to_pandas("ledger")
    books = impact.ledger["left|right"]
    pair = ledger.loc["left|right"]
    np.testing.assert_array_equal(pair.index, books["time"])
    np.testing.assert_array_equal(pair["friction"], books["friction"])
    last = ledger.xs(impact.history["time"][-1], level="time")
    assert last["friction"].sum() == pytest.approx(impact.summary["energy"]["friction"])


def test_contact_events_are_rows(impact):
    contacts, events = impact.to_pandas("contacts"), impact.summary["contacts"]
    assert len(contacts) == len(events) > 1
    assert [[row.first, row.second] for row in contacts.itertuples()] == [e["pair"] for e in events]
    assert contacts["peak_force"].tolist() == [event["peak_force"] for event in events]
    open_ended = [event["release"] is None for event in events]
    assert contacts["release"].isna().tolist() == open_ended


def test_bodies_and_pairs_have_their_books(impact):
    bodies, pairs = impact.to_pandas("bodies"), impact.to_pandas("pairs")
    assert list(bodies.index) == ["left", "right"]
    change = impact.summary["energy"]["final"] - impact.summary["energy"]["initial"]
    assert (bodies["kinetic"] + bodies["strain"]).sum() == pytest.approx(change)
    assert pairs["friction"].sum() == pytest.approx(impact.summary["energy"]["friction"])
    assert ("left", "floor") in pairs.index


def test_a_run_without_contact_has_an_empty_table(scenario, tmp_path):
    result = drive(FallingSimulation(scenario), scenario, tmp_path)
    result.summary["contacts"].clear()
    contacts = result.to_pandas("contacts")
    assert len(contacts) == 0
    assert contacts["peak_force"].sum() == 0.0


def test_a_result_stands_for_its_directory(impact):
    assert Path(impact) == impact.path


def test_another_table_is_refused(impact):
    with pytest.raises(InputError, match=r"contact: no such table.*contacts"):
        impact.to_pandas("contact")

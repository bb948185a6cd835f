"""What ranks are asked for, by an engine of one of them: nothing is missing from its sums."""

import cases
import numpy as np
import pytest
import typer
from one_rank import OneRank

import carom
from carom.building.build import build
from carom.cli.together import together
from carom.ranks import engine_named
from carom.running.run import drive


def driven(scenario, out):
    engine = OneRank()
    result = drive(build(scenario, engine=engine), scenario, out, engine=engine)
    assert engine.summed > 50
    return result


@pytest.mark.parametrize("case", [cases.discs, cases.ball, cases.pressed, cases.squeezed])
def test_one_rank_makes_the_run_of_a_process(tmp_path, case):
    alone = carom.run(case(), out=tmp_path / "alone")
    shared = driven(case(), tmp_path / "shared")
    a, b = alone.summary, shared.summary
    assert a["status"] == b["status"] == "completed"
    scale = max(abs(a["energy"]["initial"]), abs(a["energy"]["final"]))
    for name, value in a["energy"].items():
        assert b["energy"][name] == pytest.approx(value, abs=1e-10 * scale), name
    assert [event["pair"] for event in a["contacts"]] == [event["pair"] for event in b["contacts"]]
    for name in ("displacement", "stress"):
        one, other = (r.fields[name][-1] for r in (alone, shared))
        assert np.abs(one - other).max() <= 1e-7 * np.abs(one).max(), name


def test_modes_of_shared_bodies_are_refused():
    with pytest.raises(carom.InputError, match="ranks have no modes of the bodies"):
        build(cases.discs(output={"modes": 5}), engine=OneRank())


def test_a_rank_has_one_thread(capsys):
    with pytest.raises(typer.Exit), together("petsc", threads=4):
        pass
    assert "each rank has one thread" in capsys.readouterr().err


def test_an_engine_that_fails_is_told(tmp_path):
    class Broken(OneRank):
        def share(self, body, nodes, blocks):
            raise RuntimeError("no such body here")

    with pytest.raises(RuntimeError, match="no such body here"):
        build(cases.discs(), engine=Broken())


def periodic():
    layer = {"kind": "rectangle", "corner": [0, 1], "size": [1, 1], "divisions": [3, 2]}
    mesh = {**layer, "periodic": True}
    return cases.discs(bodies=[{"name": "a", "material": "m", "velocity": [1, 0], "mesh": mesh}])


def flowing():
    flows = {"kind": "j2-plasticity", "young": 2e4, "poisson": 0.3, "yield_stress": 50.0}
    return cases.discs(materials={"m": {**flows, "density": 10.0, "hardening": 100.0}})


@pytest.mark.parametrize("case", [periodic, flowing])
def test_what_ranks_cannot_share_each_has_whole(tmp_path, case):
    engine = OneRank()
    shared = drive(build(case(), engine=engine), case(), tmp_path / "whole", engine=engine)
    assert engine.summed == 0
    assert shared.summary["energy"] == carom.run(case(), out=tmp_path / "alone").summary["energy"]


def test_an_engine_that_is_not_there_is_refused():
    with pytest.raises(carom.InputError, match="no such engine; choose one of petsc"):
        engine_named("pets")


def test_a_process_with_threads_has_no_ranks(monkeypatch):
    monkeypatch.setattr("carom.ranks.engine.thread_count", lambda: 4)
    with pytest.raises(carom.InputError, match="has 4 threads by now, and a rank has one; start"):
        engine_named("petsc")

"""Looking at a run while it goes on, and stopping it."""

import numpy as np
import pytest

import carom
import restarting
from carom import Observer, Stop, cli
from carom.running.run import drive
from stand_in import FallingSimulation


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The results of a run that nobody looks at."""
    return carom.run(restarting.scenario(), out=tmp_path_factory.mktemp("whole") / "out")


def stop(_):
    raise Stop("enough")


def late(state):
    if state.time > 0.05:
        raise Stop("it is late")


def test_observers_look_at_their_beat(tmp_path):
    times = {"every": [], "steps": [], "each": []}
    result = carom.run(
        restarting.scenario(),
        out=tmp_path,
        observers=[
            Observer(lambda state: times["every"].append(state.time), every=0.0333),
            Observer(lambda state: times["steps"].append(state.time), steps=20),
            Observer(lambda state: times["each"].append(state.time)),
        ],
    )
    assert result.summary["status"] == "completed"
    assert times["every"] == pytest.approx([0.0, 0.034, 0.068, 0.1, 0.134, 0.15])
    assert times["steps"] == pytest.approx([0.0, 0.04, 0.08, 0.12, 0.15])
    assert times["each"] == pytest.approx(0.002 * np.arange(76))


def test_looking_changes_no_digit(whole, tmp_path):
    def look(state):
        assert state.bodies["left"].stress.shape == (48, 6)
        assert len(state.contacts) >= 0

    carom.run(restarting.scenario(), out=tmp_path, observers=[Observer(look, every=0.003)])
    restarting.assert_same_results(tmp_path, whole.path)


def test_an_observer_sees_the_state_of_its_time(whole, tmp_path):
    seen = []

    def look(state):
        seen.append((state.time, state.energy.total, state.bodies["left"].velocity))

    carom.run(restarting.scenario(), out=tmp_path, observers=[Observer(look, every=0.05)])
    for time, energy, velocity in seen:
        row = np.flatnonzero(np.isclose(whole.history["time"], time))
        if len(row):
            assert energy == whole.history["total"][row[0]]
        np.testing.assert_array_equal(velocity, whole.fields.body("left")["velocity"].at(time))


def test_a_stop_keeps_results_and_goes_on_to_the_same_end(whole, tmp_path):
    both = [
        Observer(late, every=0.01),
        Observer(lambda state: looks.append(state.time), every=0.01),
    ]
    looks = []
    result = carom.run(restarting.scenario(), out=tmp_path, observers=both)
    assert result.summary["status"] == "stopped"
    assert result.summary["reason"] == "it is late at t = 0.06 s"
    assert result.history["time"][-1] == result.fields.times[-1] == pytest.approx(0.06)
    assert looks[-1] == pytest.approx(0.06)  # who does not stop looks too
    assert carom.audit(tmp_path).confirmed
    end = carom.run(restarting.scenario(), out=tmp_path, resume=True)
    assert end.summary["status"] == "completed"
    restarting.assert_same_results(tmp_path, whole.path)


def test_a_run_that_goes_on_is_looked_at_from_there(tmp_path):
    carom.run(restarting.scenario(), out=tmp_path, observers=[Observer(late, every=0.01)])
    looks = []
    look = Observer(lambda state: looks.append(state.time), every=0.04)
    carom.run(restarting.scenario(), out=tmp_path, observers=[look], resume=True)
    assert looks == pytest.approx([0.08, 0.12, 0.15])


def test_a_stop_at_the_end_changes_nothing(tmp_path):
    def at_the_end(state):
        if state.time > 0.149:
            raise Stop

    result = carom.run(restarting.scenario(), out=tmp_path, observers=[Observer(at_the_end)])
    assert result.summary["status"] == "completed"
    assert "reason" not in result.summary


def test_an_observer_that_fails_leaves_a_run_that_can_go_on(whole, tmp_path):
    def fail(state):
        if state.time > 0.05:
            raise ZeroDivisionError("mine") from KeyError("x")

    with pytest.raises(ZeroDivisionError, match="mine") as caught:
        carom.run(restarting.scenario(), out=tmp_path, observers=[Observer(fail, steps=1)])
    assert isinstance(caught.value.__cause__, KeyError)
    summary = carom.Result.open(tmp_path).summary
    assert summary["status"] == "interrupted"
    assert summary["reason"] == "an observer raised ZeroDivisionError at t = 0.052 s: mine"
    carom.run(restarting.scenario(), out=tmp_path, resume=True)
    restarting.assert_same_results(tmp_path, whole.path)


def test_a_progress_that_cannot_be_shown_leaves_a_run_that_can_go_on(whole, tmp_path):
    def fail(progress):
        raise BrokenPipeError(32, "nobody reads")

    with pytest.raises(BrokenPipeError, match="nobody reads"):
        carom.run(restarting.scenario(), out=tmp_path, progress=fail)
    assert carom.Result.open(tmp_path).summary["status"] == "interrupted"
    carom.run(restarting.scenario(), out=tmp_path, resume=True)
    restarting.assert_same_results(tmp_path, whole.path)


def test_an_error_of_an_observer_is_no_failed_step(tmp_path):
    def fail(_):
        raise carom.ConvergenceError("of another run", {})

    with pytest.raises(carom.ConvergenceError, match="another"):
        carom.run(restarting.scenario(), out=tmp_path, observers=[Observer(fail)])
    assert carom.Result.open(tmp_path).summary["status"] == "interrupted"


def test_a_stopped_run_that_left_coulombs_law_does_not_pass(scenario, tmp_path):
    with pytest.raises(carom.CertificateError):
        drive(FallingSimulation(scenario, certificate=2e-9), scenario, tmp_path, progress=stop)
    assert carom.Result.open(tmp_path).summary["status"] == "uncertified"


def test_progress_may_stop_a_run_too(scenario, tmp_path):
    result = drive(FallingSimulation(scenario), scenario, tmp_path, progress=stop)
    assert result.summary["status"] == "stopped"
    assert result.summary["reason"] == "enough at t = 0 s"


def test_the_command_line_takes_a_stopped_run_for_what_it_is(tmp_path, capsys):
    out = tmp_path / "out"
    carom.run(
        restarting.scenario("output.report=true"), out=out, observers=[Observer(late, every=0.01)]
    )
    with pytest.raises(SystemExit) as caught:
        cli.app(["watch", str(out)], prog_name="carom")
    assert caught.value.code == 0
    assert "stopped: it is late at t = 0.06 s" in capsys.readouterr().out
    assert "An observer stopped the run." in (out / "report.html").read_text(encoding="utf-8")


def test_a_bare_function_is_refused_before_anything_is_replaced(whole):
    with pytest.raises(carom.InputError, match=r"function stop.*give carom\.Observer"):
        carom.run(restarting.scenario(), out=whole.path, observers=[stop], force=True)
    assert carom.Result.open(whole.path).summary == whole.summary


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"every": 0.1, "steps": 2}, "not both"),
        ({"every": 0.0}, "every = 0.0: must be a time above 0 s"),
        ({"every": float("nan")}, "every = nan"),
        ({"steps": 0}, "steps = 0: must be 1 or more"),
    ],
)
def test_a_beat_that_is_none_is_refused(given, message):
    with pytest.raises(carom.InputError, match=message):
        Observer(stop, **given)

import os
import signal
from pathlib import Path

# Before NumPy is imported. A worker is on every core already: threads of BLAS that waited for
# one another took a minute for the modes of a hundred nodes. The core keeps its threads.
for library in ("OMP", "OPENBLAS", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

import pytest
from hypothesis import settings

import carom
import carom.running.recorder
import heard
import restarting

EXAMPLES = Path(__file__).parents[1] / "examples"


settings.register_profile("same everywhere", derandomize=True, deadline=None)
settings.load_profile("same everywhere")


def pytest_configure():
    heard.listen()


MET = set()
"""Messages of the documentation that the tests of this process, or of its workers, met."""

FAULTS = []
"""What is wrong with them after the whole suite."""


def pytest_sessionfinish(session, exitstatus):
    """After the whole suite, fail if there are messages that no test met."""
    config = session.config
    is_worker = hasattr(config, "workeroutput")
    if not (is_worker or (exitstatus == pytest.ExitCode.OK and _is_whole(config))):
        return
    listed = heard.listed()
    MET.update(heard.met(listed, heard.TEXTS))
    if is_worker:
        config.workeroutput["met"] = sorted(MET)
        return
    FAULTS.extend(heard.faults(MET, listed))
    if FAULTS:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    """Take over what a worker's tests met (pytest-xdist)."""
    MET.update(getattr(node, "workeroutput", {}).get("met", ()))


def pytest_terminal_summary(terminalreporter):
    for fault in FAULTS:
        terminalreporter.write_line(fault, red=True)


def _is_whole(config):
    option = config.option
    whole = config.args_source is pytest.Config.ArgsSource.TESTPATHS
    return whole and not (option.keyword or option.markexpr or option.collectonly)


def pytest_collection_modifyitems(config, items):
    """Leave long tests to `make validate`."""
    if not os.environ.get("CAROM_LONG"):
        long = [item for item in items if item.get_closest_marker("long")]
        config.hook.pytest_deselected(items=long)
        items[:] = [item for item in items if item not in long]


@pytest.fixture(autouse=True, scope="session")
def ctrl_c_interrupts():
    """A shell starts what runs in the background with Ctrl-C ignored, and children inherit that."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


DRAW = carom.running.recorder.draw


@pytest.fixture(autouse=True, scope="session")
def runs_draw_nothing():
    """Two pictures take half a second, as long as most runs here; see `pictures`."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("carom.running.recorder.draw", lambda result: None)
        yield


@pytest.fixture
def pictures(monkeypatch):
    """Runs draw what they draw for users."""
    monkeypatch.setattr("carom.running.recorder.draw", DRAW)


@pytest.fixture(scope="module")
def module_pictures():
    """The same where a fixture runs a case for all tests of a file."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("carom.running.recorder.draw", DRAW)
        yield


@pytest.fixture
def examples():
    return EXAMPLES


@pytest.fixture
def box():
    """Two cylinders in a box, as plain data that a test may spoil."""
    return {
        "title": "Box",
        "analysis": {"kind": "dynamic", "end_time": 1.0, "time_step": 0.01},
        "output": {"track": [{"name": "tip", "body": "left", "point": [1, 4]}]},
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
                "mesh": {"kind": "disc", "centre": [x, 4.0], "radius": 1.0, "divisions": 8},
            }
            for name, x in (("left", 2.0), ("right", 6.0))
        ],
        "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}],
        "contact": {"friction": 0.2, "pairs": [{"between": ["left", "right"], "friction": 0.1}]},
    }


@pytest.fixture
def scenario(box):
    return carom.Scenario.from_dict(box)


@pytest.fixture(scope="session")
def impact(tmp_path_factory):
    """The results of two discs that meet above a floor and hit it; not to be changed."""
    return carom.run(restarting.scenario(), out=tmp_path_factory.mktemp("impact"))

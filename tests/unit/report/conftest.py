"""Small runs with a report, and a browser to open it in."""

import json
import re
from types import SimpleNamespace

import pytest
from browsing import WEBGL, Pages, found

import carom
from carom.io import layout
from carom.report import write_report
from reported import DISC

NASTY = '</script><b id="injected">&</b><img src=x onerror="window.injected = 1">'
"""A title that breaks out of whatever does not escape it."""

BALL = {
    "title": NASTY,
    "dimension": 3,
    "analysis": {"end_time": 0.05, "time_step": 5e-3, "scheme": {"kind": "theta"}},
    "materials": {"rubber": {"kind": "neo-hookean", "young": 1e4, "poisson": 0.3, "density": 1.0}},
    "bodies": [
        {
            "name": "ball",
            "material": "rubber",
            "mesh": {"kind": "ball", "centre": [0, 0, 1.01], "radius": 1, "divisions": 2},
            "velocity": [0, 0, -1.0],
        }
    ],
    "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
    "output": {"fields_every": 1e-2},
}


@pytest.fixture(scope="session")
def disc(tmp_path_factory):
    """A disc that bounces off the floor; the run wrote its report."""
    return carom.run(carom.Scenario.from_dict(DISC), out=tmp_path_factory.mktemp("disc") / "run")


@pytest.fixture(scope="session")
def steel(tmp_path_factory):
    """The disc of steel, a hundred times smaller: a run of some microseconds."""
    case = {
        **DISC,
        "title": "steel",
        "analysis": {**DISC["analysis"], "end_time": 1.2e-5, "time_step": 2e-7},
        "materials": {"rubber": {**DISC["materials"]["rubber"], "young": 2e11, "density": 7800.0}},
        "bodies": [
            {
                **DISC["bodies"][0],
                "mesh": {"kind": "disc", "centre": [0, 0.01001], "radius": 0.01, "divisions": 4},
                "velocity": [2.0, -5.0],
            }
        ],
        "obstacles": DISC["obstacles"][:1],
        "output": {"fields_every": 1e-6, "report": True},
    }
    return carom.run(carom.Scenario.from_dict(case), out=tmp_path_factory.mktemp("steel") / "run")


@pytest.fixture(scope="session")
def ball(tmp_path_factory):
    """A ball in space, with a nasty title; the report was asked for afterwards."""
    result = carom.run(carom.Scenario.from_dict(BALL), out=tmp_path_factory.mktemp("ball") / "run")
    write_report(result.path)
    return result


@pytest.fixture(scope="session")
def museum(tmp_path_factory):
    """A ball among obstacles of every kind there is in space."""
    import meshio

    directory = tmp_path_factory.mktemp("museum")
    corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    meshio.Mesh(corners, [("triangle", faces)]).write(directory / "wedge.stl")
    obstacles = [
        *BALL["obstacles"],
        {"name": "globe", "kind": "sphere", "centre": [3, 0, 1], "radius": 1},
        {"name": "bore", "kind": "cylinder", "point": [0, 0, 0], "axis": [0, 1, 1], "radius": 9}
        | {"cavity": True},
        {"name": "crate", "kind": "box", "corner": [-4, 0, 0], "size": [1, 2, 1]},
        {"name": "wedge", "kind": "surface", "file": str(directory / "wedge.stl"), "scale": 0.5}
        | {"velocity": [0, 0, -1]},
    ]
    case = carom.Scenario.from_dict({**BALL, "title": "museum", "obstacles": obstacles})
    away = {"mesh": {**BALL["bodies"][0]["mesh"], "centre": [0, 0, 1.8]}}
    case = carom.Scenario.from_dict(
        {**case.model_dump(mode="json"), "bodies": [{**BALL["bodies"][0], **away}]}
    )
    result = carom.run(case, out=directory / "run")
    write_report(result.path)
    return result


@pytest.fixture(scope="session")
def data_of():
    """Return what a page holds for its scripts."""

    def read(page):
        text = page.read_text(encoding="utf-8")
        (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', text)
        return SimpleNamespace(**json.loads(data))

    return read


@pytest.fixture(scope="module")
def launched():
    """Return a function that starts a browser with some arguments."""
    from playwright.sync_api import Error, sync_playwright

    executable = found()
    if executable is None:
        pytest.skip("there is no Chromium: python tools/get_browser.py")
    with sync_playwright() as playwright:

        def launch(arguments):
            try:
                return playwright.chromium.launch(executable_path=executable, args=list(arguments))
            except Error as error:
                pytest.skip(f"{executable} does not start: {error.message.splitlines()[0]}")

        yield launch


@pytest.fixture(scope="module")
def browser(launched):
    browser = launched(WEBGL)
    yield browser
    browser.close()


@pytest.fixture(scope="module")
def pages(browser):
    return Pages(browser)


@pytest.fixture
def opened(pages):
    """Return a function that opens a report and closes it after the test."""
    made = []

    def open_(file, **options):
        made.append(pages.open(file, **options))
        return made[-1]

    yield open_
    for page in made:
        page.context.close()


@pytest.fixture(scope="module")
def disc_page(disc, pages):
    return pages.open(disc.path / layout.REPORT)

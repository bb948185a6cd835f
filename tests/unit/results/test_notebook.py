"""What notebooks show."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest

import carom
from carom.running.run import drive
from stand_in import FallingSimulation

EVIL = '<script>alert("1")</script> & "more"'


@pytest.fixture
def evil(scenario):
    return scenario.with_values(
        {"title": EVIL, "bodies.0.name": "<b>", "output.track": [], "contact.pairs": []}
    )


def test_a_result_shows_summary_energies_and_links(impact):
    text = impact._repr_html_()
    tree = ET.fromstring(text)
    rows = {row.find("th").text: row.find("td").text for row in tree.iter("tr")}
    assert rows["status"] == "completed"
    assert "dissipated" in rows["friction"]
    assert any(quantity.startswith("left – ") for quantity in rows)
    assert [link.text for link in tree.iter("a")] == ["fields.vtkhdf"]
    assert [frame.get("sandbox") for frame in tree.iter("iframe")] == ["allow-scripts"]
    assert len(text) < 450_000


def test_the_picture_keeps_every_peak(impact):
    tree = ET.fromstring(impact._repr_html_())
    curves = list(tree.iter("polyline"))
    assert len(curves) == 4
    history = impact.history
    top = max(history["kinetic"].max(), history["total"].max())
    for curve, name in zip(curves, ("kinetic", "strain", "total", "friction"), strict=True):
        points = np.array([pair.split(",") for pair in curve.get("points").split()], dtype=float)
        assert 160 - points[:, 1].min() == pytest.approx(160 * history[name].max() / top, abs=0.1)
        assert np.all(np.diff(points[:, 0]) >= 0)


def test_a_report_is_linked(scenario, tmp_path):
    result = drive(FallingSimulation(scenario), scenario, tmp_path / "with space")
    (result.path / "report.html").write_text("")
    links = [link.get("href") for link in ET.fromstring(result._repr_html_()).iter("a")]
    assert links[0] == (result.path / "report.html").as_uri()


def test_text_is_text(evil, tmp_path):
    result = drive(FallingSimulation(evil), evil, tmp_path)
    for shown in (result, evil):
        text = shown._repr_html_()
        assert "<script" not in text
        assert "<b>" not in text
        assert EVIL in "".join(ET.fromstring(text).itertext())


def test_a_scenario_shows_its_parts_and_its_case(scenario):
    tree = ET.fromstring(scenario._repr_html_())
    rows = [(row.find("th").text, row.find("td").text) for row in tree.iter("tr")]
    assert ("body", "left: disc, elastic") in rows
    assert ("obstacle", "floor: plane") in rows
    assert tree.find("details/pre").text == scenario.to_toml()


def test_a_run_of_one_row_has_no_picture(scenario, tmp_path):
    simulation = FallingSimulation(scenario, stop_at=0.0, stop=carom.ConvergenceError("no", {}))
    with pytest.raises(carom.ConvergenceError):
        drive(simulation, scenario, tmp_path)
    tree = ET.fromstring(carom.Result.open(tmp_path)._repr_html_())
    assert next(tree.iter("svg"), None) is None

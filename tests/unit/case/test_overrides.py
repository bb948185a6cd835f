import pytest

from carom import InputError, Theta


def test_values_are_toml(scenario):
    changed = scenario.with_overrides(
        [
            "analysis.end_time=3",
            "bodies.1.mesh.divisions = 12",
            "bodies.0.velocity=[1, -2]",
            "contact.pairs.0.enabled=false",
            'title="Two words = one title"',
        ]
    )
    assert changed.analysis.end_time == 3.0
    assert changed.bodies[1].mesh.divisions == 12
    assert changed.bodies[0].velocity == (1.0, -2.0)
    assert changed.contact.pairs[0].enabled is False
    assert changed.title == "Two words = one title"
    assert scenario.analysis.end_time == 1.0


def test_a_bare_word_is_a_string(scenario):
    assert scenario.with_overrides(["contact.condition=midpoint"]).contact.condition == "midpoint"
    assert scenario.with_overrides(["contact.solver.kind=uzawa"]).contact.solver.kind == "uzawa"


def test_a_table_replaces_a_part(scenario):
    changed = scenario.with_overrides(['analysis.scheme={kind="theta", theta=1, xi=1}'])
    assert changed.analysis.scheme == Theta(theta=1, xi=1)


def test_no_override_changes_nothing(scenario):
    assert scenario.with_overrides([]) == scenario


def test_overrides_are_judged_together(scenario):
    changed = scenario.with_overrides(["analysis.time_step=5", "analysis.end_time=10"])
    assert changed.analysis.time_step == 5.0


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("analysis.end_time", "write KEY=VALUE"),
        ("=3", "write KEY=VALUE"),
        ("analysis.end_time=", "analysis.end_time = : not a TOML value"),
        ("title=two words", "title = two words: not a TOML value"),
        ("analysis.end_time=3 4", "not a TOML value"),
        ("analysys.end_time=3", "no 'analysys' in the scenario; did you mean \"analysis\"?"),
        ("materials.elastc.young=3", "no 'elastc' in materials; did you mean \"elastic\"?"),
        ("bodies.2.spin=3", "bodies has no entry '2' (entries: 0 to 1)"),
        ("bodies.-1.spin=3", "bodies has no entry '-1'"),
        ("bodies.left.spin=3", "bodies has no entry 'left'"),
        ("title.size=3", "title is a single value"),
        ("initial.result=r", "the case has no initial; give all of it, as initial=…"),
        ("analysis.gravity.x=3", "the case has no analysis.gravity; give all of it"),
        ("analysis.end_tim=3", 'analysis.end_tim: unknown key; did you mean "end_time"?'),
        ("analysis.end_time=soon", 'analysis.end_time = "soon": must be a number'),
        ("analysis.end_time=nan", "analysis.end_time = nan: must be a finite number"),
    ],
)
def test_wrong_overrides_are_named(scenario, override, message):
    with pytest.raises(InputError) as caught:
        scenario.with_overrides([override])
    assert message in str(caught.value)

"""What happens at the end of a step is audited where it is: impulses, facets that end, kinks."""

import pytest

import carom


def scene(bodies, *, material=None, step=1e-3, end=0.1, condition="midpoint", **contact):
    """Bodies under gravity above a floor."""
    elastic = {"kind": "saint-venant-kirchhoff", "poisson": 0.3, **(material or {})}
    analysis = {"end_time": end, "time_step": step, "gravity": [0, -9.81]}
    law = {"friction": 0.3, "penetration_tolerance": 5.0, **contact}
    return carom.Scenario.from_dict(
        {
            "analysis": {**analysis, "scheme": {"kind": "conserving"}},
            "output": {"audit": True, "fields_every": 2 * step, "history_every": step},
            "materials": {"m": {"young": 2e4, "density": 10.0, **elastic}},
            "bodies": bodies,
            "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}],
            "contact": {"condition": condition, **law},
        }
    )


def block(name, corner, size, divisions, **given):
    mesh = {"kind": "rectangle", "corner": corner, "size": size, "divisions": divisions}
    return {"name": name, "material": "m", "mesh": mesh, **given}


def checks_of(scenario, out):
    carom.run(scenario, out=out)
    audit = carom.audit(out)
    assert audit.refuted == ()
    return {check.name: check for check in audit.checks}


def test_steps_that_land_and_settle_are_confirmed(tmp_path):
    """Three flush squares under gravity with damping: nodes face nodes, and slide past them."""
    squares = [block(name, [0.0, float(k)], [1.0, 1.0], [3, 3]) for k, name in enumerate("abc")]
    stiff = {"young": 1e8, "density": 1000.0, "damping": {"mass": 100.0, "stiffness": 1e-4}}
    checks = checks_of(scene(squares, material=stiff, step=2e-3), tmp_path)
    assert checks["ledger: settling"].count == 25
    assert checks["ledger: settling"].figure < checks["ledger: settling"].tolerance
    assert carom.Result.open(tmp_path).summary["energy"]["settling"] > 1e-5  # J


@pytest.mark.parametrize("condition", ["gap", "midpoint"])
def test_what_is_beyond_the_rim_of_an_open_surface_is_not_inside_it(tmp_path, condition):
    """The end of a block hangs over the rim of another, of which only the top may be touched."""
    low = block("low", [0.0, 0.0], [1.0, 0.5], [4, 3], contact_sets=["top", "bottom"])
    high = block("high", [0.4, 0.52], [1.2, 0.3], [6, 3], contact_sets=["bottom"], spin=-3.0)
    checks = checks_of(
        scene([low, high], step=2e-3, end=0.3, condition=condition, friction=0.0), tmp_path
    )
    assert checks["smallest gap"].count == 76


def test_a_contact_that_passes_a_kink_of_a_rigid_body_is_confirmed(tmp_path):
    """A block slides over a faceted disc at a facet in some steps."""
    disc = {"kind": "disc", "centre": [0.0, 1.0], "radius": 1.0, "divisions": 2}
    ball = {"name": "ball", "kind": "rigid", "density": 100.0, "mesh": disc}
    slider = block("block", [-0.4, 2.001], [0.8, 0.4], [8, 4], velocity=[5.0, -0.5])
    scenario = scene([ball, slider], step=2e-3, targets="faceted")
    checks = checks_of(scenario, tmp_path)
    assert checks["Signorini: complementarity"].count > 30

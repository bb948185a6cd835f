"""Bodies whose meshes are rings, or come from files with sets, are audited."""

import pytest

import carom

WIDE, HIGH = 6, 4


def deck(path, *, shift=0.0):
    """Write a skewed block of quadrilaterals, of which the right half is a set of cells."""
    number = {(i, j): 1 + j * (WIDE + 1) + i for j in range(HIGH + 1) for i in range(WIDE + 1)}
    lines = ["*NODE"]
    for (i, j), node in number.items():
        lines.append(f"{node}, {0.15 * i + 0.02 * j + shift}, {0.2 * j}, 0.0")
    lines.append("*ELEMENT, TYPE=CPE4, ELSET=part")
    cells = [(i, j) for j in range(HIGH) for i in range(WIDE)]
    for cell, (i, j) in enumerate(cells, start=1):
        corners = [number[i, j], number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]]
        lines.append(", ".join(map(str, [cell, *corners])))
    stiff = [str(cell) for cell, (i, _) in enumerate(cells, start=1) if i >= WIDE // 2]
    lines += ["*ELSET, ELSET=stiff", ", ".join(stiff)]
    lines += ["*NSET, NSET=top", ", ".join(str(number[i, HIGH]) for i in range(WIDE + 1))]
    lines += ["*ELSET, ELSET=lowest", ", ".join(map(str, range(1, WIDE + 1)))]
    lines += ["*SURFACE, NAME=sole", "lowest, S1"]
    path.write_text("\n".join(lines) + "\n")


def dropped(file):
    """A block from a file with a stiff half, a mass on top, and a ring that falls on it."""
    elastic = {"kind": "saint-venant-kirchhoff", "young": 4e3, "poisson": 0.3, "density": 1.0}
    block = {
        "name": "block",
        "material": "soft",
        "mesh": {"kind": "file", "file": str(file), "move": [0.1, 0.01]},
        "regions": [{"material": "stiff", "on": "stiff"}],
        "velocity": [0.5, -1.0],
    }
    ring = {
        "name": "ring",
        "material": "soft",
        "mesh": {
            "kind": "ring",
            "centre": [0.6, 1.25],
            "inner_radius": 0.2,
            "outer_radius": 0.4,
            "divisions": [16, 2],
        },
        "velocity": [0.0, -2.0],
        "contact_sets": ["outer"],
    }
    return carom.Scenario.from_dict(
        {
            "analysis": {"end_time": 0.1, "time_step": 1e-3, "scheme": {"kind": "conserving"}},
            "materials": {"soft": elastic, "stiff": {**elastic, "young": 2e4, "density": 2.0}},
            "bodies": [block, ring],
            "masses": [{"body": "block", "on": "top", "mass": 0.1}],
            "springs": [
                {
                    "name": "stay",
                    "between": [{"body": "block", "on": "sole"}, {"point": [-1.0, 0.0]}],
                    "stiffness": 20.0,
                }
            ],
            "obstacles": [{"kind": "plane", "name": "floor", "point": [0, 0], "normal": [0, 1]}],
            "contact": {"friction": 0.3, "penetration_tolerance": 0.5, "condition": "gap"},
            "output": {"fields_every": 0.01, "history_every": 1e-3, "audit": True},
        }
    )


def test_meshes_from_files_and_rings_are_confirmed(tmp_path):
    deck(tmp_path / "block.inp")
    carom.run(dropped(tmp_path / "block.inp"), out=tmp_path / "run")
    audit = carom.audit(tmp_path / "run")
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["materials"].count == WIDE * HIGH + 32
    assert checks["Coulomb: slip"].count > 20


def test_a_file_that_is_no_longer_that_of_the_run_is_found(tmp_path):
    deck(tmp_path / "block.inp")
    carom.run(dropped(tmp_path / "block.inp"), out=tmp_path / "run")
    deck(tmp_path / "block.inp", shift=1e-6)
    assert {check.name for check in carom.audit(tmp_path / "run").refuted} == {"mesh"}
    text = (tmp_path / "block.inp").read_text()
    (tmp_path / "block.inp").write_text(text.replace("NAME=sole", "NAME=base"))
    with pytest.raises(carom.InputError, match="cannot audit the set 'sole': the mesh that the"):
        carom.audit(tmp_path / "run")
    (tmp_path / "block.inp").write_text(text.replace("ELSET=stiff\n4, ", "ELSET=stiff\n3, 4, "))
    assert "materials" in {check.name for check in carom.audit(tmp_path / "run").refuted}

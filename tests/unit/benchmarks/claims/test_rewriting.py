"""What drifted is corrected on the page and in the claims, and nothing else is touched."""

import pytest
from claims import __main__ as command
from claims.manifest import Manifest
from claims.pages import Page
from claims.rewriting import like

PAGE = """\
# Speeds 50.94

A ball of 50.94 mm, on
the floor for 50.94
µs, or by −0.50 %.

```text
50.94
```

| ball | 50.94 | 2.0e-12 |
"""

CLAIMS = """\
[uncovered]
"PAGE" = 2

[runs]
ball = { command = "echo 51.2 -0.49 7e-10" }

[[claims]]
page = "PAGE"
text = "the floor for «50.94» µs, or by «−0.50» %"
kind = "exact"
run = "ball"
absolute = 0.1
gives = ['^(\\S+) (\\S+)']

[[claims]]
page = "PAGE"
text = "| ball | ‹50.94› | «2.0e-12» |"
kind = "round-off"
run = "ball"
gives = ['(\\S+)$']

[[told]]
page = "PAGE"
kind = "given"
reason = "the case"
texts = ["floor for 50.94 µs, or by −0.50 %. | ball | «50.94»"]

[[sections]]
page = "PAGE"
heading = "Speeds 50.94"
kind = "timing"
reason = "none"
"""


@pytest.mark.parametrize(
    ("shown", "value", "expected"),
    [
        ("50.94", 51.2, "51.20"),
        ("−0.50", 0.25, "0.25"),
        ("+0.50", 0.25, "+0.25"),
        ("+0.50", -0.25, "−0.25"),
        ("1.7e-2", 0.0191, "1.9e-2"),
        ("2.0e-12", 7e-10, "7.0e-10"),
        ("8.1e-04", 1e-3, "1.0e-03"),
        ("15 000", 16000.0, "16 000"),
        ("10,000,000", 9e6, "9,000,000"),
        ("38", 39.0, "39"),
        ("0", -0.0004, "0"),
    ],
)
def test_a_number_is_shown_as_the_one_before(shown, value, expected):
    assert like(shown, value) == expected


def test_a_page_says_afterwards_what_was_measured(tmp_path, monkeypatch, capsys):
    page, manifest = tmp_path / "page.md", tmp_path / "claims.toml"
    page.write_text(PAGE)
    manifest.write_text(CLAIMS.replace("PAGE", str(page)))
    read = Manifest.read
    monkeypatch.setattr(command.Manifest, "read", lambda: read(manifest))
    monkeypatch.setattr(command, "MANIFEST", manifest)
    monkeypatch.setattr(command, "RECORD", tmp_path / "measured.json")
    monkeypatch.setattr("sys.argv", ["claims", "--write"])
    assert command.main() == 1
    assert page.read_text() == (
        PAGE.replace("the floor for 50.94\n", "the floor for 51.20\n")
        .replace("−0.50 %", "−0.49 %")
        .replace("2.0e-12", "7.0e-10")
    )
    after = read(manifest)
    assert [claim.text for claim in after.claims] == [
        "the floor for «51.20» µs, or by «−0.49» %",
        "| ball | ‹50.94› | «7.0e-10» |",
        "floor for 51.20 µs, or by −0.49 %. | ball | «50.94»",
    ]
    assert all(Page(page.read_text()).places(claim.plain) for claim in after.claims)
    capsys.readouterr()
    assert command.main() == 0
    assert "0 drifted" in capsys.readouterr().out

import io

import pytest
from rich.console import Console

from carom.display.sheet import Sheet, print_whole

SHEET = Sheet(
    ["problem", "contacts", *(f"gauss-seidel-{n}" for n in range(12))],
    [
        [f"LMGC_GlobalProblem{k}", str(k), *(f"{k + n / 1000:.3f}" for n in range(12))]
        for k in (3, 4)
    ],
    keys=2,
)


def printed(sheet, *, width, terminal, **title):
    screen = io.StringIO()
    print_whole(
        Console(file=screen, width=width, force_terminal=terminal, color_system=None),
        sheet,
        **title,
    )
    return screen.getvalue()


@pytest.mark.parametrize("width", [40, 80])
def test_numbers_of_a_wide_table_are_not_cut_in_a_pipe(width):
    """Symptom guarded against: a table of ten solvers in 80 columns had 0.0… in its cells."""
    text = printed(SHEET, width=width, terminal=False)
    assert "…" not in text
    for row in SHEET.rows:
        (line,) = [line for line in text.splitlines() if row[0] in line]
        assert line.split() == row


@pytest.mark.parametrize("width", [72, 80, 200])
def test_columns_that_do_not_fit_a_terminal_come_below_with_the_keys(width):
    text = printed(SHEET, width=width, terminal=True)
    assert "…" not in text
    assert max(map(len, text.splitlines())) <= width
    for row in SHEET.rows:
        lines = [line.split() for line in text.splitlines() if row[0] in line]
        assert {tuple(line[:2]) for line in lines} == {tuple(row[:2])}
        assert [cell for line in lines for cell in line[2:]] == row[2:]


@pytest.mark.parametrize("width", [30, 44])
def test_long_names_are_folded_before_numbers_are(width):
    text = printed(SHEET, width=width, terminal=True)
    assert "…" not in text
    assert max(map(len, text.splitlines())) <= width
    assert all(number in text.split() for row in SHEET.rows for number in row[2:])


def test_an_empty_sheet_has_its_header_and_titles_are_text():
    text = printed(Sheet(["run", "[J]"], []), width=80, terminal=False, title="[bold]study[/]")
    assert "[J]" in text
    assert text.count("[bold]study[/]") == 1

"""The page of a study: its picture, a row for each run, and links to their reports."""

from __future__ import annotations

import base64
import csv
import json
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Any
from urllib.parse import quote

from carom import __version__
from carom.display.counting import count
from carom.display.markup import Html, element, format_number, join
from carom.errors import InputError
from carom.io import layout
from carom.report.assembly import asset, elements, policy
from carom.report.writing import write_page
from carom.sweep.study import folder
from carom.sweep.table import COEFFICIENTS, FIGURES, PICTURE, TABLE, TITLES

SCRIPTS = ("codec.js", "theme.js", "format.js", "save.js", "study.js")


@dataclass(frozen=True)
class Study:
    """A table of `carom sweep`.

    Parameters
    ----------
    directory
        Where it and the folders of the runs are.
    keys
        What was varied.
    rows
        The cells of each run by column, as text.
    """

    directory: Path
    keys: tuple[str, ...]
    rows: tuple[dict[str, str], ...]


def is_study(directory: Path) -> bool:
    """Return whether a directory is of `carom sweep`, and of no run."""
    of_a_run = (layout.SUMMARY, layout.HISTORY, layout.FIELDS)
    return (directory / TABLE).is_file() and not any(
        (directory / name).is_file() for name in of_a_run
    )


def read_study(directory: Path) -> Study:
    """Read the table.

    Raises
    ------
    InputError
        It is no table of `carom sweep`, or cannot be read.
    """
    path = directory / TABLE
    try:
        with path.open(encoding="utf-8", newline="") as file:
            reader = csv.DictReader(file, strict=True)
            # Versions before these columns had none to tell of.
            later = ("warnings", *COEFFICIENTS)
            rows = tuple({**dict.fromkeys(later, ""), **row} for row in reader)
            columns = [*(reader.fieldnames or ()), *later]
    except (csv.Error, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from None
    missing = [name for name in ("status", "reason", *FIGURES) if name not in columns]
    if missing or any(None in row or None in row.values() for row in rows):
        lacks = f"has no column {missing[0]}" if missing else "has rows of other lengths"
        raise InputError(f"{path}: {lacks}: it is no table of `carom sweep`; make the study again")
    return Study(directory, tuple(columns[: columns.index("status")]), rows)


def study_page(study: Study) -> str:
    """Return the whole page."""
    scripts = ["\n".join(asset("assets", name) for name in SCRIPTS)]
    title = study.directory.resolve().name
    notes = _notes(study)
    return Template(asset("assets", "study.html")).substitute(
        version=join(__version__),
        policy=join(policy(scripts)),
        title=join(title),
        style=asset("assets", "style.css"),
        count=join(f"a study of {count(len(study.rows), 'run')} over {', '.join(study.keys)}"),
        picture=_picture(study),
        runs=_runs(study),
        notes=element("ul", *(element("li", note) for note in notes), id="notes"),
        scripts=join(*elements(scripts)),
    )


def write_study_page(
    directory: Path, *, out: str | Path | None = None, force: bool = False
) -> Path:
    """Write the page of a study and return its path.

    Parameters
    ----------
    directory
        Directory of a study of `carom sweep`.
    out
        File to write; by default ``report.html`` in the directory.
    force
        Whether a file is replaced that is there already and is not the study's own page.

    Raises
    ------
    InputError
        The table of the study cannot be read, or the file would be overwritten.
    """
    return write_page(study_page(read_study(directory)), directory, out=out, force=force)


def _picture(study: Study) -> Html:
    file = study.directory / PICTURE
    if not file.is_file():
        return join()
    data = base64.b64encode(file.read_bytes()).decode()
    said = f"Energies, peak force and time in contact over {study.keys[0]}"
    image = element("img", src=f"data:image/png;base64,{data}", alt=said, class_="picture")
    return element(
        "section", element("h2", "Over the values that were varied"), image, class_="card"
    )


def _runs(study: Study) -> Html:
    shown = [name for name in FIGURES if any(row[name] not in ("", "0.0") for row in study.rows)]
    head = element(
        "tr",
        *(element("th", key, scope="col") for key in study.keys),
        element("th", "run", scope="col"),
        *(element("th", TITLES[name], scope="col", class_="number") for name in shown),
    )
    body = [_row(study, row, shown) for row in study.rows]
    table = element("table", element("thead", head), element("tbody", *body))
    title = "Runs"
    scroll = element("div", table, class_="scroll", tabindex="0", role="region", aria_label=title)
    return element("section", element("h2", title), scroll, id="runs", class_="card")


def _row(study: Study, row: dict[str, str], shown: list[str]) -> Html:
    status = row["status"]
    link = _link(study, row)
    said = element("a", status, href=link) if link else status
    reason = element("div", row["reason"], class_="below") if row["reason"] else None
    return element(
        "tr",
        *(element("th", row[key], scope="row") for key in study.keys),
        element("td", said, reason),
        *(element("td", _figure(row[name]), class_="number") for name in shown),
    )


def _figure(text: str) -> Html:
    try:
        value = json.loads(text)
    except ValueError:
        return join(text or "–")
    return element("data", format_number(value, 5), value=text)


def _values(study: Study, row: dict[str, str]) -> dict[str, Any]:
    """Return the values of a row as `carom sweep` was given them."""

    def value(text: str) -> Any:  # noqa: ANN401 (any value of a case)
        try:
            return json.loads(text)
        except ValueError:
            return text

    return {key: value(row[key]) for key in study.keys}


def _link(study: Study, row: dict[str, str]) -> str | None:
    """Return the best that a run has to show, relative to the page: its report, or its energies."""
    name = folder(_values(study, row))
    for file in (layout.REPORT, layout.ENERGY_PLOT, layout.SUMMARY):
        if (study.directory / name / file).is_file():
            return f"{quote(name)}/{file}"
    return None


def _notes(study: Study) -> list[str]:
    links = [_link(study, row) for row in study.rows]
    without = sum(link is None or not link.endswith(layout.REPORT) for link in links)
    notes = [f"All numbers are in {TABLE} beside this page, and in the folders of the runs."]
    if without:
        notes.append(
            f"{count(without, 'run')} of {len(links)} without a report, whose link leads to the "
            f"picture of the energies: carom report {study.directory}/FOLDER makes one, and "
            "carom sweep with --set output.report=true all of them."
        )
    return notes

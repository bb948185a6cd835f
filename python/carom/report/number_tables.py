"""The numbers of ``summary.json`` in tables."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from carom.display.markup import Html, element, format_number, join, number
from carom.ledger_terms import terms

Summary = Mapping[str, Any]

_ENERGY = (
    ("initial", "at the start"),
    *((term.name, term.label) for term in terms("run") if term.side == "given"),
    *((term.name, f"{term.label} at the end") for term in terms("run") if term.side == "stored"),
    *((term.name, term.label) for term in terms("run") if term.side == "taken"),
    ("max_drift", "largest drift of the total"),
    ("max_defect", "largest defect of the ledger"),
    ("max_step_defect", "largest defect of one step"),
)
SLIDES = 1e-6
"""Of the speed of approach: what slid less is round-off, and a share of it says nothing."""

_ALWAYS = frozenset({"initial", "kinetic", "strain", "friction", "max_defect"})

_CONTACT = (("onset", "onset", "s"), ("release", "release", "s"))
_CONTACT_REST = (("peak_force", "peak force", "N"), ("friction_work", "friction", "J"))


def energy_table(summary: Summary) -> Html | None:
    """Return where the energy came from and where it went, with bars."""
    energy = summary.get("energy", {})
    largest = max((abs(v) for v in energy.values() if isinstance(v, int | float)), default=0.0)
    rows = []
    for name, label in _ENERGY:
        value = energy.get(name)
        if value is None or (value == 0.0 and name not in _ALWAYS):
            continue
        bar = None if name.startswith("max_") else _bar(abs(value), largest)
        rows.append(
            element(
                "tr",
                element("th", label, scope="row"),
                element("td", bar, class_="bar"),
                element("td", number(value, f"energy.{name}", unit="J"), class_="number"),
            )
        )
    return element("table", element("tbody", *rows)) if rows else None


def _bar(value: float, largest: float) -> Html:
    return element(
        "meter", min="0", max=repr(largest or 1.0), value=repr(value), aria_hidden="true"
    )


def contact_table(summary: Summary) -> Html | None:
    """Return the contact events; the button of each takes the scene there."""
    contacts = summary.get("contacts")
    if not contacts:
        return None
    titles = [
        *(f"{title} [{unit}]" for _, title, unit in _CONTACT),
        "duration [s]",
        *(f"{title} [{unit}]" for _, title, unit in _CONTACT_REST),
    ]
    head = element(
        "tr",
        element("th", "between", scope="col"),
        *(element("th", title, scope="col", class_="number") for title in titles),
    )
    rows = [_contact_row(index, contact) for index, contact in enumerate(contacts)]
    return element("table", element("thead", head), element("tbody", *rows))


def _contact_row(index: int, contact: Summary) -> Html:
    onset, release = contact["onset"], contact["release"]
    key = f"contacts.{index}."
    go = element(
        "button",
        " – ".join(map(str, contact["pair"])),
        type="button",
        class_="go",
        data_time=repr(onset),
        title="Show this contact",
    )
    touching = element("span", "still touching", class_="faint")
    duration = format_number(release - onset, 4) if release is not None else "–"
    cells = [
        number(onset, key + "onset"),
        number(release, key + "release") if release is not None else touching,
        duration,
        *(number(contact.get(name), key + name) for name, _, _ in _CONTACT_REST),
    ]
    return element(
        "tr",
        element("th", go, scope="row"),
        *(element("td", cell, class_="number") for cell in cells),
    )


_IMPACT = (
    ("translation", "translation"),
    ("rotation", "rotation"),
    ("vibration", "vibration"),
    ("strain", "strain"),
    ("plastic", "plastic"),
    ("viscous", "damping"),
)


def impact_table(summary: Summary) -> Html | None:
    """Return what every impact that has ended did to the energy of its two."""
    contacts = summary.get("contacts") or ()
    impacts = [(k, contact) for k, contact in enumerate(contacts) if contact.get("impact")]
    if not impacts:
        return None
    shown = [
        (name, title)
        for name, title in _IMPACT
        if any(contact["impact"][name] != 0.0 for _, contact in impacts)
    ]
    titles = ["impulse [N s]", "restitution", "tangential"]
    titles += [f"{title} [J]" for title in (*(title for _, title in shown), "friction")]
    head = element(
        "tr",
        element("th", "between", scope="col"),
        *(element("th", title, scope="col", class_="number") for title in titles),
    )
    names = ("impulse", "restitution", "tangential_restitution", *(name for name, _ in shown))
    rows = []
    for index, contact in impacts:
        impact = {**contact["impact"], "tangential_restitution": _tangential(contact["impact"])}
        cells = [
            number(impact[name], f"contacts.{index}.impact.{name}", digits=3)
            if impact[name] is not None
            else "–"
            for name in names
        ]
        work = number(contact["friction_work"], f"contacts.{index}.friction_work", digits=3)
        cells.append(work)
        between = " – ".join(map(str, contact["pair"]))
        rows.append(
            element(
                "tr",
                element("th", between, scope="row"),
                *(element("td", cell, class_="number") for cell in cells),
            )
        )
    return element("table", element("thead", head), element("tbody", *rows))


def _tangential(impact: Summary) -> float | None:
    """Return the tangential coefficient of restitution, unless next to nothing slid at first."""
    sliding, approach = abs(impact["sliding"]), abs(impact["approach"])
    return impact["tangential_restitution"] if sliding > SLIDES * approach else None


def body_table(summary: Summary) -> Html | None:
    """Return the books of every body."""
    return _books(summary, "bodies", lambda entry: str(entry["name"]), skip=("name",))


def pair_table(summary: Summary) -> Html | None:
    """Return the books of every pair that has touched."""
    return _books(
        summary,
        "pairs",
        lambda entry: " – ".join(map(str, entry["between"])),
        skip=("between", "has_touched", "merge_contacts"),
    )


_STAGE = (("start_time", "from [s]"), ("end_time", "to [s]"), ("steps", "steps"))
_STAGE_ENERGY = (
    ("initial", "energy at the start [J]"),
    ("final", "at the end [J]"),
    *((term.name, term.label) for term in terms("run") if term.side != "stored"),
    ("max_defect", "largest defect"),
)


def stage_table(summary: Summary) -> Html | None:
    """Return the books of every stage."""
    stages = summary.get("stages")
    if not stages:
        return None
    shown = [
        (name, label)
        for name, label in _STAGE_ENERGY
        if name in ("initial", "final") or any(stage["energy"][name] for stage in stages)
    ]
    titles = [label for _, label in (*_STAGE, *shown)]
    head = element(
        "tr",
        element("th", "stage", scope="col"),
        *(element("th", title, scope="col", class_="number") for title in titles),
    )
    rows = []
    for index, stage in enumerate(stages):
        key = f"stages.{index}."
        cells = [number(stage[name], key + name) for name, _ in _STAGE]
        cells += [number(stage["energy"][name], f"{key}energy.{name}") for name, _ in shown]
        rows.append(
            element(
                "tr",
                element("th", stage["name"], scope="row"),
                *(element("td", cell, class_="number") for cell in cells),
            )
        )
    return element("table", element("thead", head), element("tbody", *rows))


def _books(
    summary: Summary, part: str, named: Callable[[Summary], str], skip: tuple[str, ...]
) -> Html | None:
    entries = [
        (index, entry)
        for index, entry in enumerate(summary.get(part) or [])
        if entry.get("has_touched", True)
    ]
    if not entries:
        return None
    terms = [
        name
        for name in entries[0][1]
        if name not in skip and any(entry.get(name) for _, entry in entries)
    ]
    head = element(
        "tr",
        element("th", "[J]", scope="col"),
        *(element("th", name.replace("_", " "), scope="col", class_="number") for name in terms),
    )
    rows = [
        element(
            "tr",
            element("th", named(entry), scope="row"),
            *(
                element("td", number(entry.get(name), f"{part}.{index}.{name}"), class_="number")
                for name in terms
            ),
        )
        for index, entry in entries
    ]
    return element("table", element("thead", head), element("tbody", *rows))


def all_numbers(summary: Summary) -> Html:
    """Return every entry of the summary by its dotted key, with all digits."""
    rows = [
        element("tr", element("th", key, scope="row"), element("td", shown, class_="number"))
        for key, shown in _entries(summary)
    ]
    return element("table", element("tbody", *rows), class_="keys")


def _entries(value: Any, key: str = "") -> Iterator[tuple[str, Html]]:  # noqa: ANN401 (JSON)
    if isinstance(value, Mapping | list):
        items = value.items() if isinstance(value, Mapping) else enumerate(value)
        for name, member in items:
            yield from _entries(member, f"{key}.{name}" if key else str(name))
    elif isinstance(value, bool) or not isinstance(value, int | float):
        yield key, join("–" if value is None else str(value))
    else:
        yield key, element("data", repr(value), value=repr(value), data_key=key)

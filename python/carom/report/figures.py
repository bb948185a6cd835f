"""The figures at the head of the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from carom.display.markup import Html, element, format_number, join, number

Summary = Mapping[str, Any]

MANIFOLD = 10.0
"""Shares of the energy at the start from which on they are no percentages."""


def key_figures(summary: Summary) -> Html:
    """Return the figures that a reader looks for first."""
    energy, certificate = summary.get("energy", {}), summary.get("certificate", {})
    contacts = summary.get("contacts")
    figures = [
        _figure("Reached", summary, "end_time", unit="s", below=_steps(summary)),
        _figure(
            "Energy at the end",
            energy,
            "final",
            prefix="energy.",
            unit="J",
            below=_share(energy, "final"),
        ),
        _figure(
            "Friction",
            energy,
            "friction",
            prefix="energy.",
            unit="J",
            below=_share(energy, "friction"),
        ),
        _figure(
            "Not explained",
            energy,
            "max_defect",
            prefix="energy.",
            unit="J",
            below=_share(energy, "max_defect"),
            digits=3,
        ),
        _figure(
            "Certificate",
            certificate,
            "max_joule",
            prefix="certificate.",
            unit="J",
            below=_allowed(certificate),
            digits=3,
        ),
        _figure("Newton iterations", summary, "newton_iterations", below=_retried(summary)),
        _figure("Wall time", summary, "wall_s", unit="s", below=_per_step(summary), digits=4),
    ]
    if contacts is not None:
        figures.insert(
            5, _shown_figure("Contacts", join(format_number(len(contacts))), _first(contacts))
        )
    return element("dl", *(figure for figure in figures if figure), class_="figures")


def _figure(
    title: str,
    part: Summary,
    name: str,
    *,
    prefix: str = "",
    unit: str = "",
    below: Html | None = None,
    digits: int = 5,
) -> Html | None:
    if part.get(name) is None:
        return None
    return _shown_figure(title, number(part[name], prefix + name, digits=digits, unit=unit), below)


def _shown_figure(title: str, value: Html, below: Html | None) -> Html:
    return element(
        "div",
        element("dt", title),
        element("dd", value),
        element("dd", below, class_="below") if below else None,
        class_="figure",
    )


def _steps(summary: Summary) -> Html | None:
    if summary.get("steps") is None:
        return None
    step = summary.get("time_step")
    of = join(" of ", number(step, "time_step", digits=4, unit="s")) if step is not None else None
    return join(number(summary["steps"], "steps"), " steps", of)


def _share(energy: Summary, name: str) -> Html | None:
    initial = energy.get("initial")
    if not initial or not energy.get(name):
        return None
    share = energy[name] / initial
    if abs(share) >= MANIFOLD:
        return join(f"{format_number(share, 3)} times the initial energy")
    text = f"{100 * share:.3g} %" if abs(share) >= 1e-4 else format_number(share, 2)
    return join(text, " of the initial energy")


def _allowed(certificate: Summary) -> Html | None:
    if certificate.get("tolerance_joule") is None:
        return None
    allowed = number(
        certificate["tolerance_joule"], "certificate.tolerance_joule", digits=3, unit="J"
    )
    return join(allowed, " allowed")


def _retried(summary: Summary) -> Html | None:
    parts = []
    for name, what in (("retried_steps", "retried step"), ("factorisations", "factorisation")):
        if (count := summary.get(name)) is not None:
            parts.append(join(number(count, name), f" {what}{'' if count == 1 else 's'}"))
    return join(*(join(", " if index else "", part) for index, part in enumerate(parts))) or None


def _per_step(summary: Summary) -> Html | None:
    if summary.get("wall_s_per_step") is None:
        return None
    dofs = summary.get("dofs")
    return join(
        number(summary["wall_s_per_step"], "wall_s_per_step", digits=3, unit="s"),
        " per step",
        join(", ", number(dofs, "dofs"), " dofs") if dofs is not None else None,
    )


def _first(contacts: Sequence[Summary]) -> Html | None:
    if not contacts:
        return join("nothing has touched")
    return join(
        "the first at ", number(contacts[0].get("onset"), "contacts.0.onset", digits=4, unit="s")
    )

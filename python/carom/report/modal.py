"""Vibration by modes: a spectrogram of every body, and which modes ring after which contact."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from carom.display.markup import Html, element, format_number, join
from carom.display.si_prefix import prefixed
from carom.modes.energies import ModalEnergies

DECADES = 4
"""Powers of ten of energy that are told apart."""

COLUMNS = 400
"""Of a spectrogram, at most."""

MOST_BODIES = 6
"""Bodies with a spectrogram, those that vibrate most."""

MOST_EVENTS = 40
"""Rows of the table, of the hardest contacts."""

STRONGEST = 3
"""Modes that are named for each."""

LEAST_SHARE = 0.01
"""Of the energy of all modes, that one must have to be named."""

LABELS = 20
"""Modes with their frequency at the side, at most."""

_ROW = 15
"""Height of a mode [px]."""

Summary = Mapping[str, Any]
Modes = Mapping[str, ModalEnergies]


def spectrograms(modes: Modes) -> Html | None:
    """Return the spectrograms of the bodies that vibrate most; None if nothing vibrates."""
    drawn = sorted(modes.values(), key=_largest, reverse=True)
    shown = [one for one in drawn if _largest(one) > 0.0 and len(one.times) > 1][:MOST_BODIES]
    if not shown:
        return None
    parts = [_spectrogram(index, one) for index, one in enumerate(shown)]
    more = len(modes) - len(shown)
    hint = (
        "Kinetic and strain energy of each mode, the slowest below: full colour is the most that "
        f"a mode of the body had, no colour a {format_number(10**DECADES)}th of it or less."
    )
    if more:
        hint += f" {more} more {'bodies are' if more > 1 else 'body is'} in modes.csv."
    return join(*parts, element("p", hint, class_="hint"))


def _largest(one: ModalEnergies) -> float:
    return float(one.energies.max(initial=0.0))


def _spectrogram(index: int, one: ModalEnergies) -> Html:
    count = len(one.frequencies)
    every = -(-count // LABELS)
    labels = (
        element("li", _hertz(one.frequencies[k]), style=f"bottom:{100 * (k + 0.5) / count:.3f}%")
        for k in range(0, count, every)
    )
    unit, size = prefixed("J", _largest(one))
    most = f"{format_number(_largest(one) / size, 3)}\u202f{unit}"
    mask = element(
        "mask",
        element(
            "image",
            href=_picture(one),
            width="1",
            height="1",
            preserveAspectRatio="none",
        ),
        id=f"modes-{index}",
    )
    drawing = element(
        "svg",
        mask,
        element("rect", width="1", height="1", mask=f"url(#modes-{index})"),
        viewBox="0 0 1 1",
        preserveAspectRatio="none",
        role="img",
        aria_label=f"Energy of {count} modes of {one.body} over time, {most} at most",
    )
    return element(
        "div",
        element("h3", one.body, " ", element("span", f"up to {most}", class_="faint")),
        element(
            "div",
            element("ul", *labels, aria_hidden="true"),
            element("div", drawing, class_="track", style=f"height:{_ROW * count}px"),
            class_="bands",
        ),
        class_="spectrogram",
        data_from=repr(float(one.times[0])),
        data_to=repr(float(one.times[-1])),
    )


def _picture(one: ModalEnergies) -> str:
    """Return the energies as an image: a row for every mode, the fastest above, white for most."""
    columns = min(COLUMNS, 2 * len(one.times))
    at = one.times[0] + (np.arange(columns) + 0.5) / columns * (one.times[-1] - one.times[0])
    after = np.searchsorted(one.times, at).clip(1, len(one.times) - 1)
    is_nearer = at - one.times[after - 1] < one.times[after] - at
    energies = one.energies[np.where(is_nearer, after - 1, after)]
    with np.errstate(divide="ignore"):
        level = 1.0 + np.log10(energies / _largest(one)) / DECADES
    grey = np.rint(255.0 * level.clip(0.0, 1.0)).astype(np.uint8).T[::-1]
    content = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(grey)).save(content, format="PNG", optimize=True)
    return "data:image/png;base64," + base64.b64encode(content.getvalue()).decode()


def _hertz(frequency: float) -> str:
    unit, size = prefixed("Hz", frequency)
    return f"{format_number(float(frequency / size), 3)}\u202f{unit}"


def ringing_table(modes: Modes, summary: Summary) -> Html | None:
    """Return which modes of which body ring after which contact, until something touches it."""
    rows = [_row(*found) for found in _rings(modes, summary.get("contacts") or ())]
    if not rows:
        return None
    titles = ("parted [s]", "body", "rings most at", "in all modes [J]")
    head = element(
        "tr",
        element("th", "after the contact of", scope="col"),
        *(
            element("th", title, scope="col", class_="number" if "[" in title else None)
            for title in titles
        ),
    )
    return element("table", element("thead", head), element("tbody", *rows))


_Ring = tuple[Summary, ModalEnergies, NDArray[np.float64]]


def _rings(modes: Modes, contacts: Any) -> Iterator[_Ring]:  # noqa: ANN401 (JSON)
    """Yield contacts, a body of each, and the mean energy of its modes until the next contact."""
    hardest = sorted(contacts, key=lambda contact: -(contact.get("peak_force") or 0.0))
    for contact in sorted(hardest[:MOST_EVENTS], key=lambda contact: contact["onset"]):
        release = contact["release"]
        for name in dict.fromkeys(contact["pair"]):
            one = modes.get(name)
            if one is None or release is None:
                continue
            others = [c for c in contacts if name in c["pair"] and c is not contact]
            if any(c["onset"] <= release and _end(c) > release for c in others):
                continue  # something else still presses
            until = min((c["onset"] for c in others if c["onset"] > release), default=np.inf)
            free = (one.times >= release) & (one.times <= until)
            if free.any() and (mean := one.energies[free].mean(axis=0)).sum() > 0.0:
                yield contact, one, mean


def _end(contact: Summary) -> float:
    return float(np.inf if contact["release"] is None else contact["release"])


def _row(contact: Summary, one: ModalEnergies, mean: NDArray[np.float64]) -> Html:
    total = float(mean.sum())
    loudest = np.argsort(-mean, kind="stable")[:STRONGEST]
    named = ", ".join(
        f"{_hertz(one.frequencies[k])} ({100 * mean[k] / total:.0f} %)"
        for k in loudest
        if mean[k] > LEAST_SHARE * total
    )
    go = element(
        "button",
        " – ".join(map(str, contact["pair"])),
        type="button",
        class_="go",
        data_time=repr(contact["release"]),
        title="Show the end of this contact",
    )
    return element(
        "tr",
        element("th", go, scope="row"),
        element("td", format_number(contact["release"], 4), class_="number"),
        element("td", one.body),
        element("td", named),
        element("td", element("data", format_number(total, 4), value=repr(total)), class_="number"),
    )

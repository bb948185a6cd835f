"""What a run records, and how often."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from carom.case.description import Count, Description, Name, NonNegative, Positive, Vector


class Track(Description):
    """A point whose motion is recorded in the history.

    Parameters
    ----------
    name
        Unique over bodies, obstacles, springs and tracked points.
    body
        Name of the body.
    point
        Reference position [m], shape [D]; the nearest node of the body is taken.
    """

    name: Name
    body: str
    point: Vector


class Output(Description):
    """What a run records.

    Parameters
    ----------
    fields_every
        Time between two frames of fields [s]; None takes a 200th of the run, or of each stage.
    history_every
        Time between two rows of history [s]; None takes a 1000th of the run, or of each stage.
    checkpoint_every
        Time between two checkpoints, from which a run that was stopped goes on [s]; None takes ten
        minutes of wall time.
    merge_contacts
        Contact events of a pair closer than this count as one [s]; None takes the shortest of the
        times that a pressure wave needs along the longest sides of its bodies. That default is at
        least three time steps, and 0 in a static analysis.
    track
        Points to follow.
    audit
        Whether the last step before each frame of fields is kept as its two states. The
        audit can then check every equation of the step and not only its outcome.
    modes
        Over how many modes of each body its vibration and strain are split when the run ends,
        frame by frame of the fields, as `carom modes` does: into ``modes.csv``, and into the
        report. None splits nothing. Of bodies that deform and are elastic.
    report
        Whether the run ends with ``report.html``, a page with the animated bodies, the energies
        and all numbers, as `carom report` writes it.
    """

    fields_every: Positive | None = None
    history_every: Positive | None = None
    checkpoint_every: Positive | None = None
    merge_contacts: NonNegative | None = None
    track: tuple[Track, ...] = ()
    audit: Annotated[bool, Field(strict=True)] = False
    modes: Count | None = None
    report: Annotated[bool, Field(strict=True)] = False

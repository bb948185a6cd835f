"""What ``summary.json`` says of a run, by key; energies in J, forces in N, times in s.

What is not a finite number is null in the file, and None here.
"""

from typing import Literal

from typing_extensions import NotRequired, TypedDict

from carom.ledger_terms import BodyTerms, PairTerms, RunTerms

Status = Literal["completed", "uncertified", "intersecting", "stopped", "failed", "interrupted"]
"""How a run ended."""


class EnergySummary(RunTerms):
    """The energy at the start and the end, kinetic and strain energy now, and its terms."""

    initial: float
    final: float
    max_drift: float
    max_defect: float
    max_step_defect: float


class CertificateSummary(TypedDict):
    """How far the worst step was from Coulomb's law, and what a completed run may have.

    The tolerance is relative to ``reference_joule``: the largest energy of the run or, if that is
    more, the largest work of a step's reactions over the motion they prevent. Of the worst step
    ``solver_joule`` is what the solver of the contact problem left; the rest is of Newton's
    iterations.
    """

    max_joule: float
    solver_joule: NotRequired[float]
    max_residual: float
    reference_joule: NotRequired[float]
    tolerance_joule: float


class Crushed(TypedDict):
    """Cells of a body that were compressed to less than half, the worst to ``least``."""

    body: str
    cells: int
    least: float


class WorstPenetration(TypedDict):
    """Where two solids, or a body and itself, were deepest in terms of what is allowed [m, s].

    Where that was more than is allowed, ``crushed`` may be behind it.
    """

    between: list[str]
    depth: float
    allowed: float
    cell: float
    time: float
    at: list[float]
    crushed: Crushed | None


class PenetrationSummary(TypedDict):
    """How deep solids that may touch were in one another at the end of a step [m]."""

    max_depth: float
    worst: WorstPenetration | None


class FreeMotionSummary(TypedDict):
    """A motion that nothing resists and next to nothing drives, which static steps left undone.

    ``driving`` is what drives it in terms of the sum of all reactions.
    """

    body: str
    motion: str
    driving: float


class BodySummary(BodyTerms):
    """The books of a body."""

    name: str
    defect: float


class PairSummary(PairTerms):
    """The books of a pair that may touch, and how close contacts are that count as one [s]."""

    between: list[str]
    merge_contacts: NotRequired[float]
    has_touched: bool


class ImpactSummary(TypedDict):
    """What two solids did to one another from the onset of a contact to its release.

    Impulses [N s], speeds [m/s], coefficients of restitution, and changes of their energies [J].
    """

    impulse: float
    friction_impulse: float
    approach: float
    restitution: float | None
    sliding: float
    tangential_restitution: float | None
    translation: float
    rotation: float
    vibration: float
    strain: float
    plastic: float
    viscous: float


class ContactEvent(TypedDict):
    """A contact of a pair; it has no release, and no impact, while the pair may be touching."""

    pair: list[str]
    onset: float
    release: float | None
    peak_force: float
    friction_work: float
    impact: NotRequired[ImpactSummary | None]


class CrossCheckSummary(TypedDict):
    """What a second solver said of the contact problems."""

    problems: int
    solvers: dict[str, int]
    unsolved: int
    disagreements: int
    max_difference: float
    explained_difference: float
    time_of_max: float | None
    max_certificate_joule: float


class WarningSummary(TypedDict):
    """Something that speaks against the results; see `carom.CaromWarning`."""

    code: str
    message: str
    where: str
    value: float | None
    allowed: float | None


class StageSummary(TypedDict):
    """What came out of a stage: its own books, from its start to its end."""

    name: str
    start_time: float
    end_time: float
    time_step: float
    steps: int
    newton_iterations: int
    retried_steps: int
    energy: EnergySummary
    bodies: list[BodySummary]
    pairs: list[PairSummary]


class Summary(TypedDict):
    """What came out of a run, in a page."""

    status: Status
    reason: NotRequired[str]
    title: str
    version: str
    steps: int
    dofs: int
    size: NotRequired[float]
    end_time: float
    time_step: float
    newton_iterations: int
    factorisations: int
    retried_steps: int
    energy: EnergySummary
    certificate: CertificateSummary
    bodies: list[BodySummary]
    pairs: list[PairSummary]
    max_blend: float
    repaid: float
    least_friction: float
    min_gap: float | None
    free_motion: NotRequired[FreeMotionSummary]
    penetration: NotRequired[PenetrationSummary]
    cross_check: CrossCheckSummary | None
    contacts: list[ContactEvent]
    stages: NotRequired[list[StageSummary]]
    files: NotRequired[dict[str, str]]
    warnings: NotRequired[list[WarningSummary]]
    wall_s: float
    wall_s_per_step: float

"""What cannot be checked of bodies of other codes: without their code, and with it."""

from __future__ import annotations

from carom.auditing.arrays import AXES, components, turning_components
from carom.auditing.model import AuditModel
from carom.auditing.report import Findings
from carom.io import layout

MOTION = "how the centre of {name!r} moves between output times: its mass depends on the direction"

LAW = (
    "mass, law and equations of {name!r}, which its code alone knows: "
    "give its carom.ForeignBody to carom.audit(…, bodies=[…])"
)


def leave_codes(model: AuditModel, findings: Findings) -> None:
    """Say which numbers are believed of bodies of other codes.

    Their momenta are those that their mass makes, and nothing else tells of it.
    """
    turning = turning_components("angular_momentum", model.dimension)
    for body in model.bodies:
        if body.known and body.mass.plain:
            continue
        centre = [*AXES[: model.dimension], *components("v", model.dimension)]
        own = [f"{body.name}.{column}" for column in centre]
        sums = components("momentum", model.dimension)
        if body.known:
            believed = [f"history.csv: {name}, between output times" for name in (*own, *sums)]
            findings.leave(MOTION.format(name=body.name), *believed)
            continue
        own += turning_components(f"{body.name}.spin", model.dimension)
        believed = [f"history.csv: {name}" for name in (*own, *sums, *turning)]
        meshes = [f"{file}: mesh of {body.name}" for file in (layout.FIELDS, layout.SURFACE)]
        findings.leave(LAW.format(name=body.name), "summary.json: dofs", *believed, *meshes)

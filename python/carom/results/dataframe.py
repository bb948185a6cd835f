"""The tables of a run as pandas data frames."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from carom import ledger_terms
from carom.errors import InputError
from carom.io.summary_types import ImpactSummary
from carom.messages import known
from carom.system.extras import needed

if TYPE_CHECKING:
    import pandas

    from carom.results.result import Result

Table = Literal["history", "ledger", "contacts", "bodies", "pairs", "stages"]
"""What there is, see `Result.to_pandas`."""


def data_frame(result: Result, table: Table) -> pandas.DataFrame:
    """Return a table of a run; see `Result.to_pandas`."""
    pd = needed("pandas", of="to_pandas", extra="data")
    summary = result.summary
    frame: pandas.DataFrame
    if table == "history":
        frame = pd.DataFrame(result.history).set_index("time")
    elif table == "ledger":
        entries = {entry: pd.DataFrame(columns) for entry, columns in result.ledger.items()}
        frame = pd.concat(entries, names=["entry", None]).reset_index(level=1, drop=True)
        frame = frame.set_index("time", append=True)
    elif table == "contacts":
        names = ("onset", "release", "peak_force", "friction_work")
        of_impact = tuple(ImpactSummary.__annotations__)
        numbers = dict.fromkeys((*names, *of_impact), float)
        rows = [
            {
                **event,
                **(event.get("impact") or {}),
                "first": event["pair"][0],
                "second": event["pair"][1],
            }
            for event in summary["contacts"]
        ]
        frame = pd.DataFrame(rows, columns=["first", "second", *numbers]).astype(numbers)
    elif table == "bodies":
        frame = pd.DataFrame(summary["bodies"]).set_index("name")
    elif table == "pairs":
        books = [
            {"first": pair["between"][0], "second": pair["between"][1], **pair}
            for pair in summary["pairs"]
        ]
        columns = ["first", "second", *ledger_terms.names("pair"), "has_touched"]
        frame = pd.DataFrame(books, columns=columns).set_index(["first", "second"])
    elif table == "stages":
        plain = ["name", "start_time", "end_time", "steps"]
        stages = [
            {**{key: stage[key] for key in plain}, **stage["energy"]}  # type: ignore[literal-required]
            for stage in summary.get("stages", [])
        ]
        columns = [*plain, "initial", "final", *ledger_terms.names("run"), "max_defect"]
        frame = pd.DataFrame(stages, columns=columns).set_index("name")
    else:
        names = ["history", "ledger", "contacts", "bodies", "pairs", "stages"]
        raise InputError(f"{table}: no such table; {known(table, names)}")
    return frame

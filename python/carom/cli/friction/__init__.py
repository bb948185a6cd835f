"""``carom friction``: contact problems on their own.

`carom.friction` is reached as an attribute of carom, so that only these commands import scipy.
"""

from __future__ import annotations

import typer

from carom.cli.friction.bench import bench
from carom.cli.friction.convert import convert
from carom.cli.friction.solve import solve

app = typer.Typer(help="Contact problems with friction on their own.", no_args_is_help=True)
app.command()(solve)
app.command()(bench)
app.command()(convert)

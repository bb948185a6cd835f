"""Same input, same numbers, however many threads there are."""

import os
import subprocess
import sys

import pytest

CASE = (
    "--set=analysis.end_time=0.6",
    "--set=bodies.0.mesh.centre=[2.0, 1.5003]",
    "--set=bodies.1.mesh.centre=[4.2, 1.6]",
    '--set=analysis.scheme={kind="conserving"}',
    "--set=contact.condition=massless",
    "--set=contact.targets=smooth",
    "--set=output.history_every=1e-3",
)
"""A floor and a second cylinder are hit, with friction: bodies too small for threads to share."""

LARGE = (
    "--set=analysis.end_time=2e-3",
    "--set=analysis.time_step=2e-4",
    "--set=bodies.0.mesh.centre=[2.0, 1.0002]",
    "--set=bodies.0.mesh.divisions=80",
    '--set=analysis.scheme={kind="conserving"}',
    "--set=contact.condition=midpoint",
    "--set=output.history_every=2e-4",
)
"""A cylinder of 19,361 nodes hits the floor: above the 8,192 from which threads share bodies."""


def history(examples, out, threads, case):
    environment = {
        **os.environ,
        **{f"{name}_NUM_THREADS": str(threads) for name in ("RAYON", "OMP", "OPENBLAS", "MKL")},
    }
    command = [
        sys.executable,
        "-c",
        "from carom.cli import main; main()",
        "run",
        str(examples / "two_cylinders.toml"),
        *case,
    ]
    subprocess.run(
        [*command, "--quiet", "--out", str(out)], env=environment, check=True, capture_output=True
    )
    return (out / "history.csv").read_bytes()


@pytest.mark.parametrize(("case", "rows"), [(CASE, 500), (LARGE, 10)])
def test_history_is_the_same_to_the_byte_with_one_thread_and_two(examples, tmp_path, case, rows):
    one, two = (history(examples, tmp_path / str(n), n, case) for n in (1, 2))
    assert one.count(b"\n") > rows
    assert one == two

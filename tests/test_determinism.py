"""Same input, same numbers, however many threads there are."""

import os
import subprocess
import sys

CASE = (
    "--set=analysis.end_time=0.6",
    "--set=bodies.0.mesh.centre=[2.0, 1.5003]",
    "--set=bodies.1.mesh.centre=[4.2, 1.6]",
    '--set=analysis.scheme={kind="conserving"}',
    "--set=contact.condition=massless",
    "--set=contact.targets=smooth",
    "--set=output.history_every=1e-3",
)
"""A floor and a second cylinder are hit, with friction."""


def history(examples, out, threads):
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
        *CASE,
    ]
    subprocess.run(
        [*command, "--quiet", "--out", str(out)], env=environment, check=True, capture_output=True
    )
    return (out / "history.csv").read_bytes()


def test_history_is_the_same_to_the_byte_with_one_thread_and_two(examples, tmp_path):
    one, two = (history(examples, tmp_path / str(n), n) for n in (1, 2))
    assert one.count(b"\n") > 500
    assert one == two

"""Runs on several ranks, where MPI and PETSc are: in `.venv-ranks`, or where the tests run."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import carom

ROOT = Path(__file__).parents[3]
INTERPRETERS = (ROOT / ".venv-ranks" / "bin" / "python", Path(sys.executable))


def has_ranks(python):
    code = "import mpi4py, petsc4py"
    return (
        python.exists()
        and subprocess.run([python, "-c", code], check=False, capture_output=True).returncode == 0
    )


@pytest.fixture(scope="session")
def environment(tmp_path_factory):
    """Return the Python that has MPI and PETSc, and the variables that it runs with."""
    python = next((python for python in INTERPRETERS if has_ranks(python)), None)
    if python is None:
        pytest.skip("no mpi4py and petsc4py: tools/make_ranks_environment.sh brings them on Debian")
    # The carom of these tests, and nothing else of where it is installed.
    path = tmp_path_factory.mktemp("ranks")
    (path / "carom").symlink_to(Path(carom.__file__).parent)
    variables = {
        "PYTHONPATH": str(path),
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_rmaps_base_oversubscribe": "1",
        "OMPI_MCA_mpi_yield_when_idle": "1",
        "OMP_NUM_THREADS": "1",
        "TERM": "dumb",
    }

    return python, os.environ | variables


@pytest.fixture
def ranks(environment):
    """Return what starts Python with arguments on so many ranks, as a process."""
    python, variables = environment
    started = []

    def start(count, *arguments):
        process = subprocess.Popen(
            ["mpiexec", "-n", str(count), str(python), *map(str, arguments)],
            env=variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
        process.communicate()


@pytest.fixture
def run(ranks):
    """Return what runs Python on so many ranks to its end: exit status and what it said."""

    def run(count, *arguments):
        process = ranks(count, *arguments)
        said, complained = process.communicate(timeout=300)
        return process.returncode, said, complained

    return run

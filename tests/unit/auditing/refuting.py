"""What an audit refutes of a run once something in its results is not as the run left it."""

import shutil

import carom


def refuted_after(run, directory, tamper):
    """Return the names of the checks that fail of a copy of a run in which something is changed."""
    copy = directory / "copy"
    shutil.copytree(run, copy)
    tamper(copy)
    return {check.name for check in carom.audit(copy).refuted}

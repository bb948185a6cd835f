"""What an audit says of a run, and once something in its results is not as the run left it."""

import shutil

import carom


def confirmed(directory, bodies=()):
    """Return the checks of a run, of which none fails, by their names."""
    audit = carom.audit(directory, bodies=bodies)
    assert [(check.name, check.where, check.figure) for check in audit.refuted] == []
    return {check.name: check for check in audit.checks}


def refuted_after(run, directory, tamper, bodies=()):
    """Return the names of the checks that fail of a copy of a run in which something is changed."""
    copy = directory / "copy"
    shutil.copytree(run, copy)
    tamper(copy)
    return {check.name for check in carom.audit(copy, bodies=bodies).refuted}

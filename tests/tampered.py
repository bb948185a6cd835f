"""Copies of results in which something is not as the run left it."""

import shutil


def with_another_case(run, directory, old, new):
    """Copy a run to a directory; what its case says first as `old` is `new` there."""
    shutil.copytree(run, directory)
    text = (directory / "case.toml").read_text()
    assert old in text
    (directory / "case.toml").write_text(text.replace(old, new, 1))
    return directory


def with_another_number(run, directory, column, factor):
    """Copy a run to a directory; a number in the middle of its history is multiplied there."""
    shutil.copytree(run, directory)
    lines = [line.split(",") for line in (directory / "history.csv").read_text().splitlines()]
    at = lines[0].index(column)
    lines[51][at] = repr(float(lines[51][at]) * factor)
    (directory / "history.csv").write_text("\n".join(",".join(line) for line in lines) + "\n")
    return directory

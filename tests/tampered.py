"""Copies of results in which something is not as the run left it."""

import json
import shutil

import h5py


def little_more(value):
    """Return a number that differs by more than round-off, also from zero."""
    return value * (1 + 1e-6) + 1e-6


def in_case(old, new):
    """Change what the case says first as `old`."""

    def tamper(directory):
        path = directory / "case.toml"
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new, 1))

    return tamper


def in_h5(name, change):
    """Change a number in an HDF5 file: of a dataset its largest, of attributes the one named."""

    def tamper(directory):
        file, _, path = name.partition(":")
        with h5py.File(directory / file, "r+") as opened:
            path, _, attribute = path.partition("@")
            if attribute:
                opened[path].attrs[attribute] = change(opened[path].attrs[attribute])
                return
            values = opened[path][:]
            index = abs(values).ravel().argmax()
            values.ravel()[index] = change(values.ravel()[index])
            opened[path][...] = values

    return tamper


def in_csv(file, column, change=little_more, row=-3):
    """Change a number of a table, by default in the last row but two."""

    def tamper(directory):
        path = directory / file
        lines = [line.split(",") for line in path.read_text().splitlines()]
        at = lines[0].index(column)
        lines[row][at] = repr(change(float(lines[row][at])))
        path.write_text("\n".join(",".join(line) for line in lines) + "\n")

    return tamper


def in_summary(*keys, factor=1 + 1e-6):
    """Multiply a number of the summary by a factor."""

    def tamper(directory):
        path = directory / "summary.json"
        summary = json.loads(path.read_text())
        place = summary
        for key in keys[:-1]:
            place = place[key]
        place[keys[-1]] *= factor
        path.write_text(json.dumps(summary))

    return tamper


def with_another_case(run, directory, old, new):
    """Copy a run to a directory; what its case says first as `old` is `new` there."""
    shutil.copytree(run, directory)
    in_case(old, new)(directory)
    return directory


def with_another_number(run, directory, column, factor, row=51):
    """Copy a run to a directory; a number in a row of its history is multiplied there."""
    shutil.copytree(run, directory)
    lines = [line.split(",") for line in (directory / "history.csv").read_text().splitlines()]
    at = lines[0].index(column)
    lines[row][at] = repr(float(lines[row][at]) * factor)
    (directory / "history.csv").write_text("\n".join(",".join(line) for line in lines) + "\n")
    return directory

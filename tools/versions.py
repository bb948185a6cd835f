"""See that all places that state the version of carom agree, or state another in all of them.

The version is that of the workspace in ``Cargo.toml``: crates inherit it, maturin gives it to the
Python package, and ``carom.__version__`` is it. Cargo wants it again for crates that depend on one
another, and the citation and the changelog are read without Cargo.

``python tools/versions.py`` prints what differs; with ``--set 0.2.0`` it writes that version
everywhere, with ``--tag v0.2.0`` the tag must agree and the changelog have the day of the release.
``--news`` prints what the changelog says of the version.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

OWN = r"carom(?:-\w+)?"
"""Names of our crates."""

PLACES = (
    ("Cargo.toml", r'(?m)^\[workspace\.package\]\nversion = "(?P<version>[^"]+)"'),
    ("Cargo.toml", rf'(?m)^{OWN} = {{ path = "[^"]+", version = "(?P<version>[^"]+)" }}'),
    ("Cargo.lock", rf'(?m)^name = "{OWN}"\nversion = "(?P<version>[^"]+)"'),
    ("CITATION.cff", r"(?m)^version: (?P<version>\S+)"),
    ("CHANGELOG.md", r"\A(?s:.*?)^## \[(?P<version>[^\]]+)\]"),
)
"""Files and patterns of what they state; the first is what the others are measured by."""

RELEASED = re.compile(r"(?m)^## \[(?P<version>[^\]]+)\] – (?P<day>\d{4}-\d{2}-\d{2})$")


def stated(root: Path = ROOT) -> list[tuple[str, str]]:
    """Return every place that states the version, with what it states."""
    found = []
    for file, pattern in PLACES:
        text = (root / file).read_text(encoding="utf-8")
        matches = list(re.finditer(pattern, text, re.MULTILINE))
        if not matches:
            raise SystemExit(f"{file}: no version is where it was; tell tools/versions.py")
        found += [(f"{file}:{_line(text, m.start('version'))}", m["version"]) for m in matches]
    return found


def disagreements(root: Path = ROOT) -> list[str]:
    """Return a line for each place that does not state the version of the workspace."""
    (_, version), *others = stated(root)
    return [
        f"{place} states {other}, and the workspace {version}"
        for place, other in others
        if other != version
    ]


def state(version: str, root: Path = ROOT) -> None:
    """Write a version in all places; the changelog gets a heading for it, if it has none."""
    if not re.fullmatch(r"\d+\.\d+\.\d+", version):
        raise SystemExit(f"{version}: versions are three numbers, such as 0.2.0")
    for file, pattern in PLACES:
        path = root / file
        text = path.read_text(encoding="utf-8")
        if file == "CHANGELOG.md":
            new = f"## [{version}] – unreleased"
            text = text if f"## [{version}]" in text else text.replace("## [", f"{new}\n\n## [", 1)
        for match in reversed(list(re.finditer(pattern, text, re.MULTILINE))):
            start, end = match.span("version")
            text = text[:start] + version + text[end:]
        path.write_text(text, encoding="utf-8")


def unready(tag: str, root: Path = ROOT) -> list[str]:
    """Return what speaks against a release of this tag."""
    version = stated(root)[0][1]
    faults = [] if tag == f"v{version}" else [f"the tag is {tag}, and the version {version}"]
    days = {m["version"] for m in RELEASED.finditer((root / "CHANGELOG.md").read_text("utf-8"))}
    if version not in days:
        faults.append(f"CHANGELOG.md: give the day of the release, ## [{version}] – YYYY-MM-DD")
    return faults


def news(root: Path = ROOT) -> str:
    """Return what the changelog says of the version, without its heading."""
    text = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    _, _, section = text.partition(f"## [{stated(root)[0][1]}]")
    return section.partition("\n")[2].partition("\n## [")[0].strip()


def _line(text: str, position: int) -> int:
    return text.count("\n", 0, position) + 1


def main() -> int:
    """Run the script."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--set", metavar="VERSION", help="write this version in all places")
    parser.add_argument("--tag", help="refuse a tag that is not of this version")
    parser.add_argument("--news", action="store_true", help="print what is new in the version")
    options = parser.parse_args()
    if options.news:
        print(news())
        return 0
    if options.set:
        state(options.set)
    faults = disagreements() + (unready(options.tag) if options.tag else [])
    print(*faults or [f"version {stated()[0][1]} in {len(stated())} places"], sep="\n")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())

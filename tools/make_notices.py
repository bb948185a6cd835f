"""Write THIRD-PARTY-NOTICES.txt: the crates that are linked, and their licences.

``python tools/make_notices.py`` asks cargo for the crates of what is handed on, a wheel or the
library for C, and their normal dependencies on every platform (not those of builds and tests, nor
procedural macros, which stay in the compiler) and takes the licence texts from their sources. With
``--check`` nothing is written, and the exit status is 1 if the file is not up to date. Neither
needs more of the network than cargo itself: sources that are not there yet are downloaded as for a
build.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
NOTICES = ROOT / "THIRD-PARTY-NOTICES.txt"
PACKAGES = ("carom-python", "carom-c")

HEAD = """\
Notices of what a wheel of carom and its library for C contain

carom itself is licensed under MIT OR Apache-2.0 (LICENSE-MIT, LICENSE-APACHE). The native module
links the Rust crates below, the library for C some of them, and what they need of Rust's standard
library; the page of the report has JavaScript libraries, whose licences lie beside them
(report/vendor/LICENSE-*). Python packages that carom needs are installed on their own, with their
own notices.

Where a crate offers a choice of licences, it is used under the first one of: {preferred}.
`python tools/make_notices.py` writes this file.
"""

PREFERRED = ("MIT", "BSD-2-Clause", "Zlib", "Apache-2.0")
"""Which licence is taken of several that a crate offers: short texts first."""

STANDARD_LIBRARY = (
    "std",
    "Rust's standard library",
    "MIT OR Apache-2.0",
    "https://github.com/rust-lang/rust",
    "The Rust Project contributors",
)

MIT = (ROOT / "LICENSE-MIT").read_text(encoding="utf-8")
PERMISSION = MIT[MIT.index("Permission is hereby granted") :]
"""The text of the MIT licence, for crates that name it and come without a file."""


@dataclass(frozen=True)
class Crate:
    """A crate that is linked.

    Parameters
    ----------
    name, version, licence, home
        As its manifest has them.
    texts
        Licence texts, one or more.
    """

    name: str
    version: str
    licence: str
    home: str
    texts: tuple[str, ...]


def main() -> int:
    """Run the script."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="only say whether it is up to date")
    check = parser.parse_args().check
    written = text(crates())
    if check:
        if not NOTICES.exists() or NOTICES.read_text(encoding="utf-8") != written:
            print(f"{NOTICES.name}: out of date; run python tools/make_notices.py", file=sys.stderr)
            return 1
        return 0
    NOTICES.write_text(written, encoding="utf-8")
    return 0


def text(linked: list[Crate]) -> str:
    """Return the file: a list of the crates, then every text once with those it belongs to."""
    owners: dict[str, list[str]] = defaultdict(list)
    shown: dict[str, str] = {}
    for crate in linked:
        for each in crate.texts:
            owners[folded(each)].append(f"{crate.name} {crate.version}".strip())
            shown.setdefault(folded(each), each)
    parts = [HEAD.format(preferred=", ".join(PREFERRED))]
    parts += [f"{crate.name} {crate.version}: {crate.licence}, {crate.home}" for crate in linked]
    for key, names in owners.items():
        parts += ["", "=" * 80, ", ".join(names), "-" * 80, shown[key]]
    return "\n".join(parts) + "\n"


def folded(licence: str) -> str:
    """Return a text as it is compared: copies of one licence differ in line breaks and indents."""
    return " ".join(licence.split())


def crates() -> list[Crate]:
    """Return the linked crates of others by name, the standard library first."""
    names = linked()
    found = [
        described(package)
        for package in metadata()["packages"]
        if package["source"] and (package["name"], package["version"]) in names
    ]
    if len(found) != len({crate for crate in names if not crate[0].startswith("carom")}):
        raise SystemExit("cargo tree and cargo metadata disagree on the crates")
    name, what, licence, home, holder = STANDARD_LIBRARY
    standard = Crate(name, f"({what})", licence, home, (permission(holder),))
    return [standard, *sorted(found, key=lambda crate: (crate.name, crate.version))]


def linked() -> set[tuple[str, str]]:
    """Return name and version of every crate that is linked, on any platform."""
    packages = [word for name in PACKAGES for word in ("--package", name)]
    told = cargo(
        *("tree", *packages, "--edges", "normal,no-proc-macro", "--target", "all"),
        *("--prefix", "none", "--format", "{p}"),
    )
    pairs = (line.split()[:2] for line in told.splitlines() if line)
    return {(name, version.removeprefix("v")) for name, version in pairs}


def metadata() -> dict[str, Any]:
    """Return what cargo knows of all packages."""
    found: dict[str, Any] = json.loads(cargo("metadata", "--format-version", "1"))
    return found


def cargo(*arguments: str) -> str:
    """Run cargo and return what it prints."""
    command = ["cargo", arguments[0], "--locked", *arguments[1:]]
    return subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout


def described(package: dict[str, Any]) -> Crate:
    """Return a crate with the texts of the licence under which it is used."""
    folder = Path(package["manifest_path"]).parent
    licence = package["license"]
    chosen = choice(licence)
    home = package["repository"] or f"https://crates.io/crates/{package['name']}"
    texts = [file.read_text(encoding="utf-8").strip("\n") for file in files(folder, chosen)]
    if not any(states(chosen, each) for each in texts):
        # Ported algorithms come with notices of their own, beside which the crate's text may lack.
        if chosen == "Apache-2.0":
            texts.insert(0, (ROOT / "LICENSE-APACHE").read_text(encoding="utf-8").strip("\n"))
        elif chosen == "MIT":
            holders = [re.sub(r"\s*<.*>", "", author) for author in package["authors"]]
            texts.insert(0, permission(", ".join(holders) or f"the authors of {package['name']}"))
        else:
            raise SystemExit(f"{package['name']}: no text of {chosen} in {folder}")
    return Crate(package["name"], package["version"], licence, home, tuple(texts))


def choice(licence: str) -> str:
    """Return the licence that is taken of an SPDX expression; old ones have a slash for OR."""
    offered = re.split(r"\s+OR\s+|/", licence)
    for each in PREFERRED:
        if each in offered:
            return each
    raise SystemExit(f"licence {licence}: not one that carom has decided on; see PREFERRED")


def files(folder: Path, chosen: str) -> list[Path]:
    """Return the files with the chosen licence, and notices of parts that have others."""
    found = []
    for file in sorted(folder.iterdir()):
        name = file.name.upper()
        # COPYING and LICENSE without an ending say what the choice is where there is one.
        parts = name.startswith("COPYING.") or name.startswith("NOTICE")
        own = name.startswith("LICENSE") and states(chosen, file.read_text(encoding="utf-8"))
        if file.is_file() and (parts or own):
            found.append(file)
    return found


MARKS = {
    "MIT": "Permission is hereby granted, free of charge",
    "BSD-2-Clause": "Redistribution and use in source and binary forms",
    "Zlib": "This software is provided 'as-is'",
    "Apache-2.0": "TERMS AND CONDITIONS FOR USE, REPRODUCTION, AND DISTRIBUTION",
}
"""Words that only the text of a licence has."""


def states(licence: str, text: str) -> bool:
    """Say whether a text is that of a licence."""
    return folded(MARKS[licence]) in folded(text)


def permission(holder: str) -> str:
    """Return the MIT licence of somebody whose package names it without a text."""
    return f"MIT License\n\nCopyright (c) {holder}\n\n{PERMISSION}".strip("\n")


if __name__ == "__main__":
    sys.exit(main())

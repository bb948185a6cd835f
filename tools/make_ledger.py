"""Write what the table of ledger terms says where it is used.

``python tools/make_ledger.py`` reads crates/carom/src/ledger/terms.toml and writes the structs of
the core, the module ``carom.ledger_terms`` and the table of docs/theory.md. With ``--check``
nothing is written, and the exit status is 1 if one of them is not up to date.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import tomlkit

ROOT = Path(__file__).parents[1]
TABLE = ROOT / "crates/carom/src/ledger/terms.toml"
RUST = ROOT / "crates/carom/src/ledger/terms.rs"
PYTHON = ROOT / "python/carom/ledger_terms.py"
THEORY = ROOT / "docs/theory.md"

WRITTEN = "Written by tools/make_ledger.py from ledger/terms.toml of the core."
BEGIN, END = "<!-- terms of the ledger: tools/make_ledger.py -->", "<!-- end of the terms -->"
SIGNS = {"stored": "+", "given": "-", "taken": "+"}


@dataclass(frozen=True)
class Term:
    """A row of the table."""

    name: str
    books: Sequence[str]
    side: str
    meaning: str
    definition: str
    computed: str
    abaqus: str
    label: str
    colour: str
    of_body: str = ""
    of_pair: str = ""

    def meaning_in(self, book: str) -> str:
        """Return what it is in a book."""
        return {"body": self.of_body, "pair": self.of_pair}.get(book) or self.meaning


@dataclass(frozen=True)
class Book:
    """Somebody whose energy is accounted for, and the struct that does it."""

    name: str
    struct: str
    meaning: str
    balances: bool = True
    """Whether its terms explain one another."""


BOOKS = (
    Book("run", "Ledger", "What happened to the energy in a step, or since the start [J]."),
    Book(
        "body",
        "BodyLedger",
        "What happened to the energy of a body in a step, or since the start [J].",
    ),
    Book(
        "pair",
        "PairLedger",
        "What a pair did to the energy in a step, or since the start [J].",
        balances=False,
    ),
)


def balance(terms: Sequence[Term]) -> str:
    """Return the equation of the terms of a book."""
    stored = " + ".join(f"ΔE_{term.name}" for term in terms if term.side == "stored")
    given = " + ".join(term.name for term in terms if term.side == "given")
    taken = "".join(f" − {term.name}" for term in terms if term.side == "taken")
    return f"{stored} = {given}{taken} + defect"


def defect(terms: Sequence[Term]) -> list[str]:
    """Return the summands of what the other terms do not explain."""
    return [f"{SIGNS[term.side]} self.{term.name}" for term in terms]


def rust(terms: Sequence[Term]) -> str:
    """Return the structs of the core."""
    parts = [
        f"//! The terms of the books. {WRITTEN}\n",
        "use std::ops::AddAssign;\n",
        "use serde::Serialize;\n",
        "/// Terms of all books, in the order of their columns.\n"
        f"pub const TERMS: [&str; {len(terms)}] = [{', '.join(_quoted(t) for t in terms)}];\n",
    ]
    parts += [_struct(book, terms) for book in BOOKS]
    return "\n".join(parts)


def _quoted(term: Term) -> str:
    return f'"{term.name}"'


def _struct(book: Book, terms: Sequence[Term]) -> str:
    own = [term for term in terms if book.name in term.books]
    names = [term.name for term in own]
    lines = [f"/// {book.meaning}"]
    if book.name == "run":
        lines[0] += " Every term is computed from its own definition:"
    elif book.balances:
        lines[0] = lines[0].replace("[J].", "[J]:")
    if book.balances:
        lines += ["///", f"/// {balance(own)}."]
    lines += [
        "#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]",
        f"pub struct {book.struct} {{",
    ]
    for term in own:
        lines += [f"    /// {term.meaning_in(book.name)}", f"    pub {term.name}: f64,"]
    if not book.balances:
        lines += ["    /// Whether there was a reaction.", "    pub has_touched: bool,"]
    lines += ["}", "", f"impl {book.struct} {{"]
    if book.name == "run":
        quoted = ", ".join(_quoted(term) for term in own)
        lines += [
            "    /// The names of its terms.",
            f"    pub(crate) const NAMES: [&str; {len(own)}] = [{quoted}];",
            "",
        ]
    lines += [
        "    /// Its terms in the order of the columns.",
        f"    pub(crate) fn terms_mut(&mut self) -> [&mut f64; {len(own)}] {{",
        f"        [{', '.join(f'&mut self.{name}' for name in names)}]",
        "    }",
    ]
    if book.name != "run":
        cells = ", ".join(f"self.{t.name}" if t in own else "f64::NAN" for t in terms)
        lines += [
            "",
            "    /// Its terms in the columns `TERMS`; NaN where it has none.",
            f"    pub(crate) fn columns(&self) -> [f64; {len(terms)}] {{",
            f"        [{cells}]",
            "    }",
        ]
    if book.balances:
        first, *rest = defect(own)
        lines += [
            "",
            "    /// What the other terms do not explain [J].",
            "    #[must_use]",
            "    pub fn defect(&self) -> f64 {",
            f"        {first.removeprefix('+ ')} {' '.join(rest)}",
            "    }",
        ]
    if book.name == "run":
        lines += _additions(own)
    lines += [
        "}",
        "",
        f"impl AddAssign for {book.struct} {{",
        "    fn add_assign(&mut self, step: Self) {",
    ]
    lines += [f"        self.{name} += step.{name};" for name in names]
    if not book.balances:
        lines.append("        self.has_touched |= step.has_touched;")
    return "\n".join([*lines, "    }", "}", ""])


def _additions(own: Sequence[Term]) -> list[str]:
    shared = {book: [t.name for t in own if book in t.books] for book in ("body", "pair")}
    return [
        "",
        "    /// Adds what happened to a body, but for what it received through contact:",
        "    /// pairs say where that comes from.",
        "    pub(crate) fn add_body(&mut self, body: &BodyLedger) {",
        *(f"        self.{name} += body.{name};" for name in shared["body"]),
        "    }",
        "",
        "    /// Adds what a pair did.",
        "    pub(crate) fn add_pair(&mut self, pair: &PairLedger) {",
        *(f"        self.{name} += pair.{name};" for name in shared["pair"]),
        "    }",
    ]


def formatted(source: str) -> str:
    """Return Rust as the project formats it."""
    command = ["rustfmt", "--edition", "2024", "--config-path", str(ROOT), "--emit", "stdout"]
    done = subprocess.run(command, input=source, capture_output=True, text=True, check=True)
    return done.stdout


PYTHON_HEAD = f'''\
"""The terms of the energy books [J].

{WRITTEN}
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

from typing_extensions import TypedDict

Book = Literal["run", "body", "pair"]
"""Whose energy is accounted for: that of the run as a whole, a body's, what a pair did."""


class Term(NamedTuple):
    """A term: its name, whose books have it, on which side of them it stands.

    ``stored = given − taken + defect``; reports show it by its label and in its colour.
    """

    name: str
    books: tuple[Book, ...]
    side: Literal["stored", "given", "taken"]
    label: str
    colour: str

    @property
    def sign(self) -> float:
        """Its sign in the defect."""
        return -1.0 if self.side == "given" else 1.0
'''

PYTHON_MIDDLE = '''\


def terms(book: Book) -> tuple[Term, ...]:
    """Return the terms of a book."""
    return tuple(term for term in TERMS if book in term.books)


def names(book: Book) -> tuple[str, ...]:
    """Return the names of the terms of a book."""
    return tuple(term.name for term in terms(book))
'''


def python(terms: Sequence[Term]) -> str:
    """Return the module of the package."""
    lines = ["", "", "TERMS = ("]
    for t in terms:
        books = "".join(f'"{book}", ' for book in t.books).removesuffix(" " * (len(t.books) > 1))
        books = books.removesuffix("," if len(t.books) > 1 else " ")
        lines.append(f'    Term("{t.name}", ({books}), "{t.side}", "{t.label}", "{t.colour}"),')
    lines += [")", '"""All terms, in the order of their columns."""', ""]
    own = [term for term in terms if "run" in term.books]
    lines += [
        *PYTHON_MIDDLE.splitlines(),
        "",
        "",
        "@dataclass(frozen=True)",
        "class Ledger:",
        f'    """{BOOKS[0].meaning}',
        "",
        "    Every term is computed from its own definition:",
        *textwrap.wrap(f"{balance(own)}.", 96, initial_indent=" " * 4, subsequent_indent=" " * 4),
        "",
        "    Parameters",
        "    ----------",
    ]
    for term in own:
        lines += [f"    {term.name}", f"        {term.meaning}"]
    lines += ['    """', "", *(f"    {term.name}: float" for term in own), ""]
    lines += [
        "    @property",
        "    def defect(self) -> float:",
        '        """What the other terms do not explain [J]."""',
        "        return (",
        *(
            f"            {summand}".replace("    + ", "    ", i == 0)
            for i, summand in enumerate(defect(own))
        ),
        "        )",
    ]
    for book, name in (("run", "RunTerms"), ("body", "BodyTerms"), ("pair", "PairTerms")):
        lines += [
            "",
            "",
            f"class {name}(TypedDict):",
            f'    """The terms of a {book} in a file [J]."""',
            "",
        ]
        lines += [f"    {term.name}: float" for term in terms if book in term.books]
    return "\n".join([PYTHON_HEAD.rstrip("\n"), *lines, ""])


def formatted_python(source: str) -> str:
    """Return Python as the project formats it."""
    command = [sys.executable, "-m", "ruff", "format", "--stdin-filename", str(PYTHON), "-"]
    return subprocess.run(
        command, input=source, capture_output=True, text=True, check=True, cwd=ROOT
    ).stdout


def theory(terms: Sequence[Term]) -> str:
    """Return the page of the theory with its table."""
    rows = [f"| `{t.name}` | {t.definition} | {t.abaqus} | {t.computed} |" for t in terms]
    head = [
        "| column | definition, per step | Abaqus | computed in `crates/carom/src/` |",
        "|---|---|---|---|",
    ]
    last = "| `defect` | the difference of both sides | ETOTAL(t) − ETOTAL(0) | ledger/terms.rs |"
    total = "| `total` | E_t = E_c + E_e | ALLKE + ALLSE | ledger/mod.rs |"
    table = "\n".join([BEGIN, "", *head, *rows, total, last, "", END])
    page = THEORY.read_text(encoding="utf-8")
    return re.sub(f"{re.escape(BEGIN)}.*{re.escape(END)}", lambda _: table, page, flags=re.DOTALL)


def main() -> int:
    """Write, or check, what is not up to date."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing")
    check = parser.parse_args().check
    rows = tomlkit.parse(TABLE.read_text(encoding="utf-8")).unwrap()["term"]
    terms = [Term(**row) for row in rows]
    texts = {
        RUST: formatted(rust(terms)),
        PYTHON: formatted_python(python(terms)),
        THEORY: theory(terms),
    }
    stale = [
        path for path, text in texts.items() if not path.exists() or path.read_text("utf-8") != text
    ]
    for path in stale:
        print(f"{path.relative_to(ROOT)} {'is not up to date' if check else 'written'}")
        if not check:
            path.write_text(texts[path], encoding="utf-8")
    return int(check and bool(stale))


if __name__ == "__main__":
    sys.exit(main())

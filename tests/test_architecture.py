"""ARCHITECTURE.md names what there is: paths, identifiers where they are, dependencies."""

import re
from pathlib import Path

import pytest
import tomlkit

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")

LINK = re.compile(r"\[([^\]]+)\]\(([^)#\s]+)\)")
CODE = re.compile(r"`([^`\n]+)`")
PLACED = re.compile(
    r"((?:`[^`]+`(?:, | and |, of which )?)+) in (?:`([^`]+)`|\[[^\]]+\]\(([^)]+)\))"
)
NAME = re.compile(r"[A-Za-z_]\w+")
ENDINGS = {".rs", ".py", ".js", ".toml", ".json", ".html"}
BASES = ("", "crates", "python", "python/carom", "docs")
"""Where the paths that the document names begin."""

EVERYWHERE = "crates/carom/src/step/mod.rs"
"""The file that the table of a step follows, and so does not link in each row."""


def found(path):
    """Return the file or folder that a path of the document stands for, or None."""
    return next((ROOT / base / path for base in BASES if (ROOT / base / path).exists()), None)


def text_of(path):
    """Return a file's text; of a folder, or of its mod.rs, that of all files in it."""
    file = found(path)
    assert file is not None, path
    if file.name == "mod.rs":
        file = file.parent
    files = [file] if file.is_file() else [f for f in file.rglob("*") if f.suffix in ENDINGS]
    return "\n".join(f.read_text(encoding="utf-8") for f in files)


def names(code):
    """Return the identifiers of a piece of code: of `Scheme::step_map(dt)` the two first."""
    return NAME.findall(re.sub(r"\(.*|<.*", "", code))


def is_path(code):
    return bool(re.fullmatch(r"[\w.*/-]+", code)) and ("/" in code or Path(code).suffix in ENDINGS)


def defined(name, text):
    return re.search(rf"\b(?:fn|struct|enum|trait|type|const|class|def) {name}\b", text)


def misplaced(text):
    """Return the names that are not in the files said to hold them.

    A name that some crate defines is in the file that does, and not where it is used.
    """
    core = "\n".join(f.read_text(encoding="utf-8") for f in ROOT.glob("crates/*/src/**/*.rs"))
    lost = []
    for said, path, link in PLACED.findall(text):
        held = text_of(path or link)
        for name in (n for code in CODE.findall(said) if not is_path(code) for n in names(code)):
            in_core = "python/" not in (path or link) and defined(name, core)
            if not (defined(name, held) if in_core else re.search(rf"\b{name}\b", held)):
                lost.append((name, path or link))
    return lost


def section(title):
    """Return the rows of the table below a heading, each as its cells."""
    body = re.split(r"^## ", TEXT, flags=re.MULTILINE)
    (text,) = [part for part in body if part.startswith(title)]
    rows = [line for line in text.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row.strip("|").split(" | ")] for row in rows[2:]]


@pytest.fixture(scope="module")
def words():
    """Every word of the sources."""
    folders = ("crates", "python", "docs", "tests", "tools")
    files = (f for name in folders for f in (ROOT / name).rglob("*") if f.suffix in ENDINGS)
    sources = [*files, ROOT / "Cargo.toml", ROOT / "pyproject.toml", ROOT / "Makefile"]
    texts = (f.read_text(encoding="utf-8") for f in sources if f != Path(__file__))
    return set(NAME.findall("\n".join(texts)))


def test_links_lead_somewhere_and_are_named_after_it():
    links = [(name, path) for name, path in LINK.findall(TEXT) if "://" not in path]
    assert len(links) > 50
    assert [path for _, path in links if not (ROOT / path).exists()] == []
    files = [(name.replace("\\", ""), path) for name, path in links if Path(name).suffix]
    assert [(name, path) for name, path in files if not path.endswith(name)] == []


def test_paths_and_identifiers_that_the_document_names_exist(words):
    spans = set(CODE.findall(TEXT))
    paths = {span for span in spans if is_path(span) and "*" not in span}
    produced, foreign = {"fields.vtkhdf"}, {"logging"}  # by a run, of Python
    assert sorted(p for p in paths - produced if found(p) is None) == []
    named = {name for span in spans - paths for name in names(span)}
    assert sorted(named - words - foreign) == []


def test_identifiers_are_in_the_files_where_they_are_said_to_be():
    """Symptom guarded against: `missed_one` in the step, which the contacts have."""
    assert len(PLACED.findall(TEXT)) > 20
    assert misplaced(TEXT) == []
    assert misplaced("`missed_one` in `carom/src/step/mod.rs`") != []


@pytest.mark.parametrize("title", ["One step", "Core types"])
def test_tables_link_the_files_that_hold_what_they_name(title):
    rows = section(title)
    assert len(rows) > 10
    for row in rows:
        paths = [path for _, path in LINK.findall(row[-1])]
        held = "".join(map(text_of, [*paths, *([EVERYWHERE] if title == "One step" else [])]))
        told = row[-1] if title == "One step" else row[0]
        for name in (n for code in CODE.findall(told) for n in names(code)):
            assert defined(name, held), (name, paths)


def test_crates_know_what_the_document_lets_them_know():
    """Symptom guarded against: a row that said `carom`, `carom-mesh` of a crate that uses four."""
    rows = {CODE.findall(row[0])[0]: row for row in section("Crates")}
    crates = sorted(path.parent.name for path in (ROOT / "crates").glob("*/Cargo.toml"))
    assert sorted(rows) == crates
    for crate, row in rows.items():
        manifest = tomlkit.parse((ROOT / "crates" / crate / "Cargo.toml").read_text())
        uses = {name for name in manifest["dependencies"] if name in rows}
        told = set(CODE.findall(row[2])) & set(rows)
        if "all of the above" in row[2]:
            told |= set(list(rows)[: list(rows).index(crate)])
        assert uses <= told, crate
        assert told - uses <= {"carom-fem"} if crate == "carom-python" else told == uses, crate


def test_decisions_are_numbered_and_dated():
    records = sorted((ROOT / "docs" / "decisions").glob("[0-9]*.md"))
    assert [int(record.name[:3]) for record in records] == list(range(1, len(records) + 1))
    for record in records:
        title, _, place, *_ = record.read_text(encoding="utf-8").splitlines()
        assert re.match(rf"# {int(record.name[:3])}\. \w", title), record
        assert re.match(r"\d{4}-\d{2}-\d{2}", place), record


def test_links_of_decisions_lead_somewhere():
    for page in (ROOT / "docs" / "decisions").glob("*.md"):
        links = [path for _, path in LINK.findall(page.read_text(encoding="utf-8"))]
        lost = [p for p in links if "://" not in p and not (page.parent / p).exists()]
        assert lost == [], page

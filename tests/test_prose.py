"""Pages are read by people: paragraphs are short, and links lead somewhere."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

PAGES = [
    ROOT / "README.md",
    *sorted(page for page in (ROOT / "docs").rglob("*.md") if "decisions" not in page.parts),
]

MOST_WORDS = 90
"""Of a paragraph."""

FENCE = re.compile(r"^(`{3,}|~{3,}|\${2})[^\n]*\n.*?^\1\s*$", re.DOTALL | re.MULTILINE)
"""Code, and formulae."""

ITEM = re.compile(r"\n(?=\s*(?:[-*]|\d+\.)\s)|<br>")
"""Where an item of a list begins, or a line of its own: a message and what to do about it."""

LINK = re.compile(r"\]\(([^)\s]+)\)")


def paragraphs(page):
    """Yield the paragraphs of a page, and the items of its lists, without tables and code."""
    text = FENCE.sub("\n\n", page.read_text(encoding="utf-8"))
    for part in re.split(r"\n\s*\n", text):
        if not part.lstrip().startswith(("|", "#", "<", ":::")):
            yield from (item for item in ITEM.split(part) if not item.startswith("    "))


def words(paragraph):
    """Count the words that are read: an address of a link is not."""
    return len(re.sub(r"\]\([^)]*\)", "]", paragraph).split())


def anchors(page):
    """Return the anchors of the headings of a page, as GitHub and MyST make them."""
    found = set()
    for heading in re.findall(r"^#+ (.*)$", FENCE.sub("", page.read_text("utf-8")), re.MULTILINE):
        plain = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()
        found.add(re.sub(r"[^\w\- ]", "", plain).strip().replace(" ", "-"))
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_paragraphs_are_short(page):
    long = [
        f"{words(paragraph)} words: {paragraph.strip()[:70]}…"
        for paragraph in paragraphs(page)
        if words(paragraph) > MOST_WORDS
    ]
    assert long == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_to_files_lead_somewhere(page):
    """The site's own links are checked by Sphinx; these are seen on GitHub too."""
    missing = []
    for target in LINK.findall(FENCE.sub("", page.read_text(encoding="utf-8"))):
        path, _, anchor = target.partition("#")
        if re.match(r"\w+:", target) or "gallery-pages" in path:
            continue
        file = (page.parent / path).resolve() if path else page
        is_there = file.exists() or file.with_suffix(".md").exists()
        has_anchor = not anchor or file.suffix != ".md" or anchor in anchors(file)
        if not (is_there and has_anchor):
            missing.append(target)
    assert missing == []


def test_a_long_paragraph_and_a_broken_link_are_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# One\n\n" + "word " * 91 + "\n\n- item\n- [a](b.md)\n", encoding="utf-8")
    assert max(map(words, paragraphs(page))) == 91
    with pytest.raises(AssertionError):
        test_paragraphs_are_short(page)
    with pytest.raises(AssertionError):
        test_links_to_files_lead_somewhere(page)

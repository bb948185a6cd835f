"""The checker of the site finds what it is for."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[3] / "tools"))
from check_site import broken

GOOD = '<html><a href="b.html#here">b</a><a href="https://x.org">x</a><img src="a.png"></html>'


def site(folder, a):
    (folder / "a.html").write_text(a, encoding="utf-8")
    (folder / "b.html").write_text('<h1 id="here">B</h1>', encoding="utf-8")
    (folder / "a.png").write_bytes(b"")
    return broken(folder)


def test_a_site_whose_links_lead_somewhere_is_in_order(tmp_path):
    assert site(tmp_path, GOOD) == []


def test_links_that_lead_nowhere_are_named(tmp_path):
    wrong = site(tmp_path, '<a href="c.html"></a><a href="b.html#there"></a><a href="#me"></a>')
    assert wrong == [
        "a.html: c.html is not there",
        "a.html: b.html#there has no such place",
        "a.html: #me has no such place",
    ]


def test_what_is_loaded_from_elsewhere_is_named(tmp_path):
    wrong = site(tmp_path, '<script src="https://cdn.org/x.js"></script>' + GOOD)
    assert wrong == ["a.html: loads https://cdn.org/x.js"]

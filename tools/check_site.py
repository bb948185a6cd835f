"""Check the built site in a browser without a network: ``python tools/check_site.py SITE``.

Every page, in light and in dark colours: nothing is fetched from elsewhere, no link leads nowhere,
and what `tools/page_audit.py` asks. Exit status 1 and a line for each finding.
"""

from __future__ import annotations

import sys
from collections import Counter
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

sys.path.insert(0, str(Path(__file__).parent))
from get_browser import found
from page_audit import audit, focus_is_seen

NO_HEADING = "search.html"
"""The page of which the theme makes the heading when there is something to show."""


class Links(HTMLParser):
    """Where a page leads, what it loads, and the anchors that it has."""

    def __init__(self) -> None:
        super().__init__()
        self.leads: list[str] = []
        self.loads: list[str] = []
        self.anchors: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take down what an element refers to."""
        given = {name: value for name, value in attrs if value}
        self.anchors.update(given[name] for name in ("id", "name") if name in given)
        if tag == "a" and "href" in given:
            self.leads.append(given["href"])
        if tag == "link" and given.get("rel") in ("stylesheet", "preload", "icon", "manifest"):
            self.loads.append(given.get("href", ""))
        if "src" in given:
            self.loads.append(given["src"])


def links_of(page: Path) -> Links:
    """Read the links of a page."""
    links = Links()
    links.feed(page.read_text(encoding="utf-8"))
    return links


def broken(site: Path) -> list[str]:
    """Return links that lead nowhere, and what pages would load from elsewhere."""
    pages = {page.resolve(): links_of(page) for page in sorted(site.rglob("*.html"))}
    wrong = []
    for page, links in pages.items():
        name = page.relative_to(site.resolve())
        wrong += [f"{name}: loads {load}" for load in links.loads if urlsplit(load).netloc]
        for target in [*links.leads, *links.loads]:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            file = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            anchor = unquote(parts.fragment)
            if not file.is_file():
                wrong.append(f"{name}: {target} is not there")
            elif anchor and file in pages and anchor not in pages[file].anchors:
                wrong.append(f"{name}: {target} has no such place")
    return wrong


def looked_at(site: Path, files: list[Path]) -> list[str]:
    """Return what a browser finds on pages, in light and in dark colours."""
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 (only in the dev extra)

    executable = found()
    if executable is None:
        return ["there is no Chromium: python tools/get_browser.py"]
    wrong: list[str] = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=["--no-sandbox"])
        for scheme in ("light", "dark"):
            context = browser.new_context(
                color_scheme=scheme, viewport={"width": 1200, "height": 900}
            )
            context.set_offline(True)
            page = context.new_page()
            asked: list[str] = []
            page.on("request", lambda request, asked=asked: asked.append(request.url))
            page.on("pageerror", lambda error, asked=asked: asked.append(str(error)))
            for file in files:
                name = f"{file.relative_to(site)} ({scheme})"
                asked.clear()
                page.goto(file.resolve().as_uri())
                wrong += [
                    f"{name}: {url}" for url in asked if not url.startswith(("file:", "data:"))
                ]
                findings = [f for f in audit(page) if "h1" not in f or file.name != NO_HEADING]
                wrong += [f"{name}: {finding}" for finding in findings]
                if scheme == "light":
                    wrong += [f"{name}: {finding}" for finding in focus_is_seen(page)]
            context.close()
        browser.close()
    return wrong


def main(arguments: list[str]) -> int:
    """Run the script; further arguments are the only pages to be looked at."""
    site = Path(arguments[0])
    files = [site / name for name in arguments[1:]] or sorted(site.rglob("*.html"))
    wrong = [*broken(site), *looked_at(site, files)]
    for finding in wrong:
        print(finding)
    print(f"{len(files)} pages looked at, in light and dark: {len(wrong)} findings")
    for finding, count in Counter(line.partition(": ")[2] for line in wrong).most_common(12):
        print(f"{count:5} × {finding}")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

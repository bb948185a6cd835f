"""The report of a part of 200,000 cells: how large it is, and how long until it can be used.

``python benchmarks/large_report.py [--out DIR]``. A plate falls on an edge, explicit in
time: what matters here is what the page makes of it. Where there is a Chromium it opens the page.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import carom
from carom.report import write_report

DIVISIONS = (200, 100, 10)


def scenario() -> carom.Scenario:
    """Describe a plate that comes down on the edge of an obstacle."""
    plate = carom.Body(
        name="plate",
        material="steel",
        mass="lumped",
        self_contact=False,
        mesh=carom.Box(corner=[0.0, 0.0, 1e-5], size=[0.2, 0.1, 0.01], divisions=list(DIVISIONS)),
        velocity=[0.0, 0.0, -5.0],
    )
    return carom.Scenario(
        title="A plate of 200,000 cells",
        dimension=3,
        analysis=carom.Dynamic(
            end_time=6e-6, time_step=1e-7, scheme=carom.Theta(theta=0.5, xi=0.0)
        ),
        output=carom.Output(fields_every=3e-7, history_every=1e-7),
        materials={"steel": carom.LinearElastic(young=210e9, poisson=0.3, density=7850.0)},
        bodies=[plate],
        obstacles=[
            carom.RigidBox(name="edge", corner=[0.0, -0.01, -0.02], size=[0.02, 0.12, 0.02])
        ],
        contact=carom.Contact(condition="midpoint", friction=0.3),
    )


def opened(page: Path) -> dict[str, float] | None:
    """Open the page and go through its frames; return times [s], None without a browser."""
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))
    from get_browser import WEBGL, found  # noqa: PLC0415 (of tools/)
    from playwright.sync_api import sync_playwright  # noqa: PLC0415 (only in the dev extra)

    executable = found()
    if executable is None:
        return None
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=executable, args=list(WEBGL))
        shown = browser.new_page()
        begun = time.perf_counter()
        shown.goto(page.resolve().as_uri())
        shown.wait_for_selector("html[data-ready]", timeout=300_000)
        ready = time.perf_counter() - begun
        frames = int(shown.locator("#scrub").get_attribute("max") or 0)
        # What a step costs the page itself; what the graphics take differs between machines.
        steps = shown.evaluate(
            """(frames) => {
              const scrub = document.getElementById("scrub");
              const begun = performance.now();
              for (let frame = 0; frame <= frames; frame++) {
                scrub.value = frame;
                scrub.dispatchEvent(new Event("input"));
              }
              return (performance.now() - begun) / 1e3;
            }""",
            frames,
        )
        browser.close()
    return {"ready": ready, "frames": frames + 1, "frame": steps / (frames + 1)}


def main() -> None:
    """Run the script."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path)
    out = parser.parse_args().out
    with TemporaryDirectory() as folder:
        directory = out or Path(folder) / "results"
        if not (directory / "summary.json").exists():
            carom.run(scenario(), out=directory)
        begun = time.process_time()
        page = write_report(directory)
        took = time.process_time() - begun
        cells = DIVISIONS[0] * DIVISIONS[1] * DIVISIONS[2]
        print(f"{cells} cells: report of {page.stat().st_size / 1e6:.1f} MB in {took:.0f} s")
        if seen := opened(page):
            print(
                f"ready after {seen['ready']:.1f} s, {seen['frames']:.0f} frames, "
                f"{1e3 * seen['frame']:.0f} ms from one to the next"
            )


if __name__ == "__main__":
    main()

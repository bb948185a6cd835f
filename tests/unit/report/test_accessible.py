"""The report and the scene of a notebook for those who see little, or use no mouse."""

import pytest
from page_audit import audit, focus_is_seen


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("which", ["disc", "ball"])
def test_the_report_has_names_keys_and_contrast(which, scheme, opened, request):
    result = request.getfixturevalue(which)
    page = opened(result.path / "report.html", color_scheme=scheme)
    for folded in page.locator("details").all():
        folded.evaluate("details => { details.open = true; }")
    assert audit(page) == []
    assert focus_is_seen(page, presses=30) == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_scene_of_a_notebook_has_names_keys_and_contrast(disc, browser, tmp_path, scheme):
    file = tmp_path / "notebook.html"
    file.write_text(f"<!doctype html><body>{disc._repr_html_()}</body>", encoding="utf-8")
    context = browser.new_context(color_scheme=scheme)
    page = context.new_page()
    page.goto(file.as_uri())
    (frame,) = [frame for frame in page.frames if frame.parent_frame is not None]
    frame.wait_for_selector("html[data-ready]", state="attached")
    # The name of a frame is that of the page in it: no heading is wanted there.
    assert [finding for finding in audit(frame) if "h1" not in finding] == []
    context.close()


def test_what_is_wrong_is_found(browser):
    page = browser.new_page()
    page.set_content(
        """<title>x</title><body style="background: #fff"><h2>late</h2>
        <p style="color: #999">pale</p><button></button><img src="data:,">
        <a href="#" tabindex="-1" style="outline: 0">away</a><b id="a"></b><i id="a"></i>
        <input aria-label="quiet" style="outline: none; box-shadow: none">"""
    )
    found = " ".join(audit(page))
    for part in (
        "no language",
        "not one h1",
        "contrast 2.8",
        "no name: <button",
        "no alt",
        "id twice",
    ):
        assert part in found
    assert "cannot be reached by keys: <a" in found
    assert "quiet" in " ".join(focus_is_seen(page, presses=3))
    page.close()

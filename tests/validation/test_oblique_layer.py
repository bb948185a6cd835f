"""A layer hits a rough floor obliquely: it sticks or slips, and dissipates what waves say."""

from functools import cache

import layer
import numpy as np
import pytest

measured = cache(lambda **case: layer.figures(layer.run(**case)))


@pytest.fixture(params=layer.VARIANTS, ids="-".join)
def variant(request):
    scheme, condition = request.param
    return {"scheme": scheme, "condition": condition}


def known_shortfall(variant, request):
    """Expect a failure of ``midpoint``, with which nodes that have mass bounce as they land.

    A landing keeps its energy: the sole presses in 3 of 10 steps of the touch, and friction acts in
    landings alone; see the next test. It dissipates up to 0.075 / N where the layer sticks, parts
    up to 1.06 / N too early, errs with the order 0.60 where it slips, and its dissipation depends
    on the width by 0.2 %.
    """
    if variant["condition"] == "midpoint":
        request.applymarker(
            pytest.mark.xfail(strict=True, reason="nodes with mass bounce as they land")
        )


@pytest.mark.parametrize(
    ("condition", "least", "most"), [("gap", 0.97, 1.0), ("midpoint", 0.2, 0.4)]
)
def test_share_of_the_touch_in_which_the_sole_presses(condition, least, most):
    history = layer.run(elements=32, ratio=0.2, scheme="conserving", condition=condition).history
    touch = history["time"] < layer.DURATION
    assert least <= np.mean(history["normal_force"][touch] > 0.0) <= most


def refined(ratio, **case):
    return [measured(elements=n, ratio=ratio, **case) for n in layer.ELEMENTS]


def test_closed_form_has_the_numbers_of_the_case():
    exact = [layer.exact_dissipation(ratio) for ratio in (0.2, 0.4, 1.0, 2.0)]
    assert exact == pytest.approx([0.0, 0.0, 0.24, 0.64])


def test_layer_that_sticks_dissipates_nothing_but_what_vanishes_with_the_mesh(variant, request):
    """It slips in the step of the touch, and where the ringing normal reaction is close to zero."""
    known_shortfall(variant, request)
    for n, figures in zip(layer.ELEMENTS, refined(layer.STICKING, **variant), strict=True):
        assert 0.0 <= figures.dissipation <= 0.02 / n


@pytest.mark.parametrize("ratio", layer.SLIPPING)
def test_layer_that_slips_dissipates_what_the_exact_solution_says(variant, ratio, request):
    """The order is that of the front, h^⅔: see the last test."""
    if ratio == layer.SLIPPING[0]:
        known_shortfall(variant, request)
    figures = refined(ratio, **variant)
    assert layer.error(figures[-1], ratio) <= 0.015 * layer.exact_dissipation(ratio)
    if variant["condition"] != "massless":
        assert layer.order(figures, ratio) == pytest.approx(2 / 3, abs=0.05)


def test_layer_parts_when_the_wave_has_returned(variant, request):
    known_shortfall(variant, request)
    for ratio in (layer.STICKING, *layer.SLIPPING):
        for n, figures in zip(layer.ELEMENTS, refined(ratio, **variant), strict=True):
            assert figures.duration == pytest.approx(layer.DURATION, abs=1.0 / n)


def test_width_does_not_matter(variant, request):
    known_shortfall(variant, request)
    one, eight = (measured(elements=32, ratio=2.0, cells=cells, **variant) for cells in (1, 8))
    assert one.dissipation == pytest.approx(eight.dissipation, rel=1e-9)
    assert one.deficit == pytest.approx(eight.deficit, abs=1e-9)


def test_faster_slip_dissipates_more_by_the_impulse_times_friction(variant, request):
    """Slip throughout: what the errors of both have in common is the impulse of the floor."""
    known_shortfall(variant, request)
    for slow, fast in zip(*(refined(ratio, **variant) for ratio in (1.0, 2.0)), strict=True):
        more = 2.0 * layer.FRICTION * (1.0 - slow.deficit)
        assert fast.dissipation - slow.dissipation == pytest.approx(more, rel=1e-9)


@pytest.mark.parametrize("ratio", layer.SLIPPING)
def test_errors_are_smaller_where_mesh_and_scheme_cancel_their_dispersion(variant, ratio):
    case = {**variant, "courant": layer.MATCHED}
    figures = refined(ratio, **case)
    bound = 0.004 if variant["condition"] == "massless" else 0.0025
    assert layer.error(figures[-1], ratio) <= bound * layer.exact_dissipation(ratio)
    if variant["condition"] == "gap":
        assert 0.8 <= layer.order(figures, ratio) <= 1.0


@pytest.mark.parametrize("ratio", layer.SLIPPING)
def test_massless_nodes_err_by_less_than_an_eighth_of_an_element(ratio):
    """A bound and not a fitted order: what the massless layer and the front do have opposite signs
    where κ ≠ 0, and the error passes through zero between N = 64 and 256; here κ = 0."""
    case = {"scheme": "conserving", "condition": "massless", "courant": layer.MATCHED}
    for n in (16, 32, 64, 128, 256):
        figures = measured(elements=n, ratio=ratio, **case)
        assert layer.error(figures, ratio) <= 0.125 / n
        assert figures.deficit <= 0.25 / n


@pytest.mark.parametrize("mass", ["consistent", "lumped"])
@pytest.mark.parametrize("courant", [0.25, 0.5, 1.0])
def test_impulse_lacks_what_the_dispersed_front_keeps_back(mass, courant):
    """Symptom explained: errors fall as h^⅔ although bodies and scheme are of second order.

    A step front is smeared over (κ h² L)^⅓ after a way L, and what rings behind it is still in the
    layer when it leaves. Were there another cause, the factor would depend on mass or time step.
    """
    for elements in (64, 128, 256):
        figures = measured(elements=elements, ratio=1.0, courant=courant, mass=mass)
        front = layer.smeared(elements=elements, courant=courant, mass=mass)
        assert figures.deficit == pytest.approx(0.41 * front, rel=0.07)

"""The oblique impact of a layer."""

from __future__ import annotations

import time

import layer
from runs import observed_order

from sections.layout import percent, signed, table

LAYER = """\
## Oblique impact of a layer

`carom run examples/oblique_layer.toml`: an elastic layer of height H, periodic along x, hits a
rough rigid floor with the velocity (v_t, −v_n); ρ = H = c_s = 1, c_p = 2 (ν = 1/3), μ = 0.2.

Exact, derived in `tests/validation/layer.py`: contact for 2 H/c_p = 1 s; it sticks and dissipates
nothing if v_t/v_n ≤ μ c_p/c_s = 0.4, else it slips throughout and
D = 2 μ ρ H v_n (v_t − μ (c_p/c_s) v_n). D is per area, in units of ρ H v_n². N square elements
across the layer, c_pΔt = h/4. The order is that in h of the errors, by least squares over
N = {first} … {last}. Asserted in `test_oblique_layer.py`.

{refinement}

The impulse lacks the same part of 2 ρ H v_n at any v_t, and the D of v_t/v_n = 2 exceeds that of 1
by 2 μ ρ H v_n² less that part, to round-off.

**Why the order is 2/3 and not 1.** A step of velocity that travels L is smeared by dispersion over
(|κ| h² L)^⅓ if waves of number k run at c_p (1 + κ k²h²), and what rings behind the front stays in
the layer as vibration when it leaves. κ = ±1/24 − (c_pΔt/h)²/12 with consistent (+) or lumped (−)
mass. The lack of impulse over (|κ| h²/H²)^⅓ is nearly the same number for all masses, time steps
and meshes (`theta`, `gap`):

{dispersion}

Where mesh and scheme cancel, at c_pΔt = h/√2, the next order of dispersion is left, (h⁴ L)^⅕: 4/5.
Errors of D, same N; those of `midpoint` are so small there that they show no order.

{matched}
"""


def section() -> str:
    """Run the layer at several ratios of its velocities, meshes and time steps, and describe it."""
    start = time.perf_counter()
    ratios = (layer.STICKING, *layer.SLIPPING)
    names = {variant: "`{}`, `{}`".format(*variant) for variant in layer.VARIANTS}

    def refined(variant: tuple[str, str], ratio: float, courant: float) -> list[layer.Figures]:
        scheme, condition = variant
        case = {"ratio": ratio, "scheme": scheme, "condition": condition, "courant": courant}
        return [layer.figures(layer.run(elements=n, **case)) for n in layer.ELEMENTS]

    refinement: list[tuple[object, ...]] = [
        ("exact", "", *(f"{layer.exact_dissipation(ratio):g}" for ratio in ratios), "1", "0")
    ]
    matched: list[tuple[object, ...]] = []
    for variant, name in names.items():
        fine = {ratio: refined(variant, ratio, layer.FINE) for ratio in ratios}
        for k, elements in enumerate(layer.ELEMENTS):
            row = [fine[ratio][k] for ratio in ratios]
            refinement.append(
                (
                    name,
                    elements,
                    *(f"{each.dissipation:.5f}" for each in row),
                    f"{row[-1].duration:.4f}",
                    percent(row[-1].deficit),
                )
            )
        orders = [f"{layer.order(fine[ratio], ratio):.2f}" for ratio in ratios]
        deficits = [each.deficit for each in fine[ratios[-1]]]
        sizes = [1.0 / n for n in layer.ELEMENTS]
        refinement.append((name, "order", *orders, "", f"{observed_order(sizes, deficits):.2f}"))
        for ratio in layer.SLIPPING:
            runs = refined(variant, ratio, layer.MATCHED)
            errors = [f"{layer.error(each, ratio):.1e}" for each in runs]
            told_order = f"{layer.order(runs, ratio):.2f}" if variant[1] == "gap" else "–"
            matched.append((name, f"{ratio:g}", *errors, told_order))
    dispersed = [
        (
            mass,
            f"{courant:g}",
            signed(layer.dispersion(courant=courant, mass=mass), 4),
            *(
                f"{figures.deficit / layer.smeared(elements=n, courant=courant, mass=mass):.3f}"
                for n in (64, 128, 256)
                for figures in [
                    layer.figures(layer.run(elements=n, ratio=1.0, courant=courant, mass=mass))
                ]
            ),
        )
        for mass in ("consistent", "lumped")
        for courant in (0.25, 0.5, 1.0)
    ]
    print(f"{time.perf_counter() - start:6.1f} s  layer", flush=True)
    return LAYER.format(
        first=layer.ELEMENTS[0],
        last=layer.ELEMENTS[-1],
        refinement=table(
            (
                "scheme, condition",
                "N",
                *(f"D, v_t/v_n = {ratio:g}" for ratio in ratios),
                "contact [s]",
                "lack of impulse",
            ),
            refinement,
        ),
        dispersion=table(("mass", "c_pΔt/h", "κ", "N = 64", "N = 128", "N = 256"), dispersed),
        matched=table(
            ("scheme, condition", "v_t/v_n", *(f"N = {n}" for n in layer.ELEMENTS), "order"),
            matched,
        ),
    )

"""Bodies of the plane in colours that run on from point to point."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist, allow_rasterization
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.transforms import IdentityTransform
from numpy.typing import NDArray


class Shading(Artist):
    """Triangles whose colours run on between their corners.

    A renderer knows colours and no values, and the mean of two colours of a map is none of its
    own. Triangles are cut until that is not seen: colours run on between neighbours in the map.

    In vector files it is an image: viewers differ in what they make of shaded triangles.

    Parameters
    ----------
    axes
        Where it is drawn.
    triangles
        Corners of each, shape [triangle_count, 3].
    cuts
        How often edges are halved.
    """

    def __init__(self, axes: Axes, triangles: NDArray[np.int64], *, cuts: int) -> None:
        super().__init__()
        self._triangles = triangles
        self._to_page = axes.transData
        self._weights = _cut(cuts)
        self._places = np.empty((0, 3, 2))
        self._colours = np.empty((0, 3, 4))
        self.set_rasterized(True)
        self.set_zorder(2)
        axes.add_artist(self)

    def update_values(
        self,
        where: NDArray[np.float64],
        values: NDArray[np.float64],
        mappable: Any,  # noqa: ANN401 (matplotlib's ScalarMappable, which has no type for this)
    ) -> None:
        """Take new places of the points [m], shape [point_count, 2], and their values."""
        places = np.einsum("skc,tcd->tskd", self._weights, where[self._triangles])
        finer = np.einsum("skc,tc->tsk", self._weights, values[self._triangles])
        self._places = places.reshape(-1, 3, 2)
        self._colours = mappable.to_rgba(finer.reshape(-1, 3))
        self.stale = True

    @allow_rasterization  # type: ignore[untyped-decorator]
    def draw(self, renderer: RendererBase) -> None:
        """Draw all triangles."""
        if not self.get_visible() or not len(self._places):
            return
        gc = renderer.new_gc()
        self._set_gc_clip(gc)  # type: ignore[attr-defined]
        places = self._to_page.transform(self._places.reshape(-1, 2)).reshape(-1, 3, 2)
        renderer.draw_gouraud_triangles(gc, places, self._colours, IdentityTransform())
        gc.restore()


def _cut(cuts: int) -> NDArray[np.float64]:
    """Return the corners of the parts of a triangle as weights of its own, shape [4^cuts, 3, 3]."""
    parts = np.eye(3)[np.newaxis]
    for _ in range(cuts):
        a, b, c = np.moveaxis(parts, 1, 0)
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        parts = np.concatenate(
            [
                np.stack(part, axis=1)
                for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
            ]
        )
    return parts

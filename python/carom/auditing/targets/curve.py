"""Where points are closest to a target of the plane: to its facets, or to the smooth curve.

Both are handled as segments of cubics in ξ from 0 to 1 whose coefficients are fixed combinations
of up to four nodes. A facet is one whose quadratic and cubic parts are zero.
"""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, einsum
from carom.auditing.targets.feet import BEYOND, CORNER, FLAT, TIE, Feet

_TURNS = 64
"""At most: as often [0, 1] is halved by bisection alone, down to round-off; a few are needed."""

_EPSILON = float(np.finfo(np.float64).eps)

_POWERS = np.arange(4)


class Curve:
    """The boundary of a body of the plane that nodes of others are checked against.

    Parameters
    ----------
    facets
        Facets in the body's numbering, the body on their left, shape [facet_count, 2 or 3]: their
        ends and, of cells of second order, what is between.
    points
        Reference positions of the body's nodes [m], shape [node_count, 2].
    smooth
        Whether it is the curve through its nodes; facets of second order stay as they are.
    """

    def __init__(self, facets: Indices, points: Array, *, smooth: bool) -> None:
        self.facets, self.width = facets, 4
        ends, curved = facets[:, :2], facets.shape[1] == 3
        smooth = smooth and not curved
        self.smooth: Mask = np.full(len(facets), smooth)
        self._nodes = np.concatenate([ends, ends], axis=1)
        tangents = np.zeros((len(facets), 2, 4))
        tangents[:, :, :2] = [-1.0, 1.0]
        if curved:
            # The parabola through three nodes.
            self._nodes[:, 2] = facets[:, 2]
            tangents[:, :] = [[-3.0, -1.0, 4.0, 0.0], [1.0, 3.0, -4.0, 0.0]]
        self.joined: Mask = np.zeros((len(facets), 2), dtype=bool)
        """Ends at which facets go on into others smoothly, at an angle, shape [facet_count, 2]."""
        around = np.bincount(ends.ravel(), minlength=len(points))
        self._rim = around[ends] == 1
        """Ends of facets where an open surface ends, shape [facet_count, 2]."""
        if smooth:
            self._join(facets, points, tangents)
        start, end = np.eye(4)[:2]
        t0, t1 = tangents[:, 0], tangents[:, 1]
        rise = end - start
        self._weights = np.stack(
            [np.broadcast_to(start, t0.shape), t0, 3 * rise - 2 * t0 - t1, t0 + t1 - 2 * rise],
            axis=1,
        )
        """Weights of the four nodes in the coefficients of 1, ξ, ξ², ξ³, [facet_count, 4, 4]."""

    def _join(self, facets: Indices, points: Array, tangents: Array) -> None:
        """Give facets that meet at an angle, but no corner, the tangent of a parabola.

        It goes through three nodes. Its parameter is the distance of the nodes in the reference
        configuration (Catmull–Rom).
        """
        chords = points[facets[:, 1]] - points[facets[:, 0]]
        lengths = np.linalg.norm(chords, axis=1)
        around = np.bincount(facets.ravel(), minlength=len(points))
        before = {int(b): f for f, (_, b) in enumerate(facets)}
        after = {int(a): f for f, (a, _) in enumerate(facets)}
        for f, ends in enumerate(facets):
            for end, sign in ((0, 1.0), (1, -1.0)):
                node = int(ends[end])
                g = (before, after)[end].get(node)
                if around[node] != 2 or g is None:
                    continue
                turn = chords[f] @ chords[g] / (lengths[f] * lengths[g])
                if turn < CORNER or turn > FLAT:
                    continue
                # Slopes of both chords, each weighted by the length of the other.
                own = lengths[g] / (lengths[f] + lengths[g])
                other = (1 - own) * lengths[f] / lengths[g]
                tangents[f, end] = [-own, own, 0.0, 0.0]
                tangents[f, end, end] += sign * other
                tangents[f, end, 2 + end] = -sign * other
                self._nodes[f, 2 + end] = facets[g, end]
                self.joined[f, end] = True

    def over(self, facet: int, xi: Array) -> tuple[Indices, Array]:
        """Return the nodes that points at ξ of a facet follow, and weights, [count, node]."""
        return self._nodes[facet], (xi[:, None] ** _POWERS) @ self._weights[facet]

    def feet(self, x: Array, position: Array) -> Feet:
        """Return all feet, see `Target`."""
        offset = self._offsets(x, position)
        at_start, at_end = (self._slope(offset, np.full(offset.shape[:2], xi)) for xi in (0.0, 1.0))
        # Round-off must not lose a foot at the joint of two segments.
        slack = TIE * einsum("pfi,pfi->pf", offset[:, :, 1], offset[:, :, 1])
        point, segment = np.nonzero((at_start <= slack) & (at_end >= -slack))
        parts = [(point, segment, self._closest(offset[point, segment]), np.zeros(len(point)))]
        for end, falls in ((0, at_start > 0), (1, at_end < 0)):
            point, segment = np.nonzero(falls & ~self.joined[:, end])
            local = offset[point, segment]
            xi = np.full(len(point), float(end))
            tangent = _combined(local, _slopes(xi))
            reach = -_slope(local, xi) / einsum("pi,pi->p", tangent, tangent)
            parts.append((point, segment, xi, np.clip(reach, -BEYOND, BEYOND)))
        point, segment, xi, beyond = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
        local = offset[point, segment]
        basis = xi[:, None] ** _POWERS + beyond[:, None] * _slopes(xi)
        tangent = _combined(local, _slopes(xi))
        normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        return Feet(
            point=point,
            facet=segment,
            gap=-einsum("pi,pi->p", normal, _combined(local, basis)),
            normal=normal,
            nodes=self._nodes[segment],
            weights=einsum("pj,pjk->pk", basis, self._weights[segment]),
            beyond=np.abs(beyond),
        )

    def signed_distance(self, x: Array, position: Array) -> Array:
        """Return the distances of points from it [m], see `Target`."""
        offset = self._offsets(x, position)
        shape = offset.shape[:2]
        flat = offset.reshape(-1, 4, 2)
        start, end = (_slope(flat, np.full(len(flat), xi)) for xi in (0.0, 1.0))
        xi = np.where(start > 0, 0.0, 1.0)
        inside = (start <= 0) & (end >= 0)
        xi[inside] = self._closest(flat[inside])
        far = (start > 0) & (end < 0)
        ends = [
            np.linalg.norm(_combined(flat, np.full((len(flat), 1), e) ** _POWERS), axis=1)
            for e in (0.0, 1.0)
        ]
        xi[far] = (ends[1] < ends[0])[far]
        d = _combined(flat, xi[:, None] ** _POWERS)
        tangent = _combined(flat, _slopes(xi))
        size = np.linalg.norm(tangent, axis=1)
        front = (-(d[:, 0] * tangent[:, 1] - d[:, 1] * tangent[:, 0]) / size).reshape(shape)
        distance = np.linalg.norm(d, axis=1).reshape(shape)
        closest = distance.min(axis=1, keepdims=True)
        tied = distance <= closest + TIE * size.reshape(shape)
        squarely = np.where(tied, np.abs(front), -1.0).argmax(axis=1)
        every = np.arange(len(x))
        signed: Array = np.copysign(closest[:, 0], front[every, squarely])
        beyond = np.stack([start > 0, end < 0], axis=-1).reshape(*shape, 2)
        at = np.stack([xi == 0.0, xi == 1.0], axis=-1).reshape(*shape, 2)
        off = (self._rim & beyond & at)[every, squarely].any(axis=1)
        return np.where(off, np.inf, signed)

    def _offsets(self, x: Array, position: Array) -> Array:
        """Return coefficients of segments minus points [m], shape [point, facet, 4, 2].

        Offsets have less round-off than positions.
        """
        offsets = position[self._nodes][None] - x[:, None, None]
        return einsum("fjk,pfki->pfji", self._weights, offsets)

    def _slope(self, offset: Array, xi: Array) -> Array:
        return _slope(offset.reshape(-1, 4, 2), xi.ravel()).reshape(xi.shape)

    @staticmethod
    def _closest(offset: Array) -> Array:
        """Return ξ in [0, 1] where the distance is smallest, by Newton's method between bounds.

        Where a step leaves the bounds they are halved. It ends where no slope falls any more.
        """
        low, high = np.zeros(len(offset)), np.ones(len(offset))
        falls, rises = _slope(offset, low), _slope(offset, high)
        xi = np.clip(-falls / np.where(rises > falls, rises - falls, 1.0), 0.0, 1.0)
        closest, least = xi, np.full(len(offset), np.inf)
        for _ in range(_TURNS):
            slope, bend = _slope(offset, xi), _bend(offset, xi)
            better = np.abs(slope) < least
            closest, least = np.where(better, xi, closest), np.where(better, np.abs(slope), least)
            low, high = np.where(slope < 0, xi, low), np.where(slope < 0, high, xi)
            step = xi - slope / np.where(bend > 0, bend, 1.0)
            halved = (bend <= 0) | (step < low) | (step > high)
            if not (better | halved & (high - low > _EPSILON)).any():
                break
            xi = np.where(halved, 0.5 * (low + high), step)
        return closest


def _slopes(xi: Array) -> Array:
    return np.stack([np.zeros_like(xi), np.ones_like(xi), 2 * xi, 3 * xi**2], axis=-1)


def _combined(offset: Array, basis: Array) -> Array:
    combined: Array = einsum("pji,pj->pi", offset, basis)
    return combined


def _slope(offset: Array, xi: Array) -> Array:
    """Return half the slope of the squared distance along segments, shape [count]."""
    slope: Array = (_way(offset, xi) * _tangent(offset, xi)).sum(axis=1)
    return slope


def _bend(offset: Array, xi: Array) -> Array:
    """Return half the second derivative of the squared distance along segments, shape [count]."""
    tangent, turn = _tangent(offset, xi), 2.0 * offset[:, 2] + 6.0 * xi[:, None] * offset[:, 3]
    bend: Array = (tangent**2 + _way(offset, xi) * turn).sum(axis=1)
    return bend


def _way(offset: Array, xi: Array) -> Array:
    x = xi[:, None]
    way: Array = offset[:, 0] + x * (offset[:, 1] + x * (offset[:, 2] + x * offset[:, 3]))
    return way


def _tangent(offset: Array, xi: Array) -> Array:
    x = xi[:, None]
    tangent: Array = offset[:, 1] + x * (2.0 * offset[:, 2] + x * (3.0 * offset[:, 3]))
    return tangent

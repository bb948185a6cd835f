"""Who has which cells."""

import numpy as np
import pytest

from carom.ranks.partition import ranks_of_cells, ranks_of_nodes


def grid(columns, rows):
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0))
    nodes = np.stack([x.ravel(), y.ravel()], axis=1)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    cells = np.stack([first, first + 1, first + columns + 2, first + columns + 1], axis=1)
    return nodes, cells.astype(np.uint32)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7])
def test_ranks_have_as_many_cells_and_short_borders(count):
    nodes, cells = grid(20, 14)
    ranks = ranks_of_cells(nodes, [cells[:100], cells[100:]], count)
    sizes = np.bincount(ranks, minlength=count)
    assert sizes.max() - sizes.min() <= 2
    of_nodes = ranks_of_nodes(len(nodes), [cells[:100], cells[100:]], ranks)
    assert (of_nodes[cells] <= ranks[:, None]).all()
    on_borders = sum(len(set(ranks[(cells == n).any(axis=1)])) > 1 for n in range(len(nodes)))
    assert on_borders <= 16 * (count - 1)


def test_more_ranks_than_cells_leave_some_without():
    nodes, cells = grid(1, 1)
    assert set(ranks_of_cells(nodes, [cells], 3)) <= {0, 1, 2}

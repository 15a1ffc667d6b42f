"""The best assignment of a large sparse graph: most by an auction, the rest by shortest paths.

Each plot has a price. A track wants the plot with the largest gain above its price, or none where
no gain is above 0. All tracks bid at once, as arrays; a plot goes to the highest bid at the price
of the second highest (Bertsekas 1988, without his epsilon). A few rounds settle most. Each track
that is left then looks for the cheapest chain of changes that frees a plot for it, or ends at a
track that goes without, by Dijkstra's method on what the plots cost (Jonker and Volgenant 1987).
Chains are short, so it matters little that this part is Python, and matrices of tracks by plots are
never made. Prices end such that no change gains anything: the assignment is the global optimum.
Where hundreds contest the same few plots chains are long: there a matrix is solved sooner, and the
search gives up when it is told to.
"""

from heapq import heappop, heappush

import numpy as np

from ..types import Array, IntArray

ROUNDS = 4  # of the auction; more settle hardly any


def best_pairs(
    row: IntArray, column: IntArray, gain: Array, rows: int, columns: int, patience: float = np.inf
) -> IntArray | None:
    """Of the pairs [P], those of the assignment with the largest total gain; in no order.

    row, column  [P]  of each pair; each row below `rows` and column below `columns` has one
    gain         [P]  > 0, over leaving row and column alone
    patience     looks at a pair, on average, after which it gives up: None
    """
    if rows > columns:  # the fewer search, the shorter are the chains
        row, column, rows, columns = column, row, columns, rows
    order = row.argsort(kind='stable')
    row, column, gain = row[order], column[order], gain[order]
    start = row.searchsorted(np.arange(rows + 1))
    price, held = _auction(row, column, gain, start[:-1], columns)
    found = _augment(row, column, gain, start, price, held, patience * len(gain))
    return None if found is None else order[found[found >= 0]]


def _auction(
    row: IntArray, column: IntArray, gain: Array, start: IntArray, columns: int
) -> tuple[Array, IntArray]:
    """Price [columns] of each column, and the pair that each row holds, or -1.

    A row holds what it wants most at these prices; a column that nobody holds costs nothing.
    """
    price, held = np.zeros(columns), np.full(len(start), -1)
    for _ in range(ROUNDS):
        value = gain - price[column]
        best = np.maximum.reduceat(value, start)
        top = (value == best[row]).nonzero()[0]
        wanted = np.where(held >= 0, held, top[top.searchsorted(start)])
        bidding = ((held >= 0) | (best > 0)).nonzero()[0]
        own = value[wanted]
        value[wanted] = -np.inf
        margin = np.maximum(own - np.maximum(np.maximum.reduceat(value, start), 0.0), 0.0)
        goods = column[wanted[bidding]]
        bid = price[goods] + margin[bidding]
        order = np.lexsort((-bid, goods))
        goods, bid = goods[order], bid[order]
        first = np.ones(len(goods), bool)
        first[1:] = goods[1:] != goods[:-1]
        won = first.nonzero()[0]
        rival = (won + 1 < len(goods)) & ~np.append(first, True)[won + 1]
        price[goods[won[rival]]] = bid[won[rival] + 1]
        held = np.full(len(start), -1)
        winner = bidding[order[won]]
        held[winner] = wanted[winner]
    return price, held


def _augment(
    row: IntArray,
    column: IntArray,
    gain: Array,
    start: IntArray,
    price: Array,
    held: IntArray,
    looks: float,
) -> IntArray | None:
    """The pair that each row holds, or -1, after every row without one has searched; None after
    so many looks at pairs."""
    best = np.maximum.reduceat(gain - price[column], start[:-1])
    searching = ((held < 0) & (best > 0)).nonzero()[0].tolist()
    owner = np.full(len(price), -1)
    owner[column[held[held >= 0]]] = (held >= 0).nonzero()[0]
    rows, columns, gains = row.tolist(), column.tolist(), gain.tolist()
    starts, prices, holds, owners = start.tolist(), price.tolist(), held.tolist(), owner.tolist()
    for root in searching:
        # Losses count from leaving the root alone: below 0 a change gains.
        least, end, last = 0.0, -1, root  # of a chain that ends at a free column, or at a row
        loss: dict[int, float] = {}
        came: dict[int, int] = {}
        done: dict[int, float] = {}
        heap: list[tuple[float, int]] = []
        here, so_far = root, 0.0
        if looks < 0:
            return None
        while True:
            looks -= starts[here + 1] - starts[here]
            for pair in range(starts[here], starts[here + 1]):
                goods = columns[pair]
                if goods in done:
                    continue
                then = so_far - gains[pair] + prices[goods]
                if then < least and then < loss.get(goods, np.inf):
                    loss[goods], came[goods] = then, pair
                    heappush(heap, (then, goods))
            while heap and heap[0][1] in done:
                heappop(heap)
            if not heap or heap[0][0] >= least:
                break
            then, goods = heappop(heap)
            done[goods], here = then, owners[goods]
            if here < 0:
                least, end = then, goods
                break
            so_far = then + gains[holds[here]] - prices[goods]
            if so_far < least:
                least, last = so_far, here
        for goods, then in done.items():
            if then < least:
                prices[goods] += least - then
        if end < 0:
            if last == root:
                continue
            end, holds[last] = columns[holds[last]], -1
        while True:
            pair = came[end]
            taker = rows[pair]
            owners[end], given_up = taker, holds[taker]
            holds[taker] = pair
            if taker == root:
                break
            end = columns[given_up]
    return np.array(holds)

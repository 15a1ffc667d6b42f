"""The result of an experiment: figures, claims and pictures."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..files import Place, written
from .report import Claim, Figure

BORNE_OUT, NOT_BORNE_OUT, IN_PART = 'borne out', 'not borne out', 'borne out in part'

Progress = Callable[[int, int], None]  # parts done, and number of parts


class Picture(NamedTuple):
    """File name, size in inches, and the function that paints it on a matplotlib figure."""

    name: str
    size: tuple[float, float]
    paint: Callable[[Any], None]


class Result(NamedTuple):
    """figures; claims (published ones and our own) with verdicts; pictures, not drawn yet."""

    figures: list[Figure]
    claims: Sequence[Claim] = ()
    pictures: Sequence[Picture] = ()


def verdict(holds: bool, otherwise: str = NOT_BORNE_OUT) -> str:
    """The verdict as text."""
    return BORNE_OUT if holds else otherwise


def silent(done: int, whole: int) -> None:
    """Progress that shows nothing."""


def draw(folder: Place, pictures: Sequence[Picture]) -> list[Path]:
    """Draws all as PNG into the folder, which is created; returns the files. ValueError without
    matplotlib.
    """
    try:
        from matplotlib.figure import Figure as Canvas
    except ModuleNotFoundError as error:
        raise ValueError('drawing needs matplotlib: pip install "marine_tracker[plot]"') from error
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    drawn = []
    for picture in pictures:
        canvas = Canvas(figsize=picture.size, layout='constrained')
        picture.paint(canvas)
        drawn.append(folder / f'{picture.name}.png')
        with written(drawn[-1], 'wb') as file:
            canvas.savefig(file, format='png', dpi=110)
    return drawn

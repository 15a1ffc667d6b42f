"""Whether a path names a recording of topics; needs no package that reads one."""

from pathlib import Path

from ..files import Place


def is_mcap(path: Place) -> bool:
    """Whether it is an MCAP file, or a folder of them."""
    path = Path(path)
    return path.suffix == '.mcap' or (path.is_dir() and any(path.glob('*.mcap')))

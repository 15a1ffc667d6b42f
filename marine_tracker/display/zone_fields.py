"""What a viewer may send of a zone: its shape only, for the tracker judges its values."""

from typing import Any

LONGEST_NAME = 80  # characters
KEYS = ('name', 'kind', 'fixed_to', 'range_m', 'bearing_deg', 'corners_m')


def name(command: str, field: str, value: Any) -> str:
    """A zone's name, or ''. ValueError else."""
    if not isinstance(value, str) or len(value) > LONGEST_NAME:
        raise ValueError(f'{command} needs {field}, a text of at most {LONGEST_NAME} characters')
    return value


def zone(command: str, field: str, value: Any) -> dict[str, Any]:
    """A mapping with known keys, whose values are texts, numbers, or lists of numbers."""
    if not isinstance(value, dict):
        raise ValueError(f'{command} needs {field}, an object')
    for key, given in value.items():
        if key not in KEYS:
            raise ValueError(f'{field} has no key {key[:40]!r}; it may have {", ".join(KEYS)}')
        if not _plain(given, 2):
            raise ValueError(f'{field}: {key} must be a text, a number, or a list of numbers')
    return value


def _plain(value: Any, depth: int) -> bool:
    if isinstance(value, list):
        return depth > 0 and all(_plain(one, depth - 1) for one in value)
    return isinstance(value, (str, int, float)) and not isinstance(value, bool)

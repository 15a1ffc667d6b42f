"""Reads files with limits. Writes files completely or not at all."""

import contextlib
import os
import reprlib
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

_BRIEF = reprlib.Repr()
_BRIEF.maxlevel, _BRIEF.maxdict, _BRIEF.maxlist, _BRIEF.maxtuple = 2, 3, 4, 4
_BRIEF.maxstring = _BRIEF.maxlong = _BRIEF.maxother = 60
LONGEST = 80  # characters of a value in a message

Place = str | os.PathLike[str]  # of a file


def shown(value: Any) -> str:
    """The value as shown in a message: as Python writes it; long ones are cut."""
    text = _BRIEF.repr(value)
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + '...'


def shortened(text: Any) -> str:
    """A name or path as shown in a message: in one line; long ones are cut."""
    line = ' '.join(str(text).split())
    return line if len(line) <= 200 else line[:197] + '...'


def regular(path: Place) -> Path:
    """The path, if it is a regular file; else ValueError (OSError if it does not exist).

    A pipe or a device might never end, or never begin.
    """
    found = Path(path)
    if not stat.S_ISREG(found.stat().st_mode):
        raise ValueError(f'{shortened(found)} is not a regular file')
    return found


def read_text(path: Place, limit: int) -> str:
    """The text of a regular file in UTF-8 of at most `limit` bytes.

    ValueError, in one line, if it is not such a file; OSError if it cannot be read.
    """
    path = regular(path)
    with open(path, 'rb') as file:
        content = file.read(limit + 1)
    if len(content) > limit:
        raise ValueError(f'{shortened(path)} has more than {limit} bytes; it must not')
    try:
        return content.decode('utf-8-sig')
    except UnicodeDecodeError as error:
        line = content.count(b'\n', 0, error.start) + 1
        raise ValueError(
            f'{shortened(path)}, line {line}: the byte 0x{content[error.start]:02x} is not UTF-8; '
            'save the file as UTF-8'
        ) from None


@contextlib.contextmanager
def written(path: Place, mode: str = 'w', **options: Any) -> Iterator[IO[Any]]:
    """A file to write. It replaces `path` only if the block ends without an error.

    It is written next to `path` and then renamed. After an error, SIGINT or a full disk, the old
    file is unchanged. If `path` is not a regular file (a pipe, /dev/null), it is written directly.
    mode, options  as for `open`
    """
    path = Path(os.path.realpath(path))
    if 'b' not in mode:
        options.setdefault('encoding', 'utf-8')
    if path.exists() and not path.is_file():
        with open(path, mode, **options) as file:
            yield file
        return
    beside = path.with_name(f'.{path.name[:200]}.{os.getpid()}.part')
    try:
        with open(beside, mode, **options) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        if path.exists():
            beside.chmod(stat.S_IMODE(path.stat().st_mode))
        beside.replace(path)
    except OSError as error:
        if error.filename == os.fspath(beside):
            error.filename = os.fspath(path)
        raise
    finally:
        with contextlib.suppress(OSError):
            beside.unlink()


def write_text(path: Place, text: str) -> None:
    """Writes a text file, completely or not at all."""
    with written(path) as file:
        file.write(text)

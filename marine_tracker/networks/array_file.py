"""Named arrays in one file, as `numpy.savez` writes them: read with bounds.

`numpy.load` believes what a file says of itself: of a few broken bytes it raises errors of many
kinds, and it makes arrays as large as they claim to be. Here nothing is made that is not there.
"""

import io
import math
import re
import zipfile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..files import Place, regular

MAX_BYTES = 8_000_000  # of a file
MAX_UNPACKED = 32_000_000
MAX_ARRAYS = 200
PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
HEADER = re.compile(
    rb"\{'descr': '([<>|=]?[biufU][0-9]{1,9})', 'fortran_order': (True|False), "
    rb"'shape': \(([0-9, ]*)\), *\} *\n?"
)


def read(path: Place) -> dict[str, NDArray[Any]]:
    """The arrays of a file by their names.

    ValueError where it holds none, or is too large; OSError where it cannot be read.
    """
    path = regular(path)
    size = path.stat().st_size
    if size > MAX_BYTES:
        raise ValueError(f'it has {size} bytes; {MAX_BYTES} are allowed')
    try:
        with zipfile.ZipFile(io.BytesIO(path.read_bytes())) as archive:
            members = archive.infolist()
            _check(members)
            return {
                member.filename.removesuffix('.npy'): _array(archive.read(member))
                for member in members
            }
    except OSError:
        raise
    except Exception as error:  # of broken bytes zipfile raises errors of a dozen kinds
        raise ValueError(' '.join(str(error).split())[:200] or type(error).__name__) from error


def _check(members: list[zipfile.ZipInfo]) -> None:
    if len(members) > MAX_ARRAYS:
        raise ValueError(f'it holds {len(members)} arrays; {MAX_ARRAYS} are allowed')
    unpacked = sum(member.file_size for member in members)
    if unpacked > MAX_UNPACKED:
        raise ValueError(f'its arrays have {unpacked} bytes; {MAX_UNPACKED} are allowed')
    if any(member.compress_type not in PACKED for member in members):
        raise ValueError('it is packed in a way that is not read')


def _array(content: bytes) -> NDArray[Any]:
    """An array from the bytes of a .npy file."""
    if content[:6] != b'\x93NUMPY' or content[6] not in (1, 2):
        raise ValueError('it holds what is no array')
    begin = 10 if content[6] == 1 else 12
    end = begin + int.from_bytes(content[8:begin], 'little')
    header = HEADER.fullmatch(content[begin:end])
    if header is None:
        raise ValueError('it holds an array whose header is not understood')
    kind, turned, sizes = header.groups()
    dtype = np.dtype(kind.decode())
    shape = tuple(int(size) for size in sizes.split(b',') if size.strip())
    if math.prod(shape) * dtype.itemsize != len(content) - end:
        raise ValueError('it holds an array of another size than its header says')
    flat = np.frombuffer(content, dtype, offset=end)
    return flat.reshape(shape, order='F' if turned == b'True' else 'C').copy()

"""The text of a message type with all that it is made of, as MCAP files hold it."""

import re
from functools import cache
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory

RULE = '=' * 80
FIELD = re.compile(r'^\s*([A-Za-z][\w/]*)(?:<=\d+)?(?:\[[^\]]*\])?\s+[A-Za-z]\w*')
PLAIN = {
    *('bool', 'byte', 'char', 'float32', 'float64', 'string', 'wstring'),
    *(f'{sign}int{bits}' for sign in ('', 'u') for bits in (8, 16, 32, 64)),
}


@cache
def definition(kind: str) -> str:
    """The definition of a type, as sensor_msgs/msg/PointCloud2; '' if its files are not there."""
    texts: dict[str, str] = {}
    missing = False

    def collect(name: str) -> None:
        nonlocal missing
        if name in texts:
            return
        package, _, short = name.partition('/')
        try:
            path = Path(get_package_share_directory(package), 'msg', f'{short}.msg')
            texts[name] = path.read_text()
        except (PackageNotFoundError, OSError, ValueError):
            missing = True
            return
        for line in texts[name].splitlines():
            found = FIELD.match(line.partition('#')[0])
            if found and found[1] not in PLAIN:
                parts = found[1].split('/')
                collect(f'{parts[0] if len(parts) > 1 else package}/{parts[-1]}')

    package, _, short = kind.rpartition('/')
    first = f'{package.removesuffix("/msg")}/{short}'
    collect(first)
    if missing:
        return ''
    return '\n'.join(
        [texts.pop(first)] + [f'{RULE}\nMSG: {name}\n{text}' for name, text in texts.items()]
    )

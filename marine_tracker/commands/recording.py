"""Recordings of topics (MCAP): what is in one, and a whole file made of one that was cut.

show    topics with their types, counts and times, and what is lost of a file that was cut
repair  copies what can be read into a new folder, whole, for programs that read no cut file;
        counts and times of every topic are compared afterwards
"""

import time
from argparse import ArgumentParser, Namespace
from itertools import islice
from pathlib import Path

HELP = 'show or repair a recording of topics'


def add_arguments(parser: ArgumentParser) -> None:
    """Adds the two sub-commands."""
    parts = parser.add_subparsers(dest='part', metavar='show|repair', required=True)
    shown = parts.add_parser('show', help='what is in it')
    repaired = parts.add_parser('repair', help='copy what can be read')
    for part in (shown, repaired):
        part.add_argument('path', metavar='PATH', help='an MCAP file, or a folder of them')
    repaired.add_argument('--out', metavar='FOLDER', required=True, help='new folder')


def run(args: Namespace) -> int:
    """ValueError if it cannot be read, or if the copy is not like it."""
    if args.part == 'show':
        show(args.path)
    else:
        repair(args.path, args.out)
    return 0


def show(path: str) -> None:
    """Prints a table of the topics."""
    from ..recording.mcap_read import McapFiles

    files = McapFiles(path)
    first = min((about.first_ns for about in files.topics.values()), default=0)
    last = max((about.last_ns for about in files.topics.values()), default=0)
    size = sum(file.stat().st_size for file in files.paths)
    began = time.strftime('%Y-%m-%d %H:%M:%S UTC', time.gmtime(first * 1e-9))
    print(
        f'{path}: {began}, {(last - first) * 1e-9:.1f} s, {size / (1 << 20):.1f} MB in '
        f'{len(files.paths)} files'
    )
    width = max(map(len, files.topics), default=0)
    for name, about in sorted(files.topics.items()):
        rate = (about.messages - 1) / max((about.last_ns - about.first_ns) * 1e-9, 1e-9)
        often = f'{rate:8.2f} Hz' if about.messages > 1 else ''
        print(f'  {name:{width}s} {about.messages:8d} {often:11s} {about.kind}')
    for remark in files.remarks:
        print(remark)


def repair(path: str, out: str) -> None:
    """Copies, and compares. ValueError if the two are not alike."""
    from ..recording.mcap_read import McapFiles
    from ..recording.mcap_write import McapLog, Message

    files = McapFiles(path)
    for remark in files.remarks:
        print(remark)
    topics = {name: files.topic(name) for name in files.topics}
    log = McapLog(out, 1 << 40, 0)
    if files.settings:
        log.settings(files.settings)
    messages = (Message(topics[one.topic], *one[1:]) for one in files.messages())
    while batch := list(islice(messages, 10_000)):
        log.write(batch)
    log.close()
    copy = McapFiles(out)
    if copy.topics != files.topics or copy.remarks:
        different = [name for name in files.topics if copy.topics.get(name) != files.topics[name]]
        raise ValueError(f'the copy in {out} is not like {path}: {", ".join(different)}')
    count = sum(about.messages for about in copy.topics.values())
    print(f'{count} messages of {len(topics)} topics copied to {Path(out)}')

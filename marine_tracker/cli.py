"""The `marine_tracker` command."""

import argparse
import importlib
import os
import sys
from importlib import metadata
from typing import NoReturn

from .processes import one_thread, stop_on_sigterm

COMMANDS = (
    'demo',
    'top',
    'screenshots',
    'record',
    'recording',
    'replay',
    'incident',
    'score',
    'draw',
    'bench',
    'experiments',
    'train',
    'tune',
    'scenario',
    'imo',
    'soak',
    'doctor',
    'explain',
)

DESCRIPTION = """\
Track vessels by radar as an ARPA does: on simulated, recorded or live plots."""

EPILOG = """\
first steps:
  marine_tracker doctor                              what is installed, what is missing
  marine_tracker demo                                watch simulated traffic being tracked
  marine_tracker scenario list                       the scenarios that are shipped
  marine_tracker replay FOLDER --out tracks.csv      track a recording (or a scenario)
  marine_tracker score FOLDER tracks.csv             how good the tracks are

`marine_tracker COMMAND --help` explains one command."""


def main(arguments: list[str] | None = None) -> int:
    """Runs a command line. Returns the exit code: 0 success, 1 a check failed, 2 bad usage or
    input.
    """
    argv = sys.argv[1:] if arguments is None else arguments
    one_thread()
    if arguments is None:
        stop_on_sigterm()
    try:
        args = _parser(argv).parse_args(argv)
        return args.run(args)
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # reader left: be quiet
        return 141
    except ModuleNotFoundError as error:
        print(f'marine_tracker: {_missing(error)}; see marine_tracker doctor', file=sys.stderr)
        return 2
    except (ValueError, OSError) as error:
        print(f'marine_tracker: {_one_line(error)}', file=sys.stderr)
        return 2


class _Parser(argparse.ArgumentParser):
    """A parser that reports a usage error in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f'{self.prog}: {message} (see {self.prog} --help)\n')


def _parser(argv: list[str]) -> _Parser:
    """The parser. Only the requested command is imported."""
    parser = _Parser(
        'marine_tracker',
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('--version', action='version', version=f'marine_tracker {_version()}')
    commands = parser.add_subparsers(title='commands', metavar='COMMAND', required=True)
    asked = next((word for word in argv if not word.startswith('-')), None)
    for name in COMMANDS if asked not in COMMANDS else (asked,):
        try:
            command = importlib.import_module(f'.commands.{name}', __package__)
        except ModuleNotFoundError as error:
            if name == asked:
                raise
            commands.add_parser(name, help=f'(cannot run: {_missing(error)})')
            continue
        sub = commands.add_parser(
            name,
            help=command.HELP,
            description=command.__doc__,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        command.add_arguments(sub)
        sub.set_defaults(run=command.run)
    return parser


def _version() -> str:
    try:
        return metadata.version('marine_tracker')
    except metadata.PackageNotFoundError:
        return '(not installed)'


def _missing(error: ModuleNotFoundError) -> str:
    return f'the Python module {error.name} is not installed'


def _one_line(error: Exception) -> str:
    if isinstance(error, OSError) and error.filename and error.strerror:
        return f'{error.filename}: {error.strerror.lower()}'
    return ' '.join(str(error).split())

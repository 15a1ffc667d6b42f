"""Where the shipped configuration is: default parameters, scenarios, the DDS profile."""

from pathlib import Path


def path(*parts: str) -> Path:
    """A file or folder of the shipped configuration, e.g. path('scenarios', 'paper_track.yaml').

    It is always the configuration that belongs to the code that runs: config/ of the source tree,
    or share/marine_tracker/config of the prefix into which pip, colcon or a distribution put the
    package. FileNotFoundError where the package stands without its configuration.
    """
    return _root(Path(__file__).resolve().parent).joinpath(*parts)


def _root(package: Path) -> Path:
    """The configuration folder for a package folder, without asking the environment.

    A look-up by AMENT_PREFIX_PATH or sys.prefix could meet another version of the package.
    """
    if (package.parent / 'package.xml').is_file():
        return package.parent / 'config'
    for prefix in package.parents:
        installed = prefix / 'share' / 'marine_tracker' / 'config'
        if installed.is_dir():
            return installed
    raise FileNotFoundError(
        f'no configuration found for the marine_tracker package in {package}: it stands neither '
        'in its source tree nor below a prefix with share/marine_tracker/config'
    )

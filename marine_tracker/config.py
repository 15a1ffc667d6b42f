"""Where the shipped configuration is: default parameters, scenarios, the DDS profile."""

from pathlib import Path


def path(*parts: str) -> Path:
    """A file or folder of the shipped configuration, e.g. path('scenarios', 'paper_track.yaml').

    It is always the configuration that belongs to the running code: config/ of the source tree, or
    share/marine_tracker/config of the prefix into which pip, colcon or a distribution installed the
    package. FileNotFoundError if the package has no configuration.
    """
    return _root(Path(__file__).resolve().parent).joinpath(*parts)


def _root(package: Path) -> Path:
    """The configuration folder for a package folder. It does not use the environment.

    A search by AMENT_PREFIX_PATH or sys.prefix could find another version of the package.
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

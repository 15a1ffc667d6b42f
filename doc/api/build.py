"""Pages of the whole package from its docstrings: python doc/api/build.py FOLDER. `make api` does.

Docstrings are plain text. A paragraph with columns (arrays with shapes and units) or indented lines
is shown as it stands, any other one as prose. A warning is an error.
"""

import importlib
import pkgutil
import re
import sys
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # this tree, whatever is installed

import pdoc
from markupsafe import Markup, escape

COLUMNS = re.compile(r'^[ *-]|\S  +\S', re.M)  # of a paragraph that must keep its lines


def plain_text(docstring: str) -> Markup:
    """HTML of a docstring."""
    paragraphs = (part for part in re.split(r'\n\s*\n', docstring.strip('\n')) if part.strip())
    return Markup('\n').join(map(_paragraph, paragraphs))


def _paragraph(text: str) -> Markup:
    tag = 'pre' if COLUMNS.search(text) else 'p'
    marked = re.sub(r'`+([^`\n]+)`+', r'<code>\1</code>', str(escape(text)))
    return Markup(f'<{tag}>{marked}</{tag}>')


def build(folder: Path) -> None:
    """Write the pages of all modules into the folder."""
    package = importlib.import_module('marine_tracker')
    for name in package.__all__:  # imported when asked for: pdoc does not ask
        setattr(package, name, getattr(package, name))
    rooms = (room.name for room in pkgutil.iter_modules(package.__path__) if room.name[0] != '_')
    package.__all__ = [*package.__all__, *rooms]  # pdoc leaves out what is not there
    pdoc.render.env.filters['plain_text'] = plain_text
    pdoc.render.configure(template_directory=Path(__file__).parent, search=True)
    pdoc.pdoc('marine_tracker', output_directory=folder)


if __name__ == '__main__':
    warnings.simplefilter('error')
    # Annotations of textual's classes, which `top` inherits, are for type checkers only.
    warnings.filterwarnings(
        'ignore', '(?s).* annotation .*for (textual|marine_tracker.commands.top)', UserWarning
    )
    build(Path(sys.argv[1]))
    print(f'written: {sys.argv[1]}/index.html')

"""Whoever calls the package sees from each public function what it takes and what it returns."""

import ast
from pathlib import Path

import pytest

import marine_tracker

PACKAGE = Path(marine_tracker.__file__).resolve().parent
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


def public(body, owner=''):
    """Name and node of the public functions of a module's body, methods of public classes too."""
    for node in body:
        special = node.name.endswith('__') if isinstance(node, FUNCTIONS) else False
        if isinstance(node, ast.ClassDef) and not node.name.startswith('_'):
            yield from public(node.body, f'{owner}{node.name}.')
        elif isinstance(node, FUNCTIONS) and (special or not node.name.startswith('_')):
            yield owner + node.name, node


def untyped(text):
    """`function: what` for each argument, and each `return`, that has no type."""
    for name, node in public(ast.parse(text).body):
        given = node.args
        named = [*given.posonlyargs, *given.args, given.vararg, *given.kwonlyargs, given.kwarg]
        is_method = '.' in name and not any(
            getattr(decorator, 'id', '') == 'staticmethod' for decorator in node.decorator_list
        )
        for argument in [one for one in named if one is not None][is_method:]:
            if argument.annotation is None:
                yield f'{name}: {argument.arg}'
        if node.returns is None:
            yield f'{name}: return'


def test_every_public_function_is_typed():
    found = [
        f'{file.relative_to(PACKAGE)}, {what}'
        for file in sorted(PACKAGE.rglob('*.py'))
        for what in untyped(file.read_text())
    ]
    assert not found, '\n'.join(found)


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('def f(a: int, /, b: int, *c: int, d: int, **e: int) -> int: ...', []),
        ('def f(a, /, b, *c, d=1, **e) -> int: ...', [f'f: {one}' for one in 'abcde']),
        ('async def f(): ...', ['f: return']),
        ('def _f(a): ...', []),
        ('class A:\n    def __init__(self, a: int): ...', ['A.__init__: return']),
        ('class A:\n    def f(self, a) -> int: ...', ['A.f: a']),
        ('class A:\n    @staticmethod\n    def f(a) -> int: ...', ['A.f: a']),
        ('class _A:\n    def f(self, a): ...', []),
        ('def f() -> int:\n    def inside(a): ...', []),
    ],
)
def test_what_is_untyped_is_found(text, expected):
    assert list(untyped(text)) == expected

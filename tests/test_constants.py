"""Numeric constants of modules: each says what it is, and where its value comes from."""

import ast
import re
from collections import Counter
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "urdftool"

ORIGIN = re.compile(
    r"chosen|measured|source|default of|by definition|version of|section|specification|REP \d"
    r"|\brun\b|so that|because|rounding|float|double|overflow|memory|cache|limit of|real root"
    r"|newton|pybullet|mujoco|sdf|gazebo|usd|urdf|ros\b|rviz|manifold|coacd|qhull|git|stl|gltf"
    r"|about \d|than half|stands for|identity|axis|axes|vertical|pixels|processor|grows|which"
    r"|linux|macos|expat|prctl|mallopt|rlimit|at_fdcwd",
    re.IGNORECASE,
)
"""Words by which a docstring gives a source or a reason, or says that there is none."""

FOR_ALL = "# chosen, no source, where a line gives none"
"""Comment that says so for each constant of a module."""


def is_numeric(node):
    if isinstance(node, ast.Constant):
        return isinstance(node.value, int | float) and not isinstance(node.value, bool)
    if isinstance(node, ast.UnaryOp):
        return is_numeric(node.operand)
    if isinstance(node, ast.BinOp):
        return is_numeric(node.left) and is_numeric(node.right)
    return isinstance(node, ast.Tuple) and bool(node.elts) and all(map(is_numeric, node.elts))


def list_numbers(node):
    """Return the numbers of a value without signs."""
    return [one.value for one in ast.walk(node) if isinstance(one, ast.Constant)]


def list_constants(text):
    """Yield line and description of each numeric constant of a module, except axes and units."""
    lines = text.splitlines()
    body = ast.parse(text).body
    for node, after in zip(body, [*body[1:], None], strict=True):
        if not isinstance(node, ast.Assign | ast.AnnAssign) or node.value is None:
            continue
        if not is_numeric(node.value) or not set(list_numbers(node.value)) - {0, 1}:
            continue
        value = getattr(after, "value", None)
        is_text = isinstance(after, ast.Expr) and isinstance(getattr(value, "value", None), str)
        comment = lines[node.end_lineno - 1].partition("  # ")[2]
        yield node.lineno, (value.value if is_text else "") + comment


def count():
    """Return the numbers of constants without meaning and without origin, by package."""
    meaning, origin = Counter(), Counter()
    for path in PACKAGE.rglob("*.py"):
        parts = path.relative_to(PACKAGE).parts
        package = parts[0] if len(parts) > 1 else "."
        if parts[:2] == ("formats", "usd"):
            package = "formats/usd"
        module = path.read_text("utf-8")
        for _, text in list_constants(module):
            meaning[package] += not text
            origin[package] += bool(text) and not (ORIGIN.search(text) or FOR_ALL in module)
    return +meaning, +origin


def test_constants_say_what_they_are_and_where_they_come_from():
    for more in count():
        assert not more, f"say what it is, and its source or 'Chosen, no source.': {more}"


def test_constants_are_seen():
    text = 'A = 3\nX = (0, -1.0)\nB = 2.0  # seconds\nC = (1, -2)\n"""Meters."""\nD = "x"\n'
    assert list(list_constants(text)) == [(1, ""), (3, "seconds"), (4, "Meters.")]

"""Robots that launch files and builds expand, with the arguments that they pass.

Nothing is executed: Python is read as a syntax tree, in which the usual calls of ROS 2 are
evaluated (``Command``, ``PathJoinSubstitution``, ``os.path.join``, ``LaunchConfiguration`` with its
default or with each of its choices …). What is computed in another way stays unknown, and is
reported instead of guessed.
"""

from __future__ import annotations

import ast
import os
import re
import shlex
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import product
from math import prod
from typing import NamedTuple

UNKNOWN = "\0"
"""Part of a text that is computed."""

_FIND = re.compile(r"\$\((?:find|find-pkg-share|dirname)(?:\s+([\w.-]+))?\)")
_USE = re.compile(r"\$\((?:arg|var)\s+([\w.-]+)\)")
_ENVIRONMENT = re.compile(r"\$\((?:optenv|env)\s+\w+\s+([^()\s]+)\s*\)")
_INCLUDE = re.compile(r"<include\b[^<>]*[^/<>]>.*?</include>", re.DOTALL)
_EVAL = re.compile(r"\$\([^()]*\)|\$\{[^{}]*\}")
_ARGUMENT = re.compile(r"<(?:arg|let)\b[^<>]*?>")
_ATTRIBUTE = re.compile(r"""([\w-]+)\s*=\s*("[^"]*"|'[^']*')""")
_ENDINGS = (".xacro", ".urdf")
_TEXTS = frozenset(
    ("FindExecutable", "TextSubstitution", "Path", "str", "ParameterValue", "perform_substitution")
)
"""Calls in Python whose text is that of the first argument."""
_MOST_DEPTH = 40
"""Maximum depth of an expression; chosen, deeper ones stay unknown."""
_MOST_CHOICES = 32
"""Maximum number of variants that choices of launch arguments make; chosen, with more they stay
unknown."""


class Use(NamedTuple):
    """A description that a launch file or build names.

    Attributes:
        target: Path of the description, with ``UNKNOWN`` for computed parts.
        arguments: xacro arguments whose values are known.
        computed: Names of arguments whose values are computed.
        line: Line in the file.
    """

    target: str
    arguments: tuple[tuple[str, str], ...]
    computed: tuple[str, ...]
    line: int


Find = Callable[[str], str | None]
"""Function that returns the folder of a ROS package by its name; None if it is not found."""


def read_uses(path: str, text: str, find: Find) -> list[Use]:
    """Return the descriptions that a file uses; none for a file of another kind."""
    if path.endswith(".py"):
        return _Script(path, find).read(text)
    if os.path.basename(path) == "CMakeLists.txt":
        return list(_read_cmake(path, text))
    return list(_read_xml(path, text, find))


def _split(text: str, line: int) -> Use | None:
    """Return the use in a command line such as ``xacro a.xacro prefix:=l_``; None without one."""
    try:
        words = shlex.split(text)
    except ValueError:  # an open quote
        words = text.split()
    target = next((word for word in words if word.endswith(_ENDINGS)), None)
    if target is None:
        return None
    pairs = dict(word.split(":=", 1) for word in words if ":=" in word)
    known = tuple((name, value) for name, value in pairs.items() if UNKNOWN not in name + value)
    unknown = tuple(name for name in pairs if UNKNOWN in name + pairs[name])
    return Use(target, known, unknown, line)


def _read_xml(path: str, text: str, find: Find) -> Iterator[Use]:
    """Yield the uses in a launch file of ROS 1 or ROS 2 in XML."""
    text = re.sub(r"<!--.*?-->", lambda m: "\n" * m[0].count("\n"), text, flags=re.DOTALL)
    defaults: dict[str, str] = {}
    closed, end, rest = text.rpartition("</include>")  # a search behind it would read all of it
    for tag in _ARGUMENT.findall(_INCLUDE.sub("", closed + end) + rest):
        values = {key: value[1:-1] for key, value in _ATTRIBUTE.findall(tag)}
        if "name" in values:
            defaults[values["name"]] = values.get("default", values.get("value", UNKNOWN))
    for match in _ATTRIBUTE.finditer(text):
        if "xacro" in match[2] or ".urdf" in match[2]:
            filled = _fill(match[2][1:-1], path, defaults, find)
            use = _split(filled, text.count("\n", 0, match.start()) + 1)
            if use is not None:
                yield use


def _fill(text: str, path: str, defaults: Mapping[str, str], find: Find) -> str:
    """Replace the substitutions of a launch file; those that are not known become ``UNKNOWN``.

    A variable of the environment has the value that the file gives for where it is not set.
    """

    def folder(match: re.Match[str]) -> str:
        return os.path.dirname(path) if match[1] is None else find(match[1]) or UNKNOWN

    for _ in range(5):  # defaults may refer to others
        before = text
        text = _ENVIRONMENT.sub(r"\1", _FIND.sub(folder, text))
        text = _USE.sub(lambda m: defaults.get(m[1], UNKNOWN), text)
        if text == before:
            break
    command = re.fullmatch(r"\s*\$\(command\s+(.*)\)\s*", text, re.DOTALL)
    return _EVAL.sub(UNKNOWN, command[1].strip().strip("\"'") if command else text)


def _read_cmake(path: str, text: str) -> Iterator[Use]:
    """Yield the uses in a ``CMakeLists.txt``: macros of xacro, and commands that call it."""
    folder = os.path.dirname(path)
    text = re.sub(r"#[^\n]*", "", text)
    for name in ("CMAKE_CURRENT_SOURCE_DIR", "CMAKE_CURRENT_LIST_DIR", "PROJECT_SOURCE_DIR"):
        text = text.replace(f"${{{name}}}", os.path.abspath(folder))
    text = _EVAL.sub(UNKNOWN, text)
    for match in re.finditer(r"\b(\w+)\s*\(([^()]*)\)", text):
        line = text.count("\n", 0, match.start()) + 1
        words = match[2].split()
        if match[1] == "xacro_add_xacro_file" and words:
            words = words[:1] + [word for word in words if ":=" in word]
        elif match[1] == "xacro_add_files":
            for word in words:
                if word.endswith(_ENDINGS):
                    given = [other for other in words if ":=" in other]
                    yield from _make(os.path.join(folder, word), given, line)
            continue
        else:
            names = [word.rpartition("/")[2] for word in words]
            words = words[names.index("xacro") + 1 :] if "xacro" in names else []
        target = next((word for word in words if word.endswith(_ENDINGS)), None)
        if target is not None:
            given = [word for word in words if ":=" in word]
            yield from _make(os.path.join(folder, target), given, line)


def _make(target: str, given: Iterable[str], line: int) -> Iterator[Use]:
    use = _split(" ".join((target.replace(" ", UNKNOWN), *given)), line)
    if use is not None:
        yield use


@dataclass
class _Script:
    """A launch file in Python.

    Attributes:
        path: Its path.
        find: Function that returns the folder of a ROS package.
        values: Expression of each name that is assigned once, and of each parameter of a function
            that ``OpaqueFunction`` calls.
        defaults: Expression of the default of each declared launch argument.
        choices: Values of each launch argument that has choices and no default.
        chosen: Value of each of these for which expressions are evaluated.
        asked: Those on which the last expressions depend.
    """

    path: str
    find: Find
    values: dict[str, ast.expr | None] = field(default_factory=dict)
    defaults: dict[str, ast.expr] = field(default_factory=dict)
    choices: dict[str, list[str]] = field(default_factory=dict)
    chosen: dict[str, str] = field(default_factory=dict)
    asked: set[str] = field(default_factory=set)

    def read(self, text: str) -> list[Use]:
        """Return the uses in the text; none if it is not Python."""
        try:
            tree = ast.parse(text)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            return []
        nodes = list(ast.walk(tree))
        functions = {node.name: node.args for node in nodes if isinstance(node, ast.FunctionDef)}
        for node in nodes:
            if isinstance(node, ast.Assign) and len(node.targets) == 1:
                self._assign(node.targets[0], node.value)
        calls = [node for node in nodes if isinstance(node, ast.Call)]
        for call in calls:
            if _name(call.func) == "OpaqueFunction":
                self._pass(call, functions)
            elif _name(call.func) == "DeclareLaunchArgument":
                self._declare(call)
        return list(dict.fromkeys(use for call in calls for use in self._list_uses(call)))

    def _assign(self, target: ast.expr, value: ast.expr) -> None:
        if isinstance(target, ast.Name):
            self.values[target.id] = None if target.id in self.values else value

    def _pass(self, call: ast.Call, functions: Mapping[str, ast.arguments]) -> None:
        """Assign the ``args`` of an ``OpaqueFunction`` to the parameters behind the context."""
        function, given = _get_keyword(call, "function"), _get_keyword(call, "args")
        parameters = functions.get(function.id) if isinstance(function, ast.Name) else None
        if parameters is not None and isinstance(given, ast.List | ast.Tuple):
            for parameter, value in zip(parameters.args[1:], given.elts, strict=False):
                is_itself = isinstance(value, ast.Name) and value.id == parameter.arg
                if not is_itself:
                    self._assign(ast.Name(parameter.arg), value)

    def _declare(self, node: ast.Call) -> None:
        name = self._get_argument_name(node)
        default, choices = _get_keyword(node, "default_value"), _get_keyword(node, "choices")
        if name and default is not None:
            self.defaults[name] = default
        elif name and isinstance(choices, ast.List | ast.Tuple):
            texts = [self.evaluate(choice, 0) for choice in choices.elts]
            if texts and UNKNOWN not in "".join(texts):
                self.choices[name] = texts

    def _get_argument_name(self, node: ast.Call) -> str:
        """Return the name of a declared launch argument; empty if it is computed."""
        name = node.args[0] if node.args else _get_keyword(node, "name")
        text = self.evaluate(name, 0) if name is not None else UNKNOWN
        return "" if UNKNOWN in text else text

    def _list_uses(self, node: ast.Call) -> Iterator[Use]:
        """Yield the use of a call, one for each choice of the arguments without a default."""
        self.chosen, self.asked = {}, set()
        use = self._read_call(node)
        names = sorted(self.asked)
        if use is None or not names:
            yield from () if use is None else (use,)
            return
        values = [self.choices[name] for name in names]
        if prod(map(len, values)) > _MOST_CHOICES:
            yield use
            return
        for choice in product(*values):
            self.chosen = dict(zip(names, choice, strict=True))
            chosen = self._read_call(node)
            if chosen is not None:
                yield chosen

    def _read_call(self, node: ast.Call) -> Use | None:
        """Return the use of a call of ``Command``, ``open`` or a function of xacro or MoveIt."""
        name = _name(node.func)
        first = node.args[0] if node.args else None
        mappings = _get_keyword(node, "mappings")
        if name == "robot_description":
            target = self._evaluate_moveit(node)
        elif first is None:
            return None
        elif name == "Command":
            return _split(self.evaluate(first, 0), node.lineno)
        elif name in ("process_file", "process"):
            target = self.evaluate(first, 0)
            target = target if ".xacro" in target else ""
        elif name == "process_doc":
            target = self._evaluate_document(first)
        elif name == "open":
            target = self.evaluate(first, 0)
            target = target if target.endswith(".urdf") else ""
        else:
            return None
        words = self._list_mappings(mappings) if isinstance(mappings, ast.Dict) else []
        return _split(" ".join((shlex.quote(target), *words)), node.lineno)

    def _evaluate_document(self, node: ast.expr) -> str:
        """Return the path in ``xacro.parse(open(path))``, or of a name with that value."""
        for _ in range(3):  # the name, ``parse`` and ``open``
            if isinstance(node, ast.Name):
                node = self.values.get(node.id) or node
            elif isinstance(node, ast.Call) and node.args and _name(node.func) in ("parse", "open"):
                node = node.args[0]
        return self.evaluate(node, 0)

    def _evaluate_moveit(self, node: ast.Call) -> str:
        """Return the path in ``MoveItConfigsBuilder(robot).robot_description(file_path=…)``."""
        file = node.args[0] if node.args else _get_keyword(node, "file_path")
        builder: ast.expr = node.func
        while isinstance(builder, ast.Attribute | ast.Call):
            if isinstance(builder, ast.Call) and _name(builder.func) == "MoveItConfigsBuilder":
                break
            builder = builder.value if isinstance(builder, ast.Attribute) else builder.func
        if file is None or not isinstance(builder, ast.Call) or not builder.args:
            return ""
        named = _get_keyword(builder, "package_name")
        robot = self.evaluate(builder.args[0], 0)
        package = f"{robot}_moveit_config" if named is None else self.evaluate(named, 0)
        folder = UNKNOWN if UNKNOWN in package else self.find(package) or UNKNOWN
        return os.path.join(folder, self.evaluate(file, 0))

    def _list_mappings(self, mappings: ast.Dict) -> list[str]:
        pairs = zip(mappings.keys, mappings.values, strict=True)
        texts = [
            (self.evaluate(key, 0) if key else UNKNOWN, self.evaluate(value, 0))
            for key, value in pairs
        ]
        return [shlex.quote(f"{key}:={value}") for key, value in texts]

    def evaluate(self, node: ast.expr, depth: int) -> str:
        """Return the text of an expression, with ``UNKNOWN`` for what is computed otherwise."""
        if depth > _MOST_DEPTH:
            return UNKNOWN
        below = depth + 1
        if isinstance(node, ast.Constant):
            return str(node.value)
        if isinstance(node, ast.Name):
            value = self.values.get(node.id)
            return UNKNOWN if value is None else self.evaluate(value, below)
        if isinstance(node, ast.List | ast.Tuple):
            return "".join(self.evaluate(part, below) for part in node.elts)
        if isinstance(node, ast.JoinedStr):
            return "".join(self.evaluate(part, below) for part in node.values)
        if isinstance(node, ast.FormattedValue):
            return self.evaluate(node.value, below)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Div):
            middle = "/" if isinstance(node.op, ast.Div) else ""
            return self.evaluate(node.left, below) + middle + self.evaluate(node.right, below)
        if isinstance(node, ast.Attribute) and node.attr == "name":
            declared = self.values.get(_name(node.value))
            return self._get_argument_name(declared) if isinstance(declared, ast.Call) else UNKNOWN
        return self._evaluate_call(node, below) if isinstance(node, ast.Call) else UNKNOWN

    def _evaluate_call(self, node: ast.Call, depth: int) -> str:
        """Return the text of a call of a substitution or of a function on paths."""
        name = _name(node.func)
        first = node.args[0] if node.args else next((k.value for k in node.keywords), None)
        if name == "perform" and isinstance(node.func, ast.Attribute):
            return self.evaluate(node.func.value, depth)
        if first is None:
            return UNKNOWN
        if name == "join" or name == "PathJoinSubstitution":
            is_list = isinstance(first, ast.List | ast.Tuple)
            parts = first.elts if is_list else node.args  # type: ignore[attr-defined]
            return "/".join(self.evaluate(part, depth) for part in parts)
        text = self.evaluate(first, depth)
        if name in ("FindPackageShare", "get_package_share_directory", "get_package_share_path"):
            return UNKNOWN if UNKNOWN in text else self.find(text) or UNKNOWN
        if name == "LaunchConfiguration":
            default = _get_keyword(node, "default") or self.defaults.get(text)
            if default is None and text in self.choices:
                self.asked.add(text)
                return self.chosen.get(text, UNKNOWN)
            return UNKNOWN if default is None else self.evaluate(default, depth)
        if name in _TEXTS:
            return text
        return UNKNOWN


def _name(node: ast.expr) -> str:
    """Return the last part of the name of a function."""
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


def _get_keyword(node: ast.Call, name: str) -> ast.expr | None:
    return next((word.value for word in node.keywords if word.arg == name), None)

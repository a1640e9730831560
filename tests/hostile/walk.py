"""Every object that an untrusted expression can reach: ``python -m tests.hostile.walk [NAME ...]``.

Begins with the names and literals of expressions, and applies to each value what the language has:
attributes, items, iteration, calls. Each step is an expression that is compiled and evaluated as
those of a description. Prints the objects that are not in the lists below. With names of
``PLANTED``, expressions also reach these.
"""

from __future__ import annotations

import datetime
import re
import sys
import types
from collections.abc import Iterator
from typing import Any

from urdftool.source import xacro_hooks
from urdftool.source.expansion import Expansion
from urdftool.source.expressions import compile_expression
from urdftool.source.location import SourceFile

DEPTH = 4

VALUES = (
    *(str, int, float, bool, complex, bytes, type(None), range, slice),
    *(list, tuple, dict, set, frozenset, datetime.date, datetime.datetime),
    *(map, zip, filter, enumerate, reversed, type({}.keys()), type({}.values()), type({}.items())),
    *(type(iter([])), type(iter(())), type(iter("")), type(iter({})), type(iter(range(1)))),
    *(type(reversed([])), type(reversed({})), datetime.timedelta, types.EllipsisType),
)
"""Types whose values are harmless."""

CLASSES = (
    *("list", "dict", "str", "float", "int", "bool", "complex", "set", "frozenset", "tuple"),
    *("slice", "map", "zip", "filter", "enumerate", "reversed", "YamlDictWrapper"),
)
"""Classes that can be called, by name."""

FUNCTIONS = (
    *("len", "min", "max", "abs", "all", "any", "divmod", "isinstance", "ord", "repr", "sorted"),
    *("round", "sum", "range", "hash", "issubclass"),
    *("acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "ceil", "copysign"),
    *("cos", "cosh", "degrees", "dist", "erf", "erfc", "exp", "exp2", "expm1", "fabs", "factorial"),
    *("floor", "fmod", "frexp", "fsum", "gamma", "gcd", "hypot", "isclose", "isfinite", "isinf"),
    *("isnan", "isqrt", "lcm", "ldexp", "lgamma", "log", "log10", "log1p", "log2", "modf", "fma"),
    *("nextafter", "perm", "pow", "prod", "radians", "remainder", "sin", "sinh", "sqrt", "comb"),
    *("sumprod", "tan", "tanh", "trunc", "ulp"),
    *("load_yaml", "abs_filename", "dotify", "arg", "message", "warning", "error", "fatal"),
    *("print_location", "tokenize"),
)
"""Functions that can be called, by the name under which an expression finds them."""

METHODS = {
    str: (
        *("capitalize", "casefold", "center", "count", "endswith", "find", "format", "index"),
        *("isalnum", "isalpha", "isascii", "isdecimal", "isdigit", "islower", "isnumeric"),
        *("isspace", "istitle", "isupper", "join", "ljust", "lower", "lstrip", "partition"),
        *("removeprefix", "removesuffix", "replace", "rfind", "rindex", "rjust", "rpartition"),
        *("rsplit", "rstrip", "split", "splitlines", "startswith", "strip", "swapcase", "title"),
        *("upper", "zfill"),
    ),
    dict: (
        *("clear", "copy", "get", "items", "keys", "pop", "popitem", "setdefault", "update"),
        "values",
    ),
    list: (
        *("append", "clear", "copy", "count", "extend", "index", "insert", "pop", "remove"),
        *("reverse", "sort"),
    ),
    tuple: ("count", "index"),
    set: (
        *("add", "clear", "copy", "difference", "discard", "intersection", "isdisjoint", "pop"),
        *("issubset", "issuperset", "remove", "symmetric_difference", "union", "update"),
    ),
    frozenset: (
        *("copy", "difference", "intersection", "isdisjoint", "issubset", "issuperset"),
        *("symmetric_difference", "union"),
    ),
    float: ("imag", "is_integer", "real"),
    int: ("bit_length", "imag", "is_integer", "real"),
    complex: ("conjugate", "imag", "real"),
}
"""Methods that values may have, by their type."""

STARTS = (
    *("''", "'a'", "'{}'", "1", "1.5", "True", "None", "[]", "[1]", "['a', len]", "(1,)", "()"),
    *("{}", "{'a': 1}", "{1}", "python.frozenset([1])", "python.complex(1, 2)", "n", "m"),
    *("python.range(3)", "python.slice(1)", "map(str, [1])", "python.zip([1], [2])"),
    *("python.filter(None, [1])", "python.enumerate([1])", "python.reversed([1])"),
    *("{'a': 1}.keys()", "{'a': 1}.items()", "{'a': 1}.values()", "[1][:]"),
    *("xacro.load_yaml('a.yaml')", "xacro.dotify({'a': 1, 'b': [len]})", "(x for x in [1])"),
    *("python['len']", "math['pi']", "xacro['load_yaml']", "n['p']", "n['python']"),
)
"""Expressions with which the walk begins, in addition to all names."""

ARGUMENTS = ("", "'a'", "1", "[1]", "{'a': 1}", "str, [1]", "[1], [2]", "'a', 1", "[len]", "n")
"""Arguments of calls."""

HIDDEN = (
    *("__class__", "__dict__", "__globals__", "__code__", "__closure__", "__self__", "__func__"),
    *(
        "__init__",
        "__subclasses__",
        "__getattribute__",
        "__reduce__",
        "__builtins__",
        "__wrapped__",
    ),
    *("gi_frame", "gi_code", "f_back", "f_globals", "cr_frame", "ag_frame", "tb_frame", "tb_next"),
    *("mro", "format_map", "func", "args", "keywords", "parent", "root", "top", "unevaluated"),
    *(
        "attributes",
        "parentNode",
        "ownerDocument",
        "wrap",
        "obj",
        "mapping",
        "strftime",
        "fromkeys",
    ),
    *("maketrans", "translate", "encode", "decode", "to_bytes", "from_bytes", "fromhex", "hex"),
    *("_resolve_", "_setitem", "_eval_literal", "name", "value", "get", "items", "load_yaml"),
)
"""Attributes that are tried on each value, in addition to those that it has."""

KEYS = (
    "0",
    "-1",
    "'a'",
    "'__builtins__'",
    "'**b'",
    "'*b'",
    "'p'",
    "'__class__'",
    "'vars'",
    ":",
    "1:",
)
"""Subscripts that are tried on each value."""

YAML = b"""a: 1
b: [1, {c: 2}]
d: 2001-12-14
e: 2001-12-14t21:59:43.10-05:00
f: !!binary eA==
g: !!set {x, y}
h: 1.5
i: null
j: true
k: !degrees 90
l: text
get: 3
"""


PLANTED = {
    "module": datetime,
    "frame": sys._getframe(),
    "code": sys._getframe().f_code,
    "generator": (x for x in ()),
    "kind": datetime.tzinfo,
    "function": re.compile,
    "object": re.compile(""),
    "method": {}.__contains__,
}
"""Objects that the walk must find, where an expression reaches them."""


class Files:
    """Files of an expansion that has one YAML file."""

    def read_yaml(self, path: str) -> bytes:
        """Return the YAML file."""
        return YAML

    def locate_file(self, path: str) -> str:
        """Return a path."""
        return path

    def __getattr__(self, name: str) -> Any:
        """Return a function that returns a text."""
        return lambda *_: "text"


class Walk:
    """Search of the objects that expressions reach."""

    def __init__(self) -> None:
        """Make the names of a description: of xacro, of an included file and of a macro."""
        file = SourceFile("robot.xacro", b"<robot/>")
        self.run = xacro_hooks.Run(Expansion(file, {}), Files(), trusted=False)  # type: ignore[arg-type]
        self.run._install_hooks()
        xacro = xacro_hooks.xacro
        xacro.init_stacks("robot.xacro")
        xacro.substitution_args_context["arg"] = {"a": "1"}
        self.names = xacro.Table(xacro._global_symbols)
        element = xacro_hooks.parse_xacro(file).documentElement
        for name in ("n", "m"):
            space = xacro.NameSpace(parent=self.names)
            space._setitem("p", 1, unevaluated=False)
            space._setitem("**b", element, unevaluated=False)
            dict.__setitem__(self.names, name, space)
        self.namespaces = xacro.NameSpace
        self.wrappers = (xacro.YamlDictWrapper, xacro.YamlListWrapper)
        self.global_names = sorted(xacro._global_symbols)
        self.evaluated = 0
        self.reached: dict[str, str] = {}
        self.bad: dict[str, str] = {}

    def evaluate(self, text: str) -> Any:
        """Return the value of an expression, or ``None`` if there is none."""
        self.evaluated += 1
        try:
            return compile_expression(text).evaluate(self.names)
        except Exception:
            return None

    def walk(self) -> None:
        """Search, breadth first."""
        level = [*STARTS, *self.global_names]
        for space in ("python", "math", "xacro"):
            known = sorted(key for key in self.evaluate(space) if key.isidentifier())
            level += [f"{space}.{name}" for name in known]
        for _ in range(DEPTH):
            following = []
            for text in level:
                value = self.evaluate(text)
                key = self.describe(value)
                if key not in self.reached:
                    self.reached[key] = text
                    if not self.is_allowed(value, text):
                        self.bad[key] = text
                    following += self.steps(text, value)
            level = following

    def steps(self, text: str, value: Any) -> Iterator[str]:
        """Yield the expressions that continue with a value."""
        for name in sorted({*dir(value), *HIDDEN}):
            if name.isidentifier():
                yield f"({text}).{name}"
        for key in KEYS:
            yield f"({text})[{key}]"
        for key in list(value)[:9] if isinstance(value, dict) else ():
            yield f"({text})[{key!r}]"
        yield f"[x for x in ({text})]"
        yield from (f"[x for x in ({text})][{index}]" for index in range(4))
        yield from (f"{kind}({text})" for kind in ("list", "dict", "python.tuple"))
        yield from (f"dict({text})[{key}]" for key in KEYS[2:7])
        if callable(value):
            yield from (f"({text})({arguments})" for arguments in ARGUMENTS)

    def describe(self, value: Any) -> str:
        """Return a text that is equal for values of one kind."""
        kind = type(value).__name__
        if isinstance(value, type):
            return f"class {value.__name__}"
        if callable(value):
            owner = getattr(value, "__self__", None)
            function = getattr(value, "func", value)
            name = getattr(function, "__qualname__", kind)
            bound = f" of {type(owner).__name__}" if owner is not None else ""
            return f"{kind} {name}{bound}"
        return f"{kind} of {len(value) > 0}" if hasattr(value, "__len__") else kind

    def is_allowed(self, value: Any, text: str) -> bool:
        """Tell whether an object is in the lists."""
        if type(value) in VALUES or type(value) in (self.namespaces, *self.wrappers):
            return True
        if type(value).__name__ == "XacroElement":  # a block; none of its attributes is allowed
            return True
        if isinstance(value, type):
            return value.__name__ in CLASSES
        name = re.findall(r"\w+", text)[-1]
        if callable(value):
            return name in FUNCTIONS or self.is_method(value, name) or self.is_refused(value)
        return False

    def is_method(self, value: Any, name: str) -> bool:
        """Tell whether an object is a listed method of a value."""
        owner = getattr(value, "__self__", None)
        if owner is None and getattr(value, "args", None):
            owner = value.args[0]  # of functools.partial
        return any(isinstance(owner, kind) and name in names for kind, names in METHODS.items())

    def is_refused(self, value: Any) -> bool:
        """Tell whether a function refuses each call."""
        try:
            value()
        except Exception as error:
            return type(error).__name__ == "ForbiddenNameError"
        return False


def main() -> int:
    """Print what is reached and not in the lists; 1 if there is any."""
    walk = Walk()
    for name in sys.argv[1:]:
        dict.__setitem__(walk.names, name, PLANTED[name])
        walk.global_names.append(name)
    walk.walk()
    for key, text in walk.bad.items():
        print(f"{key}: {text}")
    print(f"{walk.evaluated} expressions, {len(walk.reached)} kinds of objects", file=sys.stderr)
    return 1 if walk.bad else 0


if __name__ == "__main__":
    sys.exit(main())

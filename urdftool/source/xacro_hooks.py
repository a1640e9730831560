"""Replacements of xacro's functions during an expansion.

The ``xacro`` package expands. Replaced are its parser (for locations, limits and checks), package
search (without ROS), text evaluation (equal, but each expression is compiled once), file access and
output. Only this module loads xacro, as a separate copy whose state is in module globals: one
expansion runs at a time.
"""

from __future__ import annotations

import io
import os
import re
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from types import ModuleType
from typing import Any

from ..errors import SourceError, UrdftoolError, XacroError
from .document import read_file
from .expansion import Argument, Expansion, Warned
from .expressions import BUILTINS, compile_expression
from .limits import EvaluationLimits
from .location import Call, Place
from .packages import Packages, shorten_path
from .safe_builtins import MAX_LENGTH, check_size
from .sandbox import Sandbox, evaluate_number
from .xacro_parse import parse_xacro
from .xacro_tree import Characters, Instances, XacroDocument, XacroElement
from .yaml_bounds import check_yaml

MAX_CALLS = 400
MAX_ELEMENTS = 200_000
MAX_INCLUDES = 100
_RECURSION_LIMIT = 6000


_COPY = "urdftool_xacro"


def _load_xacro() -> Any:
    """Load a second copy of xacro under a separate name.

    Its functions and module state change during an expansion; other users of xacro in this
    process are not affected.
    """
    found = find_spec("xacro")
    if found is None or found.origin is None:
        raise ModuleNotFoundError("No module named 'xacro'", name="xacro")
    folders = found.submodule_search_locations
    spec = spec_from_file_location(_COPY, found.origin, submodule_search_locations=folders)
    assert spec is not None
    assert spec.loader is not None
    copy = sys.modules[_COPY] = module_from_spec(spec)
    spec.loader.exec_module(copy)
    return copy


xacro: Any = _load_xacro()


def _import_substitution_args() -> Any:
    """Return xacro's module for ``$(…)``, imported without yaml, which it rarely uses."""
    absent = "yaml" not in sys.modules
    if absent:
        sys.modules["yaml"] = ModuleType("yaml")
    try:
        return import_module(f"{_COPY}.substitution_args")
    finally:
        if absent:
            del sys.modules["yaml"]


class Run:
    """Running expansion."""

    def __init__(self, result: Expansion, packages: Packages) -> None:
        self.result = result
        self.packages = packages
        self.reach = Sandbox(packages, self.load_yaml)
        self.instances = Instances()
        self.node: XacroElement | None = None
        self.failed_text: str | None = None
        self.include_calls: tuple[Call, ...] = ()
        self.elements = 0
        self.produced = 0
        self.patience = EvaluationLimits(self.make_time_error)

    def expand(self) -> None:
        """Parse the file and expand it with xacro; requires :meth:`install_hooks`."""
        xacro.init_stacks(self.result.file.path)
        self.result.tree = parse_xacro(self.result.file)
        xacro.process_doc(self.result.tree, mappings=dict(self.result.given), verbosity=1)

    @contextmanager
    def install_hooks(self) -> Iterator[None]:
        """Replace functions of xacro, and restore them at exit."""
        here: dict[str, Any] = {
            "parse": self.parse,
            "eval_text": self.eval_text,
            "eval_all": self.eval_all(xacro.eval_all),
            "grab_property": self.record_node(xacro.grab_property),
            "grab_macro": self.grab_macro(xacro.grab_macro),
            "process_include": self.process_include(xacro.process_include),
            "handle_macro_call": self.handle_macro_call(xacro.handle_macro_call),
            "check_attrs": self.check_attrs(xacro.check_attrs),
            "reqd_attrs": self.reqd_attrs(xacro.reqd_attrs),
            "abs_filename_spec": self.abs_filename_spec(xacro.abs_filename_spec),
            "get_include_files": self.list_included_files,
            "_empty_text_node": Characters("\n\n"),
            "_global_symbols": self.reach.make_symbols(xacro._global_symbols, self.record_warning),
            "safe_eval": evaluate_number,
            "warning": self.record_warning,
            "print_location": lambda *_: None,
            "all_includes": [],
            "verbosity": 1,
            "root_dir": os.curdir,
        }
        saved = {name: getattr(xacro, name) for name in (*here, "filestack", "macrostack")}
        substitution = _import_substitution_args()
        commands: dict[str, Any] = {
            "find": self.find,
            "env": self.reach.read_variable,
            "optenv": self.reach.read_optional_variable,
        }
        functions: dict[str, Any] = {f"_eval_{name}": f for name, f in commands.items()}
        functions["_eval"] = self.reach.make_ros1_evaluation(substitution)
        saved_functions = {name: getattr(substitution, name) for name in functions}
        saved_commands = {name: substitution._eval_dict[name] for name in commands}
        limit = sys.getrecursionlimit()
        try:
            for name, value in here.items():
                setattr(xacro, name, value)
            for name, function in functions.items():
                setattr(substitution, name, function)
            substitution._eval_dict.update(commands)
            sys.setrecursionlimit(max(limit, _RECURSION_LIMIT))
            with self.patience.enforce():
                yield
            self.store_dependencies()
        finally:
            sys.setrecursionlimit(limit)
            for name, value in saved.items():
                setattr(xacro, name, value)
            for name, function in saved_functions.items():
                setattr(substitution, name, function)
            substitution._eval_dict.update(saved_commands)
            xacro.substitution_args_context.clear()

    # Functions that xacro calls ---------------------------------------------------------------

    def parse(self, _: object, filename: str) -> XacroDocument:
        """Parse an included file; raise xacro's exception if it cannot be opened."""
        path = shorten_path(self.packages.find_installed(filename))
        if len(xacro.filestack) > MAX_INCLUDES:
            raise XacroError(
                f"includes are nested more than {MAX_INCLUDES} deep; a file includes itself",
                at=self.place._replace(calls=self.place.calls[:3]) if self.place else None,
                rule="endless-expansion",
            )
        file = self.result.files.get(path)
        if file is None:
            self.reach.check_file(path, self.place)
            try:
                file = read_file(path, self.packages.workspace)
            except SourceError as error:
                xacro.filestack.pop()
                raise xacro.XacroException(
                    error.message, exc=_MissingFileError(path, error)
                ) from error
            self.result.files[path] = file
        return parse_xacro(file, self.include_calls)

    def find(self, name: str) -> str:
        """Return the folder of a package."""
        return str(self.packages.find(name))

    def abs_filename_spec(self, original: Callable[[str], str]) -> Callable[[str], str]:
        """Wrap the resolution of relative paths: apply install rules to missing files."""

        def absolute(spec: str) -> str:
            path = original(spec)
            there = self.packages.workspace.exists(path)
            return path if there else str(self.packages.find_installed(path))

        return absolute

    def list_included_files(self, spec: str, symbols: Any) -> Iterator[str]:
        """Yield the files that an include names, as ``xacro.get_include_files``."""
        path = str(xacro.abs_filename_spec(self.eval_text(spec, symbols)))
        names = [path]
        if re.search(r"[*[?]", path):
            names = self.packages.workspace.match(path)
            if not names:
                self.record_warning(xacro.include_no_matches_msg.format(path))
        for name in names:
            xacro.all_includes.append(name)
            yield name

    def load_yaml(self, filename: str) -> Any:
        """Load a file as ``xacro.load_yaml``, within limits and with libyaml."""
        import yaml

        path = str(xacro.abs_filename_spec(filename))
        self.reach.check_file(path)
        fast: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
        loader: Any = type("Loader", (fast,), {})
        for unit in xacro.ConstructUnits:
            loader.add_constructor(unit.value.tag, unit.constructor)
        with io.TextIOWrapper(self.packages.workspace.open(path)) as stream:
            xacro.filestack.append(path)
            try:
                value = yaml.load(check_yaml(stream, fast), Loader=loader)
                return xacro.YamlListWrapper.wrap(value)
            finally:
                xacro.filestack.pop()
                xacro.all_includes.append(path)

    def record_warning(self, *words: object, **_: object) -> None:
        """Record a warning with its location."""
        self.result.warnings.append(Warned(" ".join(map(str, words)), self.place))

    def record_node(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap a function of xacro to record the element that it processes."""

        def wrapped(node: XacroElement, *rest: Any) -> Any:
            before, self.node = self.node, node
            result = original(node, *rest)
            self.node = before
            return result

        return wrapped

    def eval_all(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap the expansion of an element to limit the number of elements."""
        wrapped = self.record_node(original)

        def evaluate(node: XacroElement, macros: Any, symbols: Any) -> None:
            self.elements += 1
            if self.elements > MAX_ELEMENTS:
                raise XacroError(
                    f"the expansion has more than {MAX_ELEMENTS} elements; check macros that "
                    "call each other repeatedly",
                    at=node.place._replace(calls=node.calls[:3]),
                    rule="endless-expansion",
                )
            wrapped(node, macros, symbols)

        return evaluate

    def check_attrs(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap the check of attributes to record declared arguments."""

        def wrapped(tag: XacroElement, required: list[str], optional: list[str]) -> Any:
            self.node = tag
            values = original(tag, required, optional)
            if tag.tagName == "xacro:arg":
                name, default = values
                self.result.arguments.setdefault(name, Argument(name, default, tag.place))
            return values

        return wrapped

    def reqd_attrs(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap the reading of attributes to record their element."""

        def wrapped(tag: XacroElement, names: list[str]) -> Any:
            self.node = tag
            return original(tag, names)

        return wrapped

    def grab_macro(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap the definition of a macro so that its copies record their call."""
        wrapped = self.record_node(original)

        def grab(element: XacroElement, macros: Any) -> None:
            element.definition_of = self.instances
            wrapped(element, macros)

        return grab

    def process_include(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap an include so that its elements record it."""
        wrapped = self.record_node(original)

        def include(element: XacroElement, *rest: Any) -> None:
            before = self.include_calls
            self.include_calls = (Call(element.file, element.start, ""), *element.calls)
            wrapped(element, *rest)
            self.include_calls = before

        return include

    def handle_macro_call(self, original: Callable[..., bool]) -> Callable[..., bool]:
        """Wrap a macro call so that the elements of the instance record it."""

        def call(node: XacroElement, macros: Any, symbols: Any) -> bool:
            tag = node.tagName
            if not tag.startswith("xacro:"):
                return False
            if tag == "xacro:call":  # calls this function again with the name of its macro
                return bool(original(node, macros, symbols))
            if len(node.calls) > MAX_CALLS:
                raise XacroError(
                    f"macro '{tag[6:]}' calls itself more than {MAX_CALLS} times; "
                    "add a condition that ends the recursion",
                    at=node.place._replace(calls=node.calls[:3]),
                    rule="endless-expansion",
                )
            before, self.node = self.node, node
            calls = self.instances.calls
            arguments = tuple(
                (k, self.show_argument(v, symbols)) for k, v in node.attributes.items()
            )
            self.instances.calls = (Call(node.file, node.start, tag[6:], arguments), *node.calls)
            result = original(node, macros, symbols)
            self.instances.calls = calls
            self.node = before
            return bool(result)

        return call

    def show_argument(self, value: str, symbols: Any) -> str:
        """Return an argument of a call evaluated, or as written if that may have effects."""
        if "$" not in value or "xacro." in value or len(value) > 200:
            return value
        try:
            return str(self.eval_text(value, symbols))
        except Exception:
            self.failed_text = None
            return value

    def eval_text(self, text: str, symbols: Any) -> Any:
        """Evaluate a text as ``xacro.eval_text``, lexing and compiling each text once."""
        if "$" not in text:
            return text
        try:
            pieces = _split(text)
        except Exception:
            self.failed_text = self.failed_text or text
            raise
        results = []
        for kind, piece in pieces:
            if kind == _EXPR:
                results.append(self.evaluate(piece, symbols))
            elif kind == _EXTENSION:
                inner = self.eval_text(piece, symbols)
                try:
                    self.patience.since = time.process_time()
                    results.append(xacro.eval_extension(f"$({inner})"))
                except Exception:
                    self.failed_text = self.failed_text or text
                    raise
                finally:
                    self.patience.since = None
            else:
                results.append(piece)
        if len(results) == 1:
            return results[0]
        joined = "".join(map(str, results))
        self.produced += len(joined)
        if self.produced > 10 * MAX_LENGTH:
            raise OverflowError(f"the text exceeds the limit of {10 * MAX_LENGTH} characters")
        return joined

    def evaluate(self, expression: str, symbols: Any) -> Any:
        """Return the value of an expression in ``${…}``."""
        try:
            source = str(self.eval_text(expression, symbols))
            code = compile_expression(source)
            if not dict.__contains__(symbols, "__builtins__"):
                symbols.update(__builtins__=BUILTINS)
            self.patience.since = time.process_time()
            value = eval(code, symbols)
            check_size(value)
            return value
        except Exception as error:
            self.failed_text = self.failed_text or expression
            raise xacro.XacroException(
                exc=error, suffix=os.linesep + f"when evaluating expression '{expression}'"
            ) from error
        finally:
            self.patience.since = None

    # Results of the expansion -----------------------------------------------------------------

    @property
    def place(self) -> Place | None:
        """Return the location of the processed element; None before the first."""
        return None if self.node is None else self.node.place

    def make_time_error(self, seconds: float) -> XacroError:
        """Make the error for an expansion that was stopped after a time [s]."""
        return XacroError(
            f"the expansion was stopped because it takes more than {seconds:g} s of CPU time",
            at=self.place,
            path=self.result.file.path,
            rule="endless-expansion",
        )

    def store_dependencies(self) -> None:
        """Store the files that xacro read, each once."""
        seen = dict.fromkeys(
            shorten_path(self.packages.find_installed(path)) for path in xacro.all_includes
        )
        self.result.dependencies = list(seen)

    def explain(self, error: Exception) -> UrdftoolError:
        """Convert an exception of the expansion to an error with a location."""
        from .xacro_errors import explain

        return explain(error, self.node, self.failed_text, self.result, self.packages.workspace)


class _MissingFileError(OSError):
    """Error with the attributes by which xacro recognizes a missing optional include."""

    def __init__(self, path: str, error: SourceError) -> None:
        super().__init__(error.message)
        self.path = path
        self.error = error

    def __str__(self) -> str:
        return self.path


_TEXT, _EXPR, _EXTENSION = 0, 1, 2


@lru_cache(maxsize=1 << 15)
def _split(text: str) -> list[tuple[int, str]]:
    """Return the tokens of a text, by xacro's lexer."""
    pieces = []
    lexer = xacro.QuickLexer(xacro.LEXER)
    lexer.lex(text)
    while lexer.peek():
        kind, value = lexer.next()
        if kind == lexer.EXPR:
            pieces.append((_EXPR, value[2:-1]))
        elif kind == lexer.EXTENSION:
            pieces.append((_EXTENSION, value[2:-1]))
        elif kind == lexer.DOLLAR_DOLLAR_BRACE:
            pieces.append((_TEXT, value[1:]))
        else:
            pieces.append((_TEXT, value))
    return pieces

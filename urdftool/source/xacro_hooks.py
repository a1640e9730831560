"""Replacements of xacro's functions during an expansion.

The ``xacro`` package expands. Replaced are its parser (for locations, limits and checks), package
search (without ROS), text evaluation (equal, but each expression is compiled once), file access and
output. The state of xacro is in module globals: a process runs one expansion.
"""

from __future__ import annotations

import io
import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import Any

from ..errors import SourceError, UrdftoolError, XacroError
from .expansion import Argument, Expansion, Warned
from .expressions import Expression, compile_expression
from .limits import EvaluationLimits, make_time_error
from .location import Call, Place
from .safe_builtins import MAX_LENGTH, check_size
from .xacro_copy import substitution_args, xacro
from .xacro_errors import explain
from .xacro_files import Files
from .xacro_lookups import LookupRecorder
from .xacro_parse import parse_xacro, take_tree
from .xacro_symbols import make_ros1_evaluation, make_symbols
from .xacro_tree import Characters, Instances, XacroDocument, XacroElement
from .yaml_bounds import check_yaml

MAX_CALLS = 400  # nested calls of macros; chosen, no source
MAX_ELEMENTS = 200_000  # elements of an expansion; chosen, no source
MAX_INCLUDES = 100  # nested includes; chosen, no source
_RECURSION_LIMIT = 6000  # frames of Python; chosen, no source: 15 for each of MAX_CALLS
_SHOWN = 100  # characters of a text in a message; chosen


class Run:
    """Expansion in this process, which it occupies: the state of xacro is global."""

    def __init__(
        self,
        result: Expansion,
        files: Files,
        *,
        trusted: bool,
        codes: Mapping[str, Expression] | None = None,
    ) -> None:
        """Set where the result goes and what may be read."""
        self.result = result
        self.files = files
        self.trusted = trusted
        self.instances = Instances()
        self.node: XacroElement | None = None
        self.failed_text: str | None = None
        self.include_calls: tuple[Call, ...] = ()
        self.elements = 0
        self.produced = 0
        self.codes = dict(codes or {})
        self.shown: tuple[Any, dict[str, Any]] = None, {}
        self.patience = EvaluationLimits(lambda: make_time_error(self.place))
        record = result.lookups is not None
        self.lookups = LookupRecorder(lambda: self.node) if record else None

    def expand(self) -> list[str]:
        """Expand the file with xacro; return the paths of the included files as xacro lists them.

        Raises:
            UrdftoolError: The expansion failed; the error has the location of the cause.
        """
        self._install_hooks()
        try:
            with self.patience.enforce():
                xacro.init_stacks(self.result.file.path)
                tree = parse_xacro(self.result.file)
                self.result.set_tree(tree)
                xacro.process_doc(tree, mappings=dict(self.result.given), verbosity=1)
        except UrdftoolError as error:
            if error.line is not None or self.node is None:
                raise
            raise explain(error, self.node, None, self.result, self.files) from None
        except Exception as error:
            raise explain(error, self.node, self.failed_text, self.result, self.files) from error
        if self.lookups is not None:
            self.result.lookups = self.lookups.list_found()
        return list(xacro.all_includes)

    def _install_hooks(self) -> None:
        """Replace functions of xacro."""
        functions = self.list_functions()
        symbols = make_symbols(
            xacro._global_symbols, functions, self.record_warning, trusted=self.trusted
        )
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
            "_global_symbols": symbols,
            "safe_eval": self.evaluate_number,
            "warning": self.record_warning,
            "print_location": lambda *_: None,
            "all_includes": [],
            "verbosity": 1,
            "root_dir": os.curdir,
        }
        there: dict[str, Any] = {
            "_eval_find": self.files.find_package,
            "_eval_env": self.files.read_variable,
            "_eval_optenv": self.files.read_optional_variable,
            "_eval": make_ros1_evaluation(substitution_args, trusted=self.trusted),
        }
        for module, values in ((xacro, here), (substitution_args, there)):
            for name, value in values.items():
                setattr(module, name, value)
        if self.lookups is not None:
            self.lookups.install(xacro, substitution_args)
        sys.setrecursionlimit(max(sys.getrecursionlimit(), _RECURSION_LIMIT))

    # Functions that xacro calls ---------------------------------------------------------------

    def parse(self, _: object, filename: str) -> XacroDocument:
        """Parse an included file; raise xacro's exception if it cannot be opened."""
        if len(xacro.filestack) > MAX_INCLUDES:
            raise XacroError(
                f"includes are nested more than {MAX_INCLUDES} deep; a file includes itself",
                at=self.place._replace(calls=self.place.calls[:3]) if self.place else None,
                rule="endless-expansion",
            )
        try:
            file = self.files.read_xml(filename)
        except XacroError:  # the description may not read it
            raise
        except SourceError as error:
            xacro.filestack.pop()
            missing = _MissingFileError(error.path or filename, error)
            raise xacro.XacroException(error.message, exc=missing) from error
        self.result.files.setdefault(file.path, file)
        if self.lookups is not None:
            self.lookups.record("file", "", (file, 0))
        return take_tree(file, self.include_calls)

    def abs_filename_spec(self, original: Callable[[str], str]) -> Callable[[str], str]:
        """Wrap the resolution of relative paths: apply install rules to missing files."""
        return lambda spec: self.files.locate_file(original(spec))

    def list_included_files(self, spec: str, symbols: Any) -> Iterator[str]:
        """Yield the files that an include names, as ``xacro.get_include_files``."""
        path = str(xacro.abs_filename_spec(self.eval_text(spec, symbols)))
        names = [path]
        if re.search(r"[*[?]", path):
            names = self.files.list_matches(path)
            if not names:
                self.record_warning(xacro.include_no_matches_msg.format(path))
        for name in names:
            xacro.all_includes.append(name)
            yield name

    def load_yaml(self, filename: str) -> Any:
        """Load a file as ``xacro.load_yaml``, within limits and with libyaml."""
        yaml = self.files.import_yaml()
        path = str(xacro.abs_filename_spec(filename))
        fast: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
        loader: Any = type("Loader", (fast,), {})
        for unit in xacro.ConstructUnits:
            loader.add_constructor(unit.value.tag, unit.constructor)
        text = io.TextIOWrapper(io.BytesIO(self.files.read_yaml(path))).read()
        xacro.filestack.append(path)
        try:
            value = yaml.load(check_yaml(text, path, fast), Loader=loader)
            return xacro.YamlListWrapper.wrap(value)
        finally:
            xacro.filestack.pop()
            xacro.all_includes.append(path)

    def list_functions(self) -> dict[str, Callable[..., Any]]:
        """Return the functions of the namespace ``xacro`` of expressions."""
        original = xacro._global_symbols["xacro"]
        names = ("abs_filename", "arg", "dotify", "fatal", "tokenize")
        return {
            **{name: original[name] for name in names},
            "load_yaml": self.load_yaml,
            "message": self.make_printer(""),
            "warning": self.make_printer("warning: "),
            "error": self.make_printer("error: "),
            "print_location": self.print_location,
        }

    def make_printer(self, start: str) -> Callable[..., str]:
        """Return a function that prints words as ``xacro.message`` does."""

        def show(*words: object, **_: object) -> str:
            self.files.add_message(start + " ".join(map(str, words)))
            return ""

        return show

    def print_location(self) -> str:
        """Print the location of the processed element, as ``xacro.print_location``."""
        return self.make_printer("")(f"in {self.place or self.result.file.path}")

    def evaluate_number(self, text: str, symbols: Mapping[str, Any]) -> Any:
        """Evaluate a number with units in a YAML file; replaces ``xacro.safe_eval``."""
        return compile_expression(text, trusted=self.trusted).evaluate(dict(symbols))

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
        """Wrap the expansion of an element to record it, and to limit the number of elements.

        It begins with a loop over the attributes, of which it gets those that it changes.
        """

        def evaluate(node: XacroElement, macros: Any, symbols: Any) -> None:
            self.elements += node.plain or 1
            if self.elements > MAX_ELEMENTS:
                raise XacroError(
                    f"the expansion has more than {MAX_ELEMENTS} elements; check macros that "
                    "call each other repeatedly",
                    at=node.place._replace(calls=node.calls[:3]),
                    rule="endless-expansion",
                )
            if node.plain:
                return
            before, self.node = self.node, node
            node.attributes.only_computed = True
            original(node, macros, symbols)
            self.node = before

        return evaluate

    def check_attrs(self, original: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap the check of attributes to record declared arguments."""

        def wrapped(tag: XacroElement, required: list[str], optional: list[str]) -> Any:
            self.node = tag
            values = original(tag, required, optional)
            if tag.tagName == "xacro:arg":
                name, default = values
                self.result.arguments.setdefault(name, Argument(name, default, tag.place))
                if self.lookups is not None:
                    self.lookups.record_argument(tag, name)
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
            tag = node.tagName = node.nodeName = str(node.tagName)  # may have been computed
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
            self.shown = symbols, {}
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
        """Return an argument of a call evaluated, or as written if that may have effects.

        Its value is kept for xacro, which evaluates the arguments next.
        """
        if "$" not in value or "xacro." in value or len(value) > 200:
            return value
        try:
            evaluated = self.eval_text(value, symbols)
            shown = str(evaluated)
            self.shown[1][value] = evaluated
            return shown
        except Exception:
            self.failed_text = None
            return value

    def eval_text(self, text: str, symbols: Any) -> Any:
        """Evaluate a text as ``xacro.eval_text``, lexing and compiling each text once."""
        if "$" not in text:
            return text
        table, shown = self.shown
        if shown and symbols is table and text in shown:
            return shown.pop(text)
        try:
            pieces = split_text(text)
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
                    self.patience.start()
                    results.append(xacro.eval_extension(f"$({inner})"))
                except Exception:
                    self.failed_text = self.failed_text or text
                    raise
                finally:
                    self.patience.stop()
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
            source = expression
            if "$" in expression:
                source = str(self.eval_text(expression, symbols))
            code = self.codes.get(source)
            if code is None:
                code = compile_expression(source, trusted=self.trusted)
                self.codes[source] = code
            if self.node is not None:
                self.files.mark_place(self.node.file, self.node.start)
            self.patience.start()
            value = code.evaluate(symbols)
            check_size(value)
            return value
        except Exception as error:
            self.failed_text = self.failed_text or expression
            raise xacro.XacroException(
                exc=error, suffix=os.linesep + f"when evaluating expression '{expression}'"
            ) from error
        finally:
            self.patience.stop()

    # Results of the expansion -----------------------------------------------------------------

    @property
    def place(self) -> Place | None:
        """Return the location of the processed element; None before the first."""
        return None if self.node is None else self.node.place


class _MissingFileError(OSError):
    """Error with the attributes by which xacro recognizes a missing optional include."""

    def __init__(self, path: str, error: SourceError) -> None:
        super().__init__(error.message)
        self.path = path
        self.error = error

    def __str__(self) -> str:
        return self.path


_TEXT, _EXPR, _EXTENSION = 0, 1, 2
"""Kinds of pieces of a text. Chosen, no source."""


_LEXER = [re.compile(pattern.pattern.removeprefix("^")) for pattern in xacro.LEXER.res]
"""Patterns of xacro's lexer for a match at any position; the lexer copies the rest of the text."""


@lru_cache(maxsize=1 << 15)
def split_text(text: str) -> list[tuple[int, str]]:
    """Return the tokens of a text, as xacro's lexer does.

    Raises:
        XacroException: A bracket is not closed.
    """
    pieces = []
    lexer, start = xacro.LEXER, 0
    while start < len(text):
        kinds = enumerate(pattern.match(text, start) for pattern in _LEXER)
        kind, match = next(((kind, match) for kind, match in kinds if match), (0, None))
        if match is None:
            raise xacro.XacroException(f"invalid expression: {text[start : start + _SHOWN]}")
        start = match.end()
        if kind == lexer.EXPR:
            pieces.append((_EXPR, match[0][2:-1]))
        elif kind == lexer.EXTENSION:
            pieces.append((_EXTENSION, match[0][2:-1]))
        else:
            skipped = int(kind == lexer.DOLLAR_DOLLAR_BRACE)
            pieces.append((_TEXT, match[0][skipped:]))
    return pieces

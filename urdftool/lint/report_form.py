"""Plain form of reports for the cache: values of JSON, checked field by field when they are read.

The form of a field follows from its annotated type. Only the classes listed here are made, and
reading them calls nothing else.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass
from enum import Enum
from functools import lru_cache
from types import NoneType
from typing import Any, Literal, NamedTuple, get_args, get_origin, get_type_hints

from ..diagnostic import FileRewrite, Fix, Replacement
from ..finding import Cause, Finding, Group
from ..source.location import Call, Place, SourceFile
from .outcome import Report

_CLASSES: dict[str, type] = {
    one.__name__: one
    for one in (Report, Finding, Group, Cause, Fix, Replacement, FileRewrite, Place, Call)
}
_EMPTY = {Report: {"error", "failed_rules", "rows"}, Finding: {"members", "consequences"}}
"""Fields without a value: a cached report is complete, its findings are not grouped yet, and its
rows are stored separately."""

_LARGEST = 2**53
"""Smallest whole number whose successor is no other double, as JSON readers have."""


class _Form(NamedTuple):
    """Conversion of the values of one type; both functions raise ValueError for others."""

    write: Callable[[Any, Tables], Any]
    read: Callable[[Any, Tables], Any]


class Tables:
    """Objects that are written once and referred to by number: source files and xacro calls.

    Attributes:
        files: The source files, in the order of their numbers.
        calls: The calls in their plain form, or as objects while a report is read.
    """

    def __init__(self, files: Sequence[SourceFile] = ()) -> None:
        """Set the files to refer to; a report that is written adds its own."""
        self.files = list(files)
        self.calls: list[Any] = []
        self._numbers: dict[int, int] = {}

    def get_number(self, value: object, objects: list[Any], plain: Callable[[], Any]) -> int:
        """Return the number of an object, which is added in its plain form if it is new."""
        if id(value) not in self._numbers:
            form = plain()
            self._numbers[id(value)] = len(objects)
            objects.append(form)
        return self._numbers[id(value)]


def write_report(report: Report) -> tuple[dict[str, Any], list[SourceFile]]:
    """Return the plain form of a report, and the source files to which it refers by number.

    Raises:
        ValueError: A value has no plain form.
    """
    tables = Tables()
    try:
        table = _get_object_form("Report").write(report, tables)
    except (TypeError, AttributeError, RecursionError) as error:
        raise ValueError(repr(error)) from None
    return {"report": table, "calls": tables.calls}, tables.files


def read_report(table: Any, files: Sequence[SourceFile]) -> Report:
    """Return the report of a plain form.

    Raises:
        ValueError: The form is damaged.
    """
    tables = Tables(files)
    try:
        for call in table["calls"]:
            tables.calls.append(_get_object_form("Call").read(call, tables))
        report: Report = _get_object_form("Report").read(table["report"], tables)
    except (TypeError, KeyError, IndexError, RecursionError) as error:
        raise ValueError(repr(error)) from None
    return report


def read_file(path: Any, encoding: Any, data: bytes) -> SourceFile:
    """Return a source file whose path and encoding are checked.

    Raises:
        ValueError: They are invalid.
    """
    _check(type(path) is str and type(encoding) is str, path)
    if encoding != "utf-8":
        try:
            data.decode(encoding, "replace")
        except LookupError as error:
            raise ValueError(str(error)) from None
    return SourceFile(path, data, encoding)


def convert_to_text(data: bytes) -> str:
    """Return bytes as text that JSON holds; :func:`convert_to_bytes` returns them."""
    return data.decode("utf-8", "surrogateescape")


def convert_to_bytes(text: Any) -> bytes:
    """Return the bytes of a text of :func:`convert_to_text`.

    Raises:
        ValueError: It is not such a text.
    """
    if type(text) is not str:
        raise ValueError(text)
    return text.encode("utf-8", "surrogateescape")


def _check(condition: bool, value: object) -> None:
    if not condition:
        raise ValueError(repr(value)[:80])


def _check_truth(value: Any, _: Tables) -> Any:
    _check(type(value) is bool, value)
    return value


def _check_text(value: Any, _: Tables) -> Any:
    """Check a text; bytes of a file name that are not UTF-8 are the only surrogates in it."""
    _check(type(value) is str, value)
    if not value.isascii():
        value.encode("utf-8", "surrogateescape")
    return value


def _check_integer(value: Any, _: Tables) -> Any:
    _check(type(value) is int and abs(value) < _LARGEST, value)
    return value


def _make_form(kind: Any) -> _Form:
    """Return the form of a type.

    Raises:
        TypeError: The type has none.
    """
    origin, arguments = get_origin(kind), get_args(kind)
    if kind is str:
        return _Form(_check_text, _check_text)
    if kind is bool:
        return _Form(_check_truth, _check_truth)
    if kind is int:
        return _Form(_check_integer, _check_integer)
    if kind is bytes:
        return _Form(
            lambda value, _: convert_to_text(value), lambda value, _: convert_to_bytes(value)
        )
    if kind in (Any, object):
        return _Form(_write_plain, _read_plain)
    if kind is SourceFile:
        return _Form(_write_file, lambda number, tables: _get(tables.files, number))
    if kind is Call:
        return _Form(_write_call, lambda number, tables: _get(tables.calls, number))
    if isinstance(kind, type) and issubclass(kind, Enum):
        return _Form(lambda value, _: value.value, lambda value, _: kind(value))
    if isinstance(kind, type) and _CLASSES.get(kind.__name__) is kind:
        return _get_object_form(kind.__name__)
    if origin is Literal:
        return _make_choice(arguments)
    if NoneType in arguments:
        (other,) = (argument for argument in arguments if argument is not NoneType)
        return _make_optional(_make_form(other))
    if origin is tuple and Ellipsis not in arguments:
        return _make_row([_make_form(argument) for argument in arguments])
    if origin in (list, tuple, frozenset):
        return _make_sequence(origin, _make_form(arguments[0]))
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return _make_table(_make_form(arguments[0]), _make_form(arguments[1]))
    if isinstance(origin, type) and issubclass(origin, Sequence):
        return _make_sequence(tuple, _make_form(arguments[0]))
    raise TypeError(f"no plain form of {kind}")


def _get(objects: list[Any], number: Any) -> Any:
    _check(type(number) is int and 0 <= number < len(objects), number)
    return objects[number]


def _write_file(file: Any, tables: Tables) -> int:
    _check(type(file) is SourceFile and not file.part, file)
    return tables.get_number(file, tables.files, lambda: file)


def _write_call(call: Any, tables: Tables) -> int:
    form = _get_object_form("Call")
    return tables.get_number(call, tables.calls, lambda: form.write(call, tables))


def _make_choice(choices: tuple[Any, ...]) -> _Form:
    def check(value: Any, _: Tables) -> Any:
        _check(type(value) is str and value in choices, value)
        return value

    return _Form(check, check)


def _make_optional(form: _Form) -> _Form:
    return _Form(
        lambda value, tables: None if value is None else form.write(value, tables),
        lambda value, tables: None if value is None else form.read(value, tables),
    )


def _make_sequence(kind: type, form: _Form) -> _Form:
    def write(values: Any, tables: Tables) -> Any:
        _check(isinstance(values, list | tuple | frozenset), values)
        items = [form.write(value, tables) for value in values]
        return sorted(items) if kind is frozenset else items

    def read(values: Any, tables: Tables) -> Any:
        _check(type(values) is list, values)
        return kind([form.read(value, tables) for value in values])

    return _Form(write, read)


def _make_row(forms: list[_Form]) -> _Form:
    def write(values: Any, tables: Tables) -> Any:
        _check(type(values) is tuple, values)
        return [f.write(value, tables) for f, value in zip(forms, values, strict=True)]

    def read(values: Any, tables: Tables) -> Any:
        _check(type(values) is list, values)
        return tuple([f.read(value, tables) for f, value in zip(forms, values, strict=True)])

    return _Form(write, read)


def _make_table(key: _Form, item: _Form) -> _Form:
    def write(values: Any, tables: Tables) -> Any:
        return {key.write(k, tables): item.write(v, tables) for k, v in values.items()}

    def read(values: Any, tables: Tables) -> Any:
        _check(type(values) is dict, values)
        return {key.read(k, tables): item.read(v, tables) for k, v in values.items()}

    return _Form(write, read)


@lru_cache
def _get_object_form(name: str) -> _Form:
    """Return the form of a listed class.

    It is a list of all fields of a tuple, or a table of the fields of a dataclass that do not have
    their default.
    """
    kind = _CLASSES[name]
    hints = get_type_hints(kind, localns={**_CLASSES, "SourceFile": SourceFile})
    if not is_dataclass(kind):
        row = _make_row([_make_form(one) for one in hints.values()])
        check = _CHECKS.get(kind)

        def read_row(values: Any, tables: Tables) -> Any:
            found = kind(*row.read(values, tables))
            if check is not None:
                _check(check(found), values)
            return found

        return _Form(lambda value, tables: row.write(tuple(value), tables), read_row)
    defaults = {
        field.name: field.default_factory() if callable(field.default_factory) else field.default
        for field in fields(kind)
    }
    never = _EMPTY.get(kind, set())
    forms = {name: _make_form(hints[name]) for name in defaults if name not in never}

    def write(value: Any, tables: Tables) -> Any:
        _check(type(value) is kind, value)
        table = {}
        for name, default in defaults.items():
            item = getattr(value, name)
            if default is MISSING or item != default:
                _check(name in forms, name)
                table[name] = forms[name].write(item, tables)
        return table

    def read(table: Any, tables: Tables) -> Any:
        _check(type(table) is dict, table)
        return kind(**{name: forms[name].read(item, tables) for name, item in table.items()})

    return _Form(write, read)


def _is_inside(place: Place) -> bool:
    return 0 <= place.start <= place.end <= len(place.file.data)


_CHECKS: dict[type, Callable[[Any], bool]] = {
    Place: _is_inside,
    Call: lambda call: 0 <= call.start <= len(call.file.data),
}
_MARKS: dict[str, type] = {"tuple": tuple, "set": set, "frozenset": frozenset}


def _write_plain(value: Any, tables: Tables) -> Any:
    """Return the form of data without a declared type."""
    kind = type(value)
    if value is None or kind in _SCALARS:
        return None if value is None else _SCALARS[kind](value, tables)
    if kind is list:
        return [_write_plain(item, tables) for item in value]
    if kind is dict:
        pairs = [[_write_plain(k, tables), _write_plain(v, tables)] for k, v in value.items()]
        return {"dict": pairs}
    _check(kind.__name__ in _MARKS and kind is _MARKS[kind.__name__], value)
    return {kind.__name__: [_write_plain(item, tables) for item in value]}


def _read_plain(value: Any, tables: Tables) -> Any:
    if type(value) is list:
        return [_read_plain(item, tables) for item in value]
    if type(value) is not dict:
        return None if value is None else _SCALARS[type(value)](value, tables)
    ((mark, items),) = value.items()
    _check(type(items) is list, items)
    if mark == "dict":
        return {_read_plain(k, tables): _read_plain(v, tables) for k, v in items}
    return _MARKS[mark](_read_plain(item, tables) for item in items)


_SCALARS: dict[type, Callable[[Any, Tables], Any]] = {
    str: _check_text,
    int: _check_integer,
    bool: lambda value, _: value,
    float: lambda value, _: value,
}

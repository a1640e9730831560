"""Write the reference of the Python API from signatures and docstrings."""

from __future__ import annotations

import inspect
import re
from dataclasses import fields, is_dataclass
from enum import Enum
from importlib import import_module
from types import FunctionType
from typing import Literal, get_args, get_origin

import urdftool
from urdftool.collision import compute, settings
from urdftool.compare.check import Check
from urdftool.compare.several import Agreement, Disagreement
from urdftool.formats.written import Written
from urdftool.lint.fix_run import FixedDescription
from urdftool.model import elements
from urdftool.simulation.fault import Fault
from urdftool.simulation.settings import Settings
from urdftool.simulation.verdict import Verdict
from urdftool.source.location import Place

BEGIN, END = "<!-- names begin -->", "<!-- names end -->"

PARTS = (
    *(elements.Link, elements.Inertial, elements.Visual, elements.Collision, elements.Origin),
    *(elements.Joint, elements.Limit, elements.Mimic, Place),
)
"""Parts of a robot that most programs use."""

RESULTS = (
    *(FixedDescription, Written, Check, Agreement, Disagreement, Verdict, Fault),
    *(Settings, settings.Settings, compute.Result),
)
"""Types of arguments and results other than robots and findings."""

PLUMBING = ("element",)
"""Attributes of every part, which the page describes once."""

SECTIONS = ("Args", "Attributes", "Returns", "Yields", "Raises")


def insert_names(text: str) -> str:
    """Insert the public names between the marks of the page."""
    names = [getattr(urdftool, name) for name in urdftool.__all__ if name != "__version__"]
    functions = [name for name in names if isinstance(name, FunctionType)]
    classes = [name for name in names if not isinstance(name, FunctionType)]
    parts = [
        "## Functions",
        *(_format_function(f"urdftool.{one.__name__}", one) for one in functions),
    ]
    parts += ["## Classes", *(_format_class(f"urdftool.{one.__name__}", one) for one in classes)]
    parts += ["## Parts of a robot", *(_format_class(_format_path(one), one) for one in PARTS)]
    parts += [
        "## Settings and results",
        *(_format_class(_format_path(one), one) for one in RESULTS),
    ]
    shown = f"{BEGIN}\n" + "\n\n".join(parts) + f"\n{END}"
    return re.sub(f"{BEGIN}.*?{END}", lambda _: shown, text, flags=re.DOTALL)


def _format_path(one: type) -> str:
    return f"{one.__module__}.{one.__name__}"


def _format_function(name: str, one: FunctionType) -> str:
    signature = inspect.signature(one)
    words = [_format_parameter(parameter, one) for parameter in signature.parameters.values()]
    keyword_only = [p.kind is p.KEYWORD_ONLY for p in signature.parameters.values()]
    if True in keyword_only:
        words.insert(keyword_only.index(True), "*")
    result = signature.return_annotation
    shown = "".join(f"    {word},\n" for word in words)
    code = f"```python\n{name}(\n{shown}) -> {result}\n```"
    return f"### {one.__name__}\n\n{code}\n\n{_convert(one.__doc__)}"


def _format_parameter(parameter: inspect.Parameter, one: FunctionType) -> str:
    default = "" if parameter.default is parameter.empty else f" = {parameter.default!r}"
    return f"{parameter.name}: {_format_type(parameter.annotation, one)}{default}"


def _format_type(annotation: str, one: FunctionType) -> str:
    """Return a type; the words of a Literal in place of its name in the options of an export."""
    verb, _, target = one.__name__.partition("_")
    if verb != "export":
        return annotation
    options = import_module(f"urdftool.formats.{target}.options")
    type_ = getattr(options, annotation, None)
    if get_origin(type_) is not Literal:
        return annotation
    return f"Literal[{', '.join(map(repr, get_args(type_)))}]"


def _format_class(name: str, one: type) -> str:
    prose = _convert(one.__doc__)
    described = set(re.findall(r"^- `(\w+)`:", prose, re.MULTILINE))
    found = []
    for own in fields(one) if is_dataclass(one) else ():
        if own.name not in {*described, *PLUMBING}:
            found.append(f"- `{own.name}`: `{own.type}`")
    for own_name, value in vars(one).items():
        if not own_name.startswith("_") and _is_property(value):
            found.append(f"- `{own_name}`: {_read_summary(value)}")
    package = f"{one.__module__.split('.')[1]}." if one.__name__ == "Settings" else ""
    parts = [f"### {package}{one.__name__}", f"`{name}`", prose]
    if issubclass(one, Enum):
        values = ", ".join(f"`{member.name}` ({member.value})" for member in one)
        parts.append(f"Values: {values}.")
    if "**Attributes**" in prose:
        return "\n\n".join(parts) + "".join(f"\n{line}" for line in found)
    return "\n\n".join([*parts, *(["**Attributes**", "\n".join(found)] if found else [])])


def _is_property(value: object) -> bool:
    return type(value).__name__ in ("property", "cached_property")


def _read_summary(value: object) -> str:
    return _strip_roles(inspect.cleandoc(value.__doc__ or "").partition("\n\n")[0])


def _convert(docstring: str | None) -> str:
    """Convert a Google-style docstring to Markdown: prose, and a list for each section."""
    parts = []
    for block in re.split(r"\n\n", inspect.cleandoc(docstring or "")):
        head, _, rest = block.partition("\n")
        if head.rstrip(":") in SECTIONS and head.endswith(":"):
            items = re.split(r"\n(?=    \S)", "\n" + rest)[1:]
            parts.append(f"**{head.rstrip(':')}**\n\n" + "\n".join(map(_format_item, items)))
        elif block.strip():
            parts.append(_strip_roles(block))
    return "\n\n".join(parts)


def _format_item(text: str) -> str:
    name, colon, meaning = _strip_roles(text).partition(": ")
    return f"- `{name}`: {meaning}" if colon else f"- {name}"


def _strip_roles(text: str) -> str:
    text = " ".join(text.split())
    text = re.sub(r":(?:func|class|meth):`(?:~?[\w.]+\.)?(\w+)`", r"`\1`", text)
    return text.replace("``", "`")

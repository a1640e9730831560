"""Old names of :mod:`urdftool.rules.fix`, for fixes that do not stand beside their rules yet."""

from __future__ import annotations

import re

from ...source.edit import Source
from ...source.location import SourceFile
from .. import fix
from ..fix import (
    Change as Change,
)
from ..fix import (
    FixContext as FixContext,
)
from ..fix import (
    Lines as Lines,
)
from ..fix import (
    Proposal as Proposal,
)
from ..fix import (
    RefusedError as RefusedError,
)
from ..fix import (
    Span as Span,
)
from ..fix import (
    attribute_at as attribute_at,
)
from ..fix import (
    element_at as element_at,
)
from ..fix import (
    is_always_there as is_always_there,
)
from ..fix import (
    is_close_enough as is_close_enough,
)
from ..fix import (
    is_computed as is_computed,
)
from ..fix import (
    may_vary as may_vary,
)
from ..fix import (
    safe as safe,
)
from ..fix import (
    unsafe as unsafe,
)
from ..rule import Problem

Around = FixContext
put, drop, rename, retag = (
    fix.set_attribute,
    fix.remove_attribute,
    fix.rename_attribute,
    fix.rename_element,
)
say, remove, insert, first = fix.set_text, fix.remove_element, fix.append_child, fix.prepend_child
after, replace, sub, sub_text = (
    fix.insert_after,
    fix.replace_element,
    fix.substitute,
    fix.substitute_text,
)
figures, quote, written = fix.format_numbers, fix.escape_attribute, fix.written_value
stands_in, same, lines_of = fix.is_written_inside, fix.are_equal_elements, fix.written_lines
depends_on_a_call = fix.depends_on_arguments

_MEANT = re.compile(r"did you mean '([^']*)'\?")
_WRITE = re.compile(r"; write '?<?([^\s'<>,;]+?)>?'?(?:$|[,;])")


def meant(problem: Problem, wrong: str) -> str:
    """Take a suggestion out of a message; empty where it is too far from what is written."""
    match = _MEANT.search(problem.message)
    return match[1] if match is not None and is_close_enough(match[1], wrong) else ""


def to_write(problem: Problem) -> str:
    """Take the one word out of a message that says to write it."""
    match = _WRITE.search(problem.message)
    return match[1] if match else ""


def source_of(file: SourceFile) -> Source:
    """Get a file as it is written."""
    return file.editable()

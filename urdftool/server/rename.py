"""Renaming of links, joints, materials, macros, properties, parameters and arguments.

Every reference is changed, then each robot is read again with the changes: it must be as before,
except for the new names. A name that is computed is not changed, and the renaming is refused.
"""

from __future__ import annotations

import keyword
import re
from typing import Any

from ..errors import UrdftoolError
from ..source.location import Place
from ..source.safe_builtins import MATH, PYTHON
from .around import YAML
from .knowledge import Knowledge, make_path
from .names import Names, get_names
from .navigation import find_word
from .rename_edits import RefusedRename, SourceEdits, prove
from .rename_parts import rename_parts, split_written
from .scopes import get_scope
from .words import Word

_PARTS = ("link", "joint", "part", "material")
_XML_NAME = re.compile(r"[A-Za-z_][\w.-]*")
_FORBIDDEN = re.compile(r"[<>&\"'$\s{}]")
_TAKEN = frozenset((*MATH, *PYTHON, "xacro", "math", "python"))


def prepare_rename(knowledge: Knowledge, params: dict[str, Any]) -> dict[str, Any] | None:
    """Return the range of the name at a position and its text; None if none can be renamed."""
    word = find_word(knowledge, params)
    if word is None or word.kind in ("file", "package"):
        return None
    start, end = _find_span(knowledge, params, word)
    if start == end:
        return None
    file = word.element.file
    text = file.data[start:end].decode(file.encoding, "replace")
    return {"range": knowledge.make_table(file).get_range(start, end), "placeholder": text}


def _find_span(knowledge: Knowledge, params: dict[str, Any], word: Word) -> tuple[int, int]:
    """Return the bytes to replace: of a computed name the literal part at the position."""
    if word.kind not in _PARTS:
        first = word.end - len(word.name.rpartition(".")[2].encode("utf-8"))
        return first, word.end
    offset = knowledge.get_offset(params)
    data = word.element.file.data[word.start : word.end]
    for start, end in split_written(data):
        if word.start + start <= offset <= word.start + end:
            return word.start + start, word.start + end
    return word.start, word.start


def rename(knowledge: Knowledge, params: dict[str, Any]) -> dict[str, Any]:
    """Return the edits of a renaming, or why it is refused."""
    try:
        return {"edits": _make_edits(knowledge, params).convert(knowledge)}
    except UrdftoolError as error:
        place = "" if error.at is None else f" ({error.at})"
        return {"refused": f"{error.message}{place}"}


def _make_edits(knowledge: Knowledge, params: dict[str, Any]) -> SourceEdits:
    word, new = find_word(knowledge, params), params["name"]
    if word is None or word.kind in ("file", "package"):
        raise RefusedRename("there is no name that can be changed")
    if not params["path"].endswith(YAML) and knowledge.parse(params["path"]) is None:
        raise RefusedRename("the document is not well-formed; correct it first")
    _check_new_name(word, new)
    names = get_names(knowledge, params["path"])
    edits = SourceEdits(knowledge)
    if word.kind in _PARTS:
        rename_parts(names, word, _find_span(knowledge, params, word), new, edits)
    else:
        _rename_words(names, word, new, edits)
    return edits


def _check_new_name(word: Word, new: str) -> None:
    """Check that a text can be a name.

    Raises:
        RefusedRename: It cannot.
    """
    if word.kind == "name" and (not new.isidentifier() or keyword.iskeyword(new)):
        raise RefusedRename(f"'{new}' is not a name that expressions can use")
    if word.kind == "name" and new in _TAKEN:
        raise RefusedRename(f"'{new}' is a name of xacro or Python")
    if word.kind == "macro" and not _XML_NAME.fullmatch(new):
        raise RefusedRename(f"'{new}' cannot be the name of an element")
    if not new or _FORBIDDEN.search(new):
        raise RefusedRename(f"'{new}' cannot be a name")


def _rename_words(names: Names, word: Word, new: str, edits: SourceEdits) -> None:
    """Rename a macro, property, parameter or argument.

    Raises:
        RefusedRename: A use is computed, or the name is taken.
    """
    found = _list_related(names, word)
    definitions = [one for one in found if one.is_definition]
    if not definitions:
        raise RefusedRename(f"'{word.name}' is not defined in a file of its robots")
    for one in definitions:
        if "$" in one.name:
            raise RefusedRename(f"name '{one.name}' is computed", at=_locate(one))
    _check_free(names, definitions[0], new)
    _check_not_computed(names, definitions)
    for one in found:
        first = one.end - len(_get_last(one.name).encode(one.element.file.encoding))
        edits.replace(one.element.file, first, one.end, new)
    old = definitions[0].name if word.kind == "argument" else ""
    for path in sorted(edits.paths):
        edits.check_inside(path)
    prove(names.knowledge, edits, {}, {old: new} if old else {})


def _list_related(names: Names, word: Word) -> list[Word]:
    """Return all names that mean the same, also where one use has several definitions."""
    found: dict[tuple[str, int], Word] = {}
    todo = [word]
    while todo:
        for one in names.find_references(todo.pop()):
            key = make_path(one.element.file.path), one.start
            if key in found:
                continue
            found[key] = one
            todo += [
                other
                for other in names.find_definitions(one)
                if (make_path(other.element.file.path), other.start) not in found
            ]
    return list(found.values())


def _check_free(names: Names, definition: Word, new: str) -> None:
    taken = names.scopes.list_definitions(definition.kind, new)
    if definition.kind == "name":
        here = get_scope(definition)
        taken = [one for one in taken if get_scope(one) in (None, here)]
    if taken:
        raise RefusedRename(f"'{new}' is defined already", at=_locate(taken[0]))


def _check_not_computed(names: Names, definitions: list[Word]) -> None:
    """Check that no call of a macro computes its name.

    Raises:
        RefusedRename: One does.
    """
    for call in names.list_computed_calls(definitions):
        raise RefusedRename("the name of the macro is computed here", at=_locate(call))


def _get_last(name: str) -> str:
    return name.rpartition(".")[2]


def _locate(word: Word) -> Place:
    return Place(word.element.file, word.start, word.end)

"""Rules on definitions without effect, or with an ambiguous one."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...source.comments import remove_comments
from ...source.description import Description
from ...source.document import Element
from ...source.xacro_names import CONDITIONS
from ..fix import FixContext, Proposal, remove_element, set_attribute, set_text, unsafe
from ..renaming import find_joint_references, find_link_references
from ..rule import INFO, UNSAFE, WARNING, Problem, rule
from .definitions import Definitions, get_definitions, get_names


def _is_conditional(element: Element) -> bool:
    """Tell whether an element is inside a condition or a macro."""
    parent = element.parent
    while parent is not None:
        if parent.tag in (*CONDITIONS, "xacro:macro"):
            return True
        parent = parent.parent
    return False


def _has_varying_includes(description: Description) -> bool:
    """Tell whether other arguments could include other files."""
    return any(
        element.tag == "xacro:include"
        and (_is_conditional(element) or "$(arg" in (element.get("filename") or ""))
        for document in get_definitions(description).documents
        for element in document.root.walk()
    )


def _join_texts(description: Description) -> str:
    """Get the text of all files, without comments."""
    text = "\n".join(file.data.decode(file.encoding, "replace") for file in description.files)
    return remove_comments(text)


@rule(
    WARNING,
    effects={
        "xacro": "accepts the argument, without any effect",
    },
    pedantic="files with the ending .urdf, in which xacro left it",
)
def unused_arg(description: Description) -> Iterator[Problem]:
    """An argument is declared but never used.

    ``name:=value`` on the command line has no effect, without a message. The ``$(arg NAME)`` that
    should use it is misspelled, or was removed. In a ``.urdf``, it is left over.
    """
    if description.expansion is None:
        return
    entry = description.files[0]
    declared = [
        name for kind, name in get_names(description, entry) if kind == "arg" and "$" not in name
    ]
    text = _join_texts(description) if declared else ""
    unread = [name for name in dict.fromkeys(declared) if not _is_read(name, text)]
    if not unread or _has_varying_includes(description):
        return
    arguments = get_definitions(description).arguments
    for name in unread:
        element = next((e for e in arguments.get(name, ()) if e.file.path == entry.path), None)
        if element is None:
            continue
        yield Problem(
            element,
            f"argument '{name}' is never used; write $(arg {name}), or remove it",
            at=element.locate_attribute("name"),
            pedantic=entry.path.endswith(".urdf"),
        )


def _is_read(name: str, text: str) -> bool:
    """Tell whether an argument is used."""
    word = re.escape(name)
    pattern = rf"\$\(arg\s+{word}\s*\)|arg\(\s*['\"]{word}['\"]|\$\(eval[^)]*\b{word}\b"
    return re.search(pattern, text) is not None


@rule(
    INFO,
    default=False,
    effects={
        "xacro": "accepts it without a message",
    },
)
def unused_property(description: Description) -> Iterator[Problem]:
    """A property is defined but never used.

    It is left over, or its use is misspelled.
    """
    if description.expansion is None or _has_varying_includes(description):
        return
    entry = description.files[0].path
    expressions = " ".join(
        re.findall(r"\$\{[^}]*\}|macro=\"[^\"]*\"|\^\|?\w*", _join_texts(description))
    )
    for name, elements in get_definitions(description).properties.items():
        element = elements[0]
        if element.file.path != entry or "$" in name or element.children:
            continue
        if not re.search(rf"\b{re.escape(name)}\b", expressions):
            yield Problem(
                element,
                f"property '{name}' is never used; remove it",
                at=element.locate_attribute("name"),
            )


@rule(
    INFO,
    default=False,
    effects={
        "xacro": "accepts it without a message",
    },
)
def unused_macro(description: Description) -> Iterator[Problem]:
    """A macro in the file of the robot is never called.

    Macros of included files are not checked, because a robot rarely needs a whole library.
    """
    if description.expansion is None or _has_varying_includes(description):
        return
    entry = description.files[0].path
    text = None
    for name, elements in get_definitions(description).macros.items():
        element = elements[0]
        if element.file.path != entry:
            continue
        text = text or _join_texts(description)
        if not re.search(rf"<xacro:{re.escape(name)}[\s/>]|macro\s*=\s*[\"'][^\"']*{name}", text):
            yield Problem(
                element,
                f"macro '{name}' is never called; remove it",
                at=element.locate_attribute("name"),
            )


@unused_arg.fix(UNSAFE)
@unused_property.fix(UNSAFE)
@unused_macro.fix(UNSAFE)
def remove_definition(problem: Problem, context: FixContext) -> Proposal | None:
    """Remove the definition."""
    return unsafe("remove it", remove_element(problem.element))


@rule(
    WARNING,
    effects={
        "xacro": "takes the last one, without a message",
    },
)
def macro_redefined(description: Description) -> Iterator[Problem]:
    """Two macros have the same name.

    The second definition replaces the first for all calls that follow. If two packages define
    ``cylinder_inertia`` with different parameters or formulas, the robot depends on the order of
    includes. Definitions in a condition, or in a file included with ``ns``, are not reported,
    neither are files of which an include chooses one, by a condition or by an expression in its
    ``filename``: their macros have one name on purpose.
    """
    names = [
        name
        for file in description.files
        for kind, name in get_names(description, file)
        if kind == "macro"
    ]
    if len(names) == len(set(names)):
        return
    found = get_definitions(description)
    if any(
        element.tag == "xacro:include" and "ns" in element.attributes
        for document in found.documents
        for element in document.root.walk()
    ):
        return
    for name, elements in found.macros.items():
        certain = [
            element
            for element in elements
            if not _is_conditional(element) and not _is_chosen(element.file.path, found)
        ]
        for element in certain[1:]:
            if _is_equal(element, certain[0]):
                continue
            other = certain[0].place
            where = f"line {other.line}"
            if other.path != element.file.path:
                where += f" of {other.path}"
            yield Problem(
                element,
                f"macro '{name}' has a second, different definition (first in {where}); "
                "rename one of them",
                at=element.locate_attribute("name"),
            )


def _is_chosen(path: str, found: Definitions) -> bool:
    """Tell whether an include with a condition or a computed name may bring a file."""
    includes = (
        element
        for document in found.documents
        for element in document.root.walk()
        if element.tag == "xacro:include"
    )
    return any(_may_choose(element, path) for element in includes)


def _may_choose(include: Element, path: str) -> bool:
    """Tell whether an include is not always made, or not always of this file, but may be of it."""
    inside = re.sub(r"\$\(find\s[^)]*\)", "", include.get("filename") or "")
    if "$" not in inside and not _is_conditional(include):
        return False
    parts = re.split(r"\$\{[^}]*\}|\$\([^)]*\)", inside.lstrip("./"))
    return re.search(".*".join(map(re.escape, parts)) + "$", path) is not None


def _is_equal(a: Element, b: Element) -> bool:
    """Tell whether two elements are equal."""
    return (
        a.tag == b.tag
        and a.attributes == b.attributes
        and a.text.split() == b.text.split()
        and len(a.children) == len(b.children)
        and all(_is_equal(c, d) for c, d in zip(a.children, b.children, strict=True))
    )


@rule(
    INFO,
    default=False,
    effects={
        "xacro": "writes the same name at each call",
    },
)
def hard_coded_name_in_macro(description: Description) -> Iterator[Problem]:
    """A macro with a prefix parameter creates a link or joint without it.

    If the macro is called twice, two links or joints have the same name, and readers reject the
    robot.
    """
    for macros in get_definitions(description).macros.values():
        for macro in macros:
            parameters = re.findall(
                r"(\w*prefix\w*|\bside\b|\bnamespace\b)", macro.get("params") or ""
            )
            if not parameters:
                continue
            for element in macro.walk():
                name = element.get("name")
                if element.tag in ("link", "joint") and name and "${" not in name:
                    yield Problem(
                        element,
                        f"<{element.tag} name=\"{name}\"> in macro '{macro.get('name')}' does "
                        "not use "
                        f"'{parameters[0]}'; write ${{{parameters[0]}}}{name}",
                        at=element.locate_attribute("name"),
                        data={"write": f"${{{parameters[0]}}}{name}"},
                    )


@hard_coded_name_in_macro.fix(UNSAFE)
def add_macro_prefix(problem: Problem, context: FixContext) -> Proposal | None:
    """Add the prefix to the name and its references in the macro."""
    macro: Element | None = problem.element
    while macro is not None and macro.tag != "xacro:macro":
        macro = macro.parent
    name, new = problem.element.get("name") or "", problem.data["write"]
    if macro is None:
        return None
    named = find_link_references if problem.element.tag == "link" else find_joint_references
    changes = [
        set_attribute(e, at, new) if at else set_text(e, new) for e, at in named(macro, name)
    ]
    return unsafe(f"write {new} in the macro, for the name and its references", *changes)

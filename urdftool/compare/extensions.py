"""Differences of blocks for simulators and controllers, by the path of their elements."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping

from ..model.elements import Robot
from ..model.mechanism import NativeElement
from ..model.read import number
from ..model.urdf_schema import BLOCKS, VOCABULARY
from ..source.document import Element
from .difference import Difference, describe_change, describe_presence
from .rows import BLOCKS as ROW
from .tolerance import close

Content = Element | NativeElement
Flat = dict[str, tuple[str, Content]]
_NAMING = ("name", "reference", "filename", "type")


def compare_extensions(
    a: Robot, b: Robot, tolerance: float, renamed: Mapping[str, str]
) -> Iterator[Difference]:
    """Yield differences of blocks, then of other elements that are not compared by values."""
    for tag in list_block_tags(a, b):
        one = _collect_blocks(a, tag, renamed)
        two = _collect_blocks(b, tag, {})
        for name in dict.fromkeys((*one, *two)):
            yield from _compare_blocks(tag, name, one.get(name), two.get(name), tolerance, renamed)
    for kind in ("link", "joint"):
        before, after = (_flatten_others(*x, kind) for x in ((a, renamed), (b, {})))
        for name in (name for name in before if name in after):
            yield from _compare_flat(ROW, kind, name, before[name], after[name], tolerance, renamed)


def list_block_tags(*robots: Robot) -> list[str]:
    """Return the tags of blocks, then of what else is in a URDF next to links and joints."""
    roots = [robot.xml for robot in robots if robot.xml is not None]
    others = (child.tag for root in roots for child in root.children)
    return [
        tag for tag in dict.fromkeys((*BLOCKS, *others)) if tag not in VOCABULARY["robot"].children
    ]


def _flatten_others(robot: Robot, renamed: Mapping[str, str], kind: str) -> dict[str, Flat]:
    """Return what links or joints have in addition to the compared elements, by their names."""
    found: dict[str, Flat] = {}
    for element in () if robot.xml is None else robot.xml.list_children(kind):
        name = element.get("name") or ""
        flat = found.setdefault(renamed.get(name, name), {})
        _flatten_rest(element, "", flat, renamed)
    return found


def _flatten_rest(element: Element, above: str, found: Flat, renamed: Mapping[str, str]) -> None:
    """Add the attributes and elements in an element that are not compared by their values."""
    known, counts = VOCABULARY[element.tag], Counter[str]()
    for name, value in element.attributes.items():
        if name not in known.held and not name.startswith("xmlns"):
            found[f"{above}@{name}"] = " ".join(value.split()), element
    for child in element.children:
        if child.tag not in known.children:
            _flatten(child, above, found, renamed)
            continue
        counts[child.tag] += 1
        number = f"({counts[child.tag]})" if counts[child.tag] > 1 else ""
        _flatten_rest(child, f"{above}{child.tag}{number}/", found, renamed)


def _collect_blocks(robot: Robot, tag: str, renamed: Mapping[str, str]) -> dict[str, list[Element]]:
    """Return blocks by their name or reference."""
    blocks: dict[str, list[Element]] = {}
    for element in () if robot.xml is None else robot.xml.list_children(tag):
        name = element.get("reference" if tag == "gazebo" else "name") or ""
        blocks.setdefault(renamed.get(name, name), []).append(element)
    return blocks


def list_tags(robot: Robot, difference: Difference, renamed: Mapping[str, str]) -> set[str]:
    """Return the tags of the elements in the blocks that only one robot has."""
    blocks = _collect_blocks(robot, difference.kind, renamed).get(difference.name, [])
    return {child.tag for block in blocks for child in block.children}


def compare_elements(
    row: str,
    kind: str,
    name: str,
    sides: tuple[Content, Content],
    tolerance: float,
    renamed: Mapping[str, str],
) -> Iterator[Difference]:
    """Yield the differences of two elements, by the path of their attributes and texts."""
    before, after = _flatten_content(sides[0], renamed), _flatten_content(sides[1], {})
    yield from _compare_flat(row, kind, name, before, after, tolerance, renamed)


def _compare_blocks(
    tag: str,
    name: str,
    one: list[Element] | None,
    two: list[Element] | None,
    tolerance: float,
    renamed: Mapping[str, str],
) -> Iterator[Difference]:
    if one is None or two is None:
        sides = None if one is None else one[0], None if two is None else two[0]
        yield describe_presence(ROW, tag, name, sides)
        return
    before, after = _flatten_elements(one, renamed), _flatten_elements(two, {})
    yield from _compare_flat(ROW, tag, name, before, after, tolerance, renamed)


def _compare_flat(
    row: str,
    tag: str,
    name: str,
    before: Flat,
    after: Flat,
    tolerance: float,
    renamed: Mapping[str, str],
) -> Iterator[Difference]:
    for path, old, new in _find_renamings(before, after):
        sides = before[f"{path}[{old}]"][1], after[f"{path}[{new}]"][1]
        yield describe_change(row, tag, name, path, (old, new), sides)
        _move(after, f"{path}[{new}]", f"{path}[{old}]")
    for path in dict.fromkeys((*before, *after)):
        (x, one), (y, two) = before.get(path, (None, None)), after.get(path, (None, None))
        if (one is None or two is None) and not (x or y):
            what = f"{path} {'added' if one is None else 'removed'}"
            yield describe_presence(row, tag, name, (one, two), what)
        elif not _is_same(x, y, tolerance, renamed):
            yield describe_change(row, tag, name, path, (x, y), (one, two))


def _find_renamings(before: Flat, after: Flat) -> Iterator[tuple[str, str, str]]:
    """Yield elements of which only the name changed: the path without it, and both names.

    One element of a tag was removed from a parent, and one element of that tag was added to it.
    """
    gone, new = (_group_by_tag(one, other) for one, other in ((before, after), (after, before)))
    for path, names in gone.items():
        if len(names) == 1 and len(new.get(path, ())) == 1:
            yield path, names[0], new[path][0]


def _group_by_tag(one: Flat, other: Flat) -> dict[str, list[str]]:
    """Return the names of elements that only one robot has, by their path without the name."""
    found: dict[str, list[str]] = {}
    for path in one:
        start, mark, end = path.rpartition("[")
        if mark and end.endswith("]") and path not in other:
            found.setdefault(start, []).append(end.removesuffix("]"))
    return found


def _move(flat: Flat, path: str, to: str) -> None:
    """Replace the path of an element and its descendants."""
    for known in [known for known in flat if known == path or known.startswith(f"{path}/")]:
        flat[to + known.removeprefix(path)] = flat.pop(known)


def _is_same(a: str | None, b: str | None, tolerance: float, renamed: Mapping[str, str]) -> bool:
    if a is None or b is None:
        return a is b
    if a == b or renamed.get(a) == b:
        return True
    one, two = list(map(number, a.split())), list(map(number, b.split()))
    return (
        len(one) == len(two)
        and None not in (*one, *two)
        and all(close(x, y, tolerance) for x, y in zip(one, two, strict=True))
    )


def _flatten_elements(elements: list[Element], renamed: Mapping[str, str]) -> Flat:
    """Return attributes and texts below some elements by path, independent of their order."""
    found: Flat = {}
    for element in elements:
        for child in element.children:
            _flatten(child, "", found, renamed)
        if not element.children and (text := " ".join(element.text.split())):
            found["text"] = text, element
        for name, value in element.attributes.items():
            if name not in ("name", "reference") and not name.startswith("xmlns"):
                found.setdefault(f"@{name}", (value, element))
    return found


def _flatten_content(element: Content, renamed: Mapping[str, str]) -> Flat:
    """Return the attributes of an element, its text, and what is below it, by path."""
    found: Flat = {f"@{name}": (value, element) for name, value in element.attributes.items()}
    if element.text.strip():
        found["text"] = " ".join(element.text.split()), element
    for child in element.children:
        _flatten(child, "", found, renamed)
    return found


def _flatten(element: Content, above: str, found: Flat, renamed: Mapping[str, str]) -> None:
    naming = next((name for name in _NAMING if element.get(name)), "")
    named = element.get(naming)
    step = element.tag + (f"[{renamed.get(named, named)}]" if named else "")
    path, count = above + step, 1
    while path in found:
        count += 1
        path = f"{above}{step}({count})"
    found[path] = " ".join(element.text.split()), element
    for name, value in element.attributes.items():
        if name != naming and not name.startswith("xmlns"):
            found[f"{path}/@{name}"] = " ".join(value.split()), element
    for child in element.children:
        _flatten(child, f"{path}/", found, renamed)

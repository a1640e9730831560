"""Default classes of an MJCF: the attributes that an element has with those of its class."""

from __future__ import annotations

from ...source.document import Element

_MAIN = ""


class Defaults:
    """Attributes by class and tag."""

    def __init__(self, root: Element) -> None:
        """Read the classes of a model."""
        self.root = root
        self._found: dict[str, dict[str, dict[str, str]]] = {_MAIN: {}}
        for child in root.children:
            if child.tag == "default":
                self._add(child, _MAIN, _MAIN)

    def _add(self, element: Element, name: str, parent: str) -> None:
        own = self._found[name] = {t: dict(a) for t, a in self._found[parent].items()}
        for child in element.children:
            if child.tag != "default":
                own.setdefault(child.tag, {}).update(child.attributes)
        for child in element.children:
            if child.tag == "default":
                self._add(child, child.get("class") or _MAIN, name)

    def resolve(self, element: Element) -> dict[str, str]:
        """Return the attributes of an element, with those of its class or its body's."""
        given = self._found.get(self._find_class(element), self._found[_MAIN])
        return given.get(element.tag, {}) | element.attributes

    def _find_class(self, element: Element) -> str:
        own, body = element.get("class"), element.parent
        while own is None and body is not None:
            own, body = body.get("childclass"), body.parent
        return own or _MAIN

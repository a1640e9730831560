"""URDF text of a bundle: the description with new URIs and without xacro."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from .. import __version__
from ..errors import ModelError
from ..model.elements import Robot
from ..source.description import Description
from ..source.document import Element
from ..source.edit import Edit, Source, apply, parse_source, remove_element, set_attribute
from ..source.escape import escape
from ..source.expansion import write_xml
from ..source.location import SourceFile
from .source_folders import replace_folders

_VERSION = re.compile(rb"""\A(<\?xml\s+version\s*=\s*)("[^"]*"|'[^']*')""")
_ENCODING = re.compile(rb"""(<\?xml[^>]*?)\s+encoding\s*=\s*("[^"]*"|'[^']*')""")


NO_FOLDERS: Mapping[str, str] = {}


def make_urdf(robot: Robot, name: str) -> SourceFile:
    """Return the description as plain URDF in UTF-8; xacro is expanded.

    Raises:
        ModelError: The robot was read from another format.
    """
    if robot.source is None or robot.xml is None:
        raise ModelError("the robot was not read from URDF or xacro")
    return expand_description(robot.source, name)


def expand_description(description: Description, name: str) -> SourceFile:
    """Return a description as plain XML in UTF-8; xacro is expanded."""
    if description.expansion is not None:
        text = write_xml(description.expansion.tree, [])
        return SourceFile(name, text.encode())
    file = description.document.file
    if file.encoding.replace("-", "").lower() in ("utf8", "ascii", "usascii"):
        data = file.data.removeprefix(b"\xef\xbb\xbf")
    else:
        data = _ENCODING.sub(rb"\1", file.data.decode(file.encoding).encode(), count=1)
    return SourceFile(name, replace_version(data))


def replace_version(data: bytes) -> bytes:
    """Return an XML file whose declaration has version 1.0; browsers reject others, such as 0.0."""
    return _VERSION.sub(rb'\1"1.0"', data, count=1)


def rewrite(
    file: SourceFile,
    uris: Mapping[str, str],
    missing: set[str],
    *,
    visual_uris: Mapping[str, str] | None = None,
    comment: str = "",
    strippath: bool = False,
    folders: Mapping[str, str] = NO_FOLDERS,
) -> bytes:
    """Return a description with new URIs.

    Args:
        file: Plain URDF.
        uris: New URIs of files by those written.
        visual_uris: URIs in visuals, where they differ; None for none.
        missing: URIs of meshes and textures whose elements are removed.
        comment: Text of a comment before the root element; empty for none.
        strippath: Whether to set the option with which MuJoCo before version 4 keeps the folders
            of mesh paths.
        folders: URIs of folders of this machine, which no value of the result contains.
    """
    source = parse_source(file)
    root = source.document.root
    edits = []
    if comment:
        edits.append(Edit(root.start, root.start, f"<!-- {comment} -->\n".encode()))
    removed = {id(element) for element in _find_missing_parts(root, missing)}
    for element in root.walk():
        if any(id(above) in removed for above in _list_ancestors(element)):
            continue
        if id(element) in removed:
            edits.append(_remove(source, element))
            continue
        for name, value in element.attributes.items():
            uri = value.strip()
            if uri in uris and _may_be_file(element, name):
                new = uris[uri]
                if visual_uris and uri in visual_uris and _is_visual(element):
                    new = visual_uris[uri]
                edits.append(set_attribute(source, element, name, new))
            elif (plain := replace_folders(value, folders)) != value:
                edits.append(set_attribute(source, element, name, plain))
        if not element.children and (text := element.text.strip()):
            new = uris.get(text) or replace_folders(text, folders)
            if new != text:
                edits.append(_set_text(source, element, new))
    if strippath:
        edits += _keep_paths(source, root)
    return apply(file, edits)


def format_comment(name: str) -> str:
    """Return the comment of a bundled description."""
    plain = re.sub(r"-{2,}|[<>:]", "_", name)
    return f"Bundled by urdftool {__version__} from {plain}. The file bundle.json lists the sources"


def _may_be_file(element: Element, attribute: str) -> bool:
    """Tell whether an attribute may name a file: in a mesh, a texture, or a ``<gazebo>`` block."""
    if element.tag in ("mesh", "texture"):
        return attribute == "filename"
    return any(above.tag == "gazebo" for above in (element, *_list_ancestors(element)))


def _is_visual(element: Element) -> bool:
    """Tell whether an element is in a visual or, as the visuals that plugins name, no collision."""
    return all(above.tag != "collision" for above in _list_ancestors(element))


def _list_ancestors(element: Element) -> Iterator[Element]:
    parent = element.parent
    while parent is not None:
        yield parent
        parent = parent.parent


def _find_missing_parts(root: Element, missing: set[str]) -> Iterator[Element]:
    """Yield the visuals, collisions and textures that refer to missing files."""
    for element in root.walk():
        if (element.get("filename") or "").strip() not in missing:
            continue
        if element.tag == "texture":
            yield element
        elif element.tag == "mesh":
            for above in _list_ancestors(element):
                if above.tag in ("visual", "collision"):
                    yield above
                    break


def _remove(source: Source, element: Element) -> Edit:
    """Return the edit that removes an element; the only content of a material becomes white.

    Drake rejects a material that has neither a color nor a texture.
    """
    material = element.parent
    if element.tag != "texture" or material is None or material.find_child("color") is not None:
        return remove_element(source, element)
    return Edit(element.start, element.end, b'<color rgba="1 1 1 1"/>')


def _set_text(source: Source, element: Element, text: str) -> Edit:
    """Return the edit that replaces the text of an element without children."""
    data = source.file.data
    start = source.file.find_tag_end(element.start)
    end = data.rfind(b"</", start, element.end)
    return Edit(start, end, escape(text).encode())


def _keep_paths(source: Source, root: Element) -> list[Edit]:
    """Return the edits after which MuJoCo uses mesh paths as they are written."""
    for block in root.list_children("mujoco"):
        compiler = block.find_child("compiler")
        if compiler is not None:
            edits = [set_attribute(source, compiler, "strippath", "false")]
            for name in ("meshdir", "assetdir"):
                if name in compiler.attributes:
                    edits.append(set_attribute(source, compiler, name, "."))
            return edits
    at = source.file.find_tag_end(root.start)
    if source.file.data[at - 2 : at] == b"/>":
        return []
    line = source.line_end + source.step
    text = b'<mujoco><compiler strippath="false"/></mujoco>'
    return [Edit(at, at, line + text)]

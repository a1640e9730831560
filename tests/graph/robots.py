"""Robots that the tests of graphs are made of."""

from itertools import pairwise
from xml.sax.saxutils import quoteattr

from urdftool.model.load import make_robot
from urdftool.source.description import Description
from urdftool.source.document import parse
from urdftool.source.location import SourceFile
from urdftool.source.packages import Packages

HOSTILE = [
    'a "q" b',
    "back\\slash\\N \\l \\n",
    "tail\\",
    "<b>html</b>",
    "&amp; &lt; a&b;",
    "日本 é",
    "$(touch pwned) `id`; rm -rf *",
    "new\nline\ttab",
    "\u202eevil",
    "%s {x}",
    '#35; "] --> n1',
    "end",
    "it's",
    "|pipe|",
    "javascript:alert(1)",
    "</text></svg>",
    ">x",
    "-->",
]


def robot(text, path="r.urdf"):
    file = SourceFile(path, text.encode("utf-8"))
    return make_robot(Description(path, parse(file), [file], Packages()))


def attribute(text):
    return quoteattr(text, {"\n": "&#10;", "\t": "&#9;"})


def tree_text(names, joints, name="r"):
    """A robot of named links, and ``(joint, parent, child)`` fixed joints, a line each."""
    lines = [f"<robot name={attribute(name)}>"]
    lines += [f"<link name={attribute(link)}/>" for link in names]
    lines += [
        f'<joint name={attribute(joint)} type="fixed">'
        f"<parent link={attribute(parent)}/><child link={attribute(child)}/></joint>"
        for joint, parent, child in joints
    ]
    return "\n".join([*lines, "</robot>\n"])


def tree(names, joints, name="r"):
    return robot(tree_text(names, joints, name))


def hostile_text(names):
    """A chain of links, its joints called as they are."""
    joints = [(f"j {b}", a, b) for a, b in pairwise(names)]
    return tree_text(names, joints, 'we "$(touch pwned)" /../x')

"""Small robots for the tests, and their export as a tree."""

from lxml import etree

from urdftool.formats.sdf.options import Options
from urdftool.formats.sdf.write import write
from urdftool.model.load import make_robot
from urdftool.source.description import Description
from urdftool.source.document import parse
from urdftool.source.location import SourceFile
from urdftool.source.packages import Packages

BOX = '<geometry><box size="1 2 3"/></geometry>'
CUBE = '<collision><geometry><box size="1 1 1"/></geometry></collision>'


def inertial(mass=1.0, moments=(0.1, 0.1, 0.1), products=(0, 0, 0), xyz="0 0 0", rpy="0 0 0"):
    (xx, yy, zz), (xy, xz, yz) = moments, products
    return (
        f'<inertial><origin xyz="{xyz}" rpy="{rpy}"/><mass value="{mass}"/><inertia ixx="{xx}" '
        f'ixy="{xy}" ixz="{xz}" iyy="{yy}" iyz="{yz}" izz="{zz}"/></inertial>'
    )


def link(name, inside=None):
    return f'<link name="{name}">{inertial() if inside is None else inside}</link>'


def joint(name, parent, child, kind="revolute", inside=None, origin="0 0 0"):
    if inside is None:
        inside = '<limit lower="-1" upper="1" effort="3" velocity="4"/>'
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{origin}"/>{inside if kind != "fixed" else ""}</joint>'
    )


def gazebo(reference, inside):
    return f'<gazebo reference="{reference}">{inside}</gazebo>'


def robot(*parts, name="r"):
    """A robot of text."""
    text = f'<robot name="{name}">' + "\n".join(parts) + "</robot>\n"
    file = SourceFile("r.urdf", text.encode())
    return make_robot(Description("r.urdf", parse(file), [file], Packages(None)))


def export(*parts, **choices):
    """The export of a robot of text."""
    return write(robot(*parts), Options(**choices))


def tree(written):
    """The model of an export as an element."""
    root = etree.fromstring(written.files[written.main])
    return root.find("model") if root.find("model") is not None else root.find("world/model")


def named(model, tag, name):
    """The element of a name."""
    return next(e for e in model.iter(tag) if e.get("name") == name)


def names(model, tag):
    """The names of the model's own elements of a kind."""
    return [e.get("name") for e in model.findall(tag)]


def rules(written):
    """The names of the losses."""
    return [loss.code for loss in written.losses]


TWO = (link("a"), joint("j", "a", "b"), link("b"))
WELDED = (link("a"), joint("j", "a", "b", "fixed"), link("b"))

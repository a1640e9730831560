"""Small robots for the tests, and their export as a tree."""

from lxml import etree

from urdftool.formats.mjcf.options import Options
from urdftool.formats.mjcf.write import write
from urdftool.model.load import load

INERTIAL = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>'
)
BOX = '<geometry><box size="1 2 3"/></geometry>'


def robot(*parts, name="r"):
    return f'<robot name="{name}">' + "\n".join(parts) + "</robot>\n"


def link(name, inside=INERTIAL):
    return f'<link name="{name}">{inside}</link>'


def joint(name, parent, child, kind="revolute", inside='<limit lower="-1" upper="1"/>'):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f"{inside}</joint>"
    )


def export(path, **choices):
    """The export of a file."""
    return write(load(path), Options(**choices))


def tree(written):
    """The model of an export as elements."""
    return etree.fromstring(written.files[written.main])


def find(model, tag, name):
    """The element of a name."""
    return next(e for e in model.iter(tag) if e.get("name") == name)


def rules(written):
    """The names of the losses."""
    return [loss.code for loss in written.losses]

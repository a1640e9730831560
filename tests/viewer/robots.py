"""Robots for the tests, as text."""

from urdftool.model.load import load

BOX = '<visual><geometry><box size="{} {} {}"/></geometry></visual>'


SMALL = BOX.format(0.1, 0.1, 0.2)


def urdf(*parts, name="r"):
    return f'<robot name="{name}">\n' + "\n".join(parts) + "\n</robot>\n"


def link(name, inside=SMALL):
    return f'<link name="{name}">{inside}</link>'


def joint(name, kind, parent, child, inside="", xyz="0 0 0.2"):
    return (
        f'<joint name="{name}" type="{kind}"><origin xyz="{xyz}"/><parent link="{parent}"/>'
        f'<child link="{child}"/>{inside}</joint>'
    )


def limit(lower, upper):
    return f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>'


ARM = urdf(
    link("base"),
    link("upper"),
    link("lower"),
    link("finger"),
    link("thumb"),
    joint("shoulder", "revolute", "base", "upper", '<axis xyz="0 1 0"/>' + limit(-1.5, 1.25)),
    joint("elbow", "continuous", "upper", "lower", '<axis xyz="0 0 1"/>'),
    joint("grip", "prismatic", "lower", "finger", '<axis xyz="0 1 0"/>' + limit(0, 0.04)),
    joint(
        *("grip_mirror", "prismatic", "lower", "thumb"),
        '<axis xyz="0 1 0"/>' + limit(0, 0.04) + '<mimic joint="grip" multiplier="-1"/>',
    ),
    name="arm",
)


def chain(count):
    links = [link(f"l{number}") for number in range(count + 1)]
    joints = [
        joint(f"j{n}", "revolute", f"l{n}", f"l{n + 1}", '<axis xyz="0 1 0"/>' + limit(-1, 1))
        for n in range(count)
    ]
    return urdf(*links, *joints, name="chain")


def read(path, text):
    path.write_text(text, "utf-8")
    return load(path)

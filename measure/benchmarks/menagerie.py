"""Models of ``export mjcf`` beside those of MuJoCo Menagerie of the same robots, point by point.

``python -m measure.benchmarks.menagerie [--write]`` exports the five robots of ``menagerie.yaml``,
compiles the models, and prints the table of docs/formats/mjcf.md, or writes it there. Menagerie's
column is what was read in its files at the commits given; nothing is downloaded.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

import yaml
from lxml import etree

from .robots import ROOT, bullet_robots, example_robots

FACTS = Path(__file__).with_suffix(".yaml")
PAGE = ROOT / "docs" / "formats" / "mjcf.md"
BEGIN, END = "<!-- menagerie begins -->", "<!-- menagerie ends -->"
_OF_FILE = ("file", "commit", "robot", "options")


def main() -> int:
    """Print the table, or write it into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="Write it into docs/formats/mjcf.md.")
    text = tables()
    if not parser.parse_args().write:
        print(text)
        return 0
    page = PAGE.read_text("utf-8")
    before, _, rest = page.partition(BEGIN)
    PAGE.write_text(f"{before}{BEGIN}\n\n{text}\n{END}{rest.partition(END)[2]}", "utf-8")
    return 0


def tables() -> str:
    """Export and compile the robots, and write a table of each."""
    facts = yaml.safe_load(FACTS.read_text("utf-8"))
    there = [*example_robots(), *bullet_robots()]
    parts = []
    for name, theirs in facts.items():
        path = next(one for one in there if one.as_posix().endswith("/" + theirs["robot"]))
        with tempfile.TemporaryDirectory() as folder:
            ours = exported(path, theirs["options"], Path(folder) / "model.xml")
        options = " ".join(theirs["options"])
        parts += [
            f"`{name}`: {theirs['file']} at {theirs['commit']}, and "
            f"`urdftool export mjcf {path.name} {options}`:",
            "",
            "| | Menagerie | exported |",
            "|---|---|---|",
        ]
        points = {key: value for key, value in theirs.items() if key not in _OF_FILE}
        parts += [f"| {key} | {value} | {ours[key]} |" for key, value in points.items()]
        parts.append("")
    return "\n".join(parts)


def exported(path: Path, options: list[str], out: Path) -> dict[str, Any]:
    """Export a robot and describe the compiled model in the terms of the facts."""
    command = [sys.executable, "-m", "urdftool", "export", "mjcf", str(path), "-o", str(out)]
    subprocess.run([*command, *options], check=True, capture_output=True)
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(out))
    tree = etree.parse(str(out))
    kinds = mujoco.mjtGeom
    free = [j for j in range(model.njnt) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE]
    moving = [j for j in range(model.njnt) if j not in free]
    touching = [g for g in range(model.ngeom) if model.geom_contype[g] or model.geom_conaffinity[g]]
    shapes = Counter(kinds(model.geom_type[g]).name[7:].lower() for g in touching)
    key = next((k for k in range(model.nkey) if model.key(k).name == "home"), None)
    dofs = [model.jnt_dofadr[j] for j in moving]
    words = Counter(one.tag for one in tree.findall("actuator/*"))
    gains = sorted({round(float(one), 3) for one in model.actuator_gainprm[:, 0]}, reverse=True)
    home = [] if key is None else [float(model.key_qpos[key][model.jnt_qposadr[j]]) for j in moving]
    classes = [one.get("class") for one in tree.iter("default") if one.get("class")]
    return {
        "base": "free" if free else "fixed",
        "height at home [m]": f"{model.key_qpos[key][2]:.3g}" if free and key is not None else 0,
        "bodies": model.nbody - 1,
        "joints": len(moving),
        "mass [kg]": f"{model.body_subtreemass[0]:.5g}",
        "actuators": ", ".join(f"{count} {word}" for word, count in words.items()) or 0,
        "gains": _several(gains) if words else "none",
        "damping, armature, friction loss": ", ".join(
            _several(sorted({round(float(values[d]), 4) for d in dofs}))
            for values in (model.dof_damping, model.dof_armature, model.dof_frictionloss)
        ),
        "collision geoms": f"{len(touching)}: "
        + ", ".join(f"{count} {shape}" for shape, count in shapes.most_common()),
        "classes": ", ".join(classes[1:]),
        "contact excludes": model.nexclude,
        "sensors": model.nsensor,
        "home": "none" if key is None else " ".join(f"{value:.3g}" for value in home),
    }


def _several(values: list[float], most: int = 4) -> str:
    """Write some numbers, and of many the first and the last."""
    texts = [f"{value:g}" for value in values]
    return "/".join(texts) if len(texts) <= most else f"{texts[0]} … {texts[-1]}"


if __name__ == "__main__":
    sys.exit(main())

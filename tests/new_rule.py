"""Add the frame of a rule: ``python -m tests.new_rule NAME FAMILY/FILE``, or ``make rule``.

It appends a function that finds nothing to ``urdftool/rules/FAMILY/FILE.py``, and writes
``fixtures/rules/NAME/good.urdf`` and ``bad.urdf``. ``make check-rule`` fails until the function
reports the marked line of ``bad.urdf``.
"""

import re
import sys
from pathlib import Path

import urdftool.rules
from urdftool.rules import FAMILIES, FAMILY_OF

RULES = Path(urdftool.rules.__file__).parent
FIXTURES = RULES.parents[1] / "fixtures" / "rules"

FUNCTION = '''

@rule(WARNING)
def {function}(robot: Robot) -> Iterator[Problem]:
    """State the fact about the robot in one sentence.

    Describe what readers do with it, and what to write instead.
    """
    for joint in robot.joints:
        if False:  # the defect, by values of model/elements.py
            yield Problem(joint, f"joint '{{joint.name}}' has the defect; write the remedy")
'''

LINK = """  <link name="{name}">
    <inertial>
      <origin xyz="0 0 0.2"/>
      <mass value="1"/>
      <inertia ixx="0.0134" ixy="0" ixz="0" iyy="0.0134" iyz="0" izz="0.0002"/>
    </inertial>
    <visual>
      <origin xyz="0 0 0.2"/>
      <geometry>
        <cylinder radius="0.02" length="0.4"/>
      </geometry>
    </visual>
    <collision>
      <origin xyz="0 0 0.2"/>
      <geometry>
        <cylinder radius="0.02" length="0.4"/>
      </geometry>
    </collision>
  </link>
"""

ROBOT = f"""<?xml version="1.0"?>
<robot name="pendulum">
  <link name="base"/>
{LINK.format(name="arm")}  <joint name="swing" type="continuous">{{mark}}
    <parent link="base"/>
    <child link="arm"/>
    <axis xyz="0 1 0"/>
    <dynamics damping="0.1"/>
  </joint>
</robot>
"""


def explain_refusal(name: str, file: str) -> str:
    """Return why a rule cannot be added; empty if it can."""
    if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)+", name):
        return f"'{name}' is not a name of a rule: words in lower case with hyphens"
    if name in FAMILY_OF or (FIXTURES / name).exists():
        return f"rule '{name}' exists"
    if not (RULES / f"{file}.py").is_file() or file.partition("/")[0] not in FAMILIES:
        return f"urdftool/rules/{file}.py does not exist; write FAMILY/FILE, such as joint/drive"
    return ""


def add(name: str, file: str) -> list[Path]:
    """Add the frame of a rule, and return the changed files."""
    module = RULES / f"{file}.py"
    text = module.read_text("utf-8").rstrip("\n") + "\n"
    module.write_text(text + FUNCTION.format(function=name.replace("-", "_")), "utf-8")
    folder = FIXTURES / name
    folder.mkdir()
    written = [module]
    for stem, mark in (("good", ""), ("bad", f" <!-- {name} -->")):
        written.append(folder / f"{stem}.urdf")
        written[-1].write_text(ROBOT.format(mark=mark), "utf-8")
    return written


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: make rule NAME=heavy-damping FILE=joint/drive")
    if reason := explain_refusal(*sys.argv[1:]):
        sys.exit(reason)
    for path in add(*sys.argv[1:]):
        print(f"wrote {path.relative_to(RULES.parents[1])}")
    print(f"next: write the function and {sys.argv[1]}/bad.urdf, then make check-rule NAME=…")

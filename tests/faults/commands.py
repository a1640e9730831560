"""Faults at each event of the commands that write: ``python -m tests.faults.commands NAME…``.

Each command replaces outputs of an earlier run. After each fault the inputs are as they were, and
the outputs are the old or the new ones; after a kill at the latest when the command is repeated.
"""

import importlib
import io
import json
import os
import re
import shutil
import sys
import tempfile
from contextlib import redirect_stderr, redirect_stdout, suppress
from pathlib import Path

from tests.faults.injection import KINDS, Events, run_forked
from tests.hostile.writers import ROBOT, robot

COMMANDS = {
    "bundle": "bundle r.xacro -o out",
    "bundle-zip": "bundle r.xacro -o out.zip",
    "sdf": "export sdf r.xacro --force -o out",
    "mjcf": "export mjcf r.xacro --force --scene -o out",
    "usd": "export usd r.xacro --force -o out",
    "urdf": "export urdf r.xacro --force -o out/a.urdf",
    "mjcf-file": "export mjcf r.xacro --force -o out/a.xml",
    "collision": "collision r.xacro --method hull -j 1 -o out/a.urdf",
    "collision-in-place": "collision r.urdf --method hull -j 1 --in-place",
    "fix": "lint fixed.xacro --fix --unsafe-fixes",
    "inertia": "inertia robot r.urdf --write --density 9",
}
IN_PLACE = {
    "collision-in-place": ("r.urdf", "r_collision"),
    "fix": ("fixed.xacro", "part.xacro"),
    "inertia": ("r.urdf",),
}
"""Outputs of the commands that edit their inputs; those of the others are ``out``."""

HIDDEN = re.compile(r"\.(.+)\.\d+\.(tmp|old)")
FIXED = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="part.xacro"/>
  <link name="{}"/>
  <joint name="j" type="continuous"><parent link="{}"/><child link="part"/>
    <axis xyz="0 0 2"/></joint>
</robot>
"""
PART = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="part"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="9"/></inertial></link>
  <link name="tip"/>
  <joint name="k" type="continuous"><parent link="part"/><child link="tip"/>
    <axis xyz="0 0 3"/></joint>
</robot>
"""


class Case:
    """A command, a project before it, and the same project after it."""

    def __init__(self, name, root):
        """Run the command twice on different robots."""
        self.words = COMMANDS[name].split()
        self.outputs = IN_PLACE.get(name, ("out", "out.zip"))
        self.root = Path(os.path.realpath(root))
        self.template, self.place = self.root / "template", self.root / "case"
        project = self.place / "r"
        robot(project)
        (project / ".git").mkdir()
        (project / "part.xacro").write_text(PART)
        if name not in IN_PLACE:
            self.run()
            assert self.read_outputs()
        text = ROBOT.replace('upper="1"', 'upper="2"').replace("sphere.stl", "cube.obj")
        for file in ("r.xacro", "r.urdf"):
            (project / file).write_text(text)
        (project / "fixed.xacro").write_text(FIXED.format("base", "base"))
        shutil.copytree(self.place, self.template)
        self.inputs, self.old = self.read_inputs(), self.read_outputs()
        self.run()
        if name.startswith("collision"):  # keep its results, which take long
            home = Path("home", "urdftool", "collision")
            shutil.copytree(self.place / home, self.template / home, dirs_exist_ok=True)
        self.new, self.inputs_after = self.read_outputs(), self.read_inputs()
        assert self.inputs_after == self.inputs
        assert self.new != self.old

    def run(self, kind="", number=0):
        """Run the command; return the exit code, the number of events and what it printed."""
        said = self.root / "said"
        code, count = run_forked(lambda: self._call(said), Events(self.place, kind, number))
        text = said.read_text("utf-8", "replace") if said.exists() else ""
        if not kind:
            assert code in (0, 1), text
        return code, count, text

    def _call(self, said):
        from urdftool.cli import call

        os.chdir(self.place / "r")
        os.environ.update(HOME=str(self.place / "home"), XDG_CACHE_HOME=str(self.place / "home"))
        text = io.StringIO()
        try:
            with redirect_stdout(io.TextIOWrapper(io.BytesIO())), redirect_stderr(text):
                return call(self.words)
        finally:
            said.write_text(text.getvalue())
            (self.root / "modules").write_text(json.dumps(sorted(sys.modules)))

    def reset(self):
        shutil.rmtree(self.place)
        shutil.copytree(self.template, self.place)

    def read(self):
        project = self.place / "r"
        return {
            str(path.relative_to(project)): path.read_bytes()
            for path in sorted(project.rglob("*"))
            if path.is_file()
        }

    def read_outputs(self):
        return {name: data for name, data in self.read().items() if self._is_output(name)}

    def read_inputs(self):
        return {
            name: data
            for name, data in self.read().items()
            if not self._is_output(name) and not self.is_hidden(name)
        }

    def _is_output(self, name):
        return Path(name).parts[0] in self.outputs and not self.is_hidden(name)

    @staticmethod
    def is_hidden(name):
        return any(HIDDEN.fullmatch(part) for part in Path(name).parts)

    def list_hidden(self):
        return [str(path) for path in self.place.rglob(".*") if self.is_hidden(path.name)]

    def check(self, kind, number):
        """Yield what is wrong after a fault."""
        self.reset()
        code, _, said = self.run(kind, number)
        now = self.read_outputs()
        if "Traceback" in said:
            yield f"traceback: {said[-300:]}"
        if self.read_inputs() != self.inputs:
            yield "an input has changed"
        if kind == "kill":
            if code != -9:
                yield f"exit code {code}"
            for name in self.old.keys() | self.new.keys():
                data = now.get(name)
                if data is None and name in self.old and name in self.new:
                    yield f"{name} is missing"
                elif data not in (self.old.get(name), self.new.get(name)):
                    yield f"{name} is neither old nor new"
            code, _, said = self.run()
            now = self.read_outputs()
            if now != self.new:
                yield f"the next run does not complete it ({code}): {said[-200:]}"
            if self.read_inputs() != self.inputs:
                yield "an input has changed after the next run"
        else:
            if code not in ((130,) if kind == "interrupt" else (0, 1, 2)):
                yield f"exit code {code}: {said[-200:]}"
            if now != self.new and (now != self.old or code in (0, 1)):
                yield f"neither the old nor the new outputs (exit code {code})"
        hidden = self.list_hidden()
        if kind == "kill" and self.outputs != ("out", "out.zip"):
            hidden = [path for path in hidden if path.endswith(".tmp")]  # nothing was left to write
        if hidden:
            yield f"left: {hidden}"


def run_all(name):
    """Return the number of events, of runs, and the problems of a command."""
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        case = Case(name, folder)
        for module in json.loads((case.root / "modules").read_text()):
            if module.partition(".")[0] not in ("pxr", "__main__"):
                with suppress(Exception):
                    importlib.import_module(module)
        case.reset()
        count = case.run()[1]
        problems = [
            f"{name}, {kind} at {number} of {count}: {problem}"
            for kind in KINDS
            for number in range(1, count + 1)
            for problem in case.check(kind, number)
            if problem
        ]
        return {"events": count, "runs": len(KINDS) * count, "problems": problems}


if __name__ == "__main__":
    print(json.dumps({name: run_all(name) for name in sys.argv[1:] or COMMANDS}, indent=1))

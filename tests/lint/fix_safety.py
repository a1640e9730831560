"""Whether fixes change a robot as physics engines load it."""

import hashlib
import os
import re
import struct

from tests.lint.engine_views import ENGINES, Engine, difference
from urdftool.errors import UrdftoolError
from urdftool.lint.fix_run import fix_description
from urdftool.lint.options import Options
from urdftool.lint.run import check_file
from urdftool.lint.settings import Settings
from urdftool.source.description import read_description
from urdftool.source.document import read_file
from urdftool.source.packages import Packages
from urdftool.workspace import Workspace

_FILE = re.compile(r"""filename\s*=\s*(["'])([^"']*)\1""")
_MESHES = (".stl", ".dae", ".obj", ".ply", ".gltf", ".glb")


class Bench:
    """Engines, and a folder for the files that they load."""

    def __init__(self, folder, names=ENGINES):
        """Start with no engine running."""
        self.folder = folder
        self.engines = {name: Engine(name, folder) for name in names}
        self.compared = dict.fromkeys(names, 0)

    def close(self):
        """End the engines."""
        for engine in self.engines.values():
            engine.close()

    def changes_of_fixes(self, path, rules, *, unsafe=False):
        """Apply fixes to a description; gives what was applied, and what engines see of it."""
        options = Options(Settings(select=tuple(rules)), fixes=True)
        report = check_file(path, options)
        assert report.error is None
        done = fix_description(report, options, unsafe=unsafe, meshes=True)
        if not done.after:
            return done.applied, []
        return done.applied, self.changes(path, {}, done.after)

    def changes(self, path, one, other):
        """What engines see of a description whose files have other bytes; empty for no change.

        An engine that does not load the first may load the second.
        """
        texts = [
            self._text(path, files, side, {os.path.realpath(name) for name in (*one, *other)})
            for files, side in ((one, "one"), (other, "other"))
        ]
        if texts[0] is None:
            return []
        found = []
        for name, engine in self.engines.items():
            views = []
            for side, text in zip(("one", "other"), texts, strict=True):
                file = self.folder / side / "robot.urdf"
                file.parent.mkdir(exist_ok=True)
                file.write_text(_for_mujoco(text) if name == "mujoco" else text or "", "utf-8")
                views.append(engine.view(file))
                if "error" in views[0]:
                    break
            if "error" in views[0]:
                continue
            self.compared[name] += 1
            if "collisions" in views[0]:  # which could not be loaded
                views = [_without_collisions(view) for view in views]
            what = difference(*views)
            if what:
                found.append(f"{name}{what}")
        return found

    def _text(self, path, files, side, changed):
        """A description as engines get it: expanded where it is xacro, its meshes by full path.

        Meshes that are the same on both sides are small stand-ins of their own sizes, so that
        large ones are not read again and again, and every engine reads every kind.
        """
        workspace = Workspace(files)
        file = read_file(path, workspace)
        packages = Packages(path, workspace=workspace)
        text = file.data.decode(file.encoding, "replace")
        if str(path).endswith(".xacro") or b"<xacro:" in file.data:
            try:
                description = read_description(path, file=file, workspace=workspace)
            except UrdftoolError:
                return None
            packages = description.packages
            if description.expansion is not None:
                text = description.expansion.text

        def here(match):
            if not match[2].strip().lower().endswith(_MESHES):
                return match[0]
            try:
                mesh = packages.resolve(match[2])
                data = workspace.read_bytes(mesh)
            except (UrdftoolError, OSError):
                return match[0]
            if os.path.realpath(mesh) in changed:
                name = f"{hashlib.sha256(str(mesh).encode()).hexdigest()[:16]}{mesh.suffix}"
                copy = self.folder / side / name
            else:
                digest = hashlib.sha256(data).digest()
                copy, data = self.folder / f"{digest.hex()[:16]}.stl", _stand_in(digest)
            copy.parent.mkdir(exist_ok=True)
            copy.write_bytes(data)
            return f'filename="{copy}"'

        return _FILE.sub(here, text)


def _stand_in(digest):
    """A tetrahedron as binary STL, whose size tells one file from another."""
    x, y, z = (0.01 + byte / 2000 for byte in digest[:3])
    corners = [(0, 0, 0), (x, 0, 0), (0, y, 0), (0, 0, z)]
    rows = [
        struct.pack("<12fH", 0, 0, 0, *(v for i in face for v in corners[i]), 0)
        for face in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
    ]
    return b"\0" * 80 + struct.pack("<I", len(rows)) + b"".join(rows)


def _for_mujoco(text):
    """The same with paths that MuJoCo does not cut down to the names of the files."""
    if text is None or "</robot>" not in text:
        return text or ""
    text = re.sub(r"""\s(strippath|meshdir)\s*=\s*(["'])[^"']*\2""", "", text)
    if "<compiler" in text:
        return text.replace("<compiler", '<compiler strippath="false"', 1)
    at = text.rindex("</robot>")
    return f'{text[:at]}<mujoco><compiler strippath="false"/></mujoco>{text[at:]}'


def _without_collisions(view):
    return {key: value for key, value in view.items() if not key.startswith("collision")}

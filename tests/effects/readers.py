"""The readers of robots that are run: which are installed, their versions, and one run of one.

Each run is a process of its own, because some readers end the process on some robots.
"""

from __future__ import annotations

import importlib.metadata
import json
import math
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from .sdf_facts import sdf_facts

PROBES = Path(__file__).parent / "probes"
SECONDS = 60

Facts = dict[str, Any]


@dataclass(frozen=True)
class Robot:
    """A robot that readers are given: a file, and what is changed in it.

    Attributes:
        file: A URDF or xacro file; what stands in its folder is copied with it.
        edits: Texts that occur once in it, with what stands there instead.
        as_written: Leave an empty root link as it is for sdformat, which drops a massless root.
    """

    file: Path
    edits: tuple[tuple[str, str], ...] = ()
    as_written: bool = False

    def written_to(self, folder: Path) -> Path:
        """Copy it with its folder, make the edits, and give the path of the copy."""
        shutil.copytree(self.file.parent, folder)
        copy = folder / self.file.name
        for old, new in self.edits:
            data = copy.read_bytes()
            if data.count(old.encode()) != 1:
                raise ValueError(f"{self.file.name} has {data.count(old.encode())} times {old!r}")
            copy.write_bytes(data.replace(old.encode(), new.encode()))
        for count in re.findall(rb'"dense_(\d+)\.stl"', copy.read_bytes()):
            _write_dense_stl(folder / f"dense_{count.decode()}.stl", int(count))
        return copy


def _write_dense_stl(path: Path, count: int) -> None:
    """Write an STL file of so many triangles: a strip around a cylinder."""
    header = b"dense".ljust(80) + struct.pack("<I", count)
    triangles = []
    for i in range(count):
        points = [
            (0.1 * math.cos(angle), 0.1 * math.sin(angle), 0.1 * ((i + j) % 2))
            for j in range(3)
            for angle in [(i + j) * 2 * math.pi / count]
        ]
        numbers = [0.0, 0.0, 0.0, *(value for point in points for value in point)]
        triangles.append(struct.pack("<12fH", *numbers, 0))
    path.write_bytes(header + b"".join(triangles))


@dataclass(frozen=True)
class Reader:
    """A program or library that reads robots.

    Attributes:
        name: As the table names it, such as ``mujoco`` or ``mujoco 3.3``.
        title: As pages name it, without the version.
        version: Its version; None where it is not installed.
        command: The words of a run, before the name of the file.
    """

    name: str
    title: str
    version: Callable[[], str | None]
    command: Callable[[], list[str]]


def more_readers() -> Path:
    """Where ``python -m tests.effects.install`` puts further versions of readers."""
    return Path(os.environ.get("URDFTOOL_READERS", "build/readers")).resolve()


def _module(name: str, title: str, distribution: str) -> Reader:
    def version() -> str | None:
        try:
            return importlib.metadata.version(distribution)
        except importlib.metadata.PackageNotFoundError:
            return None

    return Reader(name, title, version, lambda: [sys.executable, str(PROBES / f"read_{name}.py")])


def _mujoco(version: str) -> Reader:
    home = more_readers() / f"mujoco-{version}"
    python = home / "bin" / "python"
    return Reader(
        f"mujoco {version.rpartition('.')[0]}",
        "MuJoCo",
        lambda: version if python.exists() else None,
        lambda: [str(python), str(PROBES / "read_mujoco.py")],
    )


def _newton(version: str) -> Reader:
    python = more_readers() / f"newton-{version}" / "bin" / "python"
    return Reader(
        "newton",
        "Newton",
        lambda: version if python.exists() else None,
        lambda: [str(python), str(PROBES / "read_newton.py")],
    )


def _debian(package: str) -> Callable[[], str | None]:
    """The version of an installed package, without what Debian adds to it."""

    def version() -> str | None:
        try:
            words = ["dpkg-query", "-W", "-f", "${db:Status-Status} ${Version}", package]
            done = subprocess.run(words, capture_output=True, text=True)
        except FileNotFoundError:
            return None
        found = re.match(r"installed (?:\d+:)?([\d.]+)", done.stdout)
        return found[1] if found and shutil.which("g++") else None

    return version


def _compiled(source: str, *flags: str) -> Callable[[], list[str]]:
    return lambda: [_compile(source, flags)]


@cache
def _compile(source: str, flags: tuple[str, ...]) -> str:
    """A program of ``probes/``, compiled into a folder of this run."""
    out = Path(tempfile.mkdtemp(prefix="urdftool-readers-")) / source.partition(".")[0]
    words = [str(PROBES / source), "-o", str(out), *_expanded(flags)]
    subprocess.run(["g++", "-std=c++17", *words], check=True, capture_output=True)
    return str(out)


def _expanded(flags: tuple[str, ...]) -> list[str]:
    words: list[str] = []
    for flag in flags:
        if flag.startswith("pkg-config:"):
            name = flag.partition(":")[2]
            asked = ["pkg-config", "--cflags", "--libs", name]
            words += subprocess.run(
                asked, check=True, capture_output=True, text=True
            ).stdout.split()
        else:
            words.append(flag)
    return words


def _urdfdom(version: str) -> Reader:
    prefix = more_readers() / f"urdfdom-{version}" / "cmeel.prefix"
    include = [f"-I{prefix}/include{folder}" for folder in ("", "/urdfdom", "/urdfdom_headers")]
    library = [f"-L{prefix}/lib", f"-Wl,-rpath,{prefix}/lib", "-lurdfdom_model"]
    return Reader(
        f"urdfdom {version.partition('.')[0]}",
        "urdfdom",
        lambda: version if prefix.exists() and shutil.which("g++") else None,
        _compiled("read_urdfdom.cpp", *include, *library),
    )


def _check_urdf_version() -> str | None:
    return _debian("liburdfdom-tools")() if shutil.which("check_urdf") else None


def _xacro_command() -> list[str]:
    return [sys.executable, "-c", "import xacro; xacro.main()"]


READERS = {
    reader.name: reader
    for reader in (
        Reader(
            "urdfdom",
            "urdfdom",
            _debian("liburdfdom-dev"),
            _compiled("read_urdfdom.cpp", "-lurdfdom_model", "-lconsole_bridge"),
        ),
        _urdfdom("4.0.1"),
        _urdfdom("6.0.0"),
        Reader("check_urdf", "check_urdf", _check_urdf_version, lambda: ["check_urdf"]),
        Reader(
            "sdformat",
            "sdformat",
            _debian("libsdformat-dev"),
            _compiled("read_sdformat.cpp", "pkg-config:sdformat12"),
        ),
        Reader(
            "KDL",
            "kdl_parser",
            _debian("libkdl-parser-dev"),
            _compiled(
                "read_kdl.cpp",
                *("-I/usr/include/eigen3", "-lkdl_parser", "-lorocos-kdl", "-lurdfdom_model"),
            ),
        ),
        _module("mujoco", "MuJoCo", "mujoco"),
        _mujoco("3.3.7"),
        _module("pybullet", "PyBullet", "pybullet"),
        _module("pinocchio", "pinocchio", "pin"),
        _module("drake", "Drake", "drake"),
        _newton("1.8.0"),
        Reader("xacro", "xacro", _module("xacro", "xacro", "xacro").version, _xacro_command),
        Reader(
            "xacro --inorder",
            "xacro",
            _module("xacro", "xacro", "xacro").version,
            lambda: [*_xacro_command(), "--inorder"],
        ),
    )
}


def installed() -> dict[str, str]:
    """The version of each reader that is installed."""
    return {name: v for name, reader in READERS.items() if (v := reader.version()) is not None}


def read(reader: str, robot: Robot) -> Facts:
    """Run a reader on a copy of a robot, and give what it made of it.

    Args:
        reader: A key of :data:`READERS`.
        robot: What it is given.
    """
    with tempfile.TemporaryDirectory(prefix="urdftool-effects-") as temporary:
        file = robot.written_to(Path(temporary) / "robot")
        if file.suffix == ".xacro" and not reader.startswith(("xacro", "newton")):
            try:
                file = _expand(file)
            except subprocess.CalledProcessError:
                return {"outcome": "xacro stops"}
        if reader == "sdformat" and not robot.as_written:
            _give_the_root_a_mass(file)
        paths = {"HOME": temporary, "ROS_PACKAGE_PATH": temporary}
        environment = {**os.environ, **paths, "LC_ALL": "C"}
        words = [*READERS[reader].command(), str(file)]
        try:
            done = subprocess.run(
                words, cwd=temporary, env=environment, capture_output=True, timeout=SECONDS
            )
        except subprocess.TimeoutExpired:
            return {"outcome": "does not end"}
        out, err = (text.decode("utf-8", "replace") for text in (done.stdout, done.stderr))
        facts = _FACTS.get(reader, _json_facts)(out, done.returncode)
        said = [*facts.pop("messages", ()), *_lines(err), *facts.pop("said", ())]
        if said := _cleaned(said, temporary):
            facts["messages"] = said
        return {key: _plain(value, temporary) for key, value in facts.items()}


def _expand(file: Path) -> Path:
    out = file.with_name(file.name.removesuffix(".xacro"))
    if out.exists():
        out = file.with_name(f"expanded_{out.name}")
    subprocess.run(
        [*_xacro_command(), str(file), "-o", str(out)],
        check=True,
        capture_output=True,
        env={**os.environ, "ROS_PACKAGE_PATH": str(file.parent)},
    )
    return out


BALLAST = (
    '<inertial><mass value="1"/>'
    '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'
)


def _give_the_root_a_mass(file: Path) -> None:
    """Give an empty root link 1 kg, so that sdformat keeps the robot and its defect shows."""
    data = file.read_bytes()
    file.write_bytes(
        re.sub(
            rb'<link name="(base|base_link|world)"\s*/>',
            lambda found: b'<link name="' + found[1] + b'">' + BALLAST.encode() + b"</link>",
            data,
            count=1,
        )
    )


def _lines(text: str) -> list[str]:
    return [line for line in text.splitlines() if line.strip()]


def _json_facts(out: str, code: int) -> Facts:
    lines = _lines(out)
    if lines and lines[-1].startswith('{"outcome"'):
        return {**json.loads(lines[-1]), "said": lines[:-1]}
    if code < 0:
        return {"outcome": "crashes", "signal": signal.Signals(-code).name, "said": lines}
    return {"outcome": "crashes", "code": code, "said": lines}


def _sdformat_facts(out: str, code: int) -> Facts:
    before, mark, rest = out.partition("---")
    if not mark:
        return _json_facts(out, code)
    outcome, _, sdf = rest.partition("\n")
    return {"outcome": outcome, **sdf_facts(sdf), "said": _lines(before)}


def _check_urdf_facts(out: str, code: int) -> Facts:
    if code < 0:
        return _json_facts(out, code)
    return {"outcome": "rejects" if code else "loads", "said": _lines(out)}


def _xacro_facts(out: str, code: int) -> Facts:
    lines = [line for line in _lines(out) if not line.startswith("<!-- ")]
    return {"outcome": "rejects" if code else "loads", "output": lines}


_FACTS = {
    "sdformat": _sdformat_facts,
    "check_urdf": _check_urdf_facts,
    "xacro": _xacro_facts,
    "xacro --inorder": _xacro_facts,
}

_COLOR = re.compile(r"\x1b\[[0-9;]*m")
_NOISE = re.compile(
    r"^(pybullet build time|at line \d+ in |WARNING: All log messages before|I0000 "
    r"|b3Printf: |ven = |argv\[)"
)
_PLACE = re.compile(r"\[(?:/|[A-Za-z_.]+/)*([A-Za-z0-9_.]+\.(?:cc|cpp|hh|h)(?:[:,]\d+)?)\]")
_TIME = re.compile(r"\[\d{4}-\d\d-\d\d [\d:.]+\] ?|\(\d{4}-\d\d-\d\d [^)]*\) ?|\[\d{10}\.\d+\]:? ?")
_TEMPORARY = re.compile(r"(?:file://)?/[^\s'\"]*urdftool-(?:effects|readers)-[^/\s'\"]*/")
_INSTALLED = re.compile(r"/[^\s'\"]*/site-packages/")


def _plain(value: Any, temporary: str) -> Any:
    """Facts that JSON can write, infinities and NaN as words, and that name no folder."""
    if isinstance(value, dict):
        return {key: _plain(each, temporary) for key, each in value.items()}
    if isinstance(value, list):
        return [_plain(each, temporary) for each in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return _without_folders(value, temporary) if isinstance(value, str) else value


def _without_folders(text: str, temporary: str) -> str:
    text = _TEMPORARY.sub("", text.replace(temporary + "/", ""))
    return _INSTALLED.sub("", text)


def _cleaned(lines: list[str], temporary: str) -> list[str]:
    """Messages without colors, times and what names this machine; a repeated one once."""
    found: list[str] = []
    for line in lines:
        text = _without_folders(_TIME.sub("", _COLOR.sub("", line)), temporary)
        text = _PLACE.sub(r"[\1]", text).strip()
        if text and not _NOISE.match(text) and text not in found:
            found.append(text)
    return found[:40]

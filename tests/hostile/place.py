"""A project among secrets: what is written and printed there is searched for them."""

from __future__ import annotations

import base64
import gzip
import html
import io
import os
import re
import shutil
import zipfile
import zlib
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

SECONDS = 20.0
"""Maximum processor time of a command, with all its processes [s]."""

MEGABYTES = 1000
"""Maximum resident memory of each process of a command [MB]."""

MESSAGE = 20_000
"""Maximum length of the messages of a command that fails [bytes]."""

_DAMAGE = zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError, EOFError

VARIABLE = "URDFTOOL_TEST_SECRET"
SECRETS = {
    "the file beside the project": "qX7besideV3wsecret",
    "the home folder": "qX7homeK9psecret",
    "the temporary folder": "qX7tempR2msecret",
    "a hidden file of the project": "qX7hiddenL5tsecret",
    "the environment": "qX7environJ8bsecret",
}
"""What no output and no message may contain, by where it comes from."""

POLYGLOT = '<robot name="{0}"><link name="{0}"/></robot>\n'
"""A file that is XML as well as YAML."""

OBJECT = re.compile(
    r"<(?:module|frame|code|generator|coroutine|async_generator|cell|weakref|_io|traceback)\b"
)
"""Text of an object of the interpreter; that of an allowed function or type is of no use."""

CONTROL = re.compile(rb"[\0-\x08\x0b\x0c\x0e-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\xaa-\xae]")
"""What a terminal obeys, or what reverses text."""


@dataclass
class Outcome:
    """What came of a command.

    Attributes:
        code: Exit code; minus the signal's number, None if it did not end.
        seconds: Processor time of all its processes.
        megabytes: Most resident memory of one of its processes.
        out: What it printed.
        err: Its messages.
        left: Whether a process of it ran on after its end.
    """

    code: int | None
    seconds: float
    megabytes: float
    out: bytes = b""
    err: bytes = b""
    left: bool = False


@dataclass
class Place:
    """Folders of one run: a project in a home folder, with secrets around it."""

    root: Path
    before: dict[str, bytes] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Make the folders and the secrets."""
        for folder in (self.project, self.beside, self.out, self.cache):
            folder.mkdir(parents=True, exist_ok=True)
        for path, where in self.secrets().items():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(POLYGLOT.format(SECRETS[where]), "utf-8")
        write_images_and_meshes(self.beside, SECRETS["the file beside the project"])

    @property
    def home(self) -> Path:
        """The home folder, in which the project is."""
        return self.root / "home"

    @property
    def project(self) -> Path:
        """The folder of the description."""
        return self.home / "work" / "project"

    @property
    def beside(self) -> Path:
        """A folder that is not the project's."""
        return self.home / "work" / "beside"

    @property
    def temporary(self) -> Path:
        """The folder of temporary files."""
        return self.root / "tmp"

    @property
    def out(self) -> Path:
        """The folder of outputs."""
        return self.root / "out"

    @property
    def cache(self) -> Path:
        """The folder of caches."""
        return self.root / "cache"

    @property
    def mark(self) -> Path:
        """A file that only a hostile expression creates."""
        return self.root / "mark"

    def secrets(self) -> dict[Path, str]:
        """Return the files with secrets, and where each comes from."""
        beside = {
            self.beside / f"secret.{kind}": "the file beside the project"
            for kind in ("yaml", "xml", "txt", "urdf", "xacro", "sdf", "toml", "srdf", "json")
        }
        return beside | {
            self.home / "Documents" / "secret.yaml": "the home folder",
            self.home / ".ssh" / "id_test": "the home folder",
            self.temporary / "secret.yaml": "the temporary folder",
            self.project / ".env": "a hidden file of the project",
            self.project / ".git" / "config": "a hidden file of the project",
            self.project / ".hidden" / "secret.yaml": "a hidden file of the project",
        }

    def fill(self, text: str) -> str:
        """Replace the names of secrets in a text."""
        names = {
            "@MARK@": self.mark,
            "@BESIDE@": self.beside / "secret.yaml",
            "@HOME@": self.home / "Documents" / "secret.yaml",
            "@HOMEDIR@": self.home,
            "@TMP@": self.temporary / "secret.yaml",
            "@ENV@": VARIABLE,
        }
        for name, value in names.items():
            text = text.replace(name, str(value))
        return text

    def environment(self) -> dict[str, str]:
        """Return the environment variables of a command."""
        kept = ("PATH", "LANG", "SYSTEMROOT", "PYTHONPATH", "LD_LIBRARY_PATH")
        return {name: os.environ[name] for name in kept if name in os.environ} | {
            "HOME": str(self.home),
            "USERPROFILE": str(self.home),
            "TMPDIR": str(self.temporary),
            "XDG_CACHE_HOME": str(self.cache),
            VARIABLE: SECRETS["the environment"],
        }

    def clear(self) -> None:
        """Remove what runs left: outputs, the mark, and files of the project."""
        self.mark.unlink(missing_ok=True)
        for folder in (self.out, self.cache, self.project):
            for path in folder.iterdir():
                if path.name in (".env", ".git", ".hidden"):
                    continue
                if path.is_dir() and not path.is_symlink():
                    shutil.rmtree(path)
                else:
                    path.unlink()

    def find_problems(self, outcome: Outcome, *, objects: bool = False) -> list[str]:
        """Return what must not be and is, after a command.

        Args:
            outcome: What came of it.
            objects: Also search for the text of Python objects in what was printed.
        """
        found = []
        if outcome.code is None:
            found.append("it does not end")
        elif outcome.code not in (0, 1, 2):
            found.append(f"exit code {outcome.code}")
        if outcome.seconds > SECONDS:
            found.append(f"{outcome.seconds:.0f} s of processor time")
        if outcome.megabytes > MEGABYTES:
            found.append(f"{outcome.megabytes:.0f} MB")
        said = outcome.out + outcome.err
        if b"Traceback (most recent" in said:
            found.append("a traceback")
        if outcome.code in (1, 2) and not said.strip():
            found.append("it failed without a message")
        if outcome.code == 2 and len(outcome.err) > MESSAGE:
            found.append(f"a message of {len(outcome.err)} bytes")
        if control := CONTROL.search(outcome.err):
            found.append(f"a control character in a message: {control[0]!r}")
        if outcome.left:
            found.append("a process ran on after its end")
        if self.mark.exists():
            found.append("it ran a command")
        text = html.unescape(html.unescape(said.decode("utf-8", "replace")))
        if objects and (thing := OBJECT.search(text)):
            found.append(f"a Python object: {text[thing.start() : thing.start() + 60]!r}")
        found += [f"it printed {name}" for name in find_secrets(said)]
        for path in self.written():
            found += [f"it wrote {name} to {path.name}" for name in find_secrets_in(path)]
        return found

    def written(self) -> list[Path]:
        """Return the regular files that a command may have written."""
        own = set(self.secrets())
        folders = (self.out, self.cache, self.temporary, self.project)
        return [
            path
            for folder in folders
            for path in sorted(folder.rglob("*"))
            if path not in own and not path.is_symlink() and path.is_file()
        ]


def find_secrets(data: bytes) -> list[str]:
    """Return where the secrets in some bytes come from; plain, or in base64 or UTF-16."""
    found = []
    for name, secret in SECRETS.items():
        plain = secret.encode()
        forms = [plain, secret.encode("utf-16-le"), plain.hex().encode(), plain[::-1]]
        for shift in range(3):
            coded = base64.b64encode(bytes(shift) + plain)
            forms.append(coded[4 if shift else 0 : -4])
        if any(form in data for form in forms):
            found.append(name)
    return found


def find_secrets_in(path: Path) -> list[str]:
    """Return where the secrets in a file come from; members of archives are searched, too."""
    data = path.read_bytes()
    found = find_secrets(data)
    if data[:2] == b"PK":
        with suppress(*_DAMAGE), zipfile.ZipFile(io.BytesIO(data)) as archive:
            for member in archive.infolist():
                found += find_secrets(archive.read(member))
    if data[:2] == b"\x1f\x8b":
        with suppress(gzip.BadGzipFile, EOFError):
            found += find_secrets(gzip.decompress(data))
    return found


def write_images_and_meshes(folder: Path, secret: str) -> None:
    """Write valid images and meshes that contain a secret."""
    from tests.hostile.pictures import png

    facet = "facet normal 0 0 1 outer loop vertex {} vertex {} vertex {} endloop endfacet\n"
    corners = ("0 0 0", "1 0 0", "0 1 0", "0 0 1")
    sides = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
    solid = "".join(facet.format(*(corners[i] for i in side)) for side in sides)
    (folder / "secret.stl").write_text(f"solid {secret}\n{solid}endsolid {secret}\n")
    vertices = "".join(f"v {corner}\n" for corner in corners)
    faces = "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in sides)
    (folder / "secret.obj").write_text(f"# {secret}\n{vertices}{faces}")
    (folder / "secret.mtl").write_text(f"# {secret}\nnewmtl {secret}\nKd 1 0 0\n")
    (folder / "secret.png").write_bytes(png(4, 4, comment=secret.encode()))
    (folder / "secret.usda").write_text(f'#usda 1.0\ndef Xform "{secret}" {{}}\n')
    (folder / "cookies.sqlite").write_bytes(
        b"SQLite format 3\0" + bytes(4080) + secret.encode() + bytes(4000)
    )

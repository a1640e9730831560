"""Reports that are kept: they are what a check without them would say, whatever changes."""

import copy
import dataclasses
import json
import os
import pickle
import random
import shutil
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.conftest import FIXTURES, XACRO
from urdftool import dependencies
from urdftool.commands import lint_printed
from urdftool.lint import cache as cache_module
from urdftool.lint import installed_code, questions, run
from urdftool.lint.cache import Cache
from urdftool.lint.options import Options
from urdftool.lint.parallel import check_files
from urdftool.rules import get_rule
from urdftool.source.location import SourceFile
from urdftool.storage import DiskCache, cache_folder

ARM = FIXTURES / "robots" / "demo_arm" / "urdf" / "arm.urdf.xacro"


@pytest.fixture
def lint(urdftool):
    return partial(urdftool, "lint")


@pytest.fixture
def lint_anew(lint, monkeypatch):
    """Call lint, which reads reports of the cache, but no output of a whole run."""
    monkeypatch.setattr(lint_printed, "_is_stored", lambda given: False)
    return lint


@pytest.fixture
def no_check(monkeypatch):
    """From its call on, whatever is not known already is an error."""

    def stop():
        def refuse(*_):
            raise AssertionError("a file was checked that was known")

        monkeypatch.setattr(run, "_check_variant", refuse)

    return stop


@pytest.mark.parametrize(
    "style",
    [
        *("concise", "json", "sarif", "github", "junit"),
        *(pytest.param(style, marks=pytest.mark.slow) for style in ("full", "html")),
    ],
)
def test_a_report_that_was_kept_says_the_same(lint, no_check, style):
    folder = FIXTURES / "robots" if style == "full" else ARM.parent
    words = [ARM, folder, "--format", style, "--exit-zero"]
    plain = lint(*words, "--no-cache")
    assert lint(*words) == plain
    no_check()
    assert lint(*words) == plain


def test_without_the_cache_nothing_is_kept(lint, write):
    path = write("r.urdf", "<robot><link name='a'/></robot>")
    lint(path, "--no-cache")
    assert not cache_folder("lint").exists()
    lint(path)
    assert cache_folder("lint").exists()
    assert lint(path, "--no-cache", "--cache-dir", "there").code == 2


# A small workspace, any file of which may become any other of its kind, go, or come.
KINDS = {
    "ws/arm/urdf/arm.urdf.xacro": [
        XACRO.format(
            '<xacro:include filename="$(find arm)/urdf/part.xacro"/>'
            '<xacro:property name="c" value="${xacro.load_yaml(\'size.yaml\')}"/>'
            '<link name="base"><visual><geometry><mesh filename="package://arm/meshes/a.stl"/>'
            '</geometry></visual></link><xacro:part n="x" m="${c[\'mass\']}"/>'
        ),
        XACRO.format(
            '<link name="base"><visual><geometry><mesh filename="package://other/b.obj"/>'
            '</geometry></visual></link><xacro:property name="h" value="$(optenv HEIGHT -1)"/>'
            '<link name="a${h}"/>'
        ),
        "<robot><link name='a'/></robot>",
        "<robot><link name='a'></robot>",
    ],
    "ws/arm/urdf/part.xacro": [
        XACRO.format(
            '<xacro:macro name="part" params="n m"><link name="${n}"><inertial>'
            '<mass value="${m}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="9"/>'
            '</inertial></link><joint name="${n}_joint" type="fixed"><parent link="base"/>'
            '<child link="${n}"/></joint></xacro:macro>'
        ),
        XACRO.format('<xacro:macro name="part" params="n m"><link name="${n}"/></xacro:macro>'),
        XACRO.format('<xacro:macro name="port" params="n m"><link name="${n}"/></xacro:macro>'),
    ],
    "ws/arm/urdf/size.yaml": ["mass: 1\n", "mass: 0\n", "mass: [\n"],
    "ws/arm/urdf/arm.srdf": [
        "<robot name='r'><group name='g'><link name='base'/></group></robot>",
        "<robot name='q'><group name='g'><link name='none'/></group></robot>",
    ],
    "ws/arm/meshes/a.stl": [
        "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n",
        b"\0" * 80 + (1).to_bytes(4, "little") + b"\0" * 50,
        b"\0" * 80 + (2).to_bytes(4, "little") + b"\0" * 50,
        "solid a\nendsolid a\n",
        "",
    ],
    "ws/arm/meshes/A.STL": [b"\0" * 84],
    "ws/other/b.obj": ["mtllib b.mtl\nv 0 0 0\n", "v 0 0 0\n"],
    "ws/other/b.mtl": ["newmtl a\n"],
    "ws/arm/package.xml": [
        "<package><name>arm</name><export><build_type>ament_cmake</build_type></export></package>",
        "<package><name>arm</name><depend>other</depend><depend>gazebo_ros</depend></package>",
        "<package><name>leg</name><buildtool_depend>catkin</buildtool_depend></package>",
    ],
    "ws/arm/CMakeLists.txt": [
        "install(DIRECTORY urdf DESTINATION share/arm)",
        "install(DIRECTORY urdf meshes DESTINATION share/arm)",
        "install(FILES urdf/part.xacro DESTINATION share/arm/urdf RENAME q.xacro)",
    ],
    "ws/other/package.xml": ["<package><name>other</name></package>"],
    "ws/deep/er/package.xml": ["<package><name>other</name></package>"],
    "ws/deep/er/b.obj": ["v 0 0 0\n"],
    "ws/deep/COLCON_IGNORE": [""],
    "ws/arm/launch/a.launch.py": ["GZ_SIM_RESOURCE_PATH", "nothing"],
    "ws/urdftool.toml": [
        "[lint]\nignore = ['inertia']\n",
        "[lint]\ntargets = ['gz', 'moveit']\n",
        "[packages]\nother = 'elsewhere'\n",
        "[lint]\nignore = ['inertai']\n",
    ],
    "ws/arm/urdftool.toml": ["[lint.severity]\nmissing-name = 'info'\n"],
    "elsewhere/b.obj": ["v 0 0 1\n"],
    "ws/elsewhere/b.obj": ["mtllib c.mtl\n"],
}
FIRST = [
    *("ws/arm/urdf/arm.urdf.xacro", "ws/arm/urdf/part.xacro", "ws/arm/urdf/size.yaml"),
    *("ws/arm/package.xml", "ws/arm/CMakeLists.txt", "ws/other/package.xml"),
]
EDITS = st.lists(
    st.one_of(
        st.tuples(
            st.just("write"), st.sampled_from(sorted(KINDS)), st.integers(0, 4), st.booleans()
        ),
        st.tuples(
            st.just("remove"), st.sampled_from(sorted(KINDS)), st.just(0), st.booleans()
        ),
        st.tuples(st.just("env"), st.sampled_from(["", "1", "2"]), st.just(0), st.booleans()),
        st.tuples(st.just("link"), st.just("ws/arm/meshes/a.stl"), st.just(0), st.booleans()),
        st.tuples(st.just("ros"), st.sampled_from(["", "ws/deep", "."]), st.just(0), st.just(True)),
    ),
    min_size=1,
    max_size=5,
)  # fmt: skip


def edit(root, how, what, number, old):
    """Change one input; ``old`` gives it a time long past, so that its stamp is trusted."""
    if how == "env":
        os.environ["HEIGHT"] = what
        return
    if how == "ros":
        os.environ["ROS_PACKAGE_PATH"] = str(root / what) if what else ""
        return
    path = root / what
    path.parent.mkdir(parents=True, exist_ok=True)
    if how == "remove":
        path.unlink(missing_ok=True)
    elif how == "link":
        other = root / "ws" / "other.stl"
        other.write_bytes(b"\0" * 80 + (7).to_bytes(4, "little"))
        path.unlink(missing_ok=True)
        path.symlink_to(other)
    else:
        path.unlink(missing_ok=True)
        text = KINDS[what][number % len(KINDS[what])]
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        if old:
            os.utime(path, (1e9, 1e9))


@given(EDITS, st.booleans())
@settings(
    max_examples=int(os.environ.get("CACHE_EXAMPLES", "6")),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_any_edit_changes_the_report_as_it_would_without_a_cache(
    lint, tmp_path, monkeypatch, edits, trusting
):
    root = tmp_path / "w"
    shutil.rmtree(root, ignore_errors=True)
    root.mkdir()
    (root / ".git").mkdir()
    monkeypatch.setattr(dependencies, "_FRESH_NS", 0 if trusting else 2_000_000_000)
    for name in ("HEIGHT", "ROS_PACKAGE_PATH"):
        monkeypatch.setenv(name, "")
    for name in FIRST:
        edit(root, "write", name, 0, False)
    monkeypatch.chdir(root / "ws")
    words = ("arm/urdf/arm.urdf.xacro", "--format", "json")
    before = lint(*words)
    assert lint(*words) == before
    for change in edits:
        edit(root, *change)
        kept = lint(*words)
        assert kept == lint(*words, "--no-cache")
        assert lint(*words) == kept


def test_a_mesh_that_comes_is_seen(lint, write):
    mesh = '<visual><geometry><mesh filename="a.stl"/></geometry></visual>'
    path = write("r.urdf", f'<robot name="r"><link name="a">{mesh}</link></robot>')
    for _ in range(2):
        assert "[mesh-not-found]" in lint(path).out
    write("a.stl", b"\0" * 84)
    assert "[mesh-not-found]" not in lint(path).out


def test_a_change_of_same_size_and_time_is_seen(lint, write):
    path = write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    assert lint(path).code == 0
    stamp = os.stat(path)
    write("r.urdf", '<robot nome="r"><link name="a"/></robot>')
    os.utime(path, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    assert lint(path).code == 1


def test_other_code_settings_folders_and_arguments_are_other_questions(
    lint, xacro_file, no_check, monkeypatch, tmp_path
):
    path = xacro_file("r.urdf.xacro", '<xacro:arg name="n" default="a"/><link name="$(arg n)"/>')
    lint(path)
    no_check()
    lint(path)
    known = (
        [path, "n:=b"],
        [path, "--select", "missing-name"],
        [path, "--ignore", "missing-name"],
        [path, "--target", "gz"],
        [path, "-p", "x=."],
        [path, "--package-path", "."],
    )
    for words in known:
        assert lint(*words).code == 3
    with monkeypatch.context() as patch:
        patch.chdir(tmp_path.parent)
        assert lint(os.path.relpath(tmp_path / path)).code == 3
    monkeypatch.setattr(cache_module, "hash_code", lambda: "another version")
    monkeypatch.setattr(installed_code, "hash_code", lambda: "another version")
    assert lint(path).code == 3


def test_variants_are_kept_each(lint, xacro_file, write, no_check):
    path = xacro_file("r.urdf.xacro", '<xacro:arg name="n" default="a"/><link name="$(arg n)"/>')
    write(
        "urdftool.toml",
        f'[[lint.variants]]\nfile = "{path}"\nargs = {{n = "a"}}\n'
        f'[[lint.variants]]\nfile = "{path}"\nargs = {{n = ""}}\n',
    )
    first = lint(path)
    assert first.code == 1
    no_check()
    assert lint(path) == first


def entries(folder):
    return [path for path in Path(folder).rglob("*") if path.is_file() and path.name != "trimmed"]


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: b"",
        lambda data: data[: len(data) // 2],
        lambda data: data[:-9] + bytes(9),
        lambda data: b"\xff" * 4000,
    ],
    ids=["empty", "half", "other end", "noise"],
)
def test_damaged_entries_count_as_absent(lint_anew, write, damage):
    path = write("r.urdf", "<robot><link name='a'/></robot>")
    first = lint_anew(path, "--cache-dir", "kept")
    for entry in entries("kept"):
        entry.write_bytes(damage(entry.read_bytes()))
    assert lint_anew(path, "--cache-dir", "kept") == first


class Evil:
    def __reduce__(self):
        return os.mkdir, ("evil",)


FORGED = {
    "pickle": pickle.dumps(Evil()),
    "number": b"7",
    "list": b"[]",
    "no report": b'{"rows":[],"files":[]}',
    "other class": b'{"rows":[],"files":[],"calls":[],"report":{"__class__":"os.system"}}',
    "wrong type": b'{"rows":[],"files":[],"calls":[],"report":{"path":7}}',
    "wrong item": b'{"rows":[],"files":[],"calls":[],"report":{"path":"a","findings":[7]}}',
    "surrogate": b'{"rows":[["file","\\ud800","-",null]],"files":[],"calls":[],"report":{}}',
    "zero byte": b'{"rows":[["file","a\\u0000","-",null]],"files":[],"calls":[],"report":{}}',
    "depth": b"[" * 200_000,
    "depth of data": b'{"rows":[],"files":[],"calls":[],"report":{"path":' + b'{"a":' * 90_000,
    "digits": b'{"rows":[],"files":[],"calls":[],"report":{"path":' + b"9" * 9000 + b"}}",
    "unknown query": b'{"rows":[["run","ls","-",null]],"files":[],"calls":[],"report":{}}',
    "device": b'{"rows":[["file","/dev/zero","x",null]],"files":[["/dev/zero","utf-8",null,"x"]],'
    b'"calls":[],"report":{"path":"r.urdf"}}',
    "codec": b'{"rows":[],"files":[["r.urdf","hex","a",""]],"calls":[],"report":{"path":"r.urdf"}}',
    "no query": b'{"rows":[],"files":[],"calls":[],"report":{"path":"r.urdf"}}',
    "other file": b'{"rows":[],"files":[["r.urdf","utf-8",null,null]],"calls":[],"report":'
    b'{"path":"r.urdf"}}',
}


@pytest.mark.parametrize("name", FORGED)
def test_a_forged_entry_runs_nothing_and_counts_as_absent(lint_anew, write, name):
    path = write("r.urdf", "<robot><link name='a'/></robot>")
    os.mkdir("kept")  # before its folder is listed
    first = lint_anew(path, "--cache-dir", "kept")
    (entry,) = entries("kept")
    DiskCache("kept").put(entry.name, FORGED[name])
    assert lint_anew(path, "--cache-dir", "kept") == first
    assert not os.path.exists("evil")


def test_a_set_of_queries_that_contains_itself_does_not_hold(lint_anew, write):
    path = write("r.urdf", "<robot><link name='a'/></robot>")
    os.mkdir("kept")  # before its folder is listed
    first = lint_anew(path, "--cache-dir", "kept")
    (entry,) = entries("kept")
    row = ["many", entry.name, "", None]
    forged = {"rows": [row], "files": [], "calls": [], "report": {"path": path}}
    DiskCache("kept").put(entry.name, json.dumps(forged).encode())
    assert lint_anew(path, "--cache-dir", "kept") == first


@pytest.mark.parametrize("span", [[-1, 2], [2, 1], [0, 10**6], [10**6, 10**6]])
def test_a_place_outside_of_its_file_is_damage(lint_anew, write, span):
    path = write("r.urdf", "<robot><link name='a'/></robot>")
    os.mkdir("kept")  # before its folder is listed
    first = lint_anew(path, "--cache-dir", "kept")
    (entry,) = entries("kept")
    forged = json.loads(DiskCache("kept").get(entry.name))
    forged["report"]["findings"][0]["message"] = "forged"
    DiskCache("kept").put(entry.name, json.dumps(forged).encode())
    assert "forged" in lint_anew(path, "--cache-dir", "kept").out  # its digest has no key
    forged["report"]["findings"][0]["location"][1:3] = span
    DiskCache("kept").put(entry.name, json.dumps(forged).encode())
    assert lint_anew(path, "--cache-dir", "kept") == first


def replace_value(table, path, value):
    """Return a copy of nested lists and tables with another value at one place."""
    if not path:
        return value
    changed = copy.copy(table)
    changed[path[0]] = replace_value(table[path[0]], path[1:], value)
    return changed


def list_paths(table, path=()):
    yield path
    if isinstance(table, dict | list):
        for key in table if isinstance(table, dict) else range(len(table)):
            yield from list_paths(table[key], (*path, key))


OTHERS = (
    *(None, True, -1, 0, 1, 2**60, 10**400, 1.5, float("nan"), float("inf"), "", "a", "\ud800"),
    *([], [[]], {}, {"tuple": []}, {"dict": [[[], 1]]}, {"set": [[]]}, {"eval": ["1"]}),
)


@pytest.mark.parametrize(
    "style",
    ["json", *(pytest.param(one, marks=pytest.mark.slow) for one in ("full", "sarif", "html"))],
)
def test_an_entry_with_any_wrong_value_is_no_crash(lint_anew, write, style):
    """An entry of the right types is believed: its digest has no key."""
    path = write(
        "r.urdf.xacro",
        XACRO.format(
            '<xacro:macro name="m" params="n"><link name="${n}"><inertial><mass value="0"/>'
            "</inertial></link></xacro:macro>"
            '<xacro:m n="a"/><xacro:m n="a"/><!-- urdftool: ignore -->'
        ),
    )
    os.mkdir("kept")  # before its folder is listed
    words = [path, "--cache-dir", "kept", "--format", style, "--exit-zero"]
    assert lint_anew(*words).code == 0
    (entry,) = entries("kept")
    whole = json.loads(DiskCache("kept").get(entry.name))
    assert whole["report"]["findings"]
    places = list(list_paths(whole))
    dice = random.Random(style)
    for _ in range(int(os.environ.get("CACHE_FORGERIES", "30"))):
        forged = replace_value(whole, dice.choice(places), dice.choice(OTHERS))
        DiskCache("kept").put(entry.name, json.dumps(forged).encode())
        result = lint_anew(*words)
        assert result.code == 0, forged
        assert "Traceback" not in result.err


ROBOTS = [
    path
    for path in sorted(FIXTURES.rglob("*"))
    if path.name.endswith((".urdf", ".xacro")) and path.is_file()
]


@pytest.mark.parametrize(
    "paths", [ROBOTS[::15], pytest.param(ROBOTS, marks=pytest.mark.slow)], ids=["some", "all"]
)
def test_a_report_of_the_cache_equals_the_computed_one(tmp_path, paths):
    """Also its fixes, and all places in a file share the file."""
    read = 0
    for path in paths:
        options = Options(fixes=True, cache=Cache(DiskCache(tmp_path)))
        computed = run.check_file(path, options)
        cached = questions.find_cached_report(
            path, Options(fixes=True, cache=Cache(DiskCache(tmp_path)))
        )
        if cached is not None:
            read += 1
            assert describe(cached) == describe(computed)
            assert len(list_files(cached)) == len(list_files(computed))
    assert read >= 0.95 * len(paths)


def describe(value):
    """Return values with their types, and source files as their contents."""
    if isinstance(value, SourceFile):
        return value.path, value.data, value.encoding, value.part
    if dataclasses.is_dataclass(value):
        return type(value), [describe(getattr(value, f.name)) for f in dataclasses.fields(value)]
    if isinstance(value, dict):
        return type(value), [(key, describe(item)) for key, item in value.items()]
    if isinstance(value, list | tuple):
        return type(value), [describe(item) for item in value]
    return type(value), value


def list_files(report):
    """Return the source files of a report, each once."""
    found, seen, todo = [], set(), [report]
    while todo:
        value = todo.pop()
        if isinstance(value, SourceFile):
            if id(value) not in seen:
                seen.add(id(value))
                found.append(value)
        elif dataclasses.is_dataclass(value):
            todo += [getattr(value, field.name) for field in dataclasses.fields(value)]
        elif isinstance(value, dict):
            todo += value.values()
        elif isinstance(value, list | tuple):
            todo += value
    return found


def test_a_folder_that_cannot_be_written_is_no_error(lint, write):
    path = write("r.urdf", "<robot><link name='a'/></robot>")
    write("file", "in the way")
    assert lint(path, "--cache-dir", "file/there") == lint(path, "--no-cache")


def test_what_failed_is_not_kept(lint, write, monkeypatch):
    def broken(robot):
        raise KeyError("oh")

    path = write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    with monkeypatch.context() as patch:
        patch.setattr(get_rule("zero-axis"), "check", broken)
        assert lint(path).code == 3
    assert lint(path).code == 0
    assert lint("absent.urdf").code == 2
    write("absent.urdf", '<robot name="r"><link name="a"/></robot>')
    assert lint("absent.urdf").code == 0


def test_standard_input_is_not_kept(lint, monkeypatch):
    import io

    for text, code in (("<robot name='r'><link name='a'/></robot>", 0), ("<robot/>", 1)):
        stream = io.TextIOWrapper(io.BytesIO(text.encode()))
        monkeypatch.setattr(sys, "stdin", stream)
        assert lint("-").code == code


def test_a_file_that_changes_while_it_is_checked_is_not_kept(write, tmp_path, monkeypatch):
    path = write("r.urdf", '<robot name="r"><link name="a"/></robot>')
    check = run._check_variant

    def slow(*question):
        report = check(*question)
        write("r.urdf", '<robot nome="other"><link name="a"/></robot>')
        return report

    options = Options(cache=Cache(DiskCache(tmp_path / "kept")))
    with monkeypatch.context() as patch:
        patch.setattr(run, "_check_variant", slow)
        found = {finding.code for finding in run.check_file(path, options).findings}
    assert "missing-name" not in found
    options.cache = Cache(DiskCache(tmp_path / "kept"))
    assert questions.find_cached_report(path, options) is None


def test_several_processes_use_one_folder(write):
    for number in range(30):
        write(f"r/{number}.urdf", f"<robot><link name='{number}'/></robot>")
    words = [
        sys.executable,
        "-m",
        "urdftool",
        "lint",
        "r",
        "--all",
        "--cache-dir",
        "kept",
        "-j",
        "2",
    ]
    os.mkdir("kept")  # before its folder is listed
    some = [subprocess.Popen(words, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    said = [process.communicate()[0] for process in some]
    assert [process.returncode for process in some] == [1, 1, 1]
    assert "(and in 29 more files) [missing-name]" in said[0].replace("\n     ", " ")
    assert said[1:] == said[:1] * 2
    kept = [json.loads(DiskCache("kept").get(entry.name)) for entry in entries("kept")]
    assert sum("report" in table for table in kept) == 30


def test_what_is_asked_once_for_all_is_kept_once(write, tmp_path):
    for number in range(60):
        write(f"ws/p{number}/package.xml", f"<package><name>p{number}</name></package>")
    mesh = '<visual><geometry><mesh filename="package://p59/a.stl"/></geometry></visual>'
    paths = [
        write(f"ws/p0/{i}.urdf", f'<robot name="r"><link name="a">{mesh}</link></robot>')
        for i in range(3)
    ]
    write("ws/.git/HEAD", "")
    options = Options(cache=Cache(DiskCache(tmp_path / "kept")))
    for report in check_files(paths, options, 1):
        assert "mesh-not-found" in [finding.code for finding in report.findings]
    sizes = sorted(path.stat().st_size for path in entries(tmp_path / "kept"))
    assert len(sizes) == 3 + 3  # a report each; packages, files of Python code, their imports
    assert sizes[-1] > 2 * sizes[0]
    options = Options(cache=Cache(DiskCache(tmp_path / "kept")))
    assert all(questions.find_cached_report(path, options) for path in paths)
    write("ws/p59/package.xml", "<package><name>gone</name></package>")
    options = Options(cache=Cache(DiskCache(tmp_path / "kept")))
    assert not any(questions.find_cached_report(path, options) for path in paths)


def test_old_entries_go(tmp_path):
    store = DiskCache(tmp_path)
    for number in range(6):
        store.put(f"{number}" * 64, b"x" * 1000)
    for number, days in ((0, 40), (1, 31)):
        entry = tmp_path / (f"{number}" * 2) / (f"{number}" * 64)
        os.utime(entry, (time.time() - days * 86400,) * 2)
    assert store.trim(days=30, most=3 * 1100) == 3
    assert len(entries(tmp_path)) == 3
    store.put("7" * 64, b"x" * 9000)
    assert store.trim(days=30, most=1) == 0  # once a day

"""What a description from a stranger can reach: attempts, and what comes of them."""

import os
import re
import signal
import sys
import time

import pytest

from urdftool import expand
from urdftool.errors import UrdftoolError
from urdftool.projects import TRUST
from urdftool.source import limits

XACRO = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">{}</robot>'


@pytest.fixture
def evaluate(tmp_path, monkeypatch):
    """The value of a text in an attribute of a description."""
    monkeypatch.delenv(TRUST, raising=False)
    (tmp_path / "project" / "urdf").mkdir(parents=True)
    path = tmp_path / "project" / "urdf" / "a.xacro"

    def value(text):
        """Braces and brackets stand in a property, since they end an expression."""
        text = text.replace("&", "&amp;").replace("<", "&lt;")
        kind, inner = text[:2], text[2:-1]
        if kind == "$(" and inner.startswith("eval "):
            body = f'<xacro:property name="p" value="{inner[5:]}"/><link name="$(eval ${{p}})"/>'
        elif kind == "${" and (quoted := re.search(r"'[^']*\{[^']*'", inner)):
            inner = inner.replace(quoted[0], "p")
            body = (
                f'<xacro:property name="p" value="{quoted[0][1:-1]}"/><link name="${{{inner}}}"/>'
            )
        else:
            body = f'<link name="{text}"/>'
        path.write_text(XACRO.format(body))
        return expand(path).partition('<link name="')[2].partition('"/>')[0]

    value.folder = path.parent
    return value


SECRET = "the-secret"

INSIDES = [
    "${(x for x in [1]).\uff47i_frame}",
    "${(x for x in [1]).\\&#10;gi_frame}",
    "${'\\x7b0.__class__\\x7d'.\uff46ormat(1)}",
    "${\uff3f\uff3fimport\uff3f\uff3f('os')}",
    "${[g := 1]}",
    "${(lambda x: x)(1)}",
    "${f'a'}",
    "${len(*[[1]])}",
    "${dict(**dict(a=1))}",
    "${b'a'.hex()}",
    "${python.list[1]}",
    "${python.str.join}",
    "${'a'.encode()}",
    "${(1).to_bytes(2, 'big')}",
    "${len.real}",
    "${[0 for python.x in [1]]}",
    "${python['__builtins__']}",
    "${().__class__}",
    "${[x.__class__ for x in [1]]}",
    "${(lambda: (1).__class__)()}",
    "${'{0.__class__}'.format(1)}",
    "${'{0.real}'.format(1)}",
    "${python.str.format('{0.__class__}', 1)}",
    "${'{a.__init__.__globals__}'.format(a=xacro.message)}",
    "${'{0.__class__}'.format_map({'0': 1})}",
    "${python.vars(python.type(1))}",
    "${python.type('A', (), {})}",
    "${python.type(python.type(1))}",
    "${python.type(1).mro()}",
    "${(x for x in [1]).gi_frame.f_back}",
    "${[g := (g.gi_frame.f_back.f_builtins for _ in [1]), list(g)]}",
    "$(eval f'{().__class__}')",
    "${open('/etc/passwd').read()}",
    "${__import__('os').environ}",
    "${globals()}",
    "${getattr(1, 'real')}",
    "$(eval open('/etc/passwd').read())",
    "$(eval exec('import os'))",
    "$(eval ().__class__)",
    "$(eval compile('1', '', 'eval'))",
]

ENDLESS = [
    "${python.sum(python.range(10**12))}",
    "${list(python.range(10**9))}",
    "${'a' * 10**10}",
    "${10**10 * 'a'}",
    "${[0] * 10**10}",
    "${10**10**10}",
    "${1 << 10**10}",
    "${'%9999999999d' % 1}",
    "${'%*d' % (10**9, 1)}",
    "${'{:9999999999}'.format(1)}",
    "$(eval f'{1:9999999999}')",
    "$(eval f'{1:{10**10}}')",
    "${'a'.ljust(10**10)}",
    "${'a'.zfill(10**10)}",
    "${'a'.join(['b' * 10**6] * 10**6)}",
    "${('a' * 10**6).replace('a', 'b' * 10**6)}",
    "${'\\t'.expandtabs(10**10)}",
    "${(1).to_bytes(10**10, 'big')}",
    "${[a := 'x', [a := a + a for _ in python.range(60)]]}",
    "${[a := 3, [a := a * a for _ in python.range(60)]]}",
    "${math.factorial(10**8)}",
    "${math.prod(python.range(1, 10**6))}",
    "${math.comb(10**7, 10**6)}",
    "${math.lcm(*python.range(1, 10**5))}",
    "${python.sum([[0] * 10**6] * 10**6, [])}",
    "${round(7, -10**10)}",
    "${(lambda f: f(f))(lambda f: f(f))}",
    "$(eval 'a' * 10**10)",
    "$(eval 10**10**10)",
]


@pytest.mark.parametrize("text", INSIDES)
def test_the_insides_of_python_are_out_of_reach(evaluate, text):
    with pytest.raises(UrdftoolError) as caught:
        evaluate(text)
    assert caught.value.line == 1


@pytest.mark.parametrize("text", ENDLESS)
def test_no_expression_takes_all_time_or_memory(evaluate, text):
    start = time.monotonic()
    with pytest.raises(UrdftoolError) as caught:
        evaluate(text)
    assert caught.value.line == 1
    assert time.monotonic() - start < 40  # without the bounds: minutes, or until memory is gone


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("${1 + 2 * 3 ** 2}", "19"),
        ("${7 % 4} ${1 << 4}", "3 16"),
        ("${'a' * 3 + 'b'}", "aaab"),
        ("${'%.3f' % 1.5}", "1.500"),
        ("${'{:04d} {}'.format(7, 'x')}", "0007 x"),
        ("${'-'.join(['a', 'b']).replace('a', 'c')}", "c-b"),
        ("${'7'.zfill(3)}", "007"),
        ("${[2 * x for x in python.range(3)]}", "[0, 2, 4]"),
        ("${python.sum([1, 2])} ${round(1.26, 1)} ${math.prod([2, 3])}", "3 1.3 6"),
        ("${math.factorial(5)} ${factorial(4)}", "120 24"),
        ("${dict(format=3).get('format')}", "3"),
        ("$(eval 2 * 3)", "6"),
        ("$(eval pi > 3 and 'a' == 'a')", "True"),
        ("${'a b'.upper().split()[-1]} ${[1, 2, 3][1:][0]} ${[1, 2, 3][::-1]}", "B 2 [3, 2, 1]"),
        ("${python.any(x > 1 for x in [1, 2])}", "True"),
        ("${python.isinstance('a', str) and len(dict(a=1)) == 1}", "True"),
    ],
)
def test_what_descriptions_do_works(evaluate, text, value):
    assert evaluate(text) == value


def test_methods_of_yaml_values_are_theirs(evaluate):
    (evaluate.folder / "c.yaml").write_text("arm: {format: 3, mro: 4, length: !degrees 180*1.0}\n")
    load = f"xacro.load_yaml('{evaluate.folder}/c.yaml')['arm']"
    assert evaluate(f"${{{load}.format}}") == "3"
    assert evaluate(f"${{{load}['mro']}}") == "4"
    assert evaluate(f"${{round({load}['length'], 5)}}") == "3.14159"


@pytest.mark.parametrize(
    "text", [f"$(env {SECRET})", f"$(optenv {SECRET} x)", f"$(eval env('{SECRET}'))"]
)
def test_the_environment_is_not_shown(evaluate, monkeypatch, text):
    monkeypatch.setenv(SECRET, "hidden-value")
    with pytest.raises(UrdftoolError) as caught:
        evaluate(text)
    assert "--trust" in str(caught.value)
    assert "hidden-value" not in str(caught.value)
    monkeypatch.setenv(TRUST, "1")
    assert evaluate(text) == "hidden-value"


def test_what_says_which_ros_there_is_is_shown(evaluate, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    assert evaluate("$(env ROS_DISTRO)") == "jazzy"


def test_a_default_stands_for_what_is_not_set(evaluate, monkeypatch):
    monkeypatch.delenv("GRIPPER", raising=False)
    assert evaluate("$(optenv GRIPPER two finger)") == "two finger"
    with pytest.raises(UrdftoolError, match="not set"):
        evaluate("$(env GRIPPER)")


@pytest.fixture
def outside(tmp_path):
    """A folder that is no package's and not the project's."""
    folder = tmp_path / "elsewhere" / "private"
    folder.mkdir(parents=True)
    (folder / "keys.yaml").write_text("key: hidden-value\n")
    (folder / "part.xacro").write_text(XACRO.format('<link name="hidden-value"/>'))
    return folder


def _write(folder, body):
    path = folder / "a.xacro"
    path.write_text(XACRO.format(body))
    return path


LOADS = [
    "<link name=\"${xacro.load_yaml('KEYS')['key']}\"/>",
    "<link name=\"${load_yaml('KEYS')['key']}\"/>",
    '<xacro:include filename="PART"/>',
    '<xacro:include filename="FOLDER/*.xacro"/>',
]


@pytest.mark.parametrize("body", LOADS)
def test_files_elsewhere_are_out_of_reach(evaluate, outside, monkeypatch, body):
    for name, path in {"KEYS": "keys.yaml", "PART": "part.xacro", "FOLDER": ""}.items():
        body = body.replace(name, str(outside / path).rstrip("/"))
    path = _write(evaluate.folder, body)
    with pytest.raises(UrdftoolError) as caught:
        expand(path)
    assert "--trust" in str(caught.value)
    assert "hidden-value" not in str(caught.value)
    assert caught.value.line == 1
    monkeypatch.setenv(TRUST, "1")
    assert "hidden-value" in expand(path)


def test_a_link_does_not_lead_out(evaluate, outside):
    (evaluate.folder / "own.yaml").symlink_to(outside / "keys.yaml")
    with pytest.raises(UrdftoolError, match="a link to"):
        expand(_write(evaluate.folder, LOADS[0].replace("KEYS", "own.yaml")))


def test_a_link_into_a_package_of_ros_is_followed(evaluate, outside, monkeypatch):
    """As colcon --symlink-install makes them."""
    (outside / "package.xml").write_text("<package><name>p</name></package>")
    share = outside.parent.parent / "install" / "share" / "p"
    share.mkdir(parents=True)
    for name in ("package.xml", "keys.yaml"):
        (share / name).symlink_to(outside / name)
    path = _write(evaluate.folder, LOADS[0].replace("KEYS", f"{share}/keys.yaml"))
    with pytest.raises(UrdftoolError, match="a link to"):
        expand(path)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(share.parent.parent))
    assert "hidden-value" in expand(path)


def test_a_package_that_is_named_can_be_read(evaluate, outside):
    path = _write(evaluate.folder, '<xacro:include filename="$(find p)/part.xacro"/>')
    assert "hidden-value" in expand(path, packages={"p": outside})


def test_a_sibling_folder_in_the_repository_can_be_read(evaluate):
    (evaluate.folder.parent / ".git").mkdir()
    (evaluate.folder.parent / "config").mkdir()
    (evaluate.folder.parent / "config" / "c.yaml").write_text("key: 7\n")
    body = LOADS[0].replace("KEYS", str(evaluate.folder.parent / "config" / "c.yaml"))
    assert 'name="7"' in expand(_write(evaluate.folder, body))


@pytest.mark.parametrize("name", ["../elsewhere/private", "..", "/etc", "a/b"])
def test_a_package_name_is_no_path(evaluate, outside, name):
    with pytest.raises(UrdftoolError, match=r"not a package name|--package"):
        expand(_write(evaluate.folder, f'<link name="$(find {name})"/>'))


def test_hidden_folders_of_a_project_are_not_read(evaluate):
    hidden = evaluate.folder / ".ssh"
    hidden.mkdir()
    (hidden / "k.yaml").write_text("key: hidden-value\n")
    with pytest.raises(UrdftoolError, match="--trust"):
        expand(_write(evaluate.folder, LOADS[0].replace("KEYS", f"{hidden}/k.yaml")))


def test_properties_that_double_are_stopped(evaluate):
    doubled = "".join(
        f'<xacro:property name="a{n + 1}" value="${{a{n}}}${{a{n}}}"/>' for n in range(60)
    )
    body = f'<xacro:property name="a0" value="ha"/>{doubled}<link name="${{a60}}"/>'
    with pytest.raises(UrdftoolError, match="exceeds the limit"):
        expand(_write(evaluate.folder, body))


TABLES = [
    "${python.parent.vars(1)}",
    "${python.parent['vars']}",
    "${math.parent['comb'](10**7, 10**6)}",
    "${xacro.parent['load_yaml']}",
    "${python.root['vars']}",
]


@pytest.mark.parametrize("text", TABLES)
def test_tables_do_not_lead_to_what_was_replaced(evaluate, text):
    with pytest.raises(UrdftoolError):
        evaluate(text)


LOOPS = [
    "${[0 for x in python.range(999999) if [y for y in python.range(999)]]}",
    "${[0 for x in python.range(999999) for y in python.range(999) if x < 0]}",
    "$(eval [0 for x in [0] * 9999 for y in [0] * 9999 if x or y])",
]


@pytest.mark.skipif(sys.platform == "win32", reason="there are no timers")
@pytest.mark.parametrize("text", LOOPS)
def test_a_loop_without_end_is_ended(evaluate, monkeypatch, text):
    monkeypatch.setattr(limits, "SECONDS", 0.3)
    with pytest.raises(UrdftoolError, match="CPU time"):
        evaluate(text)
    assert signal.getitimer(signal.ITIMER_REAL) == (0, 0)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no timers")
def test_an_expansion_of_many_slow_expressions_is_ended(evaluate, monkeypatch):
    monkeypatch.setattr(limits, "TOTAL_SECONDS", 0.3)
    slow = "${len([0 for x in python.range(900000)])} "
    with pytest.raises(UrdftoolError, match=r"more than 0\.3 s"):
        evaluate(slow * 400)
    assert signal.getitimer(signal.ITIMER_REAL) == (0, 0)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no timers")
def test_memory_is_bounded_too(evaluate, monkeypatch):
    monkeypatch.setattr(limits, "MEMORY", 200 << 20)
    with pytest.raises(UrdftoolError, match="memory"):
        evaluate("${[[x] * 100000 for x in python.range(900)]}")


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pipes with names")
@pytest.mark.parametrize("kind", ["pipe", "device"])
@pytest.mark.parametrize("trust", ["", "1"])
def test_what_never_ends_is_not_included(evaluate, monkeypatch, kind, trust):
    monkeypatch.setenv(TRUST, trust)
    path = evaluate.folder / "part.xacro"
    if kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to("/dev/zero")
    with pytest.raises(UrdftoolError, match="device or a pipe") as caught:
        expand(_write(evaluate.folder, '<xacro:include filename="part.xacro"/>'))
    assert caught.value.line == 1

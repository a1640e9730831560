"""No expression runs, reads or reveals anything that it must not, in any place and command."""

import sys
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

import pytest

from tests.hostile import escape_bodies, escapes

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs processes that fork")

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


def attribute(text):
    """A text as the value of an attribute, with line ends and tabs kept."""
    return quoteattr(text, {"\n": "&#10;", "\r": "&#13;", "\t": "&#9;"})


def by_argument(text):
    """In an attribute; an argument holds the expression, since a brace would end it."""
    return f'<xacro:arg name="e" default={attribute(text)}/><link name="${{$(arg e)}}"/>', {}


def by_ros1(text):
    return f'<xacro:property name="e" value={attribute(text)}/><link name="$(eval ${{e}})"/>', {}


def by_property(text):
    name = '<xacro:property name="p" value="${$(arg e)}"/><link name="${p}"/>'
    return f'<xacro:arg name="e" default={attribute(text)}/>{name}', {}


def by_condition(text):
    inside = '<xacro:if value="${$(arg e)}"><link name="a"/></xacro:if>'
    return f'<xacro:arg name="e" default={attribute(text)}/>{inside}', {}


def by_default(text):
    macro = '<xacro:macro name="m" params="a:=${$(arg_e)}"><link name="${a}"/></xacro:macro>'
    macro = macro.replace("arg_e", "arg e") + "<xacro:m/>"
    return f'<xacro:arg name="e" default={attribute(text)}/>{macro}', {}


def by_macro(text):
    macro = '<xacro:macro name="m" params="a"><link name="${a}"/></xacro:macro>'
    call = '<xacro:m a="${$(arg e)}"/>'
    return f'<xacro:arg name="e" default={attribute(text)}/>{macro}{call}', {}


def by_text(text):
    return f'<xacro:arg name="e" default={attribute(text)}/><link name="a">${{$(arg e)}}</link>', {}


def by_include(text):
    include = '<xacro:include filename="${$(arg e)}"/>'
    return f'<xacro:arg name="e" default={attribute(text)}/>{include}', {}


def by_element(text):
    element = '<xacro:element xacro:name="${$(arg e)}"/>'
    return f'<xacro:arg name="e" default={attribute(text)}/>{element}', {}


def by_unit(text):
    quoted = "".join(c if c.isalnum() else f"\\U{ord(c):08x}" for c in text)
    files = {"unit.yaml": f'a: !degrees "{quoted}"\n'}
    return "<link name=\"${xacro.load_yaml('unit.yaml')['a']}\"/>", files


def by_yaml(text):
    """The expression is text of a file, and evaluated as a property's value."""
    quoted = "".join(c if c.isalnum() else f"\\U{ord(c):08x}" for c in text)
    body = "<xacro:property name=\"e\" value=\"${xacro.load_yaml('e.yaml')['a']}\"/>"
    return body + '<link name="$(eval ${e})"/>', {"e.yaml": f'a: "{quoted}"\n'}


OTHERS = (
    *(by_ros1, by_property, by_condition, by_default, by_macro, by_text, by_include, by_element),
    *(by_unit, by_yaml),
)
EXPRESSIONS = [(group, name) for group, named in escapes.GROUPS.items() for name in named]
BODIES = [(group, name) for group, named in escape_bodies.GROUPS.items() for name in named]

COMMANDS = {
    "expand": "expand robot.xacro",
    "source map": "expand robot.xacro -o OUT/a.urdf --source-map OUT/a.json --depfile OUT/a.d",
    "arguments": "expand robot.xacro --list-args",
    "files": "expand robot.xacro --deps",
    "lint": "lint robot.xacro --no-cache",
    "lint folder": "lint . -j 1",
    "lint json": "lint robot.xacro --no-cache --format json",
    "lint fix": "lint robot.xacro --no-cache --unsafe-fixes --diff",
    "info": "info robot.xacro",
    "graph": "graph robot.xacro -o -",
    "diff": "diff robot.xacro robot.xacro",
    "verify": "verify robot.xacro robot.xacro",
    "inertia": "inertia robot robot.xacro",
    "collision": "collision robot.xacro --check -j 1 --no-cache",
    "bundle": "bundle robot.xacro -o OUT/b",
    "srdf": "bundle plain.urdf --srdf robot.xacro -o OUT/b",
    "sdf": "export sdf robot.xacro -o OUT/s",
    "mjcf": "export mjcf robot.xacro -o OUT/m",
    "usd": "export usd robot.xacro -o OUT/u.usda",
    "simulate": "simulate robot.xacro --duration 0.1",
    "view": "view robot.xacro --picture OUT/a.png --size 64x48",
}
"""Every command that expands."""

SAMPLE = [
    ("spelling", "fullwidth g"),
    ("spelling", "line joined after the dot"),
    ("attributes", "func of a method"),
    ("format", "globals"),
    ("frames", "open"),
    ("namespaces", "load_yaml beside"),
]
"""Expressions that every command is given: each is dangerous in plain Python."""


def write(place, body, files):
    """Write the robot of a case into its project."""
    place.clear()
    for name, text in files.items():
        path = place.project / name
        path.write_text(place.fill(text), "utf-8", newline="")
    data = place.fill(f"{HEAD}{body}</robot>").encode("utf-8", "surrogatepass")
    (place.project / "robot.xacro").write_bytes(data)
    (place.project / "plain.urdf").write_text('<robot name="r"><link name="a"/></robot>')


def try_out(zygote, place, command, body, files, arguments=()):
    """Run a command; gives its outcome and what is wrong with it."""
    write(place, body, files)
    words = [word.replace("OUT", str(place.out)) for word in command.split()]
    outcome = zygote.run([*words, *map(place.fill, arguments)], place)
    problems = place.find_problems(outcome, objects=True)
    if command == COMMANDS["expand"] and outcome.code == 0 and not _is_xml(outcome.out):
        problems.append("it printed what is not XML")
    return outcome, problems


def _is_xml(data):
    try:
        ElementTree.fromstring(data)
    except (ElementTree.ParseError, ValueError, LookupError):
        return False
    return True


def check(zygote, place, command, cases):
    """Try cases one by one, and fail with a list of those in which something is wrong."""
    found = []
    for name, body, files, *arguments in cases:
        _, problems = try_out(zygote, place, command, body, files, *arguments)
        found += [f"{name}: {problem}" for problem in problems]
    assert not found, "\n".join(found)


THIRD = 3
"""Of so many cases one is tried by default, as each takes a process; slow tests try all."""


def expressions(group, route):
    return [(name, *route(text)) for name, text in escapes.GROUPS[group].items()]


def bodies(group):
    return [
        (name, body.text, body.files, body.arguments)
        for name, body in escape_bodies.GROUPS[group].items()
    ]


def test_there_are_many():
    texts = [text for named in escapes.GROUPS.values() for text in named.values()]
    assert len(set(texts)) >= 250
    assert len(BODIES) >= 150


@pytest.mark.parametrize("group", escapes.GROUPS)
def test_no_expression_of_a_third_escapes(zygote, place, group):
    check(zygote, place, "expand robot.xacro", expressions(group, by_argument)[::THIRD])


@pytest.mark.slow
@pytest.mark.parametrize("group", escapes.GROUPS)
def test_no_expression_escapes(zygote, place, group):
    check(zygote, place, "expand robot.xacro", expressions(group, by_argument))


@pytest.mark.parametrize("route", OTHERS, ids=lambda route: route.__name__)
def test_a_sample_does_not_escape_elsewhere(zygote, place, route):
    cases = [(name, *route(escapes.GROUPS[group][name])) for group, name in SAMPLE]
    check(zygote, place, "expand robot.xacro", cases)


@pytest.mark.slow
@pytest.mark.parametrize("route", OTHERS, ids=lambda route: route.__name__)
@pytest.mark.parametrize("group", escapes.GROUPS)
def test_no_expression_escapes_elsewhere(zygote, place, group, route):
    check(zygote, place, "expand robot.xacro", expressions(group, route))


@pytest.mark.parametrize("group", escape_bodies.GROUPS)
def test_nothing_of_a_third_of_xacro_escapes(zygote, place, group):
    check(zygote, place, "expand robot.xacro", bodies(group)[::THIRD])


@pytest.mark.slow
@pytest.mark.parametrize("group", escape_bodies.GROUPS)
def test_nothing_else_of_xacro_escapes(zygote, place, group):
    check(zygote, place, "expand robot.xacro", bodies(group))


@pytest.mark.parametrize("command", COMMANDS)
def test_no_command_lets_a_sample_through(zygote, place, command):
    cases = [(name, *by_argument(escapes.GROUPS[group][name])) for group, name in SAMPLE]
    check(zygote, place, COMMANDS[command], cases)


@pytest.mark.slow
@pytest.mark.parametrize("group", [*escapes.GROUPS, *escape_bodies.GROUPS])
@pytest.mark.parametrize("command", [name for name in COMMANDS if name != "expand"])
def test_no_command_lets_any_through(zygote, place, command, group):
    cases = bodies(group) if group in escape_bodies.GROUPS else expressions(group, by_argument)
    check(zygote, place, COMMANDS[command], cases)


NORMAL = ("ligature of f and i", "comment that hides a line end")
"""Other spellings of what is allowed."""

REFUSED = (
    *(("spelling", name) for name in escapes.SPELLING if name not in NORMAL),
    *(("format", name) for name in escapes.FORMAT if name.startswith("f-string")),
    *(("frames", name) for name in escapes.FRAMES if name.startswith(("walrus", "lambda"))),
    *(("attributes", name) for name in escapes.ATTRIBUTES if name.startswith("dunder")),
)
"""Expressions with a kind of syntax or a name that is not allowed, whatever they compute."""


def check_refused(zygote, place, group, step):
    """Expect an error at the expression for each so many of a group."""
    for name in [name for of, name in REFUSED if of == group][::step]:
        text = escapes.GROUPS[group][name]
        outcome, _ = try_out(zygote, place, "expand robot.xacro", *by_argument(text))
        assert outcome.code == 2, (name, outcome.out)
        assert b"robot.xacro:1" in outcome.err, (name, outcome.err)
        assert not outcome.out.strip(), name


REFUSED_GROUPS = sorted({group for group, _ in REFUSED})


@pytest.mark.parametrize("group", REFUSED_GROUPS)
def test_a_third_of_what_is_not_allowed_is_an_error_with_its_place(zygote, place, group):
    check_refused(zygote, place, group, THIRD)


@pytest.mark.slow
@pytest.mark.parametrize("group", REFUSED_GROUPS)
def test_what_is_not_allowed_is_an_error_with_its_place(zygote, place, group):
    check_refused(zygote, place, group, 1)


HARMFUL = {
    ("frames", "import"): "it ran a command",
    ("spelling", "line joined after the dot"): "it ran a command",
    ("frames", "open"): "it printed the file beside the project",
    ("format", "globals"): "it printed the environment",
}
"""What expressions do without a sandbox."""


def find_harm(zygote, place, group, name):
    """List what is wrong after an expression is evaluated without a sandbox."""
    place.clear()
    outcome = zygote.ask({"plain": place.fill(escapes.GROUPS[group][name])}, place)
    return place.find_problems(outcome, objects=True)


@pytest.mark.parametrize(("group", "name"), HARMFUL)
def test_harm_in_plain_python_is_seen_by_the_same_search(zygote, place, group, name):
    assert HARMFUL[group, name] in find_harm(zygote, place, group, name)


@pytest.mark.slow
def test_most_are_harmful_in_plain_python(zygote, place):
    harmful = 0
    for group in ("spelling", "attributes", "format", "frames"):
        for name in escapes.GROUPS[group]:
            if name not in ("nested specification that is wide", "help", "input", "breakpoint"):
                harmful += bool(find_harm(zygote, place, group, name))
    assert harmful > 30  # others need names that xacro does not give

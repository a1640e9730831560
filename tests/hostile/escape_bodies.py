"""Bodies of xacro files that try to run, read or reveal something, as data.

The expressions of ``escapes`` stand in an attribute; these use other parts of xacro: properties,
macros, arguments, substitutions, includes and YAML. The places of secrets are named as there.
"""
# ruff: noqa: E501

from __future__ import annotations

from typing import NamedTuple


class Body(NamedTuple):
    """Content of a ``<robot>``, with the files next to it and the arguments on the command line."""

    text: str
    files: dict[str, str] = {}  # noqa: RUF012 -- a default of a tuple, never changed
    arguments: tuple[str, ...] = ()


def link(value: str) -> str:
    """Return a link whose name is a value."""
    return f'<link name="{value}"/>'


LOAD = link("${xacro.load_yaml('a.yaml')}")
LOAD_A = link("${xacro.load_yaml('a.yaml')['a']}")
FRAME = "[g := (g.gi_frame.f_back.f_back.f_globals for _ in [1]), list(g)[0]['os'].popen('echo x>@MARK@').read()]"
IMPORT = "__import__('os').popen('echo x>@MARK@').read()"
MACRO = '<xacro:macro name="m" params="{}">{}</xacro:macro>'

SUBSTITUTIONS = {
    "expression in an expression": Body(link("${${().__class__}}")),
    "expression that makes an expression": Body(
        '<xacro:property name="p" value="$${().__class__}"/>' + link("${p}")
    ),
    "expression that makes an expression twice": Body(
        '<xacro:property name="p" value="$$${().__class__}"/>' + link("${${p}}")
    ),
    "text that becomes an expression": Body(
        '<xacro:property name="d" value="\'$\'"/>' + link("${d + '{len}'}")
    ),
    "name from an argument": Body(
        '<xacro:arg name="n" default="class__"/>' + link("${().__$(arg n)}")
    ),
    "dunder in two arguments": Body(
        '<xacro:arg name="a" default="().__"/><xacro:arg name="b" default="class__"/>'
        + link("${$(arg a)$(arg b)}")
    ),
    "attribute in an argument": Body(
        '<xacro:arg name="a" default="gi_frame"/>' + link("${(x for x in [1]).$(arg a)}")
    ),
    "whole expression in an argument": Body(
        f'<xacro:arg name="a" default="{IMPORT}"/>' + link("${$(arg a)}")
    ),
    "frames by an argument": Body(f'<xacro:arg name="a" default="{FRAME}"/>' + link("${$(arg a)}")),
    "argument of the command line": Body(
        '<xacro:arg name="a" default=""/>' + link("${$(arg a)}"), arguments=(f"a:={IMPORT}",)
    ),
    "argument of the command line, evaluated": Body(
        '<xacro:arg name="a" default=""/>' + link("$(arg a)"), arguments=("a:=${len}",)
    ),
    "argument named as a function": Body(
        '<xacro:arg name="len" default="x"/>' + link("${len}"), arguments=("len:=y",)
    ),
    "argument with a dunder name": Body(
        '<xacro:arg name="__builtins__" default="x"/>' + link("$(arg __builtins__)")
    ),
    "argument in an argument": Body(
        '<xacro:arg name="a" default="$(arg b)"/><xacro:arg name="b" default="${len}"/>'
        + link("$(arg a)")
    ),
    "environment": Body(link("$(env @ENV@)")),
    "optional environment": Body(link("$(optenv @ENV@ x)")),
    "environment with blanks": Body(link("$(env   @ENV@ )")),
    "environment by a property": Body(
        '<xacro:property name="p" value="@ENV@"/>' + link("$(env ${p})")
    ),
    "environment in an expression": Body(link("${'$(env @ENV@)'}")),
    "environment in a default": Body(
        '<xacro:arg name="a" default="$(env @ENV@)"/>' + link("$(arg a)")
    ),
    "environment in a macro": Body(MACRO.format("a:=$(env @ENV@)", link("${a}")) + "<xacro:m/>"),
    "environment in a condition": Body(
        '<xacro:if value="$(env @ENV@)"><link name="a"/></xacro:if>'
    ),
    "environment in a comment": Body("<!-- xacro:eval-comments --><!-- $(env @ENV@) -->"),
    "environment in text": Body("<link name='a'>$(env @ENV@)</link>"),
    "environment in an include": Body('<xacro:include filename="$(env @ENV@)"/>'),
    "environment in the name of an element": Body('<xacro:element xacro:name="$(env @ENV@)"/>'),
    "environment in an attribute": Body(
        '<link name="a"><xacro:attribute name="b" value="$(env @ENV@)"/></link>'
    ),
    "environment in ROS 1 eval": Body(link("$(eval env('@ENV@')")),
    "environment by a ROS 1 name": Body(
        '<xacro:property name="p" value="env(\'@ENV@\')"/>' + link("$(eval ${p})")
    ),
    "environment in YAML": Body(LOAD_A, {"a.yaml": "a: $(env @ENV@)\n"}),
    "environment in YAML, evaluated later": Body(
        "<xacro:property name=\"p\" value=\"${xacro.load_yaml('a.yaml')['a']}\"/>" + link("${p}"),
        {"a.yaml": "a: $(env @ENV@)\n"},
    ),
    "find of a parent": Body(link("$(find ..)")),
    "find of the root": Body(link("$(find /)")),
    "find with a slash": Body(link("$(find a/../../beside)")),
    "find of a folder above": Body(link("${xacro.load_yaml('$(find work)/beside/secret.yaml')}")),
    "find of the home folder": Body(
        link("${xacro.load_yaml('$(find home)/Documents/secret.yaml')}")
    ),
    "find of the folder next to it": Body(link("${xacro.load_yaml('$(find beside)/secret.yaml')}")),
    "find named by the project's configuration": Body(
        link("${xacro.load_yaml('$(find x)/secret.yaml')}"),
        {"urdftool.toml": '[packages]\nx = "../beside"\n'},
    ),
    "find of an absolute folder of the configuration": Body(
        link("${xacro.load_yaml('$(find x)/Documents/secret.yaml')}"),
        {"urdftool.toml": '[packages]\nx = "@HOMEDIR@"\n'},
    ),
    "paths of the project's configuration": Body(
        link("${xacro.load_yaml('$(find beside)/secret.yaml')}"),
        {"urdftool.toml": '[packages]\npaths = [".."]\npath = [".."]\n'},
    ),
    "find in pyproject.toml": Body(
        link("${xacro.load_yaml('$(find x)/secret.yaml')}"),
        {"pyproject.toml": '[tool.urdftool.packages]\nx = "../beside"\n'},
    ),
    "dirname": Body(link("${xacro.load_yaml('$(dirname)/../beside/secret.yaml')}")),
    "cwd": Body(link("${xacro.load_yaml('$(cwd)/../beside/secret.yaml')}")),
    "anon": Body(link("$(anon a)")),
    "unknown command": Body(link("$(shell id)")),
    "command without an end": Body(link("$(eval ().__class__")),
    "ROS 1 eval": Body(link("$(eval len)")),
    "ROS 1 eval of a class": Body(link("$(eval ().__class__)")),
    "ROS 1 eval of fullwidth": Body(link("$(eval [].__ｃlass__)")),
    "ROS 1 eval by a property": Body(
        f'<xacro:property name="p" value="{IMPORT}"/>' + link("$(eval ${p})")
    ),
    "ROS 1 eval of a mathematical name": Body(link("$(eval pi.__ｃlass__)")),
    "ROS 1 eval in ROS 1 eval": Body(link("$(eval $(eval len))")),
    "ROS 1 eval of a format": Body(
        '<xacro:property name="p" value="\'{0.__class__}\'.format(1)"/>' + link("$(eval ${p})")
    ),
    "decimal entity for the dot": Body(link("${()&#46;__class__}")),
    "hexadecimal entity for a letter": Body(link("${().__&#x63;lass__}")),
    "hexadecimal entity for a fullwidth letter": Body(link("${().__&#xff43;lass__}")),
    "entity for a line end": Body(
        link("${[g := (g.\\&#10;gi_frame.f_back for _ in [1]), list(g)]}")
    ),
    "entity for a carriage return": Body(link("${(().&#13;__class__)}")),
    "entity for a tab": Body(link("${().&#9;__class__}")),
    "CDATA": Body("<link name='a'><![CDATA[${().__class__}]]></link>"),
    "text": Body("<link name='a'>${len}</link>"),
    "comment": Body("<!-- xacro:eval-comments --><!-- ${len} -->"),
    "processing instruction": Body("<?a ${len}?><link name='a'/>"),
    "namespace declaration": Body('<link xmlns:a="${len}" name="a"/>'),
    "name of a property": Body('<xacro:property name="${len}" value="1"/>'),
    "name of a macro": Body('<xacro:call macro="${len}"/>'),
    "name of an element": Body('<xacro:element xacro:name="${len}"/>'),
    "name of an attribute": Body(
        '<link name="a"><xacro:attribute name="${len}" value="b"/></link>'
    ),
    "value of an attribute": Body(
        '<link name="a"><xacro:attribute name="b" value="${len}"/></link>'
    ),
}

EVALUATION = {
    "lazy property": Body(f'<xacro:property name="p" value="${{{IMPORT}}}"/>' + link("${p}")),
    "property that is not lazy": Body(
        f'<xacro:property name="p" value="${{{IMPORT}}}" lazy_eval="false"/>'
    ),
    "property of the global scope": Body(
        f'<xacro:property name="p" value="${{{IMPORT}}}" scope="global"/>'
    ),
    "property of the parent scope": Body(
        MACRO.format("", f'<xacro:property name="p" value="${{{IMPORT}}}" scope="parent"/>')
        + "<xacro:m/>"
    ),
    "default of a property": Body(
        f'<xacro:property name="p" default="${{{IMPORT}}}"/>' + link("${p}")
    ),
    "lazy_eval": Body('<xacro:property name="p" value="1" lazy_eval="${len}"/>'),
    "remove": Body('<xacro:property name="p" remove="${len}"/>'),
    "property that holds a function": Body(
        '<xacro:property name="p" value="${len}"/>' + link("${p('a')}")
    ),
    "property that holds a namespace": Body(
        '<xacro:property name="p" value="${python}"/>' + link("${p.vars}")
    ),
    "property that holds a method": Body(
        '<xacro:property name="p" value="${\'{0.__class__}\'.format}"/>' + link("${p(1)}")
    ),
    "property that holds a generator": Body(
        '<xacro:property name="p" value="${(x for x in [1])}"/>' + link("${p.gi_frame}")
    ),
    "property that holds a lambda": Body(
        '<xacro:property name="p" value="${lambda: 0}"/>' + link("${p.__code__}")
    ),
    "property named as a function": Body(
        '<xacro:property name="len" value="${str}"/>' + link("${len(1)}")
    ),
    "property named as a namespace": Body(
        '<xacro:property name="python" value="${dict(type=1)}"/>' + link("${python.type}")
    ),
    "property named as an operator": Body(
        '<xacro:property name="__product__" value="${len}"/>' + link("${2 * 3}")
    ),
    "property with a dunder name": Body('<xacro:property name="__builtins__" value="1"/>'),
    "property with a dunder name in fullwidth": Body(
        '<xacro:property name="＿＿builtins＿＿" value="${dict(a=1)}"/>' + link("${len('a')}")
    ),
    "property that builds a list of itself": Body(
        '<xacro:property name="p" value="${[1]}"/>' + link("${p.append(p)}${p}")
    ),
    "property that is circular": Body(
        '<xacro:property name="p" value="${q}"/><xacro:property name="q" value="${p}"/>'
        + link("${p}")
    ),
    "text of a property that is an expression": Body(
        "<xacro:property name=\"p\" value=\"${'$' + '{len}'}\"/>" + link("${p}")
    ),
    "block property": Body(
        '<xacro:property name="b"><link name="${len}"/></xacro:property><xacro:insert_block name="b"/>'
    ),
    "value of a block property": Body(
        '<xacro:property name="b"><link name="a"/></xacro:property>' + link("${b}")
    ),
    "element of a block by its symbol": Body(
        MACRO.format("*b", link("${b}")) + '<xacro:m><link name="a"/></xacro:m>'
    ),
    "macro default": Body(MACRO.format("a:=${len}", link("${a}")) + "<xacro:m/>"),
    "macro default that runs": Body(MACRO.format(f"a:=${{{IMPORT}}}", link("${a}")) + "<xacro:m/>"),
    "macro default that is forwarded": Body(
        '<xacro:property name="a" value="${len}"/>'
        + MACRO.format("a:=^", link("${a}"))
        + "<xacro:m/>"
    ),
    "macro default that is forwarded or not": Body(
        MACRO.format("a:=^|${len}", link("${a}")) + "<xacro:m/>"
    ),
    "macro default that forwards a dunder": Body(
        MACRO.format("__builtins__:=^|1", link("${__builtins__}")) + "<xacro:m/>"
    ),
    "macro default that forwards a namespace": Body(
        MACRO.format("python:=^", link("${python}")) + "<xacro:m/>"
    ),
    "macro parameter named as a function": Body(
        MACRO.format("str", link("${str(1)}")) + '<xacro:m str="${len}"/>'
    ),
    "macro argument": Body(MACRO.format("a", link("${a}")) + '<xacro:m a="${len}"/>'),
    "macro argument that runs": Body(
        MACRO.format("a", link("${a}")) + f'<xacro:m a="${{{IMPORT}}}"/>'
    ),
    "macro by a name": Body(
        MACRO.format("", link("a")) + "<xacro:call macro=\"${'m' if len else ''}\"/>"
    ),
    "condition": Body('<xacro:if value="${len}"><link name="a"/></xacro:if>'),
    "condition that runs": Body(f'<xacro:if value="${{{IMPORT}}}"><link name="a"/></xacro:if>'),
    "condition that is a class": Body(
        '<xacro:unless value="${str}"><link name="a"/></xacro:unless>'
    ),
    "condition that is ROS 1": Body('<xacro:if value="$(eval len)"><link name="a"/></xacro:if>'),
    "condition that is not a boolean": Body(
        '<xacro:if value="${[len]}x"><link name="a"/></xacro:if>'
    ),
    "optional include": Body('<xacro:include filename="@BESIDE@" optional="${len}"/>'),
    "symbols of a namespace": Body(
        '<xacro:include filename="part.xacro" ns="n"/>' + link("${n}"),
        {"part.xacro": '<robot><xacro:property name="p" value="1"/></robot>'},
    ),
    "parent of a namespace": Body(
        '<xacro:include filename="part.xacro" ns="n"/>' + link("${n.parent}"),
        {"part.xacro": '<robot><xacro:property name="p" value="1"/></robot>'},
    ),
    "namespace with a dunder name": Body(
        '<xacro:include filename="part.xacro" ns="__builtins__"/>' + link("${len('a')}"),
        {"part.xacro": '<robot><xacro:property name="len" value="1"/></robot>'},
    ),
    "namespace named as another": Body(
        '<xacro:include filename="part.xacro" ns="xacro"/>' + link("${xacro.load_yaml}"),
        {"part.xacro": '<robot><xacro:property name="p" value="1"/></robot>'},
    ),
    "namespace that is evaluated": Body(
        '<xacro:include filename="part.xacro" ns="${len}"/>',
        {"part.xacro": "<robot/>"},
    ),
}

FILES = {
    "include beside": Body('<xacro:include filename="@BESIDE@"/>'),
    "include relative": Body('<xacro:include filename="../beside/secret.xml"/>'),
    "include of the home folder": Body('<xacro:include filename="@HOME@"/>'),
    "include of a user's home folder": Body('<xacro:include filename="~/Documents/secret.yaml"/>'),
    "include of the temporary folder": Body('<xacro:include filename="@TMP@"/>'),
    "include of many": Body('<xacro:include filename="../beside/*.xml"/>'),
    "include of hidden ones": Body('<xacro:include filename=".*"/>'),
    "include of all folders": Body('<xacro:include filename="../*/*"/>'),
    "include by a class of characters": Body('<xacro:include filename="../[b]eside/secret.xml"/>'),
    "include of the environment": Body('<xacro:include filename="/proc/self/environ"/>'),
    "include of a memory": Body('<xacro:include filename="/proc/self/mem"/>'),
    "include of a device": Body('<xacro:include filename="/dev/zero"/>'),
    "include of standard input": Body('<xacro:include filename="/dev/stdin"/>'),
    "include of a folder": Body('<xacro:include filename=".."/>'),
    "include of itself": Body('<xacro:include filename="robot.xacro"/>'),
    "include of a URL": Body('<xacro:include filename="file://@BESIDE@"/>'),
    "include of a package URL": Body('<xacro:include filename="package://beside/secret.xml"/>'),
    "include by an expression": Body(
        "<xacro:include filename=\"${'../bes' + 'ide/secret.xml'}\"/>"
    ),
    "include of an optional one": Body('<xacro:include filename="@BESIDE@" optional="true"/>'),
    "include of a file whose message quotes it": Body(
        '<xacro:include filename="../beside/secret.txt"/>'
    ),
    "include of the user's accounts": Body('<xacro:include filename="/etc/passwd"/>'),
    "YAML beside": Body(link("${xacro.load_yaml('../beside/secret.yaml')}")),
    "YAML whose message quotes it": Body(link("${xacro.load_yaml('../beside/secret.txt')}")),
    "YAML of a hidden file": Body(link("${xacro.load_yaml('.env')}")),
    "YAML of the repository": Body(link("${xacro.load_yaml('.git/config')}")),
    "entity of a file": Body(
        '<xacro:include filename="part.xacro"/>',
        {
            "part.xacro": '<!DOCTYPE r [<!ENTITY a SYSTEM "@BESIDE@">]><robot><link name="a">&a;</link></robot>'
        },
    ),
    "external definition": Body(
        '<xacro:include filename="part.xacro"/>',
        {"part.xacro": '<!DOCTYPE robot SYSTEM "@BESIDE@"><robot/>'},
    ),
    "parameter entity": Body(
        '<xacro:include filename="part.xacro"/>',
        {"part.xacro": '<!DOCTYPE r [<!ENTITY % a SYSTEM "@BESIDE@"> %a;]><robot/>'},
    ),
    "XInclude": Body(
        '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="@BESIDE@" parse="text"/>'
    ),
    "style sheet": Body('<?xml-stylesheet href="@BESIDE@"?><link name="a"/>'),
}


def yaml(text: str) -> Body:
    """Return a body that prints a YAML file."""
    return Body(LOAD, {"a.yaml": text})


def unit(expression: str, tag: str = "!degrees") -> Body:
    """Return a body that prints a value with a unit."""
    quoted = expression.replace("\\", "\\\\").replace('"', '\\"')
    return Body(LOAD_A, {"a.yaml": f'a: {tag} "{quoted}"\n'})


YAML = {
    "PyYAML CVE-2017-18342: apply": yaml("!!python/object/apply:os.system ['echo x>@MARK@']"),
    "PyYAML CVE-2019-20477: Popen": yaml(
        "!!python/object/apply:subprocess.Popen [['touch', '@MARK@']]"
    ),
    "PyYAML CVE-2020-1747: new": yaml(
        "!!python/object/new:type {args: [z, !!python/tuple [], {extend: !!python/name:exec}], "
        'listitems: \'__import__("os").system("echo x>@MARK@")\'}'
    ),
    "PyYAML CVE-2020-14343: new and state": yaml(
        "!!python/object/new:tuple [!!python/object/new:map [!!python/name:eval, "
        '[\'__import__("os").system("echo x>@MARK@")\']]]'
    ),
    "PyYAML issue 321: file": yaml(
        "!!python/object/apply:list [!!python/object/apply:io.FileIO ['@BESIDE@', 'r']]"
    ),
    "PyYAML: module": yaml("!!python/module:os"),
    "PyYAML: name": yaml("!!python/name:os.environ"),
    "PyYAML: object": yaml("!!python/object:urdftool.source.sandbox.Sandbox {}"),
    "PyYAML: tuple": yaml("!!python/tuple [1]"),
    "PyYAML: tag by a handle": yaml(
        "%TAG !p! tag:yaml.org,2002:python/\n---\n!p!object/apply:os.system ['echo x>@MARK@']"
    ),
    "PyYAML: verbatim tag": yaml(
        "!<tag:yaml.org,2002:python/object/apply:os.system> ['echo x>@MARK@']"
    ),
    "PyYAML: tag in percent signs": yaml("!!pyth%6fn/object/apply:os.system ['echo x>@MARK@']"),
    "PyYAML: key that is an object": yaml("? !!python/name:os.system\n: 1"),
    "PyYAML: set": yaml("!!set {a, b}"),
    "PyYAML: omap": yaml("!!omap [a: 1]"),
    "PyYAML: binary": yaml("!!binary eA=="),
    "PyYAML: timestamp": yaml("a: 2001-12-14t21:59:43.10-05:00"),
    "PyYAML: merge": yaml("a: &a {b: 1}\nc: {<<: *a}"),
    "PyYAML: value key": yaml("=: 1"),
    "unknown tag": yaml("a: !system id"),
    "several documents": yaml("a: 1\n---\nb: 2"),
    "key __class__": Body(
        link("${xacro.load_yaml('a.yaml').__class__}"), {"a.yaml": "__class__: 1\n"}
    ),
    "item __class__": Body(
        link("${xacro.load_yaml('a.yaml')['__class__']}"), {"a.yaml": "__class__: 1\n"}
    ),
    "missing item __class__": Body(
        link("${xacro.load_yaml('a.yaml')['__class__']}"), {"a.yaml": "a: 1\n"}
    ),
    "attribute of a wrapper": Body(
        link("${xacro.load_yaml('a.yaml').__init__.__globals__}"), {"a.yaml": "a: 1\n"}
    ),
    "attribute of a wrapped list": Body(
        link("${xacro.load_yaml('a.yaml').wrap.__globals__}"), {"a.yaml": "[1]\n"}
    ),
    "wrap of a list": Body(link("${xacro.load_yaml('a.yaml').wrap(python)}"), {"a.yaml": "[1]\n"}),
    "wrap as a value": Body(link("${xacro.load_yaml('a.yaml').wrap}"), {"a.yaml": "[1]\n"}),
    "method of a wrapper as a value": Body(
        link("${xacro.load_yaml('a.yaml').update}"), {"a.yaml": "a: 1\n"}
    ),
    "method of a wrapper hidden by a key": Body(
        link("${xacro.load_yaml('a.yaml').get}"), {"a.yaml": "get: 1\n"}
    ),
    "fullwidth key": Body(
        link("${xacro.load_yaml('a.yaml').＿＿class＿＿}"), {"a.yaml": "＿＿class＿＿: 1\n"}
    ),
    "key that looks like a frame": Body(
        link("${xacro.load_yaml('a.yaml').gi_frame}"), {"a.yaml": "gi_frame: 1\n"}
    ),
    "key that is an expression": Body(
        link("${xacro.load_yaml('a.yaml').a}"), {"a.yaml": "a: ${len}\n"}
    ),
    "key that is an expression, evaluated later": Body(
        '<xacro:property name="p" value="${xacro.load_yaml(\'a.yaml\').a}"/>' + link("${p}"),
        {"a.yaml": "a: ${len}\n"},
    ),
    "text of a file as an expression": Body(
        '<xacro:property name="p" value="${xacro.load_yaml(\'a.yaml\').a}"/>'
        + link("${xacro.arg(p)}"),
        {"a.yaml": f'a: "{IMPORT}"\n'.replace('"', "'").replace("''", "'")},
    ),
    "class of a date": Body(
        link("${xacro.load_yaml('a.yaml')['a'].__class__}"), {"a.yaml": "a: 2001-12-14\n"}
    ),
    "method of a date": Body(
        link("${xacro.load_yaml('a.yaml')['a'].strftime('%c')}"), {"a.yaml": "a: 2001-12-14\n"}
    ),
    "method of a date with a long format": Body(
        link("${xacro.load_yaml('a.yaml')['a'].strftime('%9999999c')}"),
        {"a.yaml": "a: 2001-12-14\n"},
    ),
    "format of a date": Body(link("${'{0:%c}'.format(1)}"), {"a.yaml": "a: 2001-12-14\n"}),
    "bytes of YAML": Body(
        link("${xacro.load_yaml('a.yaml')['a'].decode('unicode_escape')}"),
        {"a.yaml": "a: !!binary XHg1Zg==\n"},
    ),
    "file in another codec": Body(
        link("${xacro.load_yaml('a.yaml')}"), {"a.yaml": "# coding: utf-7\na: 1\n"}
    ),
    **{
        f"unit {tag}": unit("().__class__", tag)
        for tag in ("!radians", "!degrees", "!meters", "!millimeters", "!foot", "!inches")
    },
    "unit that imports": unit(IMPORT),
    "unit that opens": unit("open('@BESIDE@').read()"),
    "unit with frames": unit(FRAME),
    "unit with fullwidth": unit("().__ｃlass__"),
    "unit with a joined line": unit("().\\\n__class__"),
    "unit with a format": unit("'{0.__class__}'.format(1)"),
    "unit of a function": unit("len"),
    "unit of a class": unit("float"),
    "unit of a namespace": unit("python"),
    "unit that loads": unit("xacro.load_yaml('@BESIDE@')['key']"),
    "unit with a walrus": unit("(x := 1)"),
    "unit with a lambda": unit("(lambda: 1)()"),
    "unit of a list": Body(LOAD_A, {"a.yaml": "a: !degrees [1]\n"}),
    "unit of a mapping": Body(LOAD_A, {"a.yaml": "a: !degrees {b: 1}\n"}),
    "unit of nothing": Body(LOAD_A, {"a.yaml": "a: !degrees\n"}),
    "unit in a unit": Body(LOAD_A, {"a.yaml": "a: !degrees !meters 1\n"}),
    "unit that loads itself": unit("xacro.load_yaml('a.yaml')['a']"),
}

PART = {
    "part.xacro": '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="p" '
    'value="1"/><xacro:property name="b"><link name="x"/></xacro:property></robot>'
}
INCLUDED = '<xacro:include filename="part.xacro" ns="n"/>'

TABLES = {
    name: Body(INCLUDED + link(f"${{{expression}}}"), PART)
    for name, expression in {
        "block by its key": "n['**b']",
        "block by its key in a format": "'%s' % n['**b']",
        "block by a mapping": "'%(**b)s' % n",
        "builtins by a mapping": "'%(__builtins__)s' % n",
        "function by a mapping": "'%(load_yaml)s' % xacro",
        "copy as a dictionary": "dict(n)",
        "block of a copy": "dict(n)['**b']",
        "attribute of a block of a copy": "dict(n)['**b'].attributes",
        "parent of a block of a copy": "dict(n)['**b'].parentNode",
        "keys of a copy": "list(n)",
        "copy of the namespace xacro": "dict(xacro)['load_yaml']",
        "method of a copy": "dict(xacro)['load_yaml'].__func__",
        "items of a copy": "[v for k, v in dict(python).items()]",
        "values in a comprehension": "[n[k] for k in n]",
        "values of all namespaces": "[xacro[k] for k in xacro]",
        "text of a namespace": "str(n)",
        "joined keys": "','.join(n)",
        "zip of a namespace": "list(python.zip(n, n))",
        "sorted namespaces": "python.sorted([n, python], key=str)",
        "dotify of a copy": "xacro.dotify(dict(n))",
        "union": "n | python",
        "equality": "n == python",
        "membership of a dunder": "'__builtins__' in n",
        "isinstance of a namespace": "python.isinstance(n, dict)",
        "set of functions": "python.set([len, str])",
        "function by a conditional": "(len if n else str)('a')",
        "function in a list": "[len][0]",
        "method kept in a dictionary": "dict(a='a'.upper)['a']",
        "text by repr": "python.repr(xacro.load_yaml)",
        "text by join": "','.join(map(str, [len]))",
        "text by join of representations": "','.join(map(python.repr, [len]))",
        "text by a key": "max([len, str], key=python.repr)",
        "text by tokenize": "xacro.tokenize(str(len))",
        "text by a message": "xacro.message(len, str, n)",
        "text by an error of a key": "dict(a=1)[len]",
        "text by an error of an index": "[1].index(len)",
        "text by an error of a type": "len + 1",
        "text by an error of a call": "(1)(len)",
        "text by an error of a number": "int(str(len))",
        "text by an error of a float": "float(python.repr(len))",
        "text by an error of arguments": "len(len)",
    }.items()
}
TABLES |= {
    "text in a name": Body('<xacro:property name="${len}" value="1"/>'),
    "text in a condition": Body('<xacro:if value="${str(len)}"/>'),
    "text in the name of a macro": Body('<xacro:call macro="${str(len)}"/>'),
    "text in an include": Body('<xacro:include filename="${len}"/>'),
    "text in a package": Body(link("$(find ${len})")),
    "text in the default of an argument": Body(
        '<xacro:arg name="a" default="${len}"/>' + link("$(arg a)")
    ),
    "text in a call that is shown": Body(MACRO.format("a", link("${b}")) + '<xacro:m a="${len}"/>'),
}

OUTPUT = {
    "element with a blank in its name": Body('<xacro:element xacro:name="a b"/>'),
    "element with markup in its name": Body("<xacro:element xacro:name=\"${'a/&gt;&lt;b'}\"/>"),
    "element with a digit in its name": Body('<xacro:element xacro:name="1a"/>'),
    "element with a colon in its name": Body('<xacro:element xacro:name="a:b"/>'),
    "element whose name is a number": Body('<xacro:element xacro:name="${1}"/>'),
    "element whose name is a list": Body('<xacro:element xacro:name="${[1]}"/>'),
    "element whose name is a control character": Body(
        "<xacro:element xacro:name=\"${'a\\x1b'}\"/>"
    ),
    "element of xacro": Body('<xacro:element xacro:name="xacro:include"/>'),
    **{
        f"attribute named {name!r}": Body(
            f'<link name="a"><xacro:attribute name="{name}" value="b"/></link>'
        )
        for name in ("a b", "a=&quot;&quot; b", "1", "a&gt;", "xmlns:xacro", "&#9;")
    },
    **{
        f"character {character}": Body(link(f"${{'{character}'}}"))
        for character in (
            *("\\0", "\\x01", "\\x08", "\\x0b", "\\x0c", "\\x1b[31m", "\\x7f", "\\x9b31m"),
            *("\\ud800", "\\udfff", "\\ufffe", "\\uffff", "\\U0010ffff", "\\u202e", "\\r\\n\\t"),
        )
    },
    **{
        f"character {character} in text": Body(f"<link name='a'>${{'{character}'}}</link>")
        for character in ("\\0", "\\x1b", "\\ud800", "\\ufffe")
    },
    "surrogate by percent": Body(link("${'%c' % 55296}")),
    "control character by percent": Body(link("${'%c' % 27}")),
    "control character of YAML": Body(LOAD_A, {"a.yaml": 'a: "\\x1b]0;x\\a"\n'}),
    "surrogate of YAML": Body(LOAD_A, {"a.yaml": 'a: "\\ud800"\n'}),
    "hyphens in a comment": Body("<!-- xacro:eval-comments --><!-- ${'-' * 2} -->"),
    "end of a comment": Body("<!-- xacro:eval-comments --><!-- ${'-' * 2 + '&gt;'}<a/> -->"),
    "end of a comment without entities": Body(
        "<!-- xacro:eval-comments --><!-- ${'-' * 2 + '>'}<a/> -->"
    ),
    "control character in a comment": Body("<!-- xacro:eval-comments --><!-- ${'\\x1b'} -->"),
    "messages with escapes": Body(
        link(
            "${xacro.message('\\x1b]0;x\\x07')}${xacro.warning('\\x1b[2J')}${xacro.error('\\x9b2J')}"
        )
    ),
    "fatal message with escapes": Body(link("${xacro.fatal('\\x1b]0;x\\x07\\u202e')}")),
    "message with a surrogate": Body(link("${xacro.message('\\ud800')}")),
    "error with escapes": Body(link("${int('\\x1b]0;x\\x07')}")),
    "error with a surrogate": Body(link("${int('\\ud800')}")),
    "key with escapes": Body(link("${dict(a=1)['\\x1b[2J']}")),
    "package with escapes": Body(link("$(find ${'\\x1b[2J'})")),
    "file with escapes": Body("<xacro:include filename=\"${'\\x1b[2J'}\"/>"),
    "file with a null byte": Body("<xacro:include filename=\"${'a\\0b'}\"/>"),
    "file with a surrogate": Body("<xacro:include filename=\"${'\\ud800'}\"/>"),
    "macro with escapes": Body("<xacro:call macro=\"${'\\x1b[2J'}\"/>"),
}

GROUPS = {
    "tables": TABLES,
    "output": OUTPUT,
    "substitutions": SUBSTITUTIONS,
    "evaluation": EVALUATION,
    "files": FILES,
    "yaml": YAML,
}
"""Bodies by what they use."""

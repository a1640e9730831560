"""Expressions and bodies of xacro that would take all time or memory, as data."""
# ruff: noqa: E501

from __future__ import annotations

from tests.hostile.escape_bodies import MACRO, Body, link


def nest(count: int) -> str:
    """Return properties in which each list holds the one before it twice."""
    lists = (
        f'<xacro:property name="{a}{n}" value="${{[{a}{n - 1}, {a}{n - 1}]}}" lazy_eval="false"/>'
        for n in range(1, count + 1)
        for a in "ab"
    )
    first = '<xacro:property name="a0" value="${[1]}"/><xacro:property name="b0" value="${[1]}"/>'
    return first + "".join(lists)


def tuples(count: int) -> str:
    """Return properties in which each tuple holds the one before it twice."""
    first = '<xacro:property name="a0" value="${(1,)}"/>'
    return first + "".join(
        f'<xacro:property name="a{n}" value="${{(a{n - 1}, a{n - 1})}}" lazy_eval="false"/>'
        for n in range(1, count + 1)
    )


def dictionaries(count: int) -> str:
    """Return properties in which each dictionary holds the one before it twice."""
    first = "".join(f'<xacro:property name="{a}0" value="${{dict(k=1)}}"/>' for a in "ab")
    return first + "".join(
        f'<xacro:property name="{a}{n}" value="${{dict(k={a}{n - 1}, l={a}{n - 1})}}" lazy_eval="false"/>'
        for n in range(1, count + 1)
        for a in "ab"
    )


def repeat(times: int, text: str) -> str:
    """Return elements that evaluate an expression many times."""
    return "".join(f'<link name="{n}{text}"/>' for n in range(times))


EXPRESSIONS = {
    "power": "9**9**9**9",
    "power of a negative": "(-9)**(9**9)",
    "power in a loop": "[9**99999 for x in python.range(99999)]",
    "shift": "1 << 10**10",
    "product of texts": "'a' * 10**10",
    "product of lists": "[0] * 10**10",
    "product of products": "[[0] * 10**6] * 10**6",
    "product of tuples": "(0,) * 10**10",
    "product by a boolean": "'a' * (10**9 * True)",
    "product by itself": "('a' * 10**7) * 10**7",
    "sum of lists": "python.sum([[0] * 10**6] * 10**6, [])",
    "sum of ranges": "python.sum(python.range(10**12))",
    "range": "list(python.range(10**9))",
    "range in a range": "[[y for y in python.range(10**6)] for x in python.range(10**6)]",
    "ranges that are zipped": "list(python.zip(*[python.range(10**6)] * 10**6))",
    "ranges that are enumerated": "[list(python.enumerate(python.range(10**6))) for x in python.range(10**6)]",
    "sorted ranges": "[python.sorted(python.range(10**6)) for x in python.range(10**6)]",
    "reversed ranges": "[list(python.reversed(python.range(10**6))) for x in python.range(10**6)]",
    "sets": "[python.set(python.range(10**6)) for x in python.range(10**6)]",
    "dictionaries": "[dict(python.zip(python.range(10**6), python.range(10**6))) for x in python.range(10**6)]",
    "comprehension of a comprehension": "[0 for a in [0] * 9999 for b in [0] * 9999 for c in [0] * 9999]",
    "comprehension without a result": "[x for x in python.range(10**6) for y in python.range(10**6) if y < 0]",
    "comprehension of texts": "['a' * 10**6 for x in python.range(10**6)]",
    "comprehension of dictionaries": "{x: 'a' * 10**6 for x in python.range(10**6)}",
    "format width": "'{:9999999999}'.format(1)",
    "format width in parts": "'{:{}}'.format(1, 10**9)",
    "format precision": "'{:.999999999f}'.format(1.0)",
    "format of many": "'{0:9999}'.format(1) * 10**6",
    "format with many fields": "('{0:9999}' * 10**5).format(1)",
    "percent width": "'%9999999999d' % 1",
    "percent star": "'%*d' % (10**9, 1)",
    "percent precision": "'%.999999999f' % 1",
    "percent of many": "('%9999d' * 10**5) % ((1,) * 10**5)",
    "zfill": "'a'.zfill(10**10)",
    "center": "'a'.center(10**10)",
    "ljust": "'a'.ljust(10**10, 'b')",
    "rjust": "'a'.rjust(10**10)",
    "expandtabs": "'\\t'.expandtabs(10**10)",
    "replace": "('a' * 10**6).replace('a', 'b' * 10**6)",
    "replace of nothing": "('a' * 10**6).replace('', 'b' * 10**6)",
    "join": "('a' * 10**6).join(['b'] * 10**6)",
    "join of a text": "('a' * 10**6).join('b' * 10**6)",
    "split": "[('a ' * 10**6).split() for x in python.range(10**6)]",
    "split of characters": "('a,' * 5 * 10**6).split(',')",
    "splitlines": "[('a\\n' * 10**6).splitlines() for x in python.range(10**6)]",
    "find": "('a' * 10**6).find('a' * 5 * 10**5 + 'b')",
    "count": "[('a' * 10**6).count('a' * 5 * 10**5 + 'b') for x in python.range(10**5)]",
    "in": "('a' * 5 * 10**5 + 'b') in ('a' * 10**6)",
    "startswith": "('a' * 10**6).startswith(('a',) * 10**6)",
    "upper": "('ß' * 5 * 10**6).upper()",
    "casefold": "('ΐ' * 5 * 10**6).casefold()",
    "title": "[('a ' * 10**6).title() for x in python.range(10**6)]",
    "encode": "('\\U0001f600' * 10**6).encode('unicode_escape')",
    "translate": "('a' * 10**6).translate(dict([(97, 'b' * 10**6)]))",
    "to_bytes": "(1).to_bytes(10**10, 'big')",
    "from_bytes": "int.from_bytes(b'a' * 10**7, 'big') ** 2",
    "int of many digits": "int('9' * 10**6)",
    "int of many digits in base 3": "int('2' * 5 * 10**6, 3)",
    "int of many digits in base 36": "int('z' * 10**6, 36)",
    "float of many digits": "float('9' * 5 * 10**6)",
    "fromhex": "float.fromhex('0x' + 'f' * 5 * 10**6)",
    "bytes fromhex": "bytes.fromhex('41' * 5 * 10**6)",
    "complex": "python.complex('9' * 5 * 10**6)",
    "text of a large number": "str(9**99999)",
    "text of a large number in hexadecimal": "'%x' % (1 << 10**9)",
    "round": "round(7, -10**10)",
    "round of a large number": "round(9**9999, -9999)",
    "divmod": "python.divmod(9**99999, 7**9999)",
    "quotients in a loop": "[9**99999 // 7**55555 for x in python.range(10**6)]",
    "factorial": "math.factorial(10**8)",
    "factorials": "[math.factorial(5000) for x in python.range(10**6)]",
    "comb": "math.comb(10**7, 10**6)",
    "perm": "math.perm(10**7)",
    "lcm": "math.lcm(*python.range(1, 10**5))",
    "gcd": "[math.gcd(9**99999, 7**99999) for x in python.range(10**6)]",
    "prod": "math.prod(python.range(1, 10**6))",
    "isqrt": "[math.isqrt(9**99999) for x in python.range(10**6)]",
    "fsum": "math.fsum([1e308, 1e-308] * 5 * 10**6)",
    "dist": "math.dist([0] * 5 * 10**6, [1] * 5 * 10**6)",
    "hypot": "math.hypot(*([1] * 5 * 10**6))",
    "ldexp": "math.ldexp(1.0, 10**18)",
    "nextafter": "math.nextafter(0.0, 1.0, steps=10**18)",
    "max with a key": "max(python.range(10**6), key=lambda x: [y for y in python.range(10**6)])",
    "map": "list(map(list, [python.range(10**6)] * 10**6))",
    "filter": "list(python.filter(None, python.range(10**6)))",
    "any": "python.any(x < 0 for x in python.range(10**6) for y in python.range(10**6))",
    "tokenize": "xacro.tokenize('a' * 10**6, 'a')",
    "tokenize with a slow pattern": "xacro.tokenize('a' * 30 + 'b', ']|(a|aa)+$|[')",
    "tokenize with a slower pattern": "xacro.tokenize('a' * 40, '](a+)+b[')",
    "dotify": "[xacro.dotify(dict(a=x)) for x in python.range(10**6) for y in python.range(10**6)]",
    "message": "[xacro.message('a' * 10**6) for x in python.range(10**5)]",
    "warnings": "[xacro.warning('a' * 10**6) for x in python.range(10**5)]",
    "walrus that doubles": "[a := 'x', [a := a + a for _ in python.range(60)]]",
    "walrus that squares": "[a := 3, [a := a * a for _ in python.range(60)]]",
    "extend by itself": "[x.extend(x) for x in [[0] * 10**6] for y in python.range(60)]",
    "append of itself": "[x.append(x[:]) for x in [[0]] for y in python.range(60)]",
    "insert of itself": "[x.insert(0, x * 2) for x in [[0]] for y in python.range(60)]",
    "slices": "[([0] * 10**6)[:] for x in python.range(10**6)]",
    "slice with a step": "[([0] * 10**6)[::-1] for x in python.range(10**6)]",
    "update": "[x.update(dict([(y, 'a' * 10**6)])) for x in [{}] for y in python.range(10**6)]",
    "unions of sets": "[python.set(python.range(10**6)) | python.set(python.range(10**6)) for x in python.range(10**6)]",
    "list of itself": "[x.append(x) for x in [[]]]",
    "large set of equal hashes": "python.set([x * (2**61 - 1) for x in python.range(10**6)])",
    "large dictionary of equal hashes": "{x * (2**61 - 1): 1 for x in python.range(10**5)}",
    "search in a large list": "[x in ([0] * 10**6) for x in python.range(1, 10**6)]",
    "removals from a list": "[x.pop(0) for x in [[0] * 10**6] for y in python.range(10**6)]",
    "insertions into a list": "[x.insert(0, 0) for x in [[0] * 10**6] for y in python.range(10**6)]",
    "index in a list": "[([0] * 10**6 + [1]).index(1) for x in python.range(10**6)]",
    "sort": "[x.sort() for x in [list(python.range(10**6))] for y in python.range(10**6)]",
    "lambda that recurses": "(lambda f: f(f))(lambda f: f(f))",
    "lambda with two recursions": "(lambda f, n: f(f, n))(lambda f, n: f(f, n + 1) + f(f, n + 1), 0)",
    "brackets": "(" * 20_000 + "1" + ")" * 20_000,
    "open brackets": "(" * 20_000,
    "square brackets": "[" * 20_000 + "]" * 20_000,
    "nested calls": "str(" * 500 + "1" + ")" * 500,
    "signs": "-" * 80_000 + "1",
    "negations": "not " * 80_000 + "1",
    "sums": "+".join(["1"] * 80_000),
    "powers": "**".join(["1"] * 80_000),
    "comparisons": "<".join(["1"] * 80_000),
    "conditions": "1 if 1 else " * 20_000 + "1",
    "lambdas": "lambda: " * 20_000 + "1",
    "attributes": "a" + ".a" * 80_000,
    "subscripts": "a" + "[0]" * 80_000,
    "names": ",".join(f"a{n}" for n in range(80_000)),
    "long list": "[" + "1," * 500_000 + "]",
    "long text": "'" + "a" * 5_000_000 + "'",
    "long number": "9" * 100_000,
    "long number in hexadecimal": "0x" + "f" * 1_000_000,
    "long float": "1e" + "9" * 1_000_000,
    "long name": "a" * 1_000_000,
    "unicode names": "ｱ" * 200_000,
    "dollars": "'" + "$" * 80_000 + "'",
    **{
        f"{name} of an allowed length": text
        for name, text in {
            "brackets": "(" * 199 + "1" + ")" * 199,
            "square brackets": "[" * 199 + "]" * 199,
            "signs": "-" * 9000 + "1",
            "inversions": "~" * 9000 + "1",
            "negations": "not " * 2400 + "1",
            "sums": "+".join(["1"] * 4900),
            "products": "*".join(["9"] * 4900),
            "powers": "**".join(["1"] * 3300),
            "comparisons": "<".join(["1"] * 4900),
            "conjunctions": " and ".join(["1"] * 1600),
            "conditions": "1 if 1 else " * 800 + "1",
            "attributes": "a" + ".a" * 4900,
            "methods": "''" + ".upper()" * 1200,
            "subscripts": "a" + "[0]" * 3300,
            "calls": "a" + "()" * 4900,
            "comprehensions": "[" * 90 + "1" + " for x in [1]]" * 90,
            "loops of a comprehension": "[0" + " for x in [1]" * 700 + "]",
            "loops of a long comprehension": "[0" + " for x in range(9)" * 500 + "]",
            "keywords": "dict(" + ",".join(f"a{n}=1" for n in range(1200)) + ")",
            "number": "9" * 9900,
            "names of a property": "a" * 9900,
            "dollars": "'" + "$" * 9900 + "'",
        }.items()
    },
}
"""Expressions."""

BODIES = {
    "lists that are compared": Body(nest(60) + link("${a60 == b60}")),
    "lists that are ordered": Body(nest(60) + link("${a60 < b60}")),
    "lists that are sorted": Body(nest(60) + link("${python.sorted([a60, b60])}")),
    "lists of which one is the larger": Body(nest(60) + link("${max(a60, b60) == a60}")),
    "lists in a list": Body(nest(60) + link("${a60 in [b60]}")),
    "lists that are counted": Body(nest(60) + link("${[b60].count(a60)}")),
    "lists that are indexed": Body(nest(60) + link("${[b60].index(a60)}")),
    "lists that are removed": Body(nest(60) + link("${[b60].remove(a60)}")),
    "lists as text": Body(nest(60) + link("${a60}")),
    "lists as text of a function": Body(nest(60) + link("${len(str(a60))}")),
    "lists as text by percent": Body(nest(60) + link("${len('%s' % [a60])}")),
    "lists in a message": Body(nest(60) + link("${xacro.message(a60)}")),
    "lists in a warning": Body(nest(60) + link("${xacro.warning(a60)}")),
    "lists in an error": Body(nest(60) + link("${xacro.fatal(a60)}")),
    "lists as a condition": Body(nest(60) + '<xacro:if value="${a60}"/>'),
    "tuples that are hashed": Body(tuples(60) + link("${python.hash(a60)}")),
    "tuples as keys": Body(tuples(60) + link("${dict([(a60, 1)])}")),
    "tuples in a set": Body(tuples(60) + link("${python.set([a60])}")),
    "tuples as an index": Body(tuples(60) + link("${dict(a=1).get(a60)}")),
    "dictionaries that are compared": Body(dictionaries(60) + link("${a60 == b60}")),
    "dictionaries that are unequal": Body(dictionaries(60) + link("${a60 != b60}")),
    "dictionaries as text": Body(dictionaries(60) + link("${a60}")),
    "a list of itself that is compared": Body(
        '<xacro:property name="a" value="${[1]}"/><xacro:property name="b" value="${[1]}"/>'
        + link("${a.append(b)}${b.append(a)}${a == b}")
    ),
    "extensions by itself": Body(
        '<xacro:property name="x" value="${[0] * 10**6}"/>' + repeat(60, "${x.extend(x)}")
    ),
    "additions to itself": Body(
        '<xacro:property name="x" value="${[0] * 10**6}"/>'
        + repeat(500, "${x.append([0] * 10**6)}")
    ),
    "updates of a dictionary": Body(
        '<xacro:property name="x" value="${dict(a=1)}"/>'
        + "".join(f'<link name="${{x.update(dict(k{n}=[0] * 10**6))}}"/>' for n in range(500))
    ),
    "properties that double": Body(
        '<xacro:property name="a0" value="ha"/>'
        + "".join(
            f'<xacro:property name="a{n + 1}" value="${{a{n}}}${{a{n}}}"/>' for n in range(60)
        )
        + link("${a60}")
    ),
    "properties that are evaluated again": Body(
        '<xacro:property name="a0" value="1"/>'
        + "".join(
            f'<xacro:property name="a{n + 1}" value="${{a{n} + a{n}}}"/>' for n in range(3000)
        )
        + link("${a3000}")
    ),
    "macro that calls itself": Body(MACRO.format("", "<xacro:m/>") + "<xacro:m/>"),
    "macro that calls itself twice": Body(
        MACRO.format(
            "n", '<xacro:if value="${n}"><xacro:m n="${n - 1}"/><xacro:m n="${n - 1}"/></xacro:if>'
        )
        + '<xacro:m n="60"/>'
    ),
    "macro with a slow default": Body(
        MACRO.format("a:=${[0 for x in python.range(10**6)]}", link("a")) + "<xacro:m/>" * 500
    ),
    "block that is inserted twice": Body(
        MACRO.format(
            "n *b",
            '<xacro:if value="${n}"><xacro:m n="${n - 1}"><a><xacro:insert_block name="b"/><xacro:insert_block name="b"/></a></xacro:m></xacro:if><xacro:unless value="${n}"><xacro:insert_block name="b"/></xacro:unless>',
        )
        + '<xacro:m n="60"><b/></xacro:m>'
    ),
    "include of itself": Body('<xacro:include filename="robot.xacro"/>'),
    "include of itself twice": Body('<xacro:include filename="robot.xacro"/>' * 2),
    "includes in turn": Body(
        '<xacro:include filename="b.xacro"/>',
        {
            "b.xacro": '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="robot.xacro"/></robot>'
        },
    ),
    "slow expressions": Body(repeat(2000, "${len([0 for x in python.range(900000)])}")),
    "slow conditions": Body('<xacro:if value="${len([0 for x in python.range(900000)])}"/>' * 2000),
    "dollars in a text": Body(link("$" * 80_000)),
    "dollars and a brace": Body(link("$" * 80_000 + "{")),
    "open expressions": Body(link("${" * 40_000)),
    "open substitutions": Body(link("$(" * 40_000)),
    "substitutions in a substitution": Body(link("$(arg " * 5000 + ")" * 5000)),
    "expressions side by side": Body(link("${1}" * 80_000)),
    "blanks in a macro's parameters": Body(
        f'<xacro:macro name="m" params="{"a" * 40}={" " * 40_000}x"/>'
    ),
    "parameters of a macro": Body(
        f'<xacro:macro name="m" params="{" ".join(f"a{n}:=1" for n in range(20_000))}"/><xacro:m/>'
    ),
    "parameter of a macro with a slow pattern": Body(
        f'<xacro:macro name="m" params="a:={"x" * 30}&quot;"/>'
    ),
    "condition with many digits": Body(f'<xacro:if value="{"9" * 1_000_000}"/>'),
    "property with many digits": Body(
        f'<xacro:property name="p" value="{"9" * 1_000_000}"/>' + link("${p}")
    ),
    "tuples of an allowed depth": Body(
        '<xacro:property name="a0" value="${(1,)}"/>'
        + "".join(
            f'<xacro:property name="a{n}" value="${{{"(" * 90}a{n - 1}{",)" * 90}}}" lazy_eval="false"/>'
            for n in range(1, 2000)
        )
        + link("${dict([(a1999, 1)])}")
    ),
    "lists in lists without a result": Body(
        '<xacro:property name="a0" value="${[]}"/>'
        + "".join(
            f'<xacro:property name="a{n}" value="${{[]}}"/><link name="${{a{n}.append(a{n - 1})}}"/>'
            for n in range(1, 20_000)
        )
        + link("${str(a19999) == str(a19998)}")
    ),
    "lists in lists without a result, compared": Body(
        '<xacro:property name="a0" value="${[]}"/>'
        + "".join(
            f'<xacro:property name="a{n}" value="${{[]}}"/><link name="${{a{n}.append(a{n - 1})}}"/>'
            for n in range(1, 20_000)
        )
        + link("${a19999 == a19998}")
    ),
    "YAML aliases": Body(
        link("${xacro.load_yaml('a.yaml')}"),
        {
            "a.yaml": "a0: &a0 [1]\n"
            + "".join(f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]\n" for n in range(1, 60))
        },
    ),
    "YAML that is deep": Body(link("${xacro.load_yaml('a.yaml')}"), {"a.yaml": "[" * 50_000}),
    "YAML of many units": Body(
        link("${xacro.load_yaml('a.yaml')}"),
        {"a.yaml": "- !degrees '[0 for x in python.range(10**6)].__len__()'\n" * 5000},
    ),
    "YAML with slow units": Body(
        link("${xacro.load_yaml('a.yaml')}"),
        {"a.yaml": "- !degrees 'len([0 for x in python.range(900000)])'\n" * 5000},
    ),
    "YAML with equal hashes": Body(
        link("${len(xacro.load_yaml('a.yaml'))}"),
        {"a.yaml": "".join(f"{n * (2**61 - 1)}: 1\n" for n in range(20_000))},
    ),
    "YAML that is loaded again": Body(
        repeat(2000, "${len(xacro.load_yaml('a.yaml'))}"),
        {"a.yaml": "".join(f"k{n}: 1\n" for n in range(20_000))},
    ),
    "includes by a pattern": Body('<xacro:include filename="/*/*/*/*/*/*"/>'),
    "includes of all folders": Body('<xacro:include filename="/**/*.xacro"/>'),
    "ROS 1 eval": Body('<xacro:property name="p" value="9**9**9**9"/>' + link("$(eval ${p})")),
    "ROS 1 eval of a list": Body(
        '<xacro:property name="p" value="[0] * 10**10"/>' + link("$(eval ${p})")
    ),
    "ROS 1 eval that loops": Body(
        '<xacro:property name="p" value="[0 for x in [0] * 9999 for y in [0] * 9999]"/>'
        + link("$(eval ${p})")
    ),
    "unit": Body(link("${xacro.load_yaml('a.yaml').a}"), {"a.yaml": "a: !degrees 9**9**9**9\n"}),
}
"""Bodies of a robot."""
